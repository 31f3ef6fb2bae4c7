"""Where the two storyboards of a comparison come from: files, or revisions of a file in git.

Assumes nothing of the names. Guarantees that git is run without a shell, on a revision it has itself
resolved, and never writes; what cannot be found raises :class:`NoSideError` with the reason.
"""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..lang import Report, Source, read_source
from ..lang.files import LARGEST_FILE
from .script import Checked, ScriptError, check_source

#: The revision a file is compared with where none is named.
LAST = "HEAD"
_WAIT = 30  # seconds for git


class NoSideError(Exception):
    """What was named cannot be compared; the message says why."""


@dataclass(frozen=True)
class Side:
    """One of the two. name: as people are told; path: of the file; text: None where there is no such file."""

    name: str
    path: Path
    text: str | None

    def checked(self) -> Checked | None:
        """Its storyboard; None where there is no file. Raises :class:`~vdsl.pipeline.script.ScriptError`."""
        if self.text is None:
            return None
        return check_source(Source(str(self.path), self.text), Report())


def sides_of(words: Sequence[str]) -> tuple[Side, Side]:
    """The two sides that words on the command line mean.

    ``FILE``: as it was committed last, and as it is; ``A B``: two files; ``REV FILE``: a revision and the
    file as it is; ``REV REV FILE``: two revisions of it. Raises :class:`NoSideError`, or OSError.
    """
    if len(words) == 1:
        return at_revision(LAST, Path(words[0])), on_disk(Path(words[0]))
    if len(words) == 3:
        return at_revision(words[0], Path(words[2])), at_revision(words[1], Path(words[2]))
    if len(words) != 2:
        raise NoSideError("name two files, a file and revisions of it, or a file alone")
    first, second = Path(words[0]), Path(words[1])
    if first.is_file() and second.is_file():
        return on_disk(first), on_disk(second)
    if second.is_file():
        if first.suffix == ".vds":
            raise NoSideError(f"there is no file {first}")
        return at_revision(words[0], second), on_disk(second)
    raise NoSideError(f"there is no file {second}")


def on_disk(path: Path, shown: Path | None = None) -> Side:
    """A file as it is; shown: the name it goes by. An empty device is no file, as git means it."""
    if str(path) == "/dev/null":
        return Side(str(path), shown or path, None)
    if not path.is_file():
        raise NoSideError(f"there is no file {path}")
    report = Report()
    source = read_source(path, report)
    if source is None:
        raise ScriptError(report)
    return Side(str(shown or path), shown or path, source.text)


def at_revision(revision: str, path: Path) -> Side:
    """A file as it is in a revision of the repository it lies in; no text where it is not in it."""
    folder = path.parent if str(path.parent) else Path(".")
    if not folder.is_dir():
        raise NoSideError(f"there is no folder {folder}")
    if _git(folder, "rev-parse", "--is-inside-work-tree") is None:
        raise NoSideError(f"{path} is not in a git repository")
    commit = _git(folder, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}")
    if commit is None:
        raise NoSideError(f"git knows no revision {revision!r}")
    name = f"{path}@{revision}"
    commit_id = commit.decode("ascii", "replace").strip()
    listed = _git(folder, "ls-tree", "-z", "--name-only", commit_id, "--", f"./{path.name}")
    if not listed:
        if not path.is_file():
            raise NoSideError(f"there is no file {path}, nor was there in {revision}")
        return Side(name, path, None)
    data = _git(folder, "show", f"{commit_id}:./{path.name}")
    if data is None or len(data) > LARGEST_FILE:
        raise NoSideError(f"git cannot show {name}")
    try:
        return Side(name, path, data.decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise NoSideError(f"{name} is no UTF-8 text") from None


def _git(folder: Path, *arguments: str) -> bytes | None:
    """What git says, None where it refuses."""
    command = ["git", "-C", str(folder), *arguments]
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=_WAIT)
    except FileNotFoundError:
        raise NoSideError("git is not installed") from None
    except subprocess.TimeoutExpired:
        raise NoSideError(f"git did not answer within {_WAIT} seconds") from None
    return done.stdout if done.returncode == 0 else None
