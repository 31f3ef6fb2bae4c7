"""Tops that open in front: blazers, suits, jackets, coats, uniforms and what doctors and cooks wear."""

from __future__ import annotations

import numpy as np

from .anatomy import Figure, trunk
from .collars import collar, stand_up
from .field import Field, Points, Values
from .outfit import along_arm, both, garment, neckline, skirt_tail, sleeve_length
from .pieces import Piece, hemmed, parted, shade
from .sheets import cast, ellipsoid_patch, merged, on_chest, plate
from .spec import Colour
from .surface import clip, half, polygonise, simplify


def _opened(
    f: Figure,
    hem: float,
    button: float,
    lapel: float,
    *,
    tail: Field | None = None,
    grow: float = 0.0150,
    tone: float = 1.12,
    down: float = 1.0,
    rule: str = "body",
) -> list[Piece]:
    """An open jacket with lapels over a shirt.

    hem, button: heights of its lower edge and of where it closes; lapel: width as a share of the height
    down: how far the fronts part below the button
    """
    h = f.p.height
    line = neckline(f, 0.020 * h, -0.003 * h, 0.012 * h)
    piece = garment(
        f, grow * h, 0.16, hem, sleeve_length(f, 0.96), line, slope=0.05, tail=tail, rule=rule, faces=860
    )
    opening, edge = front(f, button, 0.0, down), front(f, button, lapel * h, down)
    cloth = Piece(
        clip(piece.patch, opening, keep_outside=True),
        piece.colour,
        "top",
        piece.solid,
        rule=rule,
        material="cloth",
    )
    looks = parted(
        cloth,
        lambda p: np.maximum(edge(p), button + 0.012 * h - p[:, 2]),
        shade(f.spec.top_color, tone),
        "trim",
    )
    pieces = [hemmed(q, 0.011 * h) for q in looks]
    shirt = shirt_front(f, button, down)
    roll = collar(f, piece.solid, f.spec.top_color, 1.2, 0.62, tone, over=0.17)
    under = collar(f, shirt.solid, f.spec.shirt_color, 0.42, 0.14, 1.05, spread=0.42)
    inner = [q.looking(q.colour, "shirt") for q in under]
    return [*pieces, hemmed(shirt, 0.009 * h), *inner, *roll]


def blazer(f: Figure) -> list[Piece]:
    """Open to a button above the waist."""
    return _opened(f, f.level(-0.22), f.level(0.36), 0.042)


def suit(f: Figure) -> list[Piece]:
    """A blazer buttoned higher, with narrower lapels and a handkerchief."""
    h = f.p.height
    pieces = _opened(f, f.level(-0.20), f.level(0.42), 0.036, tone=0.86, down=0.35)
    return [
        *pieces,
        *_buttons(pieces[0].solid, [0.010 * h], [f.level(0.38), f.level(0.26)], 0.0055 * h, _dark(f)),
    ]


def jacket(f: Figure) -> list[Piece]:
    """Short, of leather, open all the way."""
    h = f.p.height
    pieces = _opened(f, f.level(0.02), f.level(0.10), 0.046, grow=0.0160, tone=1.16, down=0.2)
    hem = f.level(0.02)
    band = parted(pieces[0], lambda p: p[:, 2] - hem - 0.030 * h, shade(f.spec.top_color, 0.82), "trim")
    cuff = along_arm(f, sleeve_length(f, 0.90), 0.04)
    sleeve = parted(band[0], lambda p: -cuff(p), shade(f.spec.top_color, 0.82), "trim")
    return [*sleeve, band[1], *pieces[1:]]


def coat(f: Figure) -> list[Piece]:
    """To the knees."""
    h = f.p.height
    hem = f.p.knee + 0.02 * h
    return _opened(f, hem, f.level(0.36), 0.042, tail=skirt_tail(f, hem), rule="skirt")


def lab_coat(f: Figure) -> list[Piece]:
    """Long, white or not, with pockets; open over shirt and trousers."""
    h = f.p.height
    hem = f.p.knee + 0.07 * h
    pieces = _opened(
        f,
        hem,
        f.level(0.22),
        0.034,
        tail=skirt_tail(f, hem, 0.04),
        grow=0.0165,
        tone=0.93,
        down=1.6,
        rule="skirt",
    )
    solid = pieces[0].solid
    assert solid is not None
    colour = shade(f.spec.top_color, 0.92)
    low = pocket(
        solid,
        np.linspace(0.040, 0.088, 4) * h,
        np.linspace(f.level(-0.16), f.level(0.04), 3),
        0.005 * h,
        colour,
    )
    high = pocket(
        solid,
        np.linspace(0.040, 0.074, 3) * h,
        np.linspace(f.level(0.60), f.level(0.72), 3),
        0.005 * h,
        colour,
    )
    return [*pieces, low, high]


def uniform(f: Figure) -> list[Piece]:
    """Buttoned to the neck, with a collar, breast pockets and epaulettes."""
    h, colour = f.p.height, f.spec.top_color
    line = neckline(f, 0.034 * h, -0.003 * h, 0.012 * h)
    piece = garment(f, 0.0120 * h, 0.10, f.level(-0.12), sleeve_length(f, 0.97), line, slope=0.03)
    assert piece.solid is not None
    cuff = along_arm(f, sleeve_length(f, 0.90), 0.04)
    pieces = parted(piece, lambda p: -cuff(p), shade(colour, 0.84), "trim")
    placket = parted(
        pieces[0], lambda p: np.maximum(p[:, 1] - 0.008 * h, 0.02 - p[:, 0]), shade(colour, 0.90), "trim"
    )
    pieces = [hemmed(q, 0.011 * h) for q in [*placket, *pieces[1:]]]
    pieces += collar(f, piece.solid, colour, 0.8, 0.10, 0.86)
    up = np.linspace(f.level(0.55), f.level(0.71), 4)
    pieces.append(pocket(piece.solid, np.linspace(0.030, 0.072, 4) * h, up, 0.005 * h, shade(colour, 0.90)))
    pieces.append(_epaulette(f, piece.solid))
    levels = [f.level(x) for x in (0.06, 0.22, 0.38, 0.54, 0.70)]
    return [*pieces, *_buttons(piece.solid, [0.0], levels, 0.0055 * h, f.spec.accent_color)]


