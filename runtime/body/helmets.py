"""What is worn over the whole head: hood, veil, a knight's and an astronaut's helmet. Head units."""

from __future__ import annotations

import numpy as np

from .field import Field, Points, Values, carve, ellipsoid, round_cone, smooth_min, union
from .head import Head
from .pieces import Piece, shade
from .sheets import lathe, lathe_grid, plate, strand
from .spec import Colour
from .surface import Patch, half, polygonise, simplify

_WHITE: Colour = (0.95, 0.94, 0.92)
_GOLD: Colour = (0.88, 0.69, 0.27)


def worn(head: Head, patch: Patch, colour: Colour, part: str = "hat", symmetry: str = "half") -> Piece:
    """A piece that goes with the head, of a patch in head units."""
    return Piece(
        Patch(head.metres(patch.vertices), patch.faces), colour, part, None, rule="head", symmetry=symmetry
    )


def _shell(
    head: Head, shape: Field, low: Points, high: Points, colour: Colour, faces: int, rule: str
) -> Piece:
    solid = head.field(shape)
    patch = half(
        simplify(
            polygonise(solid, head.metres(low), head.metres(high), 0.026 * head.unit),
            round(head.figure.detail * faces),
            solid,
        )
    )
    return Piece(patch, colour, "hat", solid, rule=rule, material="cloth" if rule == "face" else "plain")


def _window(width: float, low: float, top: float, front: float) -> Field:
    """An opening for the face: negative inside an oval seen from the front."""
    middle, tall = 0.5 * (low + top), 0.5 * (top - low)

    def field(p: Points) -> Values:
        oval = np.hypot(p[:, 1] / width, (p[:, 2] - middle) / tall) - 1.0
        return np.maximum(oval * width, front - p[:, 0])

    return field


def _draped(bottom: float, wide: float, back: float) -> Field:
    """Cloth over head and shoulders."""
    top = ellipsoid((-0.075, 0.0, 0.60), (0.50, 0.435, 0.535))
    fall = round_cone((-0.12, 0.0, 0.25), (-0.16 - back, 0.0, bottom + 0.25), 0.40, 0.42 + wide)
    whole: Field = lambda p: smooth_min(top(p), fall(p), 0.12)  # noqa: E731
    return lambda p: -smooth_min(-whole(p), p[:, 2] - bottom, 0.04)


def hood(head: Head) -> list[Piece]:
    peak = round_cone((-0.10, 0.0, 0.95), (-0.42, 0.0, 1.02), 0.26, 0.05)
    cloth = union([(_draped(-0.20, 0.05, 0.0), 0.0), (peak, 0.12)])
    shape = carve(carve(cloth, _window(0.285, 0.0, 0.92, 0.08), 0.04), _hollow(), 0.02)
    box = np.array([-0.8, -0.05, -0.3]), np.array([0.6, 0.7, 1.35])
    return [_shell(head, shape, *box, head.figure.spec.hat_color, 1100, "face")]


def _hollow() -> Field:
    """Room for the head inside a hood."""
    return union([(ellipsoid((0.0, 0.0, 0.52), (0.45, 0.37, 0.50)), 0.0),
                  (round_cone((0.0, 0.0, 0.2), (-0.12, 0.0, -0.35), 0.28, 0.30), 0.1)])  # fmt: skip


def veil(head: Head) -> list[Piece]:
    coif = union([(ellipsoid((-0.02, 0.0, 0.50), (0.455, 0.375, 0.535)), 0.0),
                  (round_cone((0.10, 0.0, 0.0), (0.06, 0.0, -0.22), 0.27, 0.33), 0.15)])  # fmt: skip
    window = _window(0.232, 0.02, 0.80, 0.12)
    white = carve(lambda p: np.maximum(coif(p), -0.36 - p[:, 2]), window, 0.03)
    veil = _draped(-0.62, 0.10, 0.06)
    open_ = lambda p: 0.14 - p[:, 0] + 0.35 * np.clip(0.55 - p[:, 2], 0.0, 1.0) * -0.6  # noqa: E731
    dark = carve(
        veil,
        lambda p: np.maximum(open_(p), np.abs(p[:, 1]) - 0.30 - 0.2 * np.clip(0.3 - p[:, 2], 0, 1)),
        0.03,
    )
    low, high = np.array([-0.85, -0.05, -0.72]), np.array([0.62, 0.85, 1.25])
    return [
        _shell(head, white, low, high, _WHITE, 900, "face"),
        _shell(head, dark, low, high, head.figure.spec.hat_color, 900, "face"),
    ]


