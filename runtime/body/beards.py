"""Facial hair: stubble, moustaches, goatees and beards."""

from __future__ import annotations

import numpy as np

from .field import Field, Points, Values, round_cone, smooth_min, union
from .head import Head, face
from .pieces import Piece, shade
from .strands import grooves, hair_piece

#: Kinds that grow on the upper lip, and on cheeks and chin.
_LIP = ("moustache", "beard", "goatee", "long-beard")
_CHEEKS = ("beard", "stubble", "long-beard")


def beard_pieces(head: Head) -> list[Piece]:
    """Hair of the face."""
    kind = head.figure.spec.facial_hair
    pieces = []
    if kind in _LIP:
        pieces.append(_moustache(head))
    if kind in _CHEEKS:
        pieces.append(_full(head, {"beard": 0.030, "stubble": 0.006, "long-beard": 0.036}[kind]))
    if kind == "goatee":
        pieces.append(_goatee(head))
    if kind == "long-beard":
        pieces.append(_flowing(head))
    if kind == "stubble":
        tint = shade(head.figure.spec.skin, 0.86)
        pieces = [p.looking(tint, "skin") for p in pieces]
    return pieces


def _moustache(head: Head) -> Piece:
    m = head.mouth_z
    shape = round_cone((0.385, 0.012, m + 0.068), (0.325, 0.115, m + 0.022), 0.026, 0.012)
    return hair_piece(head, shape, (0.2, -0.1, 0.1), (0.5, 0.2, 0.4), None, 160, rule="face")


def _full(head: Head, thick: float) -> Piece:
    m, base = head.mouth_z, face(head)
    chin = round_cone((0.26, 0.0, 0.02), (0.25, 0.06, 0.05), 0.08, 0.07)
    full: Field = (
        (lambda p: smooth_min(base(p) - thick, chin(p), 0.06))
        if thick > 0.01
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

    return hair_piece(head, full, (-0.1, -0.5, -0.15), (0.5, 0.5, 0.55), cut, 420, rule="face", rim=0.04)


def _goatee(head: Head) -> Piece:
    m, base = head.mouth_z, face(head)
    chin = round_cone((0.285, 0.0, 0.025), (0.30, 0.0, 0.10), 0.062, 0.05)

    def cut(p: Points) -> Values:
        y = np.abs(p[:, 1])
        return np.maximum(
            np.maximum(y - 0.085 + 0.25 * np.clip(p[:, 2] - 0.08, 0, 1), p[:, 2] - m + 0.066), 0.12 - p[:, 0]
        )

    full: Field = lambda p: smooth_min(base(p) - 0.024, chin(p), 0.05)  # noqa: E731
    return hair_piece(head, full, (0.1, -0.2, -0.1), (0.5, 0.2, 0.25), cut, 200, rule="face", rim=0.03)


def _flowing(head: Head) -> Piece:
    """A beard down to the chest."""
    shape = union(
        [
            (round_cone((0.22, 0.0, 0.08), (0.24, 0.0, -0.18), 0.155, 0.14), 0.0),
            (round_cone((0.24, 0.0, -0.18), (0.22, 0.0, -0.52), 0.14, 0.025), 0.08),
        ]
    )
    return hair_piece(
        head,
        grooves(shape, 0.010, 9, (0.12, 0.0)),
        (0.0, -0.3, -0.62),
        (0.5, 0.3, 0.2),
        None,
        420,
        rule="beard",
    )
