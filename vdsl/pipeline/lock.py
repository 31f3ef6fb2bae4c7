"""``FILE.lock``: the takes that were chosen, as a small sorted text beside the script, made for git.

    # The takes chosen for coffee.vds. `vdsc pick` and `vdsc serve` write this file; keep it in git.
    vds.lock/1
    seed 0
    vdsl 0.1.0
    look 1
    take kitchen-anna-pour-cup 17-3f9a2c1b of 80 line 9c41d2e07a55 "push medium high-angle"

A choice names its take by what was proposed (:func:`vdsl.pipeline.chosen.proposal_key`), not by its rank, and
carries a digest of what its line depends on. Assumes nothing of the file: what cannot be read is an error at
its line, and is never written over. Guarantees that a reader finds the whole old file or the whole new one.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..emit.folder import write_text
from ..lang import Report, Source, Span
from ..lang.diagnostics import listing, nearest
from .placing import placed
from .script import ScriptError
from .turns import one_at_a_time

SCHEMA = "vds.lock/1"
LARGEST = 4 * 1024 * 1024
_TAKE = re.compile(
    r"take (?P<shot>\S+) (?P<key>\d+-[0-9a-f]{8}) of (?P<proposals>\d{1,6})(?: seed (?P<seed>\d{1,19}))?"
    r' line (?P<depends>[0-9a-f]{12}) "(?P<words>[^"]*)"'
)
_HEAD = re.compile(r"(?P<name>vdsl|look) (?P<value>\S+)")
_SEED = re.compile(r"seed (\d{1,19})")


class ChoiceError(Exception):
    """What was asked to be chosen cannot be; the message says why, and what can."""


@dataclass(frozen=True)
class Choice:
    """A shot's chosen take.

    shot: its id; key: the proposal's; words: its movement, size and angle
    proposals, seed: with which it was proposed; depends: digest of what its line depends on
    comments: lines of comment above it, as written
    """

    shot: str
    key: str
    words: str
    proposals: int
    seed: int
    depends: str
    comments: tuple[str, ...] = ()


@dataclass(frozen=True)
class Lock:
    """The choices of a script, by shot id, and what they were made with.

    seed: of the storyboard wherever nothing else says one, None in an empty lock; versions: (name, version)
    source: the text it was read from, None for a new one; comments: lines of comment below the last choice
    """

    seed: int | None = None
    versions: tuple[tuple[str, str], ...] = ()
    choices: tuple[Choice, ...] = ()
    source: Source | None = None
    comments: tuple[str, ...] = ()

    def choice(self, shot: str) -> Choice | None:
        return next((c for c in self.choices if c.shot == shot), None)

    def span(self, shot: str) -> Span:
        """Where the file chooses for a shot."""
        source = self.source or Source("", "")
        found = re.search(rf"^take {re.escape(shot)} .*$", source.text, re.MULTILINE)
        return Span(source, found.start(), found.end()) if found else Span(source, 0, 0)


def lock_path(script: str | Path) -> Path:
    """Where the choices of a script are kept: ``coffee.vds.lock`` beside ``coffee.vds``."""
    script = Path(script)
    return script.with_name(script.name + ".lock")


def bad_path(script: str | Path) -> Path:
    """Where a lock that does not read is put aside: ``coffee.vds.lock.bad``, or the next that is free."""
    path = lock_path(script)
    names = (f"{path.name}.bad{n}" for n in ("", *(f"-{k}" for k in range(2, 10_000))))
    return next(place for place in (path.with_name(name) for name in names) if not place.exists())


def read_lock(path: Path) -> Lock:
    """The choices in a file; none where there is no such file.

    Raises :class:`ScriptError` with every line that cannot be read, or OSError.
    """
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST + 1)
    except FileNotFoundError:
        return Lock()
    report = Report()
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        text = ""
    if not text.strip() or len(data) > LARGEST:
        _wrong(report, Span(Source(str(path), ""), 0, 0), "this is no lock file")
    lock = _Reading(Source(str(path), text), report).lock()
    if report.has_errors:
        raise ScriptError(report)
    return lock


def _wrong(report: Report, span: Span, label: str, help: str | None = None) -> None:
    report.error(
        "VDS310",
        span,
        label=label,
        help=help or "mend or remove the line; `vdsc pick FILE --clear` starts the file anew",
    )


class _Reading:
    """A lock's lines, one after the other."""

    def __init__(self, source: Source, report: Report) -> None:
        self.source, self.report = source, report
        self.seed: int | None = None
        self.versions: dict[str, str] = {}
        self.choices: dict[str, Choice] = {}
        self.comments: list[str] = []
        self.schema = False

    def lock(self) -> Lock:
        for number, start in enumerate(self.source.line_starts):
            line = self.source.line(number)
            if line.startswith("#"):
                self.comments.append(line)
            elif line.strip():
                self._line(line.rstrip(), Span(self.source, start, start + len(line)))
        if self.source.text.strip() and not self.schema and not self.report.has_errors:
            _wrong(self.report, Span(self.source, 0, 0), f"it should say `{SCHEMA}` at its head")
        choices = tuple(
            replace(c, seed=c.seed if c.seed >= 0 else self.seed or 0)
            for _, c in sorted(self.choices.items())
        )
        return Lock(self.seed, tuple(self.versions.items()), choices, self.source, tuple(self.comments))

    def _line(self, line: str, span: Span) -> None:
        if line == SCHEMA:
            self.schema, self.comments = True, []  # what stands above is written anew
        elif take := _TAKE.fullmatch(line):
            self._take(take, span)
        elif seed := _SEED.fullmatch(line):
            self.seed = int(seed.group(1))
        elif head := _HEAD.fullmatch(line):
            self.versions[head["name"]] = head["value"]
        elif line[:7] in ("<<<<<<<", "=======", ">>>>>>>", "|||||||"):
            help = "keep one `take` line for each shot and remove the marks, then compile again"
            _wrong(self.report, span, "two versions of this file were not merged", help)
        elif line.startswith("vds.lock/"):
            _wrong(self.report, span, "this is of another version of vdsl", f"this one reads `{SCHEMA}`")
        else:
            _wrong(self.report, span, "this line does not read")

    def _take(self, take: re.Match[str], span: Span) -> None:
        shot = take["shot"]
        if shot in self.choices:
            _wrong(
                self.report, span, f"a take of `{shot}` is chosen above already", "keep one of the two lines"
            )
            return
        seed = int(take["seed"]) if take["seed"] else -1
        self.choices[shot] = Choice(
            shot,
            take["key"],
            take["words"],
            int(take["proposals"]),
            seed,
            take["depends"],
            tuple(self.comments),
        )
        self.comments = []


