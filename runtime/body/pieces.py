"""A body while it is being put together: pieces of surface, each with its colour, part and way to hang."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .field import Field, Values, gradient
from .spec import Colour
from .surface import Patch, compact, mirror, rim, split

#: Part labels: the ink line runs where they change.
PARTS = (
    "skin", "eye", "hair", "top", "trim", "shirt", "bottom", "belt", "shoes", "sole", "glasses",
    "hat", "brim", "badge", "plume", "visor", "neck", "over", "pocket", "pack", "cape", "gloves", "plate",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Piece:
    """Surface of one look.

    solid: field whose gradient gives the normals (of the half Y >= 0 for ``symmetry`` half and side), or
        None to take them from the triangles
    rule: how it hangs: body, legs (no arms), skirt, face, or the name of one joint
    symmetry: half (ends on Y = 0 and is welded to its mirror image), side (mirrored), whole
    """

    patch: Patch
    colour: Colour
    part: str
    solid: Field | None = None
    rule: str = "body"
    symmetry: str = "half"
    material: str = "plain"

    @property
    def tucks(self) -> bool:
        """Whether it gives way under a top: skin of head, arms and hands, and the bottom."""
        return (
            self.solid is not None
            and self.part in ("skin", "bottom")
            and self.rule in ("face", "body", "legs")
        )

    def looking(self, colour: Colour, part: str) -> Piece:
        return replace(self, colour=colour, part=part)


def shade(colour: Colour, factor: float) -> Colour:
    """Darker (below 1) or paler (above 1) of the same hue."""
    if factor <= 1.0:
        return (colour[0] * factor, colour[1] * factor, colour[2] * factor)
    t = min(factor - 1.0, 1.0)
    return (colour[0] + (1 - colour[0]) * t, colour[1] + (1 - colour[1]) * t, colour[2] + (1 - colour[2]) * t)


def parted(piece: Piece, cut: Field, colour: Colour, part: str) -> list[Piece]:
    """The piece with what lies inside ``cut`` in another look."""
    inside, outside = split(piece.patch, cut)
    return [replace(piece, patch=outside), replace(piece, patch=inside, colour=colour, part=part)]


def parted_all(piece: Piece, cuts: list[Field], colour: Colour, part: str) -> list[Piece]:
    """As :func:`parted` for what lies inside every one of ``cuts``: the way to cut out shapes thinner than
    the triangles, one smooth line after the other."""
    out = []
    rest = piece
    for cut in cuts:
        inside, outside = split(rest.patch, cut)
        out.append(replace(piece, patch=outside))
        rest = replace(rest, patch=inside)
    return [*out, replace(rest, colour=colour, part=part)]


def hemmed(piece: Piece, depth: float) -> Piece:
    """The piece with the thickness of its cloth shown at its borders (except on Y = 0)."""
    assert piece.solid is not None
    strip = rim(piece.patch, piece.solid, depth)
    if piece.symmetry == "half":
        on_seam = (np.abs(strip.vertices[:, 1]) < 1e-9)[strip.faces]
        strip = compact(Patch(strip.vertices, strip.faces[on_seam.sum(1) < 2]))
    n = len(piece.patch.vertices)
    joined = Patch(
        np.concatenate([piece.patch.vertices, strip.vertices]),
        np.concatenate([piece.patch.faces, strip.faces + n]),
    )
    return replace(piece, patch=joined)


def tucked(piece: Piece, cover: Field) -> Piece:
    """The piece drawn back a little where it lies under ``cover``, so that it stays under it when posed."""
    assert piece.solid is not None
    vertices = piece.patch.vertices
    return _moved_in(piece, 0.55 * np.clip(-cover(vertices) - 0.003, 0.0, 0.012))


def drawn_in(piece: Piece, cover: Field, depth: float, hem: float) -> Piece:
    """The piece brought at least ``depth`` metres below ``cover`` wherever it is above a hem."""
    vertices = piece.patch.vertices
    above, over = np.clip((vertices[:, 2] - hem) / 0.02 + 0.3, 0.0, 1.0), cover(vertices)
    return _moved_in(piece, above * np.clip(over + depth, 0.0, 0.02) * (over < 0.02))


def _moved_in(piece: Piece, push: Values) -> Piece:
    """The piece's vertices ``push`` [N] metres further in."""
    assert piece.solid is not None
    vertices = piece.patch.vertices.copy()
    moved = np.flatnonzero(push)
    slope = gradient(piece.solid, vertices[moved])
    if piece.symmetry == "half":
        slope[np.abs(vertices[moved, 1]) < 1e-9, 1] = 0.0
    slope /= np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-9)
    vertices[moved] -= slope * push[moved, None]
    return replace(piece, patch=Patch(vertices, piece.patch.faces))


def other_side(piece: Piece) -> Piece:
    """The mirror image of a left piece."""
    rule = piece.rule[:-2] + "_r" if piece.rule.endswith("_l") else piece.rule
    return replace(piece, patch=mirror(piece.patch), rule=rule)
