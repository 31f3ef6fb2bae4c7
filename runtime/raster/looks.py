"""What a look makes of a scene's colours and light, before any kernel runs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..materials import MATERIALS, SKIN_SHADE
from ..world import Light
from .film import exposed, to_encoded, to_linear, unexposed
from .types import Style

CLAY_SET = (0.60, 0.59, 0.565)  # linear
CLAY_LOOSE = (0.74, 0.62, 0.50)  # of people and what they handle
CLAY_SPREAD = 0.42  # how much of the lightness of things the clay keeps: eyes and brows must show
CLAY_LIGHT = 1.42  # how light it is around clay at noon
CLAY_HOURS = 0.25  # 0: as light at night as at noon, 1: as dark as it is
CLAY_BACKDROP = ((0.93, 0.93, 0.92), (0.80, 0.83, 0.86))  # sRGB
LUMA = np.array([0.2126, 0.7152, 0.0722])
CLOTH_INK, SKIN_INK = (0.40, 0.84), (0.50, 0.90)  # darkness from which it takes ink, and at which it is black
CLOTH_WASH, SKIN_WASH = (0.25, 0.95), (0.45, 1.0)  # and the same of a wash of grey
SHADE_INK = 0.24  # ink of skin that no light reaches, at least
PAPER_SHARE = 0.66  # what a thing must throw back of the light to stay white on paper
GLOOM = (200.0, 145.0)  # paper levels at which it begins to be, and is as gloomy as can be


def surface_colors(
    color: NDArray[np.floating], loose: NDArray[np.bool_], style: Style
) -> NDArray[np.float64]:
    """Linear colours [F, 3] as a look paints them; loose: faces of people and handled things."""
    if not style.clay:
        return np.asarray(color, np.float64)
    lightness = np.cbrt(np.clip(color @ LUMA, 0.0, 1.0))
    spread = 1.0 + CLAY_SPREAD * (lightness[:, None] - 0.72) / 0.5
    return np.asarray(np.where(loose[:, None], CLAY_LOOSE, CLAY_SET) * spread, np.float64)


def packed_light(light: Light, style: Style) -> NDArray[np.float32]:
    """Sun direction, sun, sky, ground, horizon and zenith in scene light, float32 [18]. Raises ValueError."""
    sun, sky, ground = (np.array(c, np.float64) for c in (light.sun_color, light.sky, light.ground))
    horizon, zenith = unexposed(to_linear(np.array(light.backdrop)))
    if style.clay:
        # a wide soft sky with little of its colour, a weak sun; nearly the same at any hour, as in a studio
        share = float((sky + sun / 2) @ LUMA) / CLAY_LIGHT
        level = share ** (CLAY_HOURS - 1.0)
        sky, ground = _paled(sky, 0.75) * 1.22 * level, _paled(ground, 0.75) * 0.84 * level
        sun = _paled(sun, 0.6) * 0.95 * level
        lowered = min(share**CLAY_HOURS, 1.0)
        horizon, zenith = (unexposed(to_linear(np.array(each) * lowered)) for each in CLAY_BACKDROP)
    packed = np.concatenate([np.array(light.sun, np.float64), sun, sky, ground, horizon, zenith])
    if not np.isfinite(packed).all():
        raise ValueError("Light: not all numbers are finite")
    return packed.astype(np.float32)


def paper_level(light: Light) -> float:
    """Luma 0..255 of what stays white on paper: a pale thing in all of the light."""
    return float(_most(np.full((1, 3), PAPER_SHARE), light)[0])


def gloom(light: Light) -> float:
    """How far from the light of day a set is, 0..1: what its lamps do not reach is hatched the more."""
    return float(np.clip((GLOOM[0] - paper_level(light)) / (GLOOM[0] - GLOOM[1]), 0.0, 1.0))


def paper_tones(
    color: NDArray[np.floating], material: NDArray[np.integer], light: Light
) -> NDArray[np.float32]:
    """What paper makes of things of linear colours [F, 3], float32 [F, 3].

    How light they are in all of the light, 1: as light as paper; how much ink their own colour takes in
    strokes, 0..1, and in a wash of grey, which is the same at any hour. Dark cloth is black; skin, which is
    no cloth, stays open so that the face on it can be read.
    """
    tone = np.clip(_most(np.asarray(color, np.float64), light) / paper_level(light), 0.05, 1.0)
    cloth = (material == MATERIALS.index("cloth"))[:, None]
    ink = 0.84 * _share(1.0 - tone, *np.where(cloth, CLOTH_INK, SKIN_INK).T)
    ink = np.where(material == SKIN_SHADE, np.maximum(ink, SHADE_INK), ink)
    pale = _luma(to_encoded(np.asarray(color, np.float64))) / _luma(to_encoded(np.full(3, PAPER_SHARE)))
    wash = 0.92 * _share(1.0 - pale, *np.where(cloth, CLOTH_WASH, SKIN_WASH).T)
    return np.stack([tone, ink, wash], axis=1).astype(np.float32)


def _share(
    x: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]
) -> NDArray[np.float64]:
    """0 up to low, 1 from high on, eased in between."""
    share = np.clip((x - low) / (high - low), 0.0, 1.0)
    return np.asarray(share * share * (3.0 - 2.0 * share))


def _most(color: NDArray[np.float64], light: Light) -> NDArray[np.float64]:
    """Luma 0..255 of colours [F, 3] under sky and sun together."""
    most = np.array(light.sky, np.float64) + np.array(light.sun_color)
    return _luma(to_encoded(exposed(color * most))) * 255


def _luma(encoded: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of sRGB colours [..., 3], as kernels have it."""
    return np.asarray(encoded @ np.array([5, 9, 2]) / 16)


def glass_colors(color: NDArray[np.floating], style: Style) -> NDArray[np.float32]:
    """Colours [F, 3] of glass as a look has them: without their tint where it has no colours."""
    if style.clay or style.hatch:
        return np.full(color.shape, 0.9, np.float32)
    return np.asarray(color, np.float32)


def _paled(light: NDArray[np.float64], share: float) -> NDArray[np.float64]:
    """A light with a share of its colour taken away."""
    return light + (light @ LUMA - light) * share