def knight_helmet(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    bowl = ellipsoid((-0.035, 0.0, 0.60), (0.50, 0.43, 0.56))
    cheeks = round_cone((0.08, 0.0, 0.35), (0.04, 0.0, -0.02), 0.38, 0.34)
    point = ellipsoid((-0.05, 0.0, 1.05), (0.34, 0.08, 0.20))
    shape = union([(bowl, 0.0), (cheeks, 0.15), (point, 0.10)])
    shape = carve(shape, _window(0.232, 0.03, 0.80, 0.10), 0.025)
    base: Field = lambda p: np.maximum(shape(p), -0.06 - p[:, 2])  # noqa: E731
    low, high = np.array([-0.7, -0.05, -0.15]), np.array([0.7, 0.6, 1.4])
    turn = np.linspace(0.0, 1.45, 9)
    visor = lathe_grid(
        [(1.16, 0.82), (1.28, 0.94), (1.22, 1.08), (1.04, 1.15)], (-0.055, 0.0, 0.0), (0.46, 0.40), turn, 0.35
    )
    inner = visor - 0.05 * (visor - np.array([-0.055, 0.0, 0.6]))
    plume = [
        (-0.12, 0.0, 1.20),
        (-0.30, 0.0, 1.34),
        (-0.54, 0.0, 1.29),
        (-0.72, 0.0, 1.08),
        (-0.80, 0.0, 0.80),
    ]
    return [
        _shell(head, base, low, high, colour, 1100, "head"),
        worn(head, plate(visor, inner, (-0.055, 0.0, 0.7), back=True), shade(colour, 0.86), "brim"),
        worn(
            head,
            strand(plume, (0.05, 0.12, 0.14, 0.11, 0.02), 7),
            head.figure.spec.accent_color,
            "plume",
            "whole",
        ),
    ]


def space_helmet(head: Head) -> list[Piece]:
    """A white ball open to the front, its gold visor lifted, on a ring."""
    colour = head.figure.spec.hat_color
    middle = np.array([0.0, 0.0, 0.50])
    polar, turn = np.linspace(0.0, 1.78, 9)[:, None], np.linspace(0.0, np.pi, 15)
    unit = np.stack(
        [-np.cos(polar) + 0.0 * turn, np.sin(polar) * np.sin(turn), np.sin(polar) * np.cos(turn)], -1
    )
    unit[:, [0, -1], 1] = 0.0
    outer, inner = middle + unit * np.array([0.70, 0.66, 0.70]), middle + unit * np.array([0.63, 0.60, 0.63])
    gold_polar, gold_turn = np.linspace(1.62, 2.35, 5)[:, None], np.linspace(0.0, 0.95, 8)
    gold = np.stack(
        [-np.cos(gold_polar) + 0.0 * gold_turn, np.sin(gold_polar) * np.sin(gold_turn),
         np.sin(gold_polar) * np.cos(gold_turn)], -1,
    )  # fmt: skip
    visor, under = middle + 0.735 * gold, middle + 0.70 * gold
    ring = [(1.0, -0.16), (1.06, -0.12), (1.06, -0.04), (1.0, 0.0)]
    return [
        worn(head, plate(outer, inner, middle, back=True), colour),
        worn(
            head, strand(0.5 * (outer + inner)[-1], 0.045, 6), head.figure.spec.accent_color, "brim", "side"
        ),
        worn(head, plate(visor, under, middle, back=True), _GOLD, "visor"),
        worn(head, lathe(ring, (0.0, 0.0, 0.0), (0.56, 0.54)), (0.62, 0.64, 0.67), "belt"),
    ]
