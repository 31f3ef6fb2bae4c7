"""What hair is made of: the scalp, caps over it, hairlines, furrows and curls; all in head units."""

from __future__ import annotations

import numpy as np

from .anatomy import neck
from .field import Field, Points, Values, ellipsoid, smooth_min
from .head import Head, face, side_line, skull
from .pieces import Piece, hemmed
from .surface import clip, cull, half, polygonise, simplify


def grooves(shape: Field, depth: float, count: float, centre: tuple[float, float] = (-0.05, 0.0)) -> Field:
    """Shallow furrows running down from the crown, as combed strands."""

    def field(p: Points) -> Values:
        angle = np.arctan2(p[:, 1] - centre[1], p[:, 0] - centre[0])
        away = np.hypot(p[:, 0] - centre[0], p[:, 1] - centre[1])
        wave = np.sin(angle * count + 3.0 * p[:, 2]) + 0.5 * np.sin(angle * count * 1.7 + 1.3 - 5.0 * p[:, 2])
        return shape(p) + depth * wave * np.clip(away / 0.2, 0.0, 1.0)

    return field


def scalp(head: Head) -> Field:
    """Skull and neck, what hair lies on; head units."""
    bone, column = skull(head), neck(head.figure)
    return lambda p: smooth_min(bone(p), column(head.metres(p)) / head.unit, 0.11)


def cap(head: Head, thick: float, top: float = 0.0) -> Field:
    """The scalp grown by ``thick``, with more on top."""
    base = scalp(head)
    crown = ellipsoid((-0.05, 0.0, 0.66 + top / 2), (0.43 + thick, 0.325 + thick, 0.345 + thick + top / 2))
    return lambda p: smooth_min(base(p) - thick, crown(p), 0.05)


def hairline(forehead: float, temple: float, nape: float, burn: float = 0.42, sweep: float = 0.0) -> Field:
    """Negative where hair grows: above a line over forehead, temple, around the ear and down to the nape.

    sweep: slant of the line over the forehead, for hair brushed to the side
    """
    line = side_line(
        (
            (0.60, forehead + 0.02),
            (0.34, forehead),
            (0.26, forehead - 0.02),
            (0.17, temple),
            (0.13, 0.55),
            (0.085, burn),
            (0.02, burn),
            (0.0, 0.545),
            (-0.07, 0.56),
            (-0.125, 0.42),
            (-0.20, nape + 0.02),
            (-0.60, nape),
        )
    )

    def field(p: Points) -> Values:
        x = np.clip(p[:, 0], -0.6, 0.6)
        front = np.clip((p[:, 0] - 0.14) / 0.12, 0.0, 1.0)
        front = np.clip((p[:, 0] - 0.14) / 0.12, 0.0, 1.0)
        return np.asarray(line(x)) + sweep * p[:, 1] * front - p[:, 2]

    return field


def hair_piece(
    head: Head,
    shape: Field,
    low: tuple[float, float, float],
    high: tuple[float, float, float],
    cut: Field | None,
    faces: int,
    rule: str = "head",
    symmetric: bool = True,
    rim: float = 0.03,
) -> Piece:
    u = head.unit
    solid = head.field(shape)
    start = (low[0], -0.05 if symmetric else low[1], low[2])
    patch = polygonise(solid, head.metres(np.array(start)), head.metres(np.array(high)), 0.022 * u)
    patch = simplify(patch, round(head.figure.detail * faces), solid)
    if symmetric:
        patch = half(patch)
    if cut is not None:
        patch = clip(patch, head.field(cut))
    patch = cull(patch, head.field(face(head)), 0.03 * u)
    piece = Piece(
        patch,
        head.figure.spec.hair_color,
        "hair",
        solid,
        rule=rule,
        symmetry="half" if symmetric else "whole",
    )
    return hemmed(piece, rim * u) if cut is not None else piece


def mirrored_half(shape: Field) -> Field:
    def field(p: Points) -> Values:
        q = p.copy()
        q[:, 1] = np.abs(q[:, 1])
        return shape(q)

    return field


def curtain(head: Head, bottom: float, flare: float, back: float = 0.0) -> Field:
    """Hair falling from the crown around the face down to ``bottom``."""
    middle = (0.62 + bottom) / 2
    fall = ellipsoid((-0.085, 0.0, middle), (0.40 + back, 0.385 + flare, (0.95 - bottom) / 2 + 0.10))
    close = cap(head, 0.045, 0.03)
    whole = lambda p: smooth_min(close(p), fall(p), 0.10)  # noqa: E731
    under: Field = lambda p: bottom - p[:, 2]  # noqa: E731
    return lambda p: -smooth_min(-whole(p), -under(p), 0.07)


def face_window(top: float, width: float, sweep: float = 0.0) -> Field:
    """The opening of long hair around the face, a rounded arch through the front; ``sweep`` slants it."""

    def field(p: Points) -> Values:
        p = p - np.stack(
            [np.zeros(len(p)), np.zeros(len(p)), sweep * p[:, 1] * np.clip((p[:, 2] - 0.35) / 0.3, 0.0, 1.0)],
            1,
        )
        y, z = np.abs(p[:, 1]) / width, (p[:, 2] - 0.20) / (top - 0.20)
        arch = (y**2.6 + np.clip(z, 0.0, None) ** 2.6) ** (1 / 2.6) - 1.0
        return np.maximum(arch * width, 0.085 + 0.10 * np.clip(p[:, 2] - 0.45, 0.0, 1.0) - p[:, 0])

    return field


def bumps(shape: Field, depth: float, wave: float) -> Field:
    """Curls as a round pattern of bumps."""

    def field(p: Points) -> Values:
        a, b, c = (p * wave).T
        return (
            shape(p)
            - depth
            * (np.sin(a + 1.0) * np.cos(b) + np.sin(b * 1.1 + 2.0) * np.cos(c) + np.sin(c * 0.9) * np.cos(a))
            / 1.5
        )

    return field
