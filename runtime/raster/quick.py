"""Taichi, started quicker.

Taichi reads the source of every kernel anew in each process, even where the compiled kernel is kept, and
spends most of that time on laying out source lines for error messages that nobody will see. Assumes Taichi
1.7; where what is replaced is not there, everything stays as it is. Guarantees the same kernels: only the
pictures of source lines in compile errors are plainer.
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
from typing import Any

from .calling import remembering


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
        kernel_impl.Kernel.__call__ = remembering(kernel_impl.Kernel.__call__)


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
