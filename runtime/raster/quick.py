"""Taichi, started quicker.

Taichi reads the source of every kernel anew in each process, even where the compiled kernel is kept, and
spends most of that time on laying out source lines for error messages that nobody will see. Assumes Taichi
1.7; where what is replaced is not there, everything stays as it is. Guarantees the same kernels: only the
pictures of source lines in compile errors are plainer, and what Taichi finds wrong after a kernel was read it
tells without a place.
"""

from __future__ import annotations

import ast
import contextlib
import gc
import inspect
import linecache
import sys
import textwrap
from collections.abc import Callable, Iterator
from functools import cache, lru_cache, wraps
from types import SimpleNamespace
from typing import Any

import numpy as np

from .calling import remembering


@contextlib.contextmanager
def importing() -> Iterator[None]:
    """Import Taichi within this: of each of its own kernels it asks ``inspect`` in which line it is defined,
    which asks all modules whether it is theirs."""
    asked = inspect.getframeinfo
    inspect.getframeinfo = lambda frame, context=1: (
        _line_of(frame) if hasattr(frame, "f_code") else asked(frame, context)
    )
    try:
        yield
    finally:
        inspect.getframeinfo = asked


def _line_of(frame: Any) -> inspect.Traceback:
    """``inspect.getframeinfo`` with a context of one line."""
    code = frame.f_code
    line = linecache.getline(code.co_filename, frame.f_lineno)
    return inspect.Traceback(code.co_filename, frame.f_lineno, code.co_name, [line], 0)


def quicken() -> None:
    """Call once a process, before the first kernel is defined."""
    from taichi.lang import expr, impl, kernel_impl
    from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext, Builder

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
    if hasattr(kernel_impl, "transform_tree"):
        kernel_impl.ast = SimpleNamespace(**{**vars(ast), "parse": _parsed})
        kernel_impl.transform_tree = _minded(kernel_impl.transform_tree)
    if all(hasattr(kernel_impl.Kernel, n) for n in ("ensure_compiled", "launch_kernel")):
        kernel_impl.Kernel.__call__ = remembering(kernel_impl.Kernel.__call__)
    if hasattr(impl.PyTaichi, "get_current_src_info"):
        Builder.__call__ = _straight(Builder.__call__)
        impl.PyTaichi.get_current_src_info = _nowhere
    if all(hasattr(expr, n) for n in ("_check_in_range", "_clamp_unsigned_to_range", "to_numpy_type")):
        expr._check_in_range, expr._clamp_unsigned_to_range = _within, _wrapped
        expr.to_numpy_type = cache(expr.to_numpy_type)


_being_read: set[int] = set()  # trees, by their address


def _minded(read: Callable[..., Any]) -> Callable[..., Any]:
    """``transform_tree``, during which its tree is no one else's."""

    @wraps(read)
    def called(tree: ast.Module, context: Any) -> Any:
        _being_read.add(id(tree))
        try:
            return read(tree, context)
        finally:
            _being_read.discard(id(tree))

    return called


def _parsed(source: str) -> ast.Module:
    """``ast.parse`` of a function, once for all places that it is called from, but within itself.

    What Taichi notes in a tree as it reads it, it notes anew the next time, but for two things: what a kernel
    takes it takes out of its tree, and of what a method was called it notes where it was one.
    """
    tree, arguments, attributes = _tree(source)
    if id(tree) in _being_read:
        return ast.parse(source)
    for function, given in zip(tree.body, arguments, strict=True):
        if isinstance(function, ast.FunctionDef):
            function.args.args = list(given)
    for node in attributes:
        vars(node).pop("caller", None)
    return tree


@cache
def _tree(source: str) -> tuple[ast.Module, list[list[ast.arg]], list[ast.Attribute]]:
    """The tree of a source, what each function in it takes, and where anything has attributes."""
    tree = ast.parse(source)
    arguments = [list(f.args.args) if isinstance(f, ast.FunctionDef) else [] for f in tree.body]
    return tree, arguments, [node for node in ast.walk(tree) if isinstance(node, ast.Attribute)]


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


def _straight(build: Callable[..., Any]) -> Callable[..., Any]:
    """``Builder.__call__`` without noting where each node stands before it is read; that is found out once
    something is wrong with it."""
    ways: dict[tuple[type, type], Any] = {}

    def called(self: Any, context: Any, node: Any) -> Any:
        kind = (self.__class__, node.__class__)  # they are static methods
        if kind not in ways:
            ways[kind] = getattr(self, "build_" + node.__class__.__name__, None)
        way = ways[kind]
        if way is None:
            return build(self, context, node)
        try:
            return way(context, node)
        except Exception as error:
            return build(_Failing(error), context, node)

    return called


class _Failing:
    """Stands for a builder of nodes, all of which fail in one way."""

    def __init__(self, error: Exception) -> None:
        self._error = error

    def __getattr__(self, name: str) -> Callable[..., Any]:
        def fail(context: Any, node: Any) -> Any:
            raise self._error

        return fail


def _nowhere(runtime: Any) -> str:
    """Where what is being read stands: not known before something is wrong."""
    return runtime.src_info_stack[-1] if runtime.src_info_stack else ""


@cache
def _bounds(kind: Any) -> tuple[int, int, int]:
    """Least, greatest and bits of a kind of whole number."""
    info = np.iinfo(kind)
    return int(info.min), int(info.max), info.bits


def _within(kind: Any, value: int) -> bool:
    """Whether a whole number is one of a kind."""
    least, most, _ = _bounds(kind)
    return least <= value <= most


def _wrapped(kind: Any, value: int) -> int:
    """A whole number without a sign as the signed one of the same bits."""
    least, most, bits = _bounds(kind)
    if not least <= value <= most and not 0 <= value < 1 << bits:
        raise ValueError(f"{value} has more than {bits} bits")
    return value if least <= value <= most else value - (1 << bits)


def _place(context: Any, node: Any) -> str:
    """Where ``node`` stands, for an error message: file, line, function and the line itself."""
    line = node.lineno + context.lineno_offset
    said = context.src[node.lineno - 1].strip()
    return f'File "{context.file}", line {line}, in {context.func.func.__name__}:\n    {said}\n'
