"""A writer's taste: a small head that learns from which take was chosen of several.

A conditional logit (McFadden 1974): the chosen take of a shot beats the others with the probability that a
softmax over their utilities says. The utility of a take is the score it had before anybody chose, and what
the head adds: of its traits, numbers somebody may like more or less of. What is learnt is added to the
ranker's margin, so a taste of nothing changes nothing; a ridge keeps the head small. Kept as JSON, which can
be read, compared and mended by hand.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.special import logsumexp, softmax

from .errors import RankerError

SCHEMA = "vds.taste/1"
LARGEST = 1024 * 1024
_RIDGE = 3.0  # of the head, in choices
#: What log odds of before are divided by while learning: the ranker is surer of an order than a writer, who
#: chooses among takes that are all good, is bound to it.
_CALMED = 4.0
_MOST = 12.0  # log odds a taste may add or take away
_DECIMALS = 4
_GREATEST = 1e6  # number in a file
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Taste:
    """likes: log odds [M] that a step of each trait adds, from ``usual`` [M] on; traits: their names

    choices: how many shots it was learnt from
    """

    likes: Array
    usual: Array
    traits: tuple[str, ...]
    choices: int

    def adds(self, traits: NDArray[np.floating]) -> Array:
        """What is added to the margins of takes with these traits [P, M]: log odds [P]."""
        found = (np.asarray(traits, np.float64) - self.usual) @ self.likes
        return np.asarray(_MOST * np.tanh(found / _MOST))


@dataclass(frozen=True, eq=False)
class Choice:
    """A shot's takes: traits [T, M] in steps, log odds [T] by which they were put in order before anybody
    chose; which was chosen."""

    traits: NDArray[np.floating]
    margins: NDArray[np.floating]
    chosen: int


def learn(choices: Sequence[Choice], traits: tuple[str, ...]) -> Taste:
    """The taste that explains choices best; raises :class:`RankerError` where there is none to learn from.

    traits: their names
    """
    some = [c for c in choices if len(c.traits) > 1]
    if not some:
        raise RankerError("there is nothing to learn from: choose takes with `vdsc pick` first")
    shots = [
        (c.traits - c.traits[c.chosen], (c.margins - c.margins[c.chosen]) / _CALMED)  # 0 of the chosen one
        for c in some
    ]

    def loss(w: Array) -> tuple[float, Array]:
        total, slope = 0.5 * _RIDGE * float(w @ w), _RIDGE * w
        for x, known in shots:
            utility = known + x @ w
            total += float(logsumexp(utility))
            slope = slope + softmax(utility) @ x
        return total, slope

    likes = minimize(loss, np.zeros(len(traits)), jac=True, method="L-BFGS-B").x * _CALMED
    usual = np.concatenate([c.traits for c in some]).mean(axis=0)
    return Taste(likes.round(_DECIMALS) + 0.0, usual.round(_DECIMALS) + 0.0, traits, len(some))


def save_taste(path: Path, taste: Taste) -> None:
    """Write a taste in one step. Raises OSError."""
    about = {
        "schema": SCHEMA,
        "choices": taste.choices,
        "likes": dict(zip(taste.traits, taste.likes.tolist(), strict=True)),
        "usual": dict(zip(taste.traits, taste.usual.tolist(), strict=True)),
    }
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        part.write_text(json.dumps(about, indent=1, allow_nan=False) + "\n", "utf-8")
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def load_taste(path: Path, traits: tuple[str, ...]) -> Taste:
    """Read a taste for traits of these names; one it does not name is neither liked nor disliked.

    Raises :class:`RankerError` for any other file.
    """
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST + 1)
        if len(content) > LARGEST:
            raise ValueError
        about = json.loads(content.decode("utf-8"))
        if about["schema"] != SCHEMA:
            raise ValueError
        likes, usual = (_numbers(about[name], traits) for name in ("likes", "usual"))
        return Taste(likes, usual, traits, int(about["choices"]))
    except OSError as error:
        raise RankerError(f"{path}: cannot be read: {error.strerror or error}") from error
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError) as error:
        raise RankerError(
            f"{path}: is no taste of this version, or damaged; `vdsc train --picks` again, or remove it"
        ) from error


def _numbers(found: dict[str, Any], traits: tuple[str, ...]) -> Array:
    """By names of traits, which all have to be known and to be numbers."""
    if not found.keys() <= set(traits):
        raise ValueError
    values = [float(found.get(name, 0.0)) for name in traits]
    if not all(abs(value) <= _GREATEST for value in values):  # nor NaN
        raise ValueError
    return np.array(values)
