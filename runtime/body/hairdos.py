"""More hair styles: those made of strands, fins and tails."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .field import Field, Points, Values, carve, ellipsoid, round_cone, union
from .head import Head
from .pieces import Piece, shade
from .sheets import merged, strand
from .strands import bumps, cap, curtain, face_window, grooves, hair_piece, hairline, mirrored_half
from .surface import Patch, split


def pixie(head: Head) -> list[Piece]:
    """Short all over, a long fringe swept to the side."""
    fringe = round_cone((0.30, -0.16, 0.78), (0.32, 0.14, 0.86), 0.07, 0.075)
    crown = union([(mirrored_half(cap(head, 0.038, 0.05)), 0.0), (fringe, 0.10)])
    cut = hairline(0.745, 0.58, 0.24, 0.40, sweep=0.34)

    def sided(p: Points) -> Values:
        q = p.copy()
        q[:, 1] = np.where(p[:, 0] > 0.14, p[:, 1], np.abs(p[:, 1]))
        return cut(q)

    return [
        hair_piece(
            head, grooves(crown, 0.008, 9), (-0.62, -0.5, 0.0), (0.62, 0.5, 1.2), sided, 900, symmetric=False
        )
    ]


def wavy(head: Head) -> list[Piece]:
    """To the shoulders in waves."""
    base = carve(curtain(head, -0.10, 0.05, 0.03), face_window(0.77, 0.258), 0.03)

    def waves(p: Points) -> Values:
        low = np.clip((0.75 - p[:, 2]) / 0.4, 0.0, 1.0)
        return np.asarray(
            base(p) + low * 0.026 * np.sin(13.0 * p[:, 2] + 5.0 * np.abs(p[:, 1]) + 3.0 * p[:, 0])
        )

    return [
        hair_piece(
            head, grooves(waves, 0.007, 8), (-0.75, -0.6, -0.25), (0.62, 0.65, 1.2), None, 1100, rule="face"
        )
    ]


def combed_back(head: Head, thick: float = 0.030) -> Piece:
    """Hair drawn tightly to the back."""
    cut = hairline(0.80, 0.69, 0.20, 0.44)
    return hair_piece(
        head, grooves(cap(head, thick, 0.02), 0.006, 14), (-0.62, -0.5, 0.0), (0.6, 0.5, 1.15), cut, 560
    )


def braids(head: Head) -> list[Piece]:
    """Two plaits in front of the shoulders, hair parted in the middle."""
    t = np.linspace(0.0, 1.0, 15)
    line = np.stack([-0.10 + 0.42 * t - 0.12 * t**2, 0.325 + 0.05 * np.sin(1.9 * t), 0.34 - 1.0 * t], 1)
    size = (0.062 + 0.014 * np.cos(np.pi * 14 * t)) * (1.0 - 0.35 * t)
    size[-1] = 0.02
    plait = strand(line, size.tolist(), 7)
    end = strand(line[11:13], (0.058, 0.058), 7)
    colour = head.figure.spec.hair_color

    def hung(patch: Patch, look: tuple[float, float, float], part: str) -> Piece:
        return Piece(
            Patch(head.metres(patch.vertices), patch.faces), look, part, None, rule="face", symmetry="side"
        )

    return [
        combed_back(head, 0.034),
        hung(plait, colour, "hair"),
        hung(end, head.figure.spec.accent_color, "belt"),
    ]


def locs(head: Head) -> list[Piece]:
    """Many ropes falling around the head."""
    top = combed_back(head, 0.05)
    parts = []
    for row, (start, low) in enumerate(((0.86, -0.06), (0.70, -0.16), (0.98, 0.10))):
        for k in range(7 if row < 2 else 5):
            turn = 1.45 + (np.pi - 1.52) * k / (6 if row < 2 else 4) + 0.06 * row
            out = np.array([0.47 * np.cos(turn) - 0.05, 0.375 * np.sin(turn)])
            root = np.array([0.62, 0.80, 0.45])[row] * out
            wide = 1.07 + 0.05 * row
            line = [
                (*root, start), (*(0.98 * out), start - 0.10), (*(wide * out), 0.5 * (start + low) - 0.05),
                (*(wide * out), low + 0.1 * np.sin(3.0 * k)),
            ]  # fmt: skip
            parts.append(strand(np.maximum(line, [-9, 0.015, -9]), (0.045, 0.055, 0.052, 0.03), 5))
    ropes = merged(parts)
    return [
        top,
        Piece(
            Patch(head.metres(ropes.vertices), ropes.faces), shade(head.figure.spec.hair_color, 0.92), "hair",
            None, rule="face", symmetry="side",
        ),
    ]  # fmt: skip


def mohawk(head: Head) -> list[Piece]:
    """A fin over a shaved head."""
    shadow = hairline(0.82, 0.73, 0.24, 0.46)
    shaved = hair_piece(
        head, cap(head, 0.004), (-0.6, -0.5, 0.0), (0.6, 0.5, 1.15), shadow, 300, rim=0.004
    ).looking(shade(head.figure.spec.skin, 0.80), "skin")
    outer = ellipsoid((-0.06, 0.0, 0.68), (0.56, 0.085, 0.56))

    def fin(p: Points) -> Values:
        spikes = 0.035 * np.cos(11.0 * np.arctan2(p[:, 2] - 0.6, p[:, 0] + 0.05))
        keep = np.maximum(
            0.40 - p[:, 2] - 1.2 * np.clip(p[:, 0], 0.0, 1.0) * 0.0, 0.72 - p[:, 2] - 3.0 * (0.36 - p[:, 0])
        )
        return np.maximum(outer(p) + spikes, keep)

    return [shaved, hair_piece(head, fin, (-0.75, -0.2, 0.3), (0.6, 0.2, 1.35), None, 520)]


def topknot(head: Head) -> list[Piece]:
    """Combed back into a small knot on the crown."""
    knot = ellipsoid((-0.20, 0.0, 1.10), (0.115, 0.11, 0.10))
    return [
        combed_back(head),
        hair_piece(
            head, grooves(knot, 0.008, 6, (-0.20, 0.0)), (-0.4, -0.2, 0.92), (0.0, 0.2, 1.28), None, 200
        ),
    ]


def curls(head: Head, shape: Field, cut: Field, depth: float, wave: float, faces: int) -> list[Piece]:
    """A volume of curls: bumps with darker valleys between them."""
    whole = hair_piece(
        head, bumps(shape, depth, wave), (-0.82, -0.72, -0.1), (0.72, 0.72, 1.45), cut, faces, symmetric=False
    )
    valley, hill = split(whole.patch, lambda p: shape(head.units(p)) + 0.10 * depth)
    colour = head.figure.spec.hair_color
    light = 0.3 * colour[0] + 0.6 * colour[1] + 0.1 * colour[2]
    other = shade(colour, 0.84) if light > 0.25 else shade(colour, 1.07)
    if light <= 0.25:
        valley, hill = hill, valley
    return [
        Piece(
            patch,
            look,
            "hair",
            whole.solid,
            whole.rule,
            "whole",
        )
        for patch, look in ((hill, colour), (valley, other))
    ]


HAIRDOS: dict[str, Callable[[Head], list[Piece]]] = {
    "pixie": pixie,
    "wavy": wavy,
    "braids": braids,
    "locs": locs,
    "mohawk": mohawk,
    "topknot": topknot,
}
