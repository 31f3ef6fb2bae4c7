"""How much memory a view takes while it is drawn, and how much of the device's drawing may take.

Guarantees nothing but good sense: where a guess is too high, the renderer draws fewer views at a time. What a
batch gives does not depend on it.
"""

from __future__ import annotations

import ctypes
import os

import psutil

from .device import Backend
from .loaded import Loaded
from .shadows import texels_of

#: Bytes: sixty-four small views of a furnished room with as much again outside; more draw no faster on a
#: processor. A good part is room for triangles that are not seen, and never written to.
HOST = 3 << 29
USUAL = 640 << 20  # bytes, of a GPU that does not say what it has
MOST = 4 << 30  # bytes, of a GPU with memory to spare
HOST_SHARE, GPU_SHARE = 4, 2  # a quarter of what a machine has free, and half of what a GPU has

PIXEL = 20 + 3  # visibility, colour, normals and edges; the finished bytes
RUN = 10 * 4  # of a run of pixels: solid, marks, level, what touched and copied it, lines and ends in it
PANE = 8  # of a pixel where there is clear glass
VERTEX = 2 * 12  # place and normal
CORNERS = 100  # of a triangle that is drawn, which may leave two on the screen, on the host
CLUSTER = 16 + 4 * 9 * 16 * 4  # bounds, and corners as they are arranged for vectors
TEXEL = 4 + 2 * 4 * 0.2  # of a shadow map, and its summaries while they are made
CELL = 2 * 4  # of floor and furniture: how much stands there; a GPU counts it in two more such


def bytes_of_view(content: Loaded, size: tuple[int, int], run: int, vertices: int) -> int:
    """Memory of one view of ``size`` with its own moment; vertices: how many are moved."""
    width, height = size
    pixels = width * height * (PIXEL + (PANE if content.glass is not None else 0))
    runs = height * -(-width // run) * RUN
    return pixels + runs + content.scene.most_drawn * CORNERS + bytes_of_moment(content, height, vertices)


def bytes_of_moment(content: Loaded, height: int, vertices: int) -> int:
    """Memory of one moment, for pictures of ``height`` rows; vertices: how many are moved."""
    scene = content.scene
    moving = len(scene.clusters) - scene.moving_first
    texels = texels_of(height) ** 2 * len(content.casting.runs) if len(scene.casters) else 0
    floor = content.rows * content.columns * CELL
    return int(vertices * VERTEX + moving * CLUSTER + texels * TEXEL + floor)


def budget(backend: Backend) -> int:
    """Bytes that the views drawn at a time may take on a device, by what it has free now."""
    if backend.on_host:
        return min(HOST, int(psutil.virtual_memory().available) // HOST_SHARE)
    free = _free_on_nvidia() if backend.name == "cuda" else None
    return USUAL if free is None else min(MOST, free // GPU_SHARE)


class _Memory(ctypes.Structure):
    """``nvmlMemory_t``, in bytes."""

    _fields_ = (("total", ctypes.c_ulonglong), ("free", ctypes.c_ulonglong), ("used", ctypes.c_ulonglong))


def _free_on_nvidia() -> int | None:
    """Free bytes of the first NVIDIA GPU that this process may use, None where its driver does not say."""
    first = os.environ.get("CUDA_VISIBLE_DEVICES", "0").split(",")[0].strip()
    if not first.isdecimal():
        return None
    try:
        library = ctypes.CDLL("libnvidia-ml.so.1")
    except OSError:
        return None
    if library.nvmlInit_v2() != 0:
        return None
    device, memory = ctypes.c_void_p(), _Memory()
    try:
        if library.nvmlDeviceGetHandleByIndex_v2(int(first), ctypes.byref(device)) != 0:
            return None
        if library.nvmlDeviceGetMemoryInfo(device, ctypes.byref(memory)) != 0:
            return None
    finally:
        library.nvmlShutdown()
    return int(memory.free)
