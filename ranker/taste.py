"""A writer's taste: a small head that learns from which take was chosen of several.

A conditional logit (McFadden 1974): the chosen take of a shot beats the others with the probability that a
softmax over their utilities says. The utility of a take is the score it had before anybody chose, tempered,
and what the head adds: of its traits, numbers somebody may like more or less of, and of its frozen features.
What is learnt is added to the ranker's margin, so a taste of nothing changes nothing, and a choice changes
little (a ridge keeps the head small). Kept as safetensors of some kilobytes with the digest of the weights
whose features it reads; nothing that is loaded is ever executed.
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
from scipy.special import logsumexp, softmax

from .errors import RankerError

SCHEMA = "vds.taste/2"
LARGEST = 1024 * 1024
_RIDGE = 3.0  # of the head, in choices
#: What log odds of before are divided by: the ranker is surer of an order than a writer, who chooses among
#: takes that are all good, is bound to it.
_TEMPERATURE = 4.0
_MOST = 12.0  # log odds a taste may add or take away
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Taste:
    """head: float32 [D], on features of unit length less ``middle`` [D]; weights: digest of the ranker's

    likes: float32 [M], log odds a step of each trait adds, from ``usual`` [M] on; traits: their names
    choices: how many shots it was learnt from
    """

    head: NDArray[np.float32]
    middle: NDArray[np.float32]
    likes: NDArray[np.float32]
    usual: NDArray[np.float32]
    traits: tuple[str, ...]
    weights: str
    choices: int

    def adds(self, traits: NDArray[np.floating], features: NDArray[np.float32] | None = None) -> Array:
        """What is added to the margins of takes with these traits [P, M] and features [P, D]: log odds [P].

        Without features, what their traits alone add.
        """
        found = (np.asarray(traits, np.float64) - self.usual) @ self.likes
        if features is not None:
            found = found + (_unit(features) - self.middle) @ self.head
        return np.asarray(_MOST * np.tanh(found / _MOST), np.float64)


@dataclass(frozen=True, eq=False)
class Choice:
    """A shot's takes: features [T, D] as the ranker sees them, traits [T, M] in steps, log odds [T] by which
    they were put in order before anybody chose; which was chosen."""

    features: NDArray[np.float32]
    traits: NDArray[np.floating]
    margins: NDArray[np.floating]
    chosen: int


def learn(choices: Sequence[Choice], traits: tuple[str, ...], weights: str) -> Taste:
    """The taste that explains choices best; raises :class:`RankerError` where there is none to learn from.

    traits: their names
    """
    some = [c for c in choices if len(c.features) > 1]
    if not some:
        raise RankerError("there is nothing to learn from: choose takes with `vdsc pick` first")
    middle = _unit(np.concatenate([c.features for c in some])).mean(axis=0)
    usual = np.concatenate([c.traits for c in some]).mean(axis=0)
    # From the chosen take on; features, that lie close together, as far apart as a step of a trait.
    apart = [_unit(c.features).astype(np.float64) - _unit(c.features)[c.chosen] for c in some]
    scale = float(np.sqrt(np.mean([(x**2).sum(axis=1).sum() / (len(x) - 1) for x in apart]))) or 1.0
    shots = [
        (
            np.hstack([c.traits - c.traits[c.chosen], x / scale]),
            (c.margins - c.margins[c.chosen]) / _TEMPERATURE,
        )
        for c, x in zip(some, apart, strict=True)
    ]

    def loss(w: Array) -> tuple[float, Array]:
        total, slope = 0.5 * _RIDGE * float(w @ w), _RIDGE * w
        for x, known in shots:
            utility = known + x @ w  # 0 for the chosen one
            total += float(logsumexp(utility))
            slope = slope + softmax(utility) @ x
        return total, slope

    found = minimize(loss, np.zeros(len(traits) + len(middle)), jac=True, method="L-BFGS-B").x * _TEMPERATURE
    likes, head = found[: len(traits)], found[len(traits) :] / scale
    small = np.float32
    return Taste(
        head.astype(small), middle, likes.astype(small), usual.astype(small), traits, weights, len(some)
    )


def save_taste(path: Path, taste: Taste) -> None:
    """Write a taste in one step. Raises OSError."""
    about = {
        "schema": SCHEMA,
        "weights": taste.weights,
        "choices": str(taste.choices),
        "traits": " ".join(taste.traits),
    }
    tensors = {"head": taste.head, "middle": taste.middle, "likes": taste.likes, "usual": taste.usual}
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        part.write_bytes(save(tensors, metadata=about))
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def load_taste(path: Path, traits: tuple[str, ...], weights: str) -> Taste:
    """Read a taste for traits of these names and a ranker with weights of a digest.

    Raises :class:`RankerError` for any other file.
    """
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST + 1)
        size = int.from_bytes(content[:8], "little")
        about = json.loads(content[8 : 8 + size])["__metadata__"]
        schema = about["schema"]
        if not str(schema).startswith("vds.taste/") or len(content) > LARGEST:
            raise ValueError
        if schema != SCHEMA or about["traits"].split() != list(traits):
            raise RankerError(
                f"{path}: was learnt by another version; `vdsc train --picks` again, or remove it"
            )
        tensors = load(content)
        head, middle, likes, usual = (tensors[name] for name in ("head", "middle", "likes", "usual"))
        if head.ndim != 1 or head.shape != middle.shape or likes.shape != usual.shape:
            raise ValueError
        if likes.shape != (len(traits),) or not all(np.isfinite(t).all() for t in tensors.values()):
            raise ValueError
        taste = Taste(head, middle, likes, usual, traits, str(about["weights"]), int(about["choices"]))
    except OSError as error:
        raise RankerError(f"{path}: cannot be read: {error.strerror or error}") from error
    except (SafetensorError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise RankerError(
            f"{path}: is no taste, or damaged; remove it, or `vdsc train --picks` again"
        ) from error
    if taste.weights != weights:
        raise RankerError(f"{path}: was learnt with other weights; remove it, or `vdsc train --picks` again")
    return taste


def _unit(features: NDArray[np.float32]) -> NDArray[np.float32]:
    length = np.linalg.norm(features, axis=1, keepdims=True)
    return np.asarray(features / np.maximum(length, 1e-9), np.float32)
