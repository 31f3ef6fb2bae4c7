"""Taichi, started and called quicker.

Taichi reads the source of every kernel anew in each process, even where the compiled kernel is kept, and
spends most of that time on laying out source lines for error messages that nobody will see. And with every
call it asks anew what kinds of arguments there are, which takes longer than many a kernel: here that is
remembered. Assumes Taichi 1.7; where what is replaced is not there, everything stays as it is. Guarantees
the same kernels: only the pictures of source lines in compile errors are plainer.
"""

from __future__ import annotations

import ast
import gc
import linecache
import sys
import textwrap
from collections.abc import Callable
from functools import cache, lru_cache, wraps
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

ARRAY, VECTORS, TEMPLATE, WHOLE, REAL = range(5)  # kinds of parameters: arrays, of vectors; numbers
MOST = (1 << 31) - 1  # bytes of an array that is passed quickly


def quicken() -> None:
    """Call once a process, before the first kernel is defined."""
    from taichi.lang import kernel_impl
    from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext

    needed = ("getsourcelines", "getsourcefile", "textwrap", "_inside_class")
    if not hasattr(ASTTransformerContext, "get_pos_info") or not all(hasattr(kernel_impl, n) for n in needed):
        return
    ASTTransformerContext.get_pos_info = _place
    # functions are inlined, and so read, at every place they are called from
    kernel_impl.getsourcelines = lru_cache(maxsize=None)(_source_of(kernel_impl.getsourcelines))
    kernel_impl.getsourcefile = _file_of
    kernel_impl.Kernel.materialize = _undisturbed(kernel_impl.Kernel.materialize)
    fill = lru_cache(maxsize=None)(textwrap.fill)
    kernel_impl.textwrap = SimpleNamespace(fill=fill, dedent=textwrap.dedent)
    kernel_impl._inside_class = _inside_class
    if all(hasattr(kernel_impl.Kernel, n) for n in ("ensure_compiled", "launch_kernel")):
        kernel_impl.Kernel.__call__ = _remembering(kernel_impl.Kernel.__call__)


def _inside_class(level_of_class_stackframe: int) -> bool:
    """Whether a kernel is defined in the body of a class, so many frames from here less one."""
    names = sys._getframe(level_of_class_stackframe - 1).f_locals
    return "__qualname__" in names and "__module__" in names


def _file_of(function: Any) -> str:
    """``inspect.getsourcefile`` of functions, which does not ask all modules whether it is theirs."""
    return str(function.__code__.co_filename)


def _source_of(otherwise: Callable[..., Any]) -> Callable[..., Any]:
    """``inspect.getsourcelines`` of functions, for which a file is parsed once and not once for each."""

    def found(function: Any) -> Any:
        code = function.__code__
        last = _ends(code.co_filename).get(code.co_firstlineno)
        if last is None:
            return otherwise(function)
        return linecache.getlines(code.co_filename)[code.co_firstlineno - 1 : last], code.co_firstlineno

    return found


@cache
def _ends(file: str) -> dict[int, int]:
    """The last line of each function of a file, by its first one, which may be a decorator."""
    try:
        tree = ast.parse("".join(linecache.getlines(file)))
    except SyntaxError:
        return {}
    out, blocks = {}, [tree.body]
    while blocks:
        for node in blocks.pop():
            if isinstance(node, ast.FunctionDef):
                first = min([node.lineno, *(d.lineno for d in node.decorator_list)])
                out[first] = node.end_lineno or node.lineno
            blocks += [getattr(node, name, []) for name in ("body", "orelse")]
    return out


class _Known(NamedTuple):
    """What is remembered of a kernel. program: for which; kinds: of its parameters, None where one of them
    cannot be passed quickly; compiled: the kernel and its code for each kind of arguments it was called
    with"""

    program: Any
    kinds: tuple[int, ...] | None
    compiled: dict[tuple[Any, ...], tuple[Any, Any]]


def _remembering(call: Callable[..., Any]) -> Callable[..., Any]:
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


def _undisturbed(build: Callable[..., Any]) -> Callable[..., Any]:
    """``build`` without a search for garbage in between: reading a kernel makes a great many small objects
    that all are needed until its end."""

    @wraps(build)
    def called(*arguments: Any, **named: Any) -> Any:
        collects = gc.isenabled()
        gc.disable()
        try:
            return build(*arguments, **named)
        finally:
            if collects:
                gc.enable()

    return called


def _place(context: Any, node: Any) -> str:
    """Where ``node`` stands, for an error message: file, line, function and the line itself."""
    line = node.lineno + context.lineno_offset
    said = context.src[node.lineno - 1].strip()
    return f'File "{context.file}", line {line}, in {context.func.func.__name__}:\n    {said}\n'
