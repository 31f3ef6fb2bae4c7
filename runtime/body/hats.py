"""Hats: each a shape of its own over the hair, which is cut where the hat begins.

All in head units (see :mod:`runtime.body.head`): the skull's crown is at 1.0, hair lies up to 1.06.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from .field import Field, Values
from .head import Head
from .helmets import hood, knight_helmet, space_helmet, veil, worn
from .pieces import Piece, shade
from .sheets import ellipsoid_patch, lathe, lathe_grid, merged, plate, strand
from .spec import Colour
from .surface import Patch

_BLACK: Colour = (0.12, 0.12, 0.14)
_GOLD: Colour = (0.88, 0.69, 0.27)
#: Where the skull is widest seen from above: centre and radii over hair.
_CENTRE, _RADII = (-0.055, 0.0, 0.0), (0.475, 0.385)

Profile = Sequence[tuple[float, float]]


def hat_line(head: Head) -> Field | None:
    """Negative where the hat lies over the hair, head units; None without a hat that does."""
    found = _LINES.get(head.figure.spec.hat)
    if found is None:
        return None
    at, tilt = found
    return lambda p: at + tilt * p[:, 0] - p[:, 2]


def hides_hair(head: Head) -> bool:
    """Whether the hat leaves no hair to be seen."""
    return head.figure.spec.hat in ("veil", "knight-helmet")


def hat_pieces(head: Head) -> list[Piece]:
    """The hat of the spec."""
    maker = _HATS.get(head.figure.spec.hat)
    return [] if maker is None else maker(head)


def turned(head: Head, profile: Profile, colour: Colour, tilt: float = 0.0, part: str = "hat") -> Piece:
    return worn(head, lathe(profile, _CENTRE, _RADII, None, tilt), colour, part)


def _brim(
    reach: Callable[[Values], Values],
    rise: Callable[[Values], Values],
    turn: Values,
    inner: float = 1.0,
    at: float = 0.74,
    tilt: float = 0.0,
    thick: float = 0.022,
) -> Patch:
    """A brim from the hat to ``reach`` (share of the radii) by the angle from the front, rising outwards."""
    share = np.array([0.0, 0.4, 0.75, 1.0])[:, None]
    r = inner + (reach(turn)[None] - inner) * share
    x = r * _RADII[0] * np.cos(turn)
    y = r * _RADII[1] * np.sin(turn)
    y[:, np.abs(np.sin(turn)) < 1e-9] = 0.0
    z = at + rise(turn)[None] * share**1.6 + tilt * x
    top = np.stack([x + _CENTRE[0], y, z], -1)
    under = top - np.array([0.0, 0.0, thick])
    return plate(top, under, (_CENTRE[0], 0.0, at - 2.0), back=True)


_HALF = np.linspace(0.0, np.pi, 15)
_FRONT = np.linspace(0.0, 1.12, 8)


def _visor(long: float, at: float, drop: float, tilt: float = 0.0) -> Patch:
    def reach(a: Values) -> Values:
        return np.asarray(1.0 + long * np.clip(np.cos(a * 1.38), 0.0, 1.0) ** 0.6)

    return _brim(reach, lambda a: -drop + 0.0 * a, _FRONT, 0.97, at, tilt)


def _dome(low: float, top: float, wide: float = 1.0) -> Profile:
    """A round cap from ``low`` up to ``top``."""
    rise = np.array([0.0, 0.22, 0.45, 0.66, 0.83, 0.95, 1.0])
    radius = (1.0 - rise**2.6) ** (1 / 2.2)
    return [(wide * float(r), low + (top - low) * float(z)) for r, z in zip(radius, rise, strict=True)]


def _cap(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    button = ellipsoid_patch((_CENTRE[0], 0.0, 1.135), (0.03, 0.03, 0.015), 6, 3)
    return [
        turned(head, _dome(0.70, 1.13), colour, 0.06),
        worn(head, _visor(0.62, 0.715, 0.06, 0.06), shade(colour, 0.8), "brim"),
        worn(head, button, shade(colour, 0.8), "brim", "whole"),
    ]


def _police_cap(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    crown = [(1.0, 0.80), (1.20, 0.93), (1.30, 1.03), (1.24, 1.08), (0.85, 1.10), (0.4, 1.09), (0.0, 1.085)]
    badge = ellipsoid_patch((0.455, 0.0, 0.915), (0.03, 0.065, 0.075), 8, 4)
    return [
        turned(head, crown, colour, 0.16),
        turned(head, [(1.0, 0.70), (1.01, 0.82)], shade(colour, 0.62), 0.16, "brim"),
        worn(head, _visor(0.42, 0.715, 0.10, 0.16), _BLACK, "trim"),
        worn(head, badge, _GOLD, "badge", "whole"),
    ]


def _beanie(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    band = [(1.02, 0.60), (1.06, 0.62), (1.08, 0.70), (1.06, 0.78), (1.0, 0.79)]
    return [
        turned(head, _dome(0.70, 1.20, 1.01), colour, 0.10),
        turned(head, band, shade(colour, 0.82), 0.10, "brim"),
    ]


def _beret(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    grid = lathe_grid(
        [(1.0, 0.76), (1.06, 0.80), (1.34, 0.90), (1.36, 0.98), (1.1, 1.06), (0.6, 1.10), (0.0, 1.11)],
        (_CENTRE[0], 0.0, 0.0), _RADII, np.linspace(0.0, 2 * np.pi, 25), 0.05,
    )  # fmt: skip
    lift = np.clip((grid[..., 2] - 0.80) / 0.2, 0.0, 1.0)
    grid[..., 1] += 0.08 * lift
    grid[..., 2] -= 0.22 * lift * grid[..., 1]
    grid[:, -1] = grid[:, 0]
    from_grid = plate(grid, grid, (_CENTRE[0], 0.0, 0.8))
    return [worn(head, from_grid, colour, "hat", "whole")]


def _brimmed(
    head: Head, long: float, curl: float, high: float, dent: float, part_band: Colour
) -> list[Piece]:
    colour = head.figure.spec.hat_color
    crown = [
        (1.0, 0.78), (0.98, 0.90), (0.94, high - 0.10), (0.84, high - 0.01), (0.66, high),
        (0.30, high - dent), (0.0, high - 1.2 * dent),
    ]  # fmt: skip
    band = [(1.015, 0.775), (1.005, 0.87), (0.97, 0.875)]

    def reach(a: Values) -> Values:
        return np.asarray(1.0 + long * (1.0 + 0.06 * np.cos(2 * a)))

    brim = _brim(reach, lambda a: curl * np.sin(a) ** 2 - 0.04, _HALF, 0.97, 0.775, 0.03)
    return [
        turned(head, crown, colour, 0.03),
        turned(head, band, part_band, 0.03, "belt"),
        worn(head, brim, colour, "brim"),
    ]


def _hat(head: Head) -> list[Piece]:
    return _brimmed(head, 0.62, 0.13, 1.24, 0.09, shade(head.figure.spec.hat_color, 0.55))


def _straw(head: Head) -> list[Piece]:
    return _brimmed(head, 0.85, 0.02, 1.13, 0.0, head.figure.spec.accent_color)


def _toque(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    puff = lathe_grid(
        [(0.98, 0.98), (1.14, 1.05), (1.32, 1.20), (1.30, 1.34), (1.0, 1.43), (0.5, 1.45), (0.0, 1.45)],
        _CENTRE, _RADII, np.linspace(0.0, np.pi, 25), 0.04,
    )  # fmt: skip
    turn = np.linspace(0.0, np.pi, 25)
    fold = 1.0 + 0.045 * np.cos(12 * turn)[None, :, None]
    middle = np.array([_CENTRE[0], 0.0, 0.0])
    puff[..., :2] = (middle + (puff - middle) * fold)[..., :2]
    return [
        worn(head, plate(puff, puff, (_CENTRE[0], 0.0, 1.1)), colour),
        turned(head, [(1.0, 0.72), (1.02, 0.86), (1.0, 1.0)], shade(colour, 0.93), 0.04, "brim"),
    ]


def _hard_hat(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    ridge = [
        (x, 0.0, z) for x, z in ((0.40, 0.98), (0.22, 1.17), (-0.06, 1.235), (-0.34, 1.16), (-0.52, 0.95))
    ]
    brim = _brim(
        lambda a: 1.16 + 0.34 * np.clip(np.cos(a), 0, 1) ** 1.5,
        lambda a: -0.05 + 0.0 * a,
        _HALF,
        1.05,
        0.77,
        0.05,
    )
    return [
        turned(head, _dome(0.76, 1.22, 1.09), colour, 0.05),
        worn(head, strand(ridge, 0.045, 6), shade(colour, 1.15), "brim", "whole"),
        worn(head, brim, shade(colour, 0.9), "brim"),
    ]


def _fire_helmet(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    brim = _brim(
        lambda a: 1.32 + 0.34 * np.clip(-np.cos(a), 0, 1) ** 1.2,
        lambda a: -0.06 - 0.20 * np.clip(-np.cos(a), 0, 1), _HALF, 1.04, 0.79, 0.03,
    )  # fmt: skip
    ridge = [
        (x, 0.0, z) for x, z in ((0.42, 1.02), (0.24, 1.25), (-0.06, 1.32), (-0.36, 1.22), (-0.53, 0.98))
    ]
    shield = ellipsoid_patch((0.47, 0.0, 1.02), (0.05, 0.12, 0.17), 8, 4)
    return [
        turned(head, _dome(0.78, 1.27, 1.07), colour, 0.03),
        worn(head, brim, shade(colour, 0.85), "brim"),
        worn(head, strand(ridge, 0.04, 6), shade(colour, 0.85), "brim", "whole"),
        worn(head, shield, _GOLD, "badge", "whole"),
    ]


def _helmet(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    low = [(1.16, 0.60), (1.13, 0.64), (1.12, 0.76)]
    shell = [*low, *[(r, z) for r, z in _dome(0.78, 1.21, 1.12)][1:]]
    strap = [(0.08, 0.345, 0.72), (0.12, 0.30, 0.35), (0.22, 0.19, 0.09), (0.28, 0.0, 0.0)]
    return [
        turned(head, shell, colour, 0.20),
        worn(head, strand(strap, 0.018, 5), shade(colour, 0.6), "belt", "side"),
    ]


def _crown(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    turn = np.linspace(0.0, np.pi, 17)
    point = np.abs(np.cos(4 * turn))
    low = lathe_grid([(0.94, 0.86), (0.97, 0.93)], _CENTRE, _RADII, turn, 0.05)
    high = lathe_grid([(1.05, 1.02)], _CENTRE, _RADII, turn, 0.05)
    high[..., 2] += 0.17 * point**1.5
    outer = np.concatenate([low, high])
    inner = outer - 0.05 * (outer - np.array([_CENTRE[0], 0.0, 0.0])) * np.array([1.0, 1.0, 0.0])
    gems = merged(
        [
            ellipsoid_patch(outer[1, k] * np.array([1.02, 1.02, 1.0]), (0.032, 0.032, 0.036), 6, 4)
            for k in (2, 6, 10, 14)
        ]
    )
    return [
        worn(head, plate(outer, inner, (_CENTRE[0], 0.0, 0.9), back=True), colour),
        worn(head, gems, head.figure.spec.top_color, "badge", "side"),
    ]


def _tiara(head: Head) -> list[Piece]:
    turn = np.linspace(0.0, 1.75, 12)
    wave = np.clip(np.cos(0.9 * turn), 0, 1)
    low = lathe_grid([(0.97, 0.90)], _CENTRE, _RADII, turn)
    high = lathe_grid([(0.99, 0.935)], _CENTRE, _RADII, turn)
    high[..., 2] += wave * (0.06 + 0.09 * np.abs(np.cos(3 * turn)))
    outer = np.concatenate([low, high])
    inner = outer - 0.05 * (outer - np.array([_CENTRE[0], 0.0, 0.0])) * np.array([1.0, 1.0, 0.0])
    gem = ellipsoid_patch((0.43, 0.0, 0.985), (0.025, 0.035, 0.045), 6, 4)
    return [
        worn(head, plate(outer, inner, (_CENTRE[0], 0.0, 0.9), back=True), head.figure.spec.hat_color),
        worn(head, gem, head.figure.spec.top_color, "badge", "whole"),
    ]


def _tricorn(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    turn = np.linspace(0.0, np.pi, 25)

    def corner(a: Values) -> Values:
        return np.asarray((0.5 + 0.5 * np.cos(3 * a)) ** 1.5)

    def rise(a: Values) -> Values:
        return np.asarray(0.36 - 0.32 * corner(a))

    brim = _brim(lambda a: 1.22 + 0.62 * corner(a), rise, turn, 0.98, 0.77, 0.02, 0.03)
    edge = _brim(lambda a: 1.25 + 0.62 * corner(a), lambda a: rise(a) + 0.012, turn, 1.2, 0.80, 0.02, 0.03)
    trim = Patch(
        edge.vertices, edge.faces[(np.linalg.norm(edge.vertices[edge.faces].mean(1)[:, :2], axis=1) > 0.62)]
    )
    return [
        turned(head, _dome(0.76, 1.18), colour, 0.02),
        worn(head, brim, colour, "brim"),
        *([worn(head, trim, head.figure.spec.accent_color, "trim")] if len(trim.faces) else []),
    ]


def _wizard_hat(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    height = np.array([0.0, 0.15, 0.32, 0.5, 0.7, 0.88, 1.0])
    grid = lathe_grid(
        [(1.0 * (1 - t) ** 0.9 + 0.02, 0.76 + 1.25 * t) for t in height.tolist()],
        _CENTRE,
        _RADII,
        _HALF,
        0.03,
    )
    grid[..., 0] -= 0.55 * (height**2.2)[:, None]
    band = [(1.02, 0.77), (0.95, 0.88)]
    brim = _brim(lambda a: 1.78 + 0.0 * a, lambda a: 0.05 * np.cos(2 * a) - 0.07, _HALF, 0.97, 0.77, 0.03)
    return [
        worn(head, plate(grid, grid, (_CENTRE[0], 0.0, 0.7)), colour),
        turned(head, band, head.figure.spec.accent_color, 0.03, "belt"),
        worn(head, brim, colour, "brim"),
    ]


def _nurse_cap(head: Head) -> list[Piece]:
    turn = np.linspace(0.0, 1.35, 8)
    low = lathe_grid([(0.90, 0.95)], _CENTRE, _RADII, turn)
    high = lathe_grid([(1.04, 1.14)], _CENTRE, _RADII, turn)
    low[..., 0] -= 0.06
    high[..., 2] -= 0.06 * turn
    back = low + np.array([-0.16, 0.0, 0.10])
    grid = np.concatenate(
        [low, high, np.stack([np.where(back[0] > high[0], back[0], high[0] * 0.8 + back[0] * 0.2)])]
    )
    return [worn(head, plate(grid, grid, (_CENTRE[0], 0.0, 0.9)), head.figure.spec.hat_color)]


def _scrub_cap(head: Head) -> list[Piece]:
    colour = head.figure.spec.hat_color
    return [
        turned(head, _dome(0.66, 1.12, 1.0), colour, 0.14),
        turned(
            head, [(1.0, 0.64), (1.03, 0.66), (1.03, 0.72), (1.0, 0.73)], shade(colour, 0.85), 0.14, "brim"
        ),
    ]


_HATS: dict[str, Callable[[Head], list[Piece]]] = {
    "cap": _cap,
    "police-cap": _police_cap,
    "beanie": _beanie,
    "beret": _beret,
    "brimmed-hat": _hat,
    "straw-hat": _straw,
    "toque": _toque,
    "hard-hat": _hard_hat,
    "fire-helmet": _fire_helmet,
    "helmet": _helmet,
    "crown": _crown,
    "tiara": _tiara,
    "tricorn": _tricorn,
    "wizard-hat": _wizard_hat,
    "nurse-cap": _nurse_cap,
    "scrub-cap": _scrub_cap,
    "hood": hood,
    "veil": veil,
    "knight-helmet": knight_helmet,
    "space-helmet": space_helmet,
}
#: Height at the middle and slope forward of the line from which on a hat hides the hair.
_LINES: dict[str, tuple[float, float]] = {
    "cap": (0.74, 0.06),
    "police-cap": (0.74, 0.16),
    "beanie": (0.64, 0.10),
    "beret": (0.80, 0.05),
    "brimmed-hat": (0.80, 0.03),
    "straw-hat": (0.80, 0.03),
    "toque": (0.76, 0.04),
    "hard-hat": (0.79, 0.05),
    "fire-helmet": (0.81, 0.03),
    "helmet": (0.68, 0.20),
    "tricorn": (0.79, 0.02),
    "wizard-hat": (0.79, 0.03),
    "scrub-cap": (0.69, 0.14),
}
