"""Views drawn at a time fit the memory there is; where it runs out, fewer are, and nothing else changes."""

from __future__ import annotations

import ctypes
from types import SimpleNamespace
from typing import Any

import numpy as np
import psutil
import pytest
from raster_scenes import looking, room, still

from runtime.raster import memory
from runtime.raster.device import Backend
from runtime.raster.memory import HOST, USUAL, budget, bytes_of_view
from runtime.raster.renderer import Renderer, skinned

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


def test_a_small_budget_gives_the_same_in_more_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    drawer = Renderer("cpu")
    drawer.load(room())
    views = looking(EYES, [(2.0, 1.8, 1.0)] * 5)
    expected = drawer.render(still(2), views, SIZE).color
    sizes: list[int] = []
    draw = drawer._draw
    monkeypatch.setattr(drawer, "_draw", lambda view, *rest: (sizes.append(len(view)), draw(view, *rest)))
    assert drawer._loaded is not None
    each = bytes_of_view(drawer._loaded, SIZE, drawer._passes.run, len(drawer._loaded.scene.rest))
    for room_for, cut in ((0, [1] * 5), (1, [1] * 5), (2, [2, 2, 1]), (7, [5])):
        drawer.budget = room_for * each
        sizes.clear()
        assert (drawer.render(still(2), views, SIZE).color == expected).all()
        assert sizes == cut


@pytest.mark.parametrize("size", [(64, 36), (224, 224), (1280, 720)])
def test_what_a_view_is_said_to_take_is_what_it_takes(size: tuple[int, int]) -> None:
    held = []
    for count in (4, 12):
        drawer = Renderer("cpu")
        drawer.load(room())
        eyes = [(2.0 + 0.1 * k, -1.8, 1.5) for k in range(count)]
        views = looking(eyes, [(2.0, 1.8, 1.0)] * count, moments=list(range(count)))
        pictures = drawer.render(still(2, count), views, size).color
        held.append(sum(b.nbytes for b in drawer._buffers.values()) + pictures.nbytes)
    content = drawer._loaded
    assert content is not None
    vertices = skinned(content, np.zeros((1, content.walls + content.people + 1), np.int32))
    said = bytes_of_view(content, size, drawer._passes.run, vertices)
    assert 0.7 * said < (held[1] - held[0]) / 8 < 1.1 * said


def test_a_processor_shares_what_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    free = SimpleNamespace(available=400 << 20)
    monkeypatch.setattr(psutil, "virtual_memory", lambda: free)
    assert budget(Backend("cpu", 2)) == 100 << 20
    free.available = 64 << 30
    assert budget(Backend("cpu", 2)) == HOST


class Driver:
    """What NVIDIA's library does, for one device with 6 of 8 GiB free. broken: the call that fails"""

    def __init__(self, broken: str = "") -> None:
        self.broken, self.asked, self.open = broken, -1, 0

    def nvmlInit_v2(self) -> int:  # noqa: N802
        self.open += self.broken != "init"
        return int(self.broken == "init")

    def nvmlShutdown(self) -> int:  # noqa: N802
        self.open -= 1
        return 0

    def nvmlDeviceGetHandleByIndex_v2(self, index: int, device: Any) -> int:  # noqa: N802
        self.asked = index
        return int(self.broken == "handle")

    def nvmlDeviceGetMemoryInfo(self, device: Any, out: Any) -> int:  # noqa: N802
        figures = ctypes.cast(out, ctypes.POINTER(ctypes.c_ulonglong))
        figures[0], figures[1], figures[2] = 8 << 30, 6 << 30, 2 << 30
        return int(self.broken == "memory")


def test_a_gpu_shares_what_its_driver_says_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    cuda = Backend("cuda", 2)
    for broken, devices, expected, asked in (
        ("", "", USUAL, -1),  # none may be used
        ("", "2,0", 3 << 30, 2),
        ("", "GPU-5f1c", USUAL, -1),
        ("init", "0", USUAL, -1),
        ("handle", "0", USUAL, 0),
        ("memory", "0", USUAL, 0),
    ):
        driver = Driver(broken)
        monkeypatch.setattr(memory.ctypes, "CDLL", lambda name, driver=driver: driver)
        monkeypatch.setenv("CUDA_VISIBLE_DEVICES", devices)
        assert budget(cuda) == expected, broken
        assert (driver.asked, driver.open) == (asked, 0)
    assert budget(Backend("vulkan", 2)) == USUAL  # which cannot be asked


def test_without_a_driver_the_usual_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> None:
        raise OSError(name)

    monkeypatch.setattr(memory.ctypes, "CDLL", missing)
    monkeypatch.setenv("CUDA_VISIBLE_DEVICES", "0")
    assert budget(Backend("cuda", 2)) == USUAL
