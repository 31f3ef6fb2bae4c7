"""A writer's taste: a small head on frozen features that learns from which take was chosen of several.

Bradley and Terry's model: the chosen take of a shot beats every other with the probability that the
difference of their scores says. What is learnt is added to the ranker's margin, so a taste of nothing
changes nothing, and few choices change little (a ridge keeps the head small). Kept as safetensors of some
kilobytes with the digest of the weights whose features it reads; nothing that is loaded is ever executed.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from safetensors import SafetensorError
from safetensors.numpy import load, save
from scipy.optimize import minimize

from .errors import RankerError

SCHEMA = "vds.taste/1"
LARGEST = 1024 * 1024
_RIDGE = 4.0  # of the head, in pairs
_MOST = 6.0  # log odds a taste may add or take away
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Taste:
    """head: float32 [D], on features of unit length less ``middle`` [D]; weights: digest of the ranker's

    choices: how many shots it was learnt from
    """

    head: NDArray[np.float32]
    middle: NDArray[np.float32]
    weights: str
    choices: int

    def adds(self, features: NDArray[np.float32]) -> Array:
        """What is added to the margins of takes with these features [P, D]: log odds [P]."""
        return np.asarray(np.clip((_unit(features) - self.middle) @ self.head, -_MOST, _MOST), np.float64)


@dataclass(frozen=True, eq=False)
class Choice:
    """A shot's takes: features [T, D] as the ranker sees them, log odds [T] by which they were put in order
    before anybody chose; which was chosen."""

    features: NDArray[np.float32]
    margins: NDArray[np.floating]
    chosen: int


def learn(choices: Sequence[Choice], weights: str) -> Taste:
    """The taste that explains choices best; raises :class:`RankerError` where there is none to learn from."""
    some = [c for c in choices if len(c.features) > 1]
    if not some:
        raise RankerError("there is nothing to learn from: choose takes with `vdsc pick` first")
    middle = _unit(np.concatenate([c.features for c in some])).mean(axis=0)
    pairs, known = [], []
    for c in some:
        found = _unit(c.features).astype(np.float64)
        for other in (i for i in range(len(found)) if i != c.chosen):
            pairs.append(found[c.chosen] - found[other])
            known.append(float(c.margins[c.chosen] - c.margins[other]))
    x, offset = np.array(pairs), np.array(known)
    scale = float(np.sqrt((x**2).sum(axis=1).mean())) or 1.0
    x = x / scale

    def loss(w: Array) -> tuple[float, Array]:
        z = offset + x @ w
        slope = -1.0 / (1.0 + np.exp(np.clip(z, -60, 60)))
        return float(np.logaddexp(0.0, -z).sum() + 0.5 * _RIDGE * w @ w), x.T @ slope + _RIDGE * w

    head = minimize(loss, np.zeros(x.shape[1]), jac=True, method="L-BFGS-B").x / scale
    return Taste(head.astype(np.float32), middle.astype(np.float32), weights, len(some))


def save_taste(path: Path, taste: Taste) -> None:
    """Write a taste in one step. Raises OSError."""
    about = {"schema": SCHEMA, "weights": taste.weights, "choices": str(taste.choices)}
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        part.write_bytes(save({"head": taste.head, "middle": taste.middle}, metadata=about))
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def load_taste(path: Path, weights: str) -> Taste:
    """Read a taste for a ranker with weights of a digest; :class:`RankerError` for any other file."""
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST + 1)
        size = int.from_bytes(content[:8], "little")
        about = json.loads(content[8 : 8 + size])["__metadata__"]
        if about["schema"] != SCHEMA or len(content) > LARGEST:
            raise ValueError
        tensors = load(content)
        head, middle = tensors["head"], tensors["middle"]
        if head.ndim != 1 or head.shape != middle.shape or not np.isfinite([head, middle]).all():
            raise ValueError
        taste = Taste(head, middle, str(about["weights"]), int(about["choices"]))
    except OSError as error:
        raise RankerError(f"{path}: cannot be read: {error.strerror or error}") from error
    except (SafetensorError, ValueError, KeyError, TypeError) as error:
        raise RankerError(
            f"{path}: is no taste, or damaged; remove it, or `vdsc train --picks` again"
        ) from error
    if taste.weights != weights:
        raise RankerError(f"{path}: was learnt with other weights; remove it, or `vdsc train --picks` again")
    return taste


def _unit(features: NDArray[np.float32]) -> NDArray[np.float32]:
    length = np.linalg.norm(features, axis=1, keepdims=True)
    return np.asarray(features / np.maximum(length, 1e-9), np.float32)
