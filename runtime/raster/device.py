"""Starts Taichi once per process.

Assumes nobody else calls ``ti.init``. Guarantees one backend per process: asking for another one
later is an error, because Taichi would throw every kernel and buffer away.
"""

from __future__ import annotations

import contextlib
import io
import os
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray
from platformdirs import user_cache_path

from .quick import importing, quicken

ALIGNMENT = 64  # bytes
DEVICES = ("auto", "cpu", "cuda", "vulkan")


class DeviceError(RuntimeError):
    """The asked-for device cannot be used; the message says what to do."""


@dataclass(frozen=True)
class Backend:
    """The running backend. name: ``cpu``, ``cuda`` or ``vulkan``; threads: CPU threads in use."""

    name: str
    threads: int

    @property
    def on_host(self) -> bool:
        """Whether kernels work on numpy arrays in place."""
        return self.name == "cpu"

    def crew(self, tasks: int) -> tuple[Any, int, bool]:
        """What kernels ask for that share ``tasks`` as ``kernels/crew.py`` says: a queue, how many slots,
        and whether tasks are drawn from the queue. Only for one call."""
        from .kernels import crew  # only now: it imports taichi

        if not self.on_host:
            return self.upload(np.zeros(1, np.int32)), tasks, False
        return crew.queue_for(tasks, self.threads), self.threads * max(tasks, crew.STRETCH), True

    def buffer(self, shape: tuple[int, ...], dtype: DTypeLike) -> Any:
        """An array that kernels can use: numpy zeros on the host (:func:`aligned`), else a Taichi ndarray."""
        if self.on_host:
            return aligned(shape, dtype)
        import taichi as ti

        kinds = {"f4": ti.f32, "i4": ti.i32, "u1": ti.u8, "u2": ti.u16, "u4": ti.u32, "u8": ti.u64}
        return ti.ndarray(kinds[np.dtype(dtype).str[1:]], shape=shape)

    def upload(self, array: NDArray[Any]) -> Any:
        """A copy of ``array`` (at least one element long) where kernels can use it."""
        if array.size == 0:
            array = np.zeros(tuple(max(s, 1) for s in array.shape), array.dtype)
        array = np.ascontiguousarray(array)
        if self.on_host:
            return array
        out = self.buffer(array.shape, array.dtype)
        out.from_numpy(array)
        return out


def aligned(shape: tuple[int, ...], dtype: DTypeLike) -> NDArray[Any]:
    """Zeros that begin on a line of the cache, as kernels under :func:`vectorised` need them."""
    size = int(np.prod(shape)) * np.dtype(dtype).itemsize
    memory = np.zeros(size + ALIGNMENT, np.uint8)
    start = -memory.ctypes.data % ALIGNMENT
    return memory[start : start + size].view(dtype).reshape(shape)


def vectorised(kernel: Callable[..., None]) -> Callable[..., None]:
    """A kernel that is compiled with vectors kept whole, for one vector instruction each.

    Only for the host, and for kernels that keep to plain arithmetic, comparisons and selections of vectors:
    at others the compiler gives up, and the process with it.
    """

    def call(*arguments: Any) -> None:
        import taichi as ti

        config = ti.lang.impl.current_cfg()
        before = config.real_matrix_scalarize
        config.real_matrix_scalarize = False
        try:
            kernel(*arguments)
        finally:
            config.real_matrix_scalarize = before

    return call


_started: list[Backend] = []


def start(device: str = "auto") -> Backend:
    """Start Taichi on ``device``, or return the backend already running. Raises DeviceError."""
    if device not in DEVICES:
        raise DeviceError(f"unknown device {device!r}; choose one of {', '.join(DEVICES)}")
    if _started:
        backend = _started[0]
        if device not in ("auto", backend.name):
            raise DeviceError(
                f"this process already renders on {backend.name}; start another one for {device}"
            )
        return backend
    os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")
    os.environ.setdefault("TI_LOG_LEVEL", "error")
    with importing():
        import taichi as ti

    quicken()
    threads = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    cache = _kernel_cache()
    wanted = {"auto": ("cuda", "cpu")}.get(device, (device,))
    for name in wanted:
        arch = getattr(ti, name)
        if name != "cpu" and not ti._lib.core.with_cuda() and name == "cuda":
            continue
        try:
            with contextlib.redirect_stdout(io.StringIO()):  # it prints a banner
                ti.init(
                    arch=arch,
                    offline_cache=cache is not None,
                    **({} if cache is None else {"offline_cache_file_path": cache}),
                    cpu_max_num_threads=threads,
                    fast_math=False,  # shared edges must come out the same in every triangle
                    # LLVM finds what Taichi's own passes do: without them a large kernel is compiled
                    # ten times as fast and runs as fast, on a CPU with the same bits
                    advanced_optimization=name == "vulkan",
                    log_level=ti.ERROR,
                    enable_fallback=False,
                )
                ti.sync()  # else the first kernel finishes the start, and fails on any other thread
        except Exception as error:  # Taichi raises what it likes when a driver is missing
            if name != wanted[-1]:
                continue
            raise DeviceError(f"no usable {name} device here ({error}); try --device cpu") from error
        if ti.lang.impl.current_cfg().arch == arch or name == "cpu":
            if name == "vulkan":
                _check_driver()
            _started.append(Backend(name, threads))
            return _started[0]
    raise DeviceError(f"no usable {device} device here; try --device cpu")


def _check_driver() -> None:
    """Raise DeviceError where the Vulkan driver would leave holes in the picture."""
    from .kernels.probe import sound

    if not sound():
        raise DeviceError(
            "the Vulkan driver here gets atomic operations in loops wrong (as Mesa's lavapipe 22.3 does); "
            "update it, or try --device cpu"
        )


def _kernel_cache() -> str | None:
    """A folder for compiled kernels, or None where there can be none (Taichi would crash on it)."""
    folder = user_cache_path("vdsl") / "kernels"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return str(folder)
    except OSError:
        return None
