"""Hair and beards: volumes with an outline of their own, cut along the hairline."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .anatomy import neck
from .field import Field, Points, Values, carve, ellipsoid, round_cone, smooth_min, union
from .head import Head, face, side_line, skull
from .pieces import Piece, hemmed, shade
from .surface import clip, cull, half, polygonise, simplify


def hair_pieces(head: Head) -> list[Piece]:
    """Hair of the head and of the face."""
    style = _STYLES.get(head.figure.spec.hair)
    pieces = [] if style is None else style(head)
    return [*pieces, *_facial(head)]


def hair_cover(head: Head) -> Field | None:
    """A solid that hides the scalp under it in every style but the bald ones; metres."""
    style = head.figure.spec.hair
    if style in ("bald", "tonsure"):
        return None
    line = hairline(head, 0.83, 0.75, 0.26, 0.52)
    shell = scalp(head)
    return head.field(lambda p: np.maximum(shell(p) - 0.014, line(p) + 0.03))


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


def _cap(head: Head, thick: float, top: float = 0.0) -> Field:
    """The scalp grown by ``thick``, with more on top."""
    base = scalp(head)
    crown = ellipsoid((-0.05, 0.0, 0.66 + top / 2), (0.43 + thick, 0.325 + thick, 0.345 + thick + top / 2))
    return lambda p: smooth_min(base(p) - thick, crown(p), 0.05)


def hairline(
    head: Head, forehead: float, temple: float, nape: float, burn: float = 0.42, sweep: float = 0.0
) -> Field:
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


def _piece(
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
    patch = simplify(patch, faces, solid)
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


def _short(head: Head) -> list[Piece]:
    quiff = round_cone((0.20, 0.06, 0.93), (0.30, -0.13, 0.90), 0.085, 0.10)
    shape = grooves(union([(_both(_cap(head, 0.030, 0.05)), 0.0), (quiff, 0.10)]), 0.005, 11)
    cut = _both(hairline(head, 0.80, 0.70, 0.20))
    return [_piece(head, shape, (-0.62, -0.5, -0.05), (0.62, 0.5, 1.2), cut, 900, symmetric=False)]


def _crop(head: Head) -> list[Piece]:
    cut = hairline(head, 0.80, 0.71, 0.22, 0.44)
    return [_piece(head, _cap(head, 0.016), (-0.6, -0.5, 0.0), (0.6, 0.5, 1.15), cut, 420)]


def _both(shape: Field) -> Field:
    def field(p: Points) -> Values:
        q = p.copy()
        q[:, 1] = np.abs(q[:, 1])
        return shape(q)

    return field


def _curtain(head: Head, bottom: float, flare: float, back: float = 0.0) -> Field:
    """Hair falling from the crown around the face down to ``bottom``."""
    middle = (0.62 + bottom) / 2
    fall = ellipsoid((-0.085, 0.0, middle), (0.40 + back, 0.385 + flare, (0.95 - bottom) / 2 + 0.10))
    cap = _cap(head, 0.045, 0.03)
    whole = lambda p: smooth_min(cap(p), fall(p), 0.10)  # noqa: E731
    under: Field = lambda p: bottom - p[:, 2]  # noqa: E731
    return lambda p: -smooth_min(-whole(p), -under(p), 0.07)


def _face_window(head: Head, top: float, width: float, sweep: float = 0.0) -> Field:
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


def _bob(head: Head) -> list[Piece]:
    shape = carve(_both(_curtain(head, 0.07, 0.030)), _face_window(head, 0.745, 0.262, 0.30), 0.03)
    return [
        _piece(
            head,
            grooves(shape, 0.0055, 9),
            (-0.66, -0.6, -0.02),
            (0.62, 0.6, 1.2),
            None,
            1400,
            symmetric=False,
        )
    ]


def _long(head: Head) -> list[Piece]:
    shape = carve(_curtain(head, 0.0, 0.02), _face_window(head, 0.78, 0.255), 0.03)
    fall = round_cone((-0.24, 0.10, 0.35), (-0.30, 0.10, -0.42), 0.24, 0.17)
    both = union([(shape, 0.0), (_both(fall), 0.12)])
    return [
        _piece(head, grooves(both, 0.006, 9), (-0.75, -0.6, -0.75), (0.62, 0.6, 1.2), None, 800, rule="face")
    ]


def _tied(head: Head) -> Piece:
    """Hair combed back from a parting at the side."""
    young = head.figure.spec.youth > 0.3
    cut = hairline(head, 0.755 if young else 0.80, 0.66, 0.20, 0.44, sweep=0.36 if young else 0.16)
    wave = round_cone((0.30, -0.20, 0.80), (0.30, 0.16, 0.90), 0.085, 0.075)
    shape = grooves(union([(_both(_cap(head, 0.040, 0.06)), 0.0), (wave, 0.10)]), 0.005, 12)

    def sided(p: Points) -> Values:
        q = p.copy()
        q[:, 1] = np.where(p[:, 0] > 0.14, p[:, 1], np.abs(p[:, 1]))
        return cut(q)

    return _piece(head, shape, (-0.64, -0.5, 0.0), (0.6, 0.5, 1.2), sided, 750, symmetric=False)


def _ponytail(head: Head) -> list[Piece]:
    tail = union(
        [
            (ellipsoid((-0.52, 0.0, 0.80), (0.075, 0.07, 0.07)), 0.0),
            (round_cone((-0.56, 0.0, 0.78), (-0.72, 0.0, 0.52), 0.075, 0.125), 0.05),
            (round_cone((-0.72, 0.0, 0.52), (-0.68, 0.0, 0.02), 0.125, 0.035), 0.08),
        ]
    )
    end = _piece(
        head, grooves(tail, 0.006, 5, (-0.68, 0.0)), (-1.0, -0.3, -0.1), (-0.35, 0.3, 1.0), None, 420
    )
    return [_tied(head), end]


def _bun(head: Head) -> list[Piece]:
    knot = ellipsoid((-0.40, 0.0, 0.97), (0.155, 0.165, 0.150))
    return [
        _tied(head),
        _piece(head, grooves(knot, 0.006, 7, (-0.40, 0.0)), (-0.65, -0.3, 0.7), (-0.15, 0.3, 1.2), None, 320),
    ]


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


def _curly(head: Head) -> list[Piece]:
    shape = union([(_cap(head, 0.085, 0.07), 0.0)])
    cut = hairline(head, 0.79, 0.68, 0.10, 0.38)
    return [
        _piece(
            head,
            bumps(_both(shape), 0.034, 17.0),
            (-0.72, -0.6, -0.1),
            (0.68, 0.6, 1.3),
            _both(cut),
            1300,
            symmetric=False,
        )
    ]


def _afro(head: Head) -> list[Piece]:
    puff = ellipsoid((-0.07, 0.0, 0.74), (0.53, 0.52, 0.50))
    cut = hairline(head, 0.80, 0.66, 0.25, 0.42)
    return [
        _piece(
            head,
            bumps(puff, 0.012, 34.0),
            (-0.8, -0.7, 0.0),
            (0.7, 0.7, 1.45),
            _both(cut),
            1200,
            symmetric=False,
            rim=0.12,
        )
    ]


def _tonsure(head: Head) -> list[Piece]:
    line = hairline(head, 0.80, 0.70, 0.20)

    def cut(p: Points) -> Values:
        ring = p[:, 2] - 0.70 + 0.25 * np.clip(p[:, 0], -0.3, 0.3)
        return np.maximum(np.maximum(line(p), ring), p[:, 0] - 0.12)

    thick = _cap(head, 0.040)
    shape: Field = lambda p: thick(p) + 0.032 * np.clip((p[:, 2] - 0.48) / 0.2, 0.0, 1.0)  # noqa: E731
    return [_piece(head, grooves(shape, 0.004, 12), (-0.6, -0.5, 0.0), (0.6, 0.5, 1.15), cut, 420)]


def _facial(head: Head) -> list[Piece]:
    kind = head.figure.spec.facial_hair
    if kind == "none":
        return []
    m = head.mouth_z
    base = face(head)
    moustache = union([(round_cone((0.385, 0.012, m + 0.068), (0.325, 0.115, m + 0.022), 0.026, 0.012), 0.0)])
    pieces = []
    if kind in ("moustache", "beard"):
        pieces.append(_piece(head, moustache, (0.2, -0.1, 0.1), (0.5, 0.2, 0.4), None, 160, rule="head"))
    if kind in ("beard", "stubble"):
        thick = 0.030 if kind == "beard" else 0.006
        chin = round_cone((0.26, 0.0, 0.02), (0.25, 0.06, 0.05), 0.08, 0.07)
        full: Field = (
            (lambda p: smooth_min(base(p) - thick, chin(p), 0.06))
            if kind == "beard"
            else (lambda p: base(p) - thick)
        )

        def cut(p: Points) -> Values:
            y = np.abs(p[:, 1])
            cheek = p[:, 2] - (
                m - 0.045 + 1.05 * np.clip(y - 0.045, 0.0, 1.0) ** 1.0 + 0.1 * np.clip(0.12 - p[:, 0], 0, 1)
            )
            lip = 0.062 - np.hypot(y * 0.55, p[:, 2] - m)
            return np.maximum(
                np.maximum(np.maximum(cheek, lip), 0.015 - p[:, 0]),
                np.maximum(-0.10 - p[:, 2], p[:, 2] - 0.46),
            )

        pieces.append(
            _piece(head, full, (-0.1, -0.5, -0.15), (0.5, 0.5, 0.55), cut, 420, rule="face", rim=0.04)
        )
    if kind == "stubble":
        skin = head.figure.spec.skin
        tint = shade(skin, 0.86)
        pieces = [p.looking(tint, "skin") for p in pieces]
    return pieces


_STYLES: dict[str, Callable[[Head], list[Piece]]] = {
    "short": _short,
    "crop": _crop,
    "bob": _bob,
    "long": _long,
    "ponytail": _ponytail,
    "bun": _bun,
    "curly": _curly,
    "afro": _afro,
    "tonsure": _tonsure,
}