# -- writing ------------------------------------------------------------------------------------


def lock_text(lock: Lock, script: str) -> str:
    """What :func:`read_lock` reads."""
    seed = lock.seed or 0
    lines = [
        f"# The takes chosen for {script}. `vdsc pick` and `vdsc serve` write this file; keep it in git.",
        SCHEMA,
        f"seed {seed}",
        *(f"{name} {value}" for name, value in lock.versions),
        "",
    ]
    for choice in sorted(lock.choices, key=lambda c: c.shot):
        other = f" seed {choice.seed}" if choice.seed != seed else ""
        lines += choice.comments
        lines.append(
            f"take {choice.shot} {choice.key} of {choice.proposals}{other} line {choice.depends}"
            f' "{choice.words}"'
        )
    return "\n".join((*lines, *lock.comments)) + "\n"


def write_lock(path: Path, lock: Lock) -> None:
    """Write a lock in one step; one without choices and comments is no file at all. Raises OSError."""
    if not lock.choices and not lock.comments:
        path.unlink(missing_ok=True)
        return
    write_text(Path(os.path.realpath(path)), lock_text(lock, path.name.removesuffix(".lock")))


@contextmanager
def _changing(script: Path) -> Iterator[Path]:
    """The lock's path, which nobody else changes meanwhile."""
    path = lock_path(script)
    with one_at_a_time(path):
        yield path


