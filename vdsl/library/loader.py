"""Finds definitions by name: the script's own first, then those of files it uses, then the library's.

The library's files are only looked through for the heads of definitions; a definition is parsed when
somebody asks for it. Mistakes in a definition go to the report the catalog was made with, at their
place in the file they are in. Importing this module reads nothing.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterable, Iterator
from importlib import import_module
from pathlib import Path

from ..lang import ast
from ..lang.definitions.files import FileDef, character_cast, read_file
from ..lang.definitions.types import DefinitionBase
from ..lang.diagnostics import Report
from ..lang.files import used_scripts
from ..lang.kept import parsed
from ..lang.parse import parse_definition
from ..lang.source import Source

KINDS = ("set", "prop", "cast", "action")
LIBRARY = Path(__file__).parent
FOLDERS = {"set": "sets", "prop": "props", "cast": "cast", "action": "actions"}

#: What models in several files consist of besides.
BESIDE = frozenset({".bin", ".mtl", ".png", ".jpg", ".jpeg", ".webp"})
_NAME = re.compile(r"[^\W\d][\w-]*")
_ALSO = re.compile(r"(?:^|[{;])[ \t]*also[ \t]+([^\n#;}]*)", re.MULTILINE)
_HEAD = re.compile(r"^[ \t\ufeff]*(set|prop|cast|action)[ \t]+([^\W\d][\w-]*)", re.MULTILINE)


class Catalog:
    """Definitions of every kind, by name."""

    def __init__(self, report: Report | None = None, library: Path = LIBRARY) -> None:
        self.report = Report() if report is None else report
        self._library = library
        self._own: dict[tuple[str, str], ast.Definition | ast.FileDefinition] = {}
        self._folder = Path()
        self._index: dict[str, dict[str, tuple[Source, int, int]]] = {}
        self._digests: dict[str, str] = {}
        self._unread: set[tuple[str, str]] = set()
        self._read: dict[tuple[str, str], DefinitionBase | None] = {}

    @classmethod
    def for_script(cls, script: ast.Script, report: Report, also: ast.Script | None = None) -> Catalog:
        """The catalog a script sees. Its own definitions are all read, so that all their mistakes show.

        also: another script whose definitions it sees, but not its characters and scenes
        """
        catalog = cls(report)
        catalog._folder = Path((also or script).source.name).parent
        others = (also, *used_scripts(also, report)) if also is not None else ()
        for each in (script, *used_scripts(script, report), *others):
            catalog._add(each)
        for kind, name in catalog._own:
            catalog._check_own(kind, catalog.get(kind, name))
        return catalog

    def _check_own(self, kind: str, definition: DefinitionBase | None) -> None:
        """What of a definition can only be checked with the others at hand: the props it names."""
        if kind == "set" and definition is not None:
            import_module("vdsl.lang.definitions.set").check_set(definition, self, self.report)
        if kind == "action" and (at := getattr(definition, "brings_at", None)) is not None:
            import_module("vdsl.lang.bringing").check_brings(definition, at, self, self.report)
        if kind == "action" and definition is not None:
            import_module("vdsl.lang.bringing").check_others(definition, self, self.report)

    def names(self, kind: str) -> tuple[str, ...]:
        """All names of a kind: own ones first, then the library's, each in order of the alphabet."""
        own = sorted({name for k, name in (*self._own, *self._unread) if k == kind and "/" not in name})
        return (*own, *(name for name in sorted(self._scan(kind)) if name not in own))

    def get(self, kind: str, name: str) -> DefinitionBase | None:
        """The definition, read; None where there is none or it could not be read (then it is reported)."""
        key = (kind, name)
        if key not in self._read:
            self._read[key] = None  # a definition that needs itself finds nothing
            definition = self._definition(kind, name)
            if definition is not None:
                self._read[key] = self._reading(definition)
        return self._read[key]

    def synonyms(self, kind: str) -> dict[str, str]:
        """Other words for definitions of a kind, as their ``also`` says them, and the names they stand for; a
        word that is a name itself stands for nothing else. Nothing is parsed for it."""
        names = self.names(kind)
        found: dict[str, str] = {}
        for name in names:
            if (kind, name) in self._own:
                text = self._own[kind, name].span.text
            elif name in (listed := self._scan(kind)):
                source, start, end = listed[name]
                text = source.text[start:end]
            else:
                continue
            for said in _ALSO.finditer(text):
                for word in _NAME.findall(said.group(1)):
                    if word not in names:
                        found.setdefault(word, name)
        return found

    def source_of(self, kind: str, name: str) -> Source | None:
        """The source a definition comes from."""
        if (kind, name) in self._own:
            return self._own[kind, name].span.source
        found = self._scan(kind).get(name)
        return found[0] if found is not None else None

    def written(self, kind: str, names: Iterable[str]) -> tuple[str, ...] | None:
        """What decides about definitions, found without parsing any: the text of each that is the script's
        own, and a digest of all the library's files of that kind. None where one is out of another
        program's file.
        """
        own = [self._own[kind, name] for name in names if (kind, name) in self._own]
        if any(isinstance(one, ast.FileDefinition) for one in own):
            return None
        return (*(one.span.text for one in own), self._digest(kind))

    def reached(self, names: Iterable[str]) -> tuple[str, ...]:
        """What decides about definitions that names lead to, as far as it is the script's own: the texts of
        those definitions, and digests of other programs' files. A definition leads to what its text names.
        """
        if not self._own:
            return ()
        found: dict[tuple[str, str], str] = {}
        todo, seen = list(names), set[str]()
        while todo:
            name = todo.pop()
            if name in seen:
                continue
            seen.add(name)
            for kind in KINDS:
                own = self._own.get((kind, name))
                if own is not None:
                    found[kind, name] = f"{kind} {name}\0{own.span.text}"
                    if isinstance(own, ast.FileDefinition):
                        folder = Path(own.span.source.name).parent
                        found[kind, name] += "\0" + _file_digest(folder / own.path.value)
                    todo += _NAME.findall(own.span.text)
                elif name in (listed := self._scan(kind)):
                    source, start, end = listed[name]
                    todo += _NAME.findall(source.text, start, end)
        return tuple(found[key] for key in sorted(found))

    def _digest(self, kind: str) -> str:
        """Of the library's files of a kind."""
        if kind not in self._digests:
            sources = {s.name: s.text for s, _, _ in self._scan(kind).values()}
            told = "\0".join(part for name in sorted(sources) for part in (Path(name).name, sources[name]))
            self._digests[kind] = hashlib.sha256(told.encode()).hexdigest()
        return self._digests[kind]

    def paths(self) -> tuple[Path, ...]:
        """The files that the script's definitions are in, or are made of."""
        found = {Path(one.span.source.name): None for one in self._own.values()}
        for one in self._own.values():
            if isinstance(one, ast.FileDefinition):
                found[Path(one.span.source.name).parent / one.path.value] = None
        return tuple(found)

    def files(self) -> Iterator[FileDef]:
        """The script's definitions out of other programs' files."""
        for kind, name in self._own:
            definition = self.get(kind, name)
            if isinstance(definition, FileDef):
                yield definition

    # -- finding ---------------------------------------------------------------------

    def _add(self, script: ast.Script) -> None:
        """Take the definitions of a script; a name that is taken already in the same file is an error."""
        self._unread.update((b.keyword, b.name) for b in script.broken if b.keyword in KINDS and b.name)
        for statement in script.statements:
            if isinstance(statement, ast.CharacterLine) and isinstance(statement.cast, ast.Text):
                statement = character_cast(statement.cast)
                if ("cast", statement.name.text) in self._own:
                    continue
            if not isinstance(statement, ast.Definition | ast.FileDefinition):
                continue
            key = (statement.kind, statement.name.text)
            first = self._own.get(key)
            if first is None:
                self._own[key] = statement
            elif first.span.source is statement.span.source:
                self.report.error(
                    "VDS018",
                    statement.name.span,
                    label=f"the {key[0]} `{key[1]}` is defined twice",
                    notes=[(first.name.span, "first here")],
                )

    def _scan(self, kind: str) -> dict[str, tuple[Source, int, int]]:
        """Names of a kind in the library, with the file each is in and where in it."""
        if kind not in self._index:
            found: dict[str, tuple[Source, int, int]] = {}
            for path in sorted((self._library / FOLDERS[kind]).glob("*.vds")):
                source = Source(str(path), path.read_text(encoding="utf-8"))
                heads = list(_HEAD.finditer(source.text))
                ends = [*(head.start() for head in heads[1:]), len(source.text)]
                for head, end in zip(heads, ends, strict=True):
                    if head.group(1) == kind:
                        found.setdefault(head.group(2), (source, head.start(), end))
            self._index[kind] = found
        return self._index[kind]

    def _reading(self, definition: ast.Definition | ast.FileDefinition) -> DefinitionBase | None:
        if isinstance(definition, ast.FileDefinition):
            return read_file(definition, self._folder, self.report)
        return _reader(definition.kind)(definition, self.report)

    def _definition(self, kind: str, name: str) -> ast.Definition | ast.FileDefinition | None:
        if (kind, name) in self._own:
            return self._own[kind, name]
        if (kind, name) in self._unread:  # it is there, and reported
            return None
        found = self._scan(kind).get(name)
        if found is None:
            return None
        source, start, end = found
        key = (source, start, end, kind, name)
        if key not in _parsed:
            definition, found_wrong = parsed(source, kind, name, start, end)
            if definition is None or found_wrong.diagnostics:  # to be reported every time
                return parse_definition(source, kind, name, self.report, start, end)
            if len(_parsed) >= _PARSED:
                _parsed.clear()
            _parsed[key] = definition
        return _parsed[key]


#: Definitions of library files by what they were read from: source, offsets, kind and name. Who watches a
#: script compiles it again and again, and they seldom change.
_parsed: dict[tuple[Source, int, int, str, str], ast.Definition] = {}
_PARSED = 1024


def _file_digest(path: Path) -> str:
    """Of a file and, as it may draw on them, the sizes and times of those beside and below it."""
    told = hashlib.sha256()
    try:
        told.update(path.read_bytes())
        if path.suffix.lower() in (".gltf", ".obj"):
            for other in sorted(p for p in path.parent.rglob("*") if p.suffix.lower() in BESIDE):
                about = other.stat()
                told.update(f"\0{other.name} {about.st_size} {about.st_mtime_ns}".encode("utf-8", "replace"))
    except OSError as error:
        told.update(str(error.errno).encode())
    return told.hexdigest()


def _reader(kind: str) -> Callable[[ast.Definition, Report], DefinitionBase | None]:
    """``read_set`` and its fellows, imported when first needed."""
    reader: Callable[[ast.Definition, Report], DefinitionBase | None] = getattr(
        import_module(f"vdsl.lang.definitions.{kind}"), f"read_{kind}"
    )
    return reader
