"""Where memory runs out, fewer views are drawn at a time, and nothing else changes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from raster_scenes import looking, room, still

from runtime.raster.renderer import Renderer

SIZE = (64, 36)
EYES = [(2.6, -1.8, 1.5), (1.0, -2.0, 1.2), (3.0, -1.0, 1.4), (2.0, -2.4, 1.8), (0.5, -1.5, 1.1)]


@pytest.mark.parametrize("error", [MemoryError(), RuntimeError("CUDA_ERROR_OUT_OF_MEMORY while allocating")])
def test_a_batch_that_does_not_fit_is_halved(monkeypatch: pytest.MonkeyPatch, error: Exception) -> None:
    drawer = Renderer("cpu")
    drawer.load(room())
    views = looking(EYES, [(2.0, 1.8, 1.0)] * 5)
    expected = drawer.render(still(2), views, SIZE).color
    sizes: list[int] = []
    draw = drawer._draw

    def tight(view: Any, *rest: Any) -> None:
        sizes.append(len(view))
        if len(view) > 2:
            raise error
        draw(view, *rest)

    monkeypatch.setattr(drawer, "_draw", tight)
    assert (drawer.render(still(2), views, SIZE).color == expected).all()
    assert sizes == [5, 2, 2, 1]
    sizes.clear()
    drawer.render(still(2), views, SIZE)
    assert sizes == [2, 2, 1]  # remembered


def test_one_view_that_does_not_fit_and_other_errors_are_raised(monkeypatch: pytest.MonkeyPatch) -> None:
    drawer = Renderer("cpu")
    drawer.load(room())
    views = looking(EYES, [(2.0, 1.8, 1.0)] * 5)
    for error in (MemoryError(), RuntimeError("something else")):
        monkeypatch.setattr(drawer, "_draw", lambda *rest, error=error: (_ for _ in ()).throw(error))
        with pytest.raises(type(error)):
            drawer.render(still(2), views, SIZE)
    monkeypatch.undo()
    assert np.isfinite(drawer.render(still(2), views, SIZE).color).all()
