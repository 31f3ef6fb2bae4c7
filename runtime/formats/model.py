"""A model as read: coloured triangles in pieces, and how they are brought to our axes, size and floor.

Lengths of a :class:`Piece` are as in the file until :func:`settled`; colours are sRGB 0..1.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import limits
from .errors import ModelFileError

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Piece:
    """Part of a model with a name of its own.

    vertices: float64 [V, 3]; faces: int32 [F, 3]; colors: float32 [F, 3]
    glass: bool [F], faces that are seen through; glow: bool [F], faces that give light
    """

    name: str
    vertices: Array
    faces: NDArray[np.int32]
    colors: NDArray[np.float32]
    glass: NDArray[np.bool_]
    glow: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Model:
    """All pieces of a file, in its own coordinates; ``y_up``: its upward axis is Y, not Z."""

    path: Path
    pieces: tuple[Piece, ...]
    y_up: bool


@dataclass(frozen=True)
class Fit:
    """How a model is brought into a film.

    up: ``y``, ``z`` or ``""`` as its format has it; turn: radians about Z
    scale: metres for one of its units; height, length, width: what it has to measure (one of the four)
    """

    up: str = ""
    turn: float = 0.0
    scale: float | None = None
    height: float | None = None
    length: float | None = None
    width: float | None = None


def settled(model: Model, fit: Fit, centred: bool = True) -> tuple[Piece, ...]:
    """The pieces in metres, Z up, front along -Y, on z = 0; ``centred``: and around (0, 0)."""
    used = [p for p in model.pieces if len(p.faces)]
    if not used:
        raise ModelFileError(model.path, "it has no triangles")
    points = np.concatenate([p.vertices[p.faces.ravel()] for p in used])
    if not np.isfinite(points).all():
        raise ModelFileError(model.path, "some of its points are no numbers (NaN or infinite)")
    linear = _turned(fit.turn) @ upright(fit.up == "y" if fit.up else model.y_up)
    with np.errstate(over="ignore", invalid="ignore"):
        points = points @ linear.T
        low, high = points.min(0), points.max(0)
        scale = _scale(fit, high - low)
        size = scale * float((high - low).max())
    if not limits.SMALLEST <= size <= limits.LARGEST:
        raise ModelFileError(
            model.path, f"it would be {size:.3g} m large; say `height`, `length` or `scale` to set it right"
        )
    shift = np.array([*(0.5 * (low + high)[:2] if centred else (0.0, 0.0)), low[2]])
    return tuple(replace(p, vertices=(p.vertices @ linear.T - shift) * scale) for p in used)


def upright(y_up: bool) -> Array:
    """[3, 3]: to Z up with the front along -Y; Y-up files have their front along +Z."""
    if y_up:
        return np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    return np.eye(3)


def _turned(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _scale(fit: Fit, size: Array) -> float:
    for wanted, axis in ((fit.height, 2), (fit.length, 1), (fit.width, 0)):
        if wanted is not None:
            return float(wanted / max(size[axis], 1e-9))
    return 1.0 if fit.scale is None else fit.scale
