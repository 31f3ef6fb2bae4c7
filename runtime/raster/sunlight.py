"""Which places of an interior the sun falls on through its windows, worked out once per scene.

Assumes a set with walls and :attr:`runtime.world.Light.windows` above 0. Guarantees that nothing is worked
out or drawn otherwise.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mesh import MATERIALS
from ..world import Light
from .device import Backend
from .looks import LUMA
from .prepare import Prepared
from .types import Style

CLAY_SHARE = 0.55  # how much of it there is on clay, and without its colour


@dataclass(frozen=True, eq=False)
class Sunlight:
    """color: how much it lightens red, green and blue; shadow: its map (``loaded.ShadowMap``); begin, side,
    plot: cells of triangles; chart, whole: kinds of cells and of triangles (``kernels/chart.py``)"""

    color: Any
    shadow: Any
    plot: Any
    begin: Any
    side: Any
    chart: Any
    whole: Any


def opaque_faces(prepared: Prepared) -> NDArray[np.int32]:
    """Static triangles that keep the sun off, walls and ceilings among them."""
    material = prepared.info[: prepared.static_faces, 1] & 0xFF
    clear = [MATERIALS.index("glass"), MATERIALS.index("glow")]
    return np.flatnonzero(~np.isin(material, clear)).astype(np.int32)


def window_color(light: Light, style: Style) -> NDArray[np.float32]:
    """How much sunlight through windows lightens what it falls on, float32 [3]."""
    color = np.array(light.sun_color, np.float64)
    color *= light.windows / max(float(color @ LUMA), 1e-6)
    if style.clay:
        color = np.full(3, CLAY_SHARE * light.windows)
    return color.astype(np.float32)


def find_sunlight(
    prepared: Prepared,
    arrays: Mapping[str, Any],
    light: Light,
    style: Style,
    backend: Backend,
    cast: Any,
    chart: Any,
) -> Sunlight | None:
    """Sunlight through the windows of a set, None where there is none.

    cast: makes the shadow map of static triangles [K]; chart: its cells (``loaded.Chart``)
    """
    indoors = (prepared.info[: prepared.static_faces, 2] >= 0).any()
    if light.windows <= 0 or not indoors or not style.shadows:
        return None
    from .kernels import sunlight  # only now: they import taichi
    from .kernels.chart import survey
    from .kernels.paint import SHEET

    count = prepared.static_faces
    shadow = cast(opaque_faces(prepared))
    of_set = (shadow.frame, shadow.size, shadow.depth, shadow.coarse)
    places = tuple(arrays[name] for name in ("vertices", "normals", "faces", "light", "basis"))
    sheet = backend.buffer((2 * count * SHEET,), np.float32)
    kinds = backend.buffer(chart.kinds.shape, np.uint8)
    whole = backend.buffer((count,), np.uint8)
    sunlight.sunny(*places, *of_set, count, sheet)
    survey(*places, *of_set, sheet, chart.begin, chart.side, count, kinds)
    sunlight.keep(sheet, chart.begin, chart.side, count, kinds, whole)
    color = backend.upload(window_color(light, style))
    return Sunlight(color, shadow, chart.plot, chart.begin, chart.side, kinds, whole)
