"""Taichi, started quicker.

Taichi reads the source of every kernel anew in each process, even where the compiled kernel is kept, and
spends most of that time on laying out source lines for error messages that nobody will see. Assumes Taichi
1.7; where its insides are named otherwise, everything stays as it is. Guarantees the same kernels: only the
pictures of source lines in compile errors are plainer.
"""

from __future__ import annotations

import gc
import textwrap
from collections.abc import Callable
from functools import lru_cache, wraps
from types import SimpleNamespace
from typing import Any


def quicken() -> None:
    """Call once a process, before the first kernel is compiled."""
    from taichi.lang import kernel_impl
    from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext

    needed = ("getsourcelines", "getsourcefile", "textwrap")
    if not hasattr(ASTTransformerContext, "get_pos_info") or not all(hasattr(kernel_impl, n) for n in needed):
        return
    ASTTransformerContext.get_pos_info = _place
    # functions are inlined, and so read, at every place they are called from
    kernel_impl.getsourcelines = lru_cache(maxsize=None)(kernel_impl.getsourcelines)
    kernel_impl.getsourcefile = lru_cache(maxsize=None)(kernel_impl.getsourcefile)
    kernel_impl.Kernel.materialize = _undisturbed(kernel_impl.Kernel.materialize)
    fill = lru_cache(maxsize=None)(textwrap.fill)
    kernel_impl.textwrap = SimpleNamespace(fill=fill, dedent=textwrap.dedent)


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
