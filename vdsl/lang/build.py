"""Parse trees into the syntax tree (:mod:`vdsl.lang.ast`), with spans in the whole source.

Assumes trees of ``grammar/vds.lark`` whose positions count from the start of a logical line, and
guarantees nodes without any of the grammar's own shapes. Units are checked here, names are not.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from lark import Token, Tree

from . import ast
from .diagnostics import Report, listing, nearest
from .source import Source, Span

UNITS = ("m", "cm", "mm", "deg", "s", "f", "%")
_SPOKEN_UNITS = {
    "metre": "m", "metres": "m", "meter": "m", "meters": "m", "degrees": "deg", "degree": "deg", "sec": "s",
    "secs": "s", "seconds": "s", "second": "s", "frames": "f", "frame": "f", "percent": "%",
    "centimetres": "cm", "millimetres": "mm", "milimeter": "mm",
}  # fmt: skip

#: Values nested deeper than this are refused.
DEEPEST_VALUE = 120

Node = Any  # Tree | Token: lark's trees are untyped inside


def _at_once(before: ast.Name | ast.Star | ast.Choice, word: ast.Name | ast.Star) -> ast.Name | ast.Choice:
    """Two words joined by ``+`` as one; of a choice, the last one is joined."""
    if isinstance(before, ast.Choice):
        last = before.items[-1]
        joined = _at_once(last, word) if isinstance(last, (ast.Name, ast.Star)) else last
        return ast.Choice((*before.items[:-1], joined), before.span.to(word.span))
    span = before.span.to(word.span)
    return ast.Name((span.text,), span)


class TooDeepError(Exception):
    """A value nested beyond reason; turned into a diagnostic by the parser."""


class Builder:
    """Builds nodes of one logical line; ``offset`` is where that line begins in the source."""

    def __init__(self, source: Source, offset: int, report: Report) -> None:
        self.source = source
        self.offset = offset
        self.report = report
        #: what was read cannot be used; it is reported
        self.failed = False

    # -- places ----------------------------------------------------------------------

    def span(self, node: Node) -> Span:
        if isinstance(node, Token):
            start, end = node.start_pos, node.end_pos
        else:
            start, end = getattr(node.meta, "start_pos", 0), getattr(node.meta, "end_pos", 0)
        return Span(self.source, self.offset + (start or 0), self.offset + (end or 0))

    def name(self, token: Token) -> ast.Name:
        text = str(token)
        return ast.Name(tuple(text.split(".")) if "." in text else (text,), self.span(token))

    def text(self, token: Token) -> ast.Text:
        raw = str(token)[1:-1]
        if "\\" in raw:
            raw = raw.replace("\\\\", "\0").replace('\\"', '"').replace("\\n", "\n").replace("\0", "\\")
        return ast.Text(raw, self.span(token))

    def number(self, token: Token) -> ast.Number:
        raw = str(token)
        cut = len(raw)
        while not (raw[cut - 1].isdigit() or raw[cut - 1] == "."):
            cut -= 1
        unit: str | None = raw[cut:] or None
        if unit is not None and unit not in UNITS:
            unit = self._odd_unit(token, unit, cut)
        return ast.Number(float(raw[:cut]), unit, self.span(token))

    def _negative(self, node: Tree[Token]) -> ast.Number:
        number = self.number(_token(node.children[-1]))
        return ast.Number(-number.value, number.unit, self.span(node))

    def _odd_unit(self, token: Token, unit: str, cut: int) -> str | None:
        low = unit.casefold()
        meant = low if low in UNITS else _SPOKEN_UNITS.get(low)
        span = self.span(token)
        self.failed = self.failed or meant is None
        self.report.error(
            "VDS008",
            Span(self.source, span.start + cut, span.end),
            label=f"`{_short(unit)}` is no unit",
            help=f"units are {listing(UNITS, last='and')}",
            suggestion=meant,
            fix=meant,
        )
        return meant

    # -- values ----------------------------------------------------------------------

    def value(self, node: Node, depth: int = 0) -> ast.Value:
        if depth > DEEPEST_VALUE:
            raise TooDeepError
        return _VALUES[node.data](self, node, depth + 1)

    def values(self, node: Tree[Token], depth: int = 0) -> tuple[ast.Value, ...]:
        return tuple(self.value(child, depth) for child in node.children)

    def _binary(self, node: Tree[Token], depth: int) -> ast.Binary:
        left, right = node.children[0], node.children[-1]
        op = _OPS[str(node.data)]
        return ast.Binary(op, self.value(left, depth), self.value(right, depth), self.span(node))

    def _range(self, node: Tree[Token], depth: int) -> ast.Range:
        low, high = (self.number(_token(child)) for child in node.children)
        return ast.Range(low, high, self.span(node))

    def _group(self, node: Tree[Token], depth: int) -> ast.Group:
        children = list(node.children)
        unit = str(children.pop())[1:] if isinstance(children[-1], Token) else None
        return ast.Group(tuple(self.value(child, depth) for child in children), unit, self.span(node))

    def call(self, node: Tree[Token], depth: int = 0) -> ast.Call:
        head = _token(node.children[0])
        text = str(head)[:-1]
        at = self.offset + (head.start_pos or 0)
        callee = ast.Name(tuple(text.split(".")), Span(self.source, at, at + len(text)))
        arguments = tuple(self._argument(child, depth) for child in node.children[1:])
        return ast.Call(callee, arguments, self.span(node))

    def _argument(self, node: Node, depth: int) -> ast.Argument:
        return ast.Argument(
            self.name(node.children[0]), self.values(node.children[1], depth), self.span(node)
        )

    # -- definitions -----------------------------------------------------------------

    def entry(self, node: Tree[Token]) -> ast.Entry:
        head, values, *rest = node.children
        bound: tuple[ast.Value, ...] = ()
        options = []
        for child in rest:
            assert isinstance(child, Tree)
            if child.data == "bound":
                bound = self.values(child)
            else:
                options.append(self._entry_option(child))
        return ast.Entry(
            self.name(_token(head)), self.values(_tree(values)), bound, tuple(options), None, self.span(node)
        )

    def _entry_option(self, node: Tree[Token]) -> ast.Option:
        name, values = _token(node.children[0]), _tree(node.children[1])
        return ast.Option(self.name(name), self.values(values), self.span(node))

    def definition_head(self, node: Tree[Token]) -> tuple[str, ast.Name, tuple[ast.Parameter, ...]]:
        kind, target = node.children
        if isinstance(target, Token):
            return str(kind), self.name(target), ()
        call = self.call(target)
        parameters = tuple(ast.Parameter(a.name, a.values, a.span) for a in call.arguments)
        return str(kind), call.callee, parameters

    def definition_file(self, node: Tree[Token]) -> ast.FileDefinition:
        kind, name, path = (_token(child) for child in node.children[:3])
        options = tuple(self._entry_option(_tree(child)) for child in node.children[3:])
        return ast.FileDefinition(str(kind), self.name(name), self.text(path), options, (), self.span(node))

    # -- the story -------------------------------------------------------------------

    def storyboard(self, node: Tree[Token]) -> ast.Title:
        text = self.text(_token(node.children[0])) if node.children else None
        return ast.Title(text, self.span(node))

    def header(self, node: Tree[Token]) -> ast.Header:
        keyword, value = node.children
        return ast.Header(self.name(_token(keyword)), self._header_values(value), self.span(node))

    def _header_values(self, value: Node) -> tuple[ast.Value, ...]:
        if isinstance(value, Tree):  # a ratio
            return tuple(self.number(_token(child)) for child in value.children)
        if value.type == "NUMBER":
            return (self.number(value),)
        if value.type == "PATH":
            return (self.name(value),)
        width, height = str(value).replace("×", "x").split("x")
        span = self.span(value)
        return ast.Number(float(width), None, span), ast.Number(float(height), None, span)

    def use(self, node: Tree[Token]) -> ast.Use:
        return ast.Use(self.text(_token(node.children[0])), self.span(node))

    def character(self, node: Tree[Token]) -> ast.CharacterLine:
        name, cast = node.children
        made: ast.Name | ast.Call | ast.Text
        if isinstance(cast, Tree):
            made = self.call(cast)
        else:
            made = self.text(cast) if cast.type == "TEXT" else self.name(cast)
        return ast.CharacterLine(self.name(_token(name)), made, self.span(node))

    def scene(self, node: Tree[Token]) -> ast.SceneLine:
        name, *parts = node.children
        found = {str(_tree(part).data): self.name(_token(_tree(part).children[0])) for part in parts}
        return ast.SceneLine(
            self.name(_token(name)), found.get("scene_set"), found.get("scene_time"), self.span(node)
        )

    def placement(self, node: Tree[Token]) -> ast.PlacementLine:
        name, *parts = node.children
        found: dict[str, ast.Name] = {}
        held: ast.Name | ast.Call | None = None
        beside = False
        for part in parts:
            assert isinstance(part, Tree)
            first, last = part.children[0], part.children[-1]
            beside = beside or (isinstance(first, Token) and first.type == "NEXT_TO")
            word = self.call(last) if isinstance(last, Tree) else self.name(_token(last))
            if part.data in found or (part.data == "place_holding" and held is not None):
                self.report.error(
                    "VDS009", self.span(part), label=f"said twice on this line: `{word.span.text}`"
                )
            if part.data == "place_holding":
                held = word
            elif isinstance(word, ast.Name):
                found[str(part.data)] = word
        return ast.PlacementLine(
            self.name(_token(name)),
            found.get("place_at"),
            found.get("place_facing"),
            found.get("place_posture"),
            held,
            self.span(node),
            beside,
        )

    def transition(self, node: Tree[Token]) -> ast.TransitionLine:
        kind, *duration = (_token(child) for child in node.children)
        return ast.TransitionLine(
            self.name(kind), self.number(duration[0]) if duration else None, self.span(node)
        )

    def story(self, node: Tree[Token]) -> ast.StoryNode:
        beats: list[ast.BeatNode] = []
        options: tuple[ast.Option, ...] = ()
        cameras: list[ast.CameraNode] = []
        for child in node.children:
            assert isinstance(child, Tree)
            if child.data == "beat":
                beats.append(self._beat(child))
            elif child.data == "options":
                options = self._options(child)
            else:
                cameras.append(self._camera(child))
        return ast.StoryNode(tuple(beats), options, tuple(cameras), self.span(node))

    def _beat(self, node: Tree[Token]) -> ast.BeatNode:
        """The words of a beat, with a full stop or a comma for any mark."""
        words: list[ast.Name] = []
        spoken: list[ast.Text] = []
        tokens = [_token(child) for child in node.children]
        for k, token in enumerate(tokens):
            if token.type == "TEXT":
                spoken.append(self.text(token))
                if _ends_sentence(tokens[k:]):
                    words.append(ast.Name((".",), self.span(token)))
            elif token.type == "MARK":
                ends = any(mark in token for mark in ".!?;:")
                words.append(ast.Name(("." if ends else ",",), self.span(token)))
            else:
                words.append(self.name(token))
        return ast.BeatNode(tuple(words), self.span(node), spoken=tuple(spoken))

    def _camera(self, node: Tree[Token]) -> ast.CameraNode:
        parts: list[Token] = [child for child in node.children if isinstance(child, Token)]
        trees = [child for child in node.children if isinstance(child, Tree)]
        options = self._options(trees[0]) if trees else ()
        words = None if node.data == "camera_bare" else self._camera_words(parts)
        return ast.CameraNode(words, options, self.span(node))

    def _camera_words(self, tokens: Sequence[Token]) -> tuple[ast.Name | ast.Star | ast.Choice, ...]:
        """Words in the order written, those joined by ``|`` as one choice."""
        words: list[ast.Name | ast.Star | ast.Choice] = []
        joined = False
        for i, token in enumerate(tokens):
            if token.type == "BAR":
                if joined or not words or i + 1 == len(tokens):
                    self.report.error(
                        "VDS010",
                        self.span(token),
                        label="`|` stands between two words",
                        help="as in push|static",
                    )
                joined = True
                continue
            if token.type == "PLUS":
                self._lone_plus(tokens, i)
                continue
            word = ast.Star(self.span(token)) if token.type == "STAR" else self.name(token)
            if i and tokens[i - 1].type == "PLUS" and words:
                words.append(_at_once(words.pop(), word))
                continue
            if joined and words:
                last = words.pop()
                items = last.items if isinstance(last, ast.Choice) else (last,)
                words.append(ast.Choice((*items, word), last.span.to(word.span)))
            else:
                words.append(word)
            joined = False
        return tuple(words)

    def _lone_plus(self, tokens: Sequence[Token], i: int) -> None:
        """Report a ``+`` that does not stand between two words."""
        if not 0 < i < len(tokens) - 1 or {tokens[i - 1].type, tokens[i + 1].type} & {"BAR", "PLUS", "STAR"}:
            self.report.error(
                "VDS010",
                self.span(tokens[i]),
                label="`+` stands between two movements",
                help="as in push+pan-left",
            )

    def _options(self, node: Tree[Token]) -> tuple[ast.Option, ...]:
        return tuple(self._option(_tree(child)) for child in node.children)

    def _option(self, node: Tree[Token]) -> ast.Option:
        first = _token(node.children[0])
        if node.data == "option_number":
            number = self.number(first)
            return ast.Option(ast.Name(("duration",), number.span), (number,), number.span)
        values = tuple(self._choice(_tree(child)) for child in node.children[1:])
        return ast.Option(self.name(first), values, self.span(node))

    def _choice(self, node: Tree[Token]) -> ast.Value:
        if node.data != "choice":
            return self.value(node)
        items = tuple(self.value(child) for child in node.children if isinstance(child, Tree))
        return ast.Choice(items, self.span(node))


def _token(node: Node) -> Token:
    assert isinstance(node, Token)
    return node


def _tree(node: Node) -> Tree[Token]:
    assert isinstance(node, Tree)
    return node


def _short(text: str) -> str:
    return text if len(text) <= 24 else text[:24] + "…"


_OPS = {"add": "+", "subtract": "-", "multiply": "*", "divide": "/"}
_VALUES: dict[str, Callable[[Builder, Any, int], ast.Value]] = {
    "number": lambda b, n, d: b.number(n.children[0]),
    "negative": lambda b, n, d: b._negative(n),
    "text": lambda b, n, d: b.text(n.children[0]),
    "name": lambda b, n, d: b.name(n.children[0]),
    "star": lambda b, n, d: ast.Star(b.span(n)),
    "range": Builder._range,
    "group": Builder._group,
    "call": Builder.call,
    "add": Builder._binary,
    "subtract": Builder._binary,
    "multiply": Builder._binary,
    "divide": Builder._binary,
    "negate": lambda b, n, d: ast.Negate(b.value(n.children[-1], d), b.span(n)),
}

__all__ = ["DEEPEST_VALUE", "UNITS", "Builder", "TooDeepError", "nearest"]


def _ends_sentence(tokens: list[Token]) -> bool:
    """Whether a text that ends a sentence is followed by another: a name in capitals, or one and a colon."""
    after = [token for token in tokens[1:] if token.type not in ("COMMA", "MARK")]
    if not after or str(tokens[0]).rstrip('"')[-1:] not in (".", "!", "?", "…"):
        return False
    at = tokens.index(after[0], 1)
    speaks = len(tokens) > at + 1 and ":" in tokens[at + 1]
    return str(after[0]).istitle() or speaks