def choose(file: str | Path, shot: str, take: int | str, build_dir: str | Path) -> Choice:
    """Choose a take of a build for a shot, and write it to the script's lock.

    It takes the place of what was chosen for the shot, also under a name that the shot had before.
    take: its rank in the build, or its proposal's key
    Raises :class:`ChoiceError` where the build has no such shot or take, :class:`ScriptError` for a lock that
    does not read, OSError for a disk that refuses.
    """
    document = _build(Path(build_dir))
    entry = _entry(document, shot)
    found = _take_of(entry, take, Path(file))
    words = " ".join(str(found[k]) for k in ("movement", "scale", "angle"))
    made = document["seed"]
    choice = Choice(shot, found["key"], words, int(entry["wanted"]), int(made), entry["depends"])
    with _changing(Path(file)) as path:
        lock = read_lock(path)
        where = _where(lock, document)
        old = _of(lock, shot, where, document)
        choice = replace(choice, comments=old.comments if old else ())
        names = {c: name for name, c in where.items() if c.shot == shot}  # one that has gone over to another
        others = tuple(replace(c, shot=names.get(c, c.shot)) for c in lock.choices if c != old)
        seed = lock.seed if others and lock.seed is not None else int(made)
        versions = tuple((k, str(v)) for k, v in document["made_with"].items())
        write_lock(path, replace(lock, seed=seed, versions=versions, choices=(*others, choice)))
    return choice


def clear(
    file: str | Path, shot: str | None = None, build_dir: str | Path | None = None
) -> tuple[Choice, ...]:
    """Take back the choice of one shot, or all of them; returns what was taken back.

    build_dir: a build that knows the shot also under a name that it has now, and had not when it was chosen
    All of them, from a lock that does not read as well: then it is moved to ``….lock.bad``, not thrown away.
    """
    with _changing(Path(file)) as path:
        try:
            lock = read_lock(path)
        except ScriptError:
            if shot is not None:
                raise
            os.replace(path, bad_path(file))
            return ()
        document = None
        if build_dir is not None:
            with suppress(ChoiceError, OSError):
                document = _build(Path(build_dir))
        one = _of(lock, shot, _where(lock, document), document) if shot is not None else None
        gone = lock.choices if shot is None else (one,) if one is not None else ()
        if gone:
            kept = tuple(c for c in lock.choices if c not in gone)
            write_lock(path, replace(lock, choices=kept))
        return gone


def _of(
    lock: Lock, shot: str, where: Mapping[str, Choice], document: Mapping[str, Any] | None
) -> Choice | None:
    """What is chosen for a shot: under its id, or under the one it had when it was chosen.

    By an id that no shot of the build has, what the lock calls so.
    """
    if shot in where:
        return where[shot]
    known = document is not None and any(s["id"] == shot for s in document["shots"])
    return next((c for c in lock.choices if c.shot == shot and not (known and c in where.values())), None)


def _where(lock: Lock, document: Mapping[str, Any] | None) -> dict[str, Choice]:
    """The choices by the shots of a build that they are for."""
    shots = document["shots"] if document is not None else ()
    return placed(lock.choices, {s["id"]: s["depends"] for s in shots})


def _build(folder: Path) -> dict[str, Any]:
    """A build's document, with all that a choice needs."""
    try:
        document: dict[str, Any] = json.loads((folder / "storyboard.json").read_text("utf-8"))
        if document["schema"] == "vds.storyboard/1" and document["made_with"]:
            return document
    except FileNotFoundError:
        raise ChoiceError(f"there is no build at {folder}; compile the storyboard first") from None
    except (ValueError, KeyError, TypeError):
        pass
    raise ChoiceError(f"{folder} is no build of this version; compile the storyboard again")


def _entry(document: dict[str, Any], shot: str) -> dict[str, Any]:
    shots: dict[str, dict[str, Any]] = {s["id"]: s for s in document["shots"]}
    if shot not in shots:
        meant = nearest(shot, shots)
        hint = f"did you mean `{meant}`?" if meant else "compile the storyboard again"
        raise ChoiceError(f"the build has no shot `{shot}`; {hint}")
    return shots[shot]


def _take_of(entry: dict[str, Any], take: int | str, file: Path) -> dict[str, Any]:
    takes: list[dict[str, Any]] = entry["takes"]
    for found in takes:
        if take in (found["rank"], found["key"]):
            return found
    if not takes:
        raise ChoiceError(f"the shot `{entry['id']}` has no take to choose")
    has = listing((f"{t['rank']} ({t['key']})" for t in takes), last="and")
    raise ChoiceError(
        f"the shot `{entry['id']}` has no take {take}; it has {has}. "
        f"`vdsc compile {file} --more {entry['id']}` draws more"
    )
