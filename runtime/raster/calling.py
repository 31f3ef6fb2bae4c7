"""Taichi's kernels, called quicker.

With every call Taichi asks anew what kinds of arguments there are, which takes longer than many a kernel:
here that is remembered. Assumes Taichi 1.7. Guarantees that a kind of arguments is checked by Taichi itself
at the first call, and that whatever is not plainly of such a kind goes Taichi's own way.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, NamedTuple

import numpy as np

ARRAY, VECTORS, TEMPLATE, WHOLE, REAL = range(5)  # kinds of parameters: arrays, of vectors; numbers
MOST = (1 << 31) - 1  # bytes of an array that is passed quickly


class _Known(NamedTuple):
    """What is remembered of a kernel. program: for which; kinds: of its parameters, None where one of them
    cannot be passed quickly; compiled: the kernel and its code for each kind of arguments it was called
    with"""

    program: Any
    kinds: tuple[int, ...] | None
    compiled: dict[tuple[Any, ...], tuple[Any, Any]]


def remembering(call: Callable[..., Any]) -> Callable[..., Any]:
    """``Kernel.__call__``, that passes arrays of the host and numbers straight on where a call of the same
    kind has been checked before."""

    @wraps(call)
    def called(self: Any, *arguments: Any, **named: Any) -> Any:
        runtime = self.runtime
        known: _Known | None = self.__dict__.get("_known")
        if known is None or known.program is not runtime.prog:
            out = call(self, *arguments, **named)  # which may only now make the program
            self._known = _Known(runtime.prog, _kinds(self), {})
            return out
        kinds = known.kinds
        if kinds is None or named or self.has_print or runtime.target_tape or runtime.fwd_mode_manager:
            return call(self, *arguments, **named)
        signature = _signature(kinds, arguments)
        if signature is None:
            return call(self, *arguments)
        found = known.compiled.get(signature)
        if found is None:
            kernel = self.compiled_kernels[self.ensure_compiled(*arguments)]
            program = runtime.prog
            code = program.compile_kernel(program.config(), program.get_device_caps(), kernel)
            call(self, *arguments)  # which checks them
            known.compiled[signature] = (kernel, code)
            return None
        _launch(runtime.prog, *found, kinds, arguments)
        return None

    return called


def _kinds(kernel: Any) -> tuple[int, ...] | None:
    """The kinds of the parameters of a kernel, None where it gives something back or takes something else."""
    from taichi.lang.util import cook_dtype
    from taichi.types import ndarray_type, primitive_types
    from taichi.types.annotations import template
    from taichi.types.utils import is_signed

    if kernel.return_type is not None or kernel.classkernel:
        return None
    out = []
    for argument in kernel.arguments:
        needed = argument.annotation
        if isinstance(needed, template):
            out.append(TEMPLATE)
        elif isinstance(needed, ndarray_type.NdarrayType) and id(needed.dtype) in primitive_types.type_ids:
            out.append(ARRAY)
        elif isinstance(needed, ndarray_type.NdarrayType) and getattr(needed.dtype, "ndim", 0) == 1:
            out.append(VECTORS)
        elif id(needed) in primitive_types.real_type_ids:
            out.append(REAL)
        elif id(needed) in primitive_types.integer_type_ids and is_signed(cook_dtype(needed)):
            out.append(WHOLE)
        else:
            return None
    return tuple(out)


def _signature(kinds: tuple[int, ...], arguments: tuple[Any, ...]) -> tuple[Any, ...] | None:
    """What the code of a kernel depends on, of its arguments; None where they cannot be passed quickly."""
    if len(kinds) != len(arguments):
        return None
    out: list[Any] = []
    for kind, value in zip(kinds, arguments, strict=True):
        if kind <= VECTORS:
            if type(value) is not np.ndarray or value.nbytes > MOST or not value.flags.c_contiguous:
                return None
            out.append((value.dtype.char, value.ndim, value.shape[-1] if kind == VECTORS else 0))
        elif kind == TEMPLATE:
            if type(value) is not bool and type(value) is not int:
                return None
            out.append(value)
        elif not isinstance(value, int | float | np.integer | np.floating) or (
            kind == WHOLE and isinstance(value, float | np.floating)
        ):
            return None
    return tuple(out)


def _launch(program: Any, kernel: Any, code: Any, kinds: tuple[int, ...], arguments: tuple[Any, ...]) -> None:
    """As ``Kernel.launch_kernel`` does it, of arguments that need no further look."""
    context, place = kernel.make_launch_context(), 0
    pass_array, pass_whole, pass_real = (
        context.set_arg_external_array_with_shape,
        context.set_arg_int,
        context.set_arg_float,
    )
    for kind, value in zip(kinds, arguments, strict=True):
        if kind == TEMPLATE:
            continue
        if kind <= VECTORS:
            shape = value.shape if kind == ARRAY else value.shape[:-1]
            pass_array((place,), value.ctypes.data, value.nbytes, shape, 0)
        elif kind == WHOLE:
            pass_whole((place,), int(value))
        else:
            pass_real((place,), float(value))
        place += 1
    program.launch_kernel(code, context)