def _epaulette(f: Figure, solid: Field) -> Piece:
    """A flap along the left shoulder."""
    h, shoulder = f.p.height, f.joint("upperarm_l")
    along = np.linspace(0.55, 1.12, 5) * shoulder[1]
    across = np.array([-0.016, -0.006, 0.006, 0.016]) * h + shoulder[0]
    x, y = np.meshgrid(across, along)
    start = np.stack([x, y, np.full_like(x, f.level(1.0) + 0.12 * h)], -1).reshape(-1, 3)
    points = cast(solid, start, (0.0, 0.0, -1.0), 0.25 * h).reshape(5, 4, 3)
    outer, under = points + np.array([0.0, 0.0, 0.006 * h]), points - np.array([0.0, 0.0, 0.002 * h])
    return Piece(
        plate(outer, under, shoulder - (0, 0, 0.2 * h)), f.spec.accent_color, "badge", None, symmetry="side"
    )


def chef_jacket(f: Figure) -> list[Piece]:
    """Double-breasted, with a band collar and two rows of buttons."""
    h, colour = f.p.height, f.spec.top_color
    line = neckline(f, 0.026 * h, -0.001 * h, 0.012 * h)
    piece = garment(f, 0.0125 * h, 0.16, f.level(-0.14), sleeve_length(f, 0.95), line)
    assert piece.solid is not None
    cuff = along_arm(f, sleeve_length(f, 0.86), 0.04)
    pieces = parted(piece, lambda p: -cuff(p), shade(colour, 0.90), "trim")
    flap = parted(pieces[0], _flap(f), shade(colour, 0.965), "over")
    pieces = [hemmed(q, 0.011 * h) for q in [*flap, *pieces[1:]]]
    levels = [f.level(x) for x in (0.30, 0.46, 0.62, 0.78)]
    return [
        *pieces,
        *stand_up(f, shade(colour, 0.95), 0.026),
        *_buttons(piece.solid, [0.034 * h], levels, 0.0065 * h, _dark(f), both_sides=True),
    ]


def _flap(f: Figure) -> Field:
    h = f.p.height

    def field(p: Points) -> Values:
        return np.maximum(p[:, 1] - 0.046 * h - 0.02 * np.clip(p[:, 2] - f.level(0.8), 0, 1), 0.01 - p[:, 0])

    return field


def _dark(f: Figure) -> Colour:
    return (0.13, 0.13, 0.15) if sum(f.spec.top_color) > 1.2 else (0.62, 0.58, 0.50)


def _buttons(
    solid: Field | None,
    across: list[float],
    levels: list[float],
    size: float,
    colour: Colour,
    both_sides: bool = False,
) -> list[Piece]:
    """Buttons down the front of a garment."""
    assert solid is not None
    grid = on_chest(solid, np.array(across), np.array(levels), 0.0).reshape(-1, 3)
    patch = merged([ellipsoid_patch(p, (0.45 * size, size, size), 6, 3) for p in grid])
    return [Piece(patch, colour, "badge", None, symmetry="side" if both_sides else "whole")]


def pocket(solid: Field, across: Values, up: Values, lift: float, colour: Colour) -> Piece:
    """A pocket on the front of a garment, of both sides."""
    outer, under = on_chest(solid, across, up, lift), on_chest(solid, across, up, -0.002)
    patch = plate(outer, under, (-0.3, 0.05, float(up.mean())))
    return Piece(patch, colour, "pocket", None, symmetry="side", material="cloth")


def shirt_front(f: Figure, button: float, down: float = 1.0) -> Piece:
    """What an open jacket shows of the shirt under it."""
    h = f.p.height
    low, high = f.level(-0.16 if down > 1.0 else -0.05), f.level(1.35)
    solid = trunk(f, 0.0066 * h, 0.10)
    patch = polygonise(solid, (-0.1 * h, -0.03, low), (0.2 * h, 0.12 * h, high), 0.0110 * h / 1.7)
    patch = half(simplify(patch, 260, solid))
    cut, shown = neckline(f, 0.002 * h, -0.004 * h, 0.012 * h), front(f, button, 0.016 * h, down)
    patch = clip(patch, both(cut, shown))
    return Piece(patch, f.spec.shirt_color, "shirt", solid, material="cloth")


def front(f: Figure, button: float, margin: float, down: float = 1.0) -> Field:
    """The open front of a jacket: a wedge from the button up to the collar and a slit below it."""
    h = f.p.height

    def field(p: Points) -> Values:
        up = np.clip((p[:, 2] - button) / (f.level(1.13) - button), 0.0, 1.3)
        low = np.clip((button - p[:, 2]) / (0.25 * h), 0.0, 1.0)
        width = 0.036 * h * up**0.85 + 0.018 * h * down * low**1.5 + 0.0015 * h
        return np.maximum(
            p[:, 1] - width - margin * np.minimum(up * 2.2, 1.0), f.joint("neck")[0] + 0.004 * h - p[:, 0]
        )

    return field
