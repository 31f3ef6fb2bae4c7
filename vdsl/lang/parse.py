"""Text into syntax tree: :func:`parse`.

Assumes nothing of the text. Guarantees that every mistake is in the report and nothing is raised; a
logical line with a mistake is left out of the tree and reading goes on at the next one.
"""

from __future__ import annotations

import re
from dataclasses import replace

from lark import Tree
from lark.exceptions import UnexpectedInput

import grammar

from . import ast
from .build import Builder, TooDeepError
from .diagnostics import Report
from .layout import Line, cut
from .source import Source, Span
from .syntax_errors import explain_syntax, unknown_statement

#: What follows the name where a line says where somebody is.
_PLACING = re.compile(
    r"[ \t]+(?:at|on|in|by|near|beside|next[ \t]+to|facing|holding"
    r"|sitting|standing|kneeling|crouching|lying)\b"
)
_FIRST_WORD = re.compile(r"[^\W\d][\w-]*")
_FIRST_WORDS = re.compile(r"([^\W\d][\w-]*)(?:[ \t]+\"?([^\W\d][\w-]*))?")
#: A definition whose body is another program's file.
_FROM_FILE = re.compile(r"[a-z]+[ \t]+[^({=]*=")
_HEADERS = ("fps", "size", "aspect", "seed", "rig", "style", "takes", "proposals", "aperture")
_TRANSITIONS = ("cut", "dissolve", "fade-out", "fade-in", "wipe")
_KINDS = ("set", "prop", "cast", "action")
#: The start rule for a line beginning with this word; anything else is a placement.
STATEMENTS: dict[str, str] = {
    "storyboard": "storyboard",
    "use": "use",
    "character": "character",
    "scene": "scene",
    **dict.fromkeys(_HEADERS, "header"),
    **dict.fromkeys(_TRANSITIONS, "transition"),
    **dict.fromkeys(_KINDS, "definition_head"),
}


def parse(source: Source, report: Report | None = None) -> tuple[ast.Script, Report]:
    """Read a whole script. Mistakes are in the report; what could be read is in the script."""
    report = Report() if report is None else report
    reader = _Reader(source, report)
    statements: list[ast.Statement] = []
    broken: list[ast.Broken] = []
    for line in cut(source, report):
        statement = reader.statement(line)
        if statement is None:
            broken.append(_broken(source, line))
        if isinstance(statement, ast.StoryNode) and not statement.beats:
            last = statements[-1] if statements else None
            if not line.gap and reader.attaches and isinstance(last, ast.StoryNode):
                statements[-1] = _with_cameras(last, statement)
                continue
        if statement is not None:
            statements.append(statement)
        reader.attaches = isinstance(statement, ast.StoryNode) and bool(statement.beats)
    return ast.Script(source, tuple(statements), Span(source, 0, len(source.text)), tuple(broken)), report


def _broken(source: Source, line: Line) -> ast.Broken:
    match = _FIRST_WORDS.match(source.text, line.start, line.end)
    keyword, name = match.groups() if match else ("", None)
    return ast.Broken(keyword, name, Span(source, line.start, line.end))


def parse_definition(
    source: Source, kind: str, name: str, report: Report, start: int = 0, end: int | None = None
) -> ast.Definition | None:
    """One definition of a file, leaving the rest unread; start, end: the offsets it stands between."""
    head = re.compile(rf"{kind}[ \t]+{re.escape(name)}(?![\w.-])")
    reader = _Reader(source, report)
    for line in cut(source, report, start, end):
        if head.match(source.text, line.start):
            statement = reader.statement(line)
            return statement if isinstance(statement, ast.Definition) else None
    return None


def _with_cameras(story: ast.StoryNode, cameras: ast.StoryNode) -> ast.StoryNode:
    """The story line with further camera lines that stand directly below it."""
    span = story.span.to(cameras.span)
    return ast.StoryNode(story.beats, story.options, story.cameras + cameras.cameras, span)


