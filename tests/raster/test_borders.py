"""Where lines may be is found for sixteen pixels at once: never another byte than pixel by pixel."""

from __future__ import annotations

import numpy as np
import pytest
from raster_scenes import looking, room, still

from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES


# small and large pictures have lines of one pixel and of two; the narrow one is a single run
@pytest.mark.parametrize("size", [(1280, 368), (224, 224), (16, 9)])
@pytest.mark.parametrize("style", ["board", "clay", "ink"])
def test_lines_are_those_found_pixel_by_pixel(style: str, size: tuple[int, int]) -> None:
    eyes = [(2.6, -1.8, 1.5), (1.2, 0.2, 1.1), (0.3, 0.4, 2.2)]
    views = looking(eyes, [(1.7, 1.8, 1.0), (1.7, 1.8, 0.9), (2.0, 2.0, 0.4)])
    drawer = Renderer("cpu", STYLES[style])
    drawer.load(room())
    fast = drawer.render(still(2), views, size).color
    assert drawer._passes._ink_runs is not None
    drawer._passes._ink_runs = None
    slow = drawer.render(still(2), views, size).color
    assert np.array_equal(fast, slow)
    assert len(np.unique(fast)) > 20
