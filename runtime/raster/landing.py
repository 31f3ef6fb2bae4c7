"""Where finished pictures land in a GPU's memory before they are fetched.

Given an array of the host's, Taichi copies it to a CUDA device before each kernel and back after it, also
what is only written. Here kernels are given memory of the device's own, and it is copied once. Assumes that
Taichi runs in the device's primary context, as frameworks do that share memory. Guarantees that where the
driver cannot be asked, pictures come as they would without.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from numpy.typing import NDArray

_OUT_OF_MEMORY = 2  # CUDA_ERROR_OUT_OF_MEMORY


class Landing:
    """Memory that kernels write finished bytes to. on_device: whether the device is one with its own"""

    def __init__(self, on_device: bool) -> None:
        self._driver: ctypes.CDLL | None = None
        self._context, self._at, self._size = ctypes.c_void_p(), ctypes.c_uint64(), 0
        if on_device:
            self._driver = self._started()

    def bytes(self, out: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Where kernels are to write what belongs into ``out``, flat: nobody else may look into it. Call
        :meth:`fetch` when it is written. Raises MemoryError."""
        if self._driver is None or not out.size:
            return out.reshape(-1)
        if self._size < out.size:
            self.release()
            self._asked("cuMemAlloc_v2", ctypes.byref(self._at), ctypes.c_size_t(out.size))
            self._size = out.size
        there = (ctypes.c_uint8 * out.size).from_address(int(self._at.value))
        return np.ctypeslib.as_array(there)

    def fetch(self, out: NDArray[np.uint8]) -> None:
        """Bring what was written to where it belongs. Raises RuntimeError if the device does not answer."""
        if self._driver is None or not out.size:
            return
        import taichi as ti

        ti.sync()
        self._asked("cuMemcpyDtoH_v2", ctypes.c_void_p(out.ctypes.data), self._at, ctypes.c_size_t(out.size))

    def release(self) -> None:
        """Give the memory back."""
        if self._driver is not None and self._size:
            self._asked("cuMemFree_v2", self._at)
            self._size = 0

    def _started(self) -> ctypes.CDLL | None:
        try:
            driver = ctypes.CDLL("libcuda.so.1")
        except OSError:
            return None
        device = ctypes.c_int()
        if driver.cuInit(0) or driver.cuDeviceGet(ctypes.byref(device), 0):
            return None
        if driver.cuDevicePrimaryCtxRetain(ctypes.byref(self._context), device):
            return None
        return driver

    def _asked(self, name: str, *arguments: Any) -> None:
        """Call the driver in the context that Taichi's memory is in."""
        assert self._driver is not None
        self._driver.cuCtxPushCurrent_v2(self._context)
        code = getattr(self._driver, name)(*arguments)
        self._driver.cuCtxPopCurrent_v2(ctypes.byref(ctypes.c_void_p()))
        if code == _OUT_OF_MEMORY:
            raise MemoryError(f"{name}: out of memory on the device")
        if code:
            raise RuntimeError(f"{name}: CUDA error {code}")