class _Reader:
    def __init__(self, source: Source, report: Report) -> None:
        self.source = source
        self.report = report
        self.parser = grammar.parser()
        #: whether a camera line that comes next belongs to the statement before it
        self.attaches = False

    def statement(self, line: Line) -> ast.Statement | None:
        if line.broken:
            return None
        start = self._start(line)
        if start is None:
            return None
        if start.startswith("definition"):
            return self._definition(line, start)
        if line.body is not None:
            self.report.error(
                "VDS011",
                Span(self.source, line.start, line.end),
                label="a line of the story has no braces",
                help="braces belong to set, prop, cast and action",
            )
            return None
        return self._tree(line, start)

    def _start(self, line: Line) -> str | None:
        """The kind of line, by how it begins."""
        first = self.source.text[line.start]
        if first == "(":
            return "story"
        if first == "/":
            return "cameras"
        text = self.source.text[line.start : line.end]
        word = _FIRST_WORD.match(text)
        kind = STATEMENTS.get(word.group()) if word else None
        if kind == "definition_head" and _FROM_FILE.match(text):
            return "definition_file"
        if kind is not None:
            return kind
        if word and _PLACING.match(text, word.end()):
            return "placement"
        unknown_statement(
            Span(self.source, line.start, line.end), word.group() if word else None, self.report
        )
        return None

    def _tree(self, line: Line, start: str) -> ast.Statement | None:
        tree = self._parse(line, start)
        if tree is None:
            return None
        builder = Builder(self.source, line.start, self.report)
        method = "story" if start == "cameras" else start
        try:
            node: ast.Statement = getattr(builder, method)(tree)
        except TooDeepError:
            self._too_deep(line)
            return None
        return None if builder.failed else node

    def _parse(self, line: Line, start: str) -> Tree | None:
        text = self.source.text[line.start : line.end]
        try:
            return self.parser.parse(text, start=start)
        except UnexpectedInput as error:
            explain_syntax(error, start, Span(self.source, line.start, line.end), self.report)
            return None

    def _too_deep(self, line: Line) -> None:
        span = Span(self.source, line.start, line.end)
        self.report.error("VDS006", span, label="these values are nested too deeply")

    # -- definitions -----------------------------------------------------------------

    def _definition(self, line: Line, start: str) -> ast.Definition | ast.FileDefinition | None:
        tree = self._parse(line, start)
        if tree is None:
            self._entries(line)  # for the mistakes inside
            return None
        builder = Builder(self.source, line.start, self.report)
        try:
            if start == "definition_file":
                made = builder.definition_file(tree)
                return replace(made, body=self._entries(line))
            kind, name, parameters = builder.definition_head(tree)
        except TooDeepError:
            self._too_deep(line)
            return None
        if line.body is None:
            self.report.error(
                "VDS012",
                Span(self.source, line.start, line.end),
                label=f"this {kind} has no body",
                help=f"as in `{kind} {name.text} {{ … }}`, the brace on the same line",
            )
            return None
        end = max(line.end, *(self._last(child) for child in line.body)) if line.body else line.end
        return ast.Definition(kind, name, parameters, self._entries(line), Span(self.source, line.start, end))

    def _last(self, line: Line) -> int:
        return max([line.end, *(self._last(child) for child in line.body or ())])

    def _entries(self, line: Line) -> tuple[ast.Entry, ...]:
        entries = (self._entry(child) for child in line.body or ())
        return tuple(entry for entry in entries if entry is not None)

    def _entry(self, line: Line) -> ast.Entry | None:
        body = self._entries(line) if line.body is not None else None
        if line.broken:
            return None
        tree = self._parse(line, "entry")
        if tree is None:
            return None
        builder = Builder(self.source, line.start, self.report)
        try:
            entry = builder.entry(tree)
        except TooDeepError:
            self._too_deep(line)
            return None
        if builder.failed:
            return None
        return ast.Entry(entry.head, entry.values, entry.bound, entry.options, body, entry.span)
