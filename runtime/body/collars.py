"""Collars: turned down, stood up, given point by point and laid on the garment under them."""

from __future__ import annotations

import numpy as np

from .anatomy import Figure
from .field import Field, Values
from .outfit import neck_radius
from .pieces import Piece, shade
from .sheets import Grid, laid, plate
from .spec import Colour

#: How far a collar lies below the one it goes around, for how much wider it is, as a share of the height.
_LOWER = 0.06


def _ring(f: Figure, turn: Values, radius: Values, up: Values) -> Grid:
    """Points around the neck: [C, 3] of angles from the front, radii and heights above the collar's level."""
    x, z = f.joint("neck")[0] + 0.002 * f.p.height, f.level(1.165)
    y = radius * np.sin(turn)
    y[np.abs(turn - np.pi) < 1e-9] = 0.0
    return np.stack([x + 1.02 * radius * np.cos(turn), y, z + up], -1)


def collar(
    f: Figure,
    solid: Field | None,
    colour: Colour,
    drop: float = 1.0,
    gap: float = 0.16,
    tone: float = 1.10,
    over: float = 0.0,
    spread: float = 1.0,
) -> list[Piece]:
    """A turned-down collar with points in front.

    solid: the garment it lies on; drop: how far it comes down; gap: half its opening in front, radians
    over: how much wider than one that goes around the neck itself, as a share of its radius: it lies around
    another collar, and lower, so that this one shows above it; spread: how far it falls outwards, less for
    one that is to lie under another
    """
    assert solid is not None
    h, r = f.p.height, (1.0 + over) * neck_radius(f)
    turn = np.linspace(gap, np.pi, 13)
    ahead = 0.5 + 0.5 * np.cos(turn)
    fold = (0.026 - 0.028 * ahead - _LOWER * over) * h
    point = np.exp(-(((turn - 0.55) / 0.38) ** 2))
    fall = (drop * (0.034 + 0.020 * point) + 0.010 * spread * (1.0 - ahead)) * h
    wide = r * (1.17 + spread * (0.13 + 0.16 * ahead))
    rows = [
        _ring(f, turn, 0.98 * r + 0.0 * turn, fold - 0.030 * h),
        _ring(f, turn, 1.08 * r + 0.0 * turn, fold - 0.004 * h),
        _ring(f, turn, 1.17 * r + 0.0 * turn, fold),
        _ring(f, turn, 0.5 * (1.17 * r + wide), fold - 0.45 * fall),
        _ring(f, turn + 0.10 * drop * point, wide, fold - fall),
    ]
    outer = np.stack(rows)
    outer[3:] = _clear(solid, outer[3:], spread * np.array([0.010, 0.006]) * h)
    under = outer.copy()
    under[2:] = outer[2:] - np.array([0.0, 0.0, 0.006 * h])
    under[4] = laid(solid, outer[4], -0.002)
    middle = np.array([f.joint("neck")[0], 0.0, f.level(1.0)])
    return [Piece(plate(outer, under, middle), shade(colour, tone), "trim", None, material="cloth")]


def _clear(solid: Field, grid: Grid, lifts: Values) -> Grid:
    """Rows of points brought out of a solid by ``lifts`` metres, or most of the way down onto it."""
    rows = []
    for row, lift in zip(grid, lifts, strict=True):
        near = laid(solid, row, float(lift))
        share = np.where(solid(row) < lift, 1.0, 0.75)[:, None]
        rows.append(row + share * (near - row))
    return np.stack(rows)


def stand_up(
    f: Figure, colour: Colour, high: float = 0.030, gap: float = 0.05, part: str = "trim", until: float = 1.0
) -> list[Piece]:
    """A band standing around the neck, almost closed in front; ``until``: share of the way to the nape."""
    h, r = f.p.height, neck_radius(f)
    turn = np.linspace(gap, until * np.pi, 12)
    low = (-0.052 + 0.016 * (0.5 - 0.5 * np.cos(turn))) * h
    rows = [
        _ring(f, turn, (1.27 + 0.07 * np.cos(turn)) * r, low),
        _ring(f, turn, 1.20 * r + 0.0 * turn, low + 0.55 * high * h),
        _ring(f, turn, 1.16 * r + 0.0 * turn, low + high * h + 0.008 * h),
    ]
    outer = np.stack(rows)
    axis = np.array([f.joint("neck")[0], 0.0, 0.0])
    flat = outer - axis
    flat[..., 2] = 0.0
    under = outer - 0.004 * h * flat / np.maximum(np.linalg.norm(flat, axis=-1, keepdims=True), 1e-9)
    middle = np.array([axis[0], 0.0, f.level(1.15)])
    return [Piece(plate(outer, under, middle, back=True), colour, part, None, material="cloth")]
