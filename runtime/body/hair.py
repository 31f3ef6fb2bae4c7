"""Hair: volumes with an outline of their own, cut along the hairline."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .field import Field, Points, Values, carve, ellipsoid, round_cone, union
from .hairdos import HAIRDOS, curls
from .head import Head
from .pieces import Piece
from .strands import cap, curtain, face_window, grooves, hair_piece, hairline, mirrored_half, scalp


def hair_pieces(head: Head) -> list[Piece]:
    """Hair of the head."""
    word = head.figure.spec.hair
    if head.figure.spec.hat == "hood" and word != "bald":
        word = "crop"  # the rest is under it
    style = _STYLES.get(word) or HAIRDOS.get(word)
    return [] if style is None else style(head)


def hair_cover(head: Head) -> Field | None:
    """A solid that hides the scalp under it in every style but the bald ones; metres."""
    style = head.figure.spec.hair
    if style in ("bald", "tonsure"):
        return None
    line = hairline(0.83, 0.75, 0.26, 0.52)
    shell = scalp(head)
    return head.field(lambda p: np.maximum(shell(p) - 0.014, line(p) + 0.03))


def _short(head: Head) -> list[Piece]:
    quiff = round_cone((0.20, 0.06, 0.93), (0.30, -0.13, 0.90), 0.085, 0.10)
    shape = grooves(union([(mirrored_half(cap(head, 0.030, 0.05)), 0.0), (quiff, 0.10)]), 0.005, 11)
    cut = mirrored_half(hairline(0.80, 0.70, 0.20))
    return [hair_piece(head, shape, (-0.62, -0.5, -0.05), (0.62, 0.5, 1.2), cut, 900, symmetric=False)]


def _crop(head: Head) -> list[Piece]:
    cut = hairline(0.80, 0.71, 0.22, 0.44)
    return [hair_piece(head, cap(head, 0.016), (-0.6, -0.5, 0.0), (0.6, 0.5, 1.15), cut, 420)]


def _bob(head: Head) -> list[Piece]:
    shape = carve(mirrored_half(curtain(head, 0.07, 0.030)), face_window(0.745, 0.262, 0.30), 0.03)
    return [
        hair_piece(
            head,
            grooves(shape, 0.0055, 9),
            (-0.66, -0.6, -0.02),
            (0.62, 0.6, 1.2),
            None,
            1150,
            symmetric=False,
        )
    ]


def _long(head: Head) -> list[Piece]:
    shape = carve(curtain(head, 0.0, 0.02), face_window(0.78, 0.255), 0.03)
    fall = round_cone((-0.24, 0.10, 0.35), (-0.30, 0.10, -0.42), 0.24, 0.17)
    both = union([(shape, 0.0), (mirrored_half(fall), 0.12)])
    return [
        hair_piece(
            head, grooves(both, 0.006, 9), (-0.75, -0.6, -0.75), (0.62, 0.6, 1.2), None, 800, rule="face"
        )
    ]


def _tied(head: Head) -> Piece:
    """Hair combed back from a parting at the side."""
    young = head.figure.spec.youth > 0.3
    cut = hairline(0.755 if young else 0.80, 0.66, 0.20, 0.44, sweep=0.36 if young else 0.16)
    wave = round_cone((0.30, -0.20, 0.80), (0.30, 0.16, 0.90), 0.085, 0.075)
    shape = grooves(union([(mirrored_half(cap(head, 0.040, 0.06)), 0.0), (wave, 0.10)]), 0.005, 12)

    def sided(p: Points) -> Values:
        q = p.copy()
        q[:, 1] = np.where(p[:, 0] > 0.14, p[:, 1], np.abs(p[:, 1]))
        return cut(q)

    return hair_piece(head, shape, (-0.64, -0.5, 0.0), (0.6, 0.5, 1.2), sided, 750, symmetric=False)


def _ponytail(head: Head) -> list[Piece]:
    tail = union(
        [
            (ellipsoid((-0.52, 0.0, 0.80), (0.075, 0.07, 0.07)), 0.0),
            (round_cone((-0.56, 0.0, 0.78), (-0.72, 0.0, 0.52), 0.075, 0.125), 0.05),
            (round_cone((-0.72, 0.0, 0.52), (-0.68, 0.0, 0.02), 0.125, 0.035), 0.08),
        ]
    )
    end = hair_piece(
        head, grooves(tail, 0.006, 5, (-0.68, 0.0)), (-1.0, -0.3, -0.1), (-0.35, 0.3, 1.0), None, 420
    )
    return [_tied(head), end]


def _bun(head: Head) -> list[Piece]:
    knot = ellipsoid((-0.40, 0.0, 0.97), (0.155, 0.165, 0.150))
    return [
        _tied(head),
        hair_piece(
            head, grooves(knot, 0.006, 7, (-0.40, 0.0)), (-0.65, -0.3, 0.7), (-0.15, 0.3, 1.2), None, 320
        ),
    ]


def _curly(head: Head) -> list[Piece]:
    shape = mirrored_half(cap(head, 0.085, 0.07))
    return curls(head, shape, mirrored_half(hairline(0.79, 0.68, 0.10, 0.38)), 0.036, 19.0, 1300)


def _afro(head: Head) -> list[Piece]:
    puff = ellipsoid((-0.07, 0.0, 0.74), (0.53, 0.52, 0.50))
    return curls(head, puff, mirrored_half(hairline(0.80, 0.66, 0.25, 0.42)), 0.016, 34.0, 1200)


def _tonsure(head: Head) -> list[Piece]:
    line = hairline(0.80, 0.70, 0.20)

    def cut(p: Points) -> Values:
        ring = p[:, 2] - 0.70 + 0.25 * np.clip(p[:, 0], -0.3, 0.3)
        return np.maximum(np.maximum(line(p), ring), p[:, 0] - 0.12)

    thick = cap(head, 0.040)
    shape: Field = lambda p: thick(p) + 0.032 * np.clip((p[:, 2] - 0.48) / 0.2, 0.0, 1.0)  # noqa: E731
    return [hair_piece(head, grooves(shape, 0.004, 12), (-0.6, -0.5, 0.0), (0.6, 0.5, 1.15), cut, 420)]


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
