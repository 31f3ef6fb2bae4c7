"""The build folder: staged beside its place and swapped in at the end.

A run that fails or is interrupted leaves the last good build as it was. A folder that holds
something else than a build is never replaced.
"""

from __future__ import annotations

import contextlib
import glob
import json
import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

#: Everything the compiler puts at the top of a build; other entries in an old build are the
#: writer's own and are carried over to the new one.
OWN = ("index.html", "animatic.mp4", "storyboard.json", "report.json", "shots")
_STORYBOARD = "storyboard.json"
#: Seconds without a change after which a half-made build is nobody's.
_LEFTOVER_AGE = 6 * 3600


class BuildFolderError(OSError):
    """The build cannot go where it was asked to go; the message says why."""


@contextlib.contextmanager
def staged_build(target: str | Path) -> Iterator[Path]:
    """An empty folder to write a build into; it becomes ``target`` when the block ends well.

    Raises :class:`BuildFolderError` before anything is computed if ``target`` cannot be written or
    is a folder of something else.
    """
    place = Path(os.path.realpath(target))
    if not place.name:
        raise BuildFolderError(f"cannot build into {place}: name a folder in it")
    try:
        _recover(place)
        _refuse_foreign(place)
        place.parent.mkdir(parents=True, exist_ok=True)
        _clear_leftovers(place)
        stage = Path(tempfile.mkdtemp(prefix=f".{place.name}.new-", dir=place.parent))
        stage.chmod(0o777 & ~_umask())
    except BuildFolderError:
        raise
    except OSError as error:
        raise _failure(f"cannot write to {place.parent}", error) from error
    try:
        yield stage
        _swap(stage, place)
    finally:
        shutil.rmtree(stage, ignore_errors=True)


def write_bytes(path: Path, data: bytes) -> None:
    """Write a whole file under a temporary name, then give it its own."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        part.write_bytes(data)
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise _failure(f"cannot write {path}", error) from error


def write_text(path: Path, text: str) -> None:
    """:func:`write_bytes` of UTF-8 text."""
    write_bytes(path, text.encode("utf-8", "replace"))


def _failure(what: str, error: OSError) -> BuildFolderError:
    failure = BuildFolderError(f"{what}: {error.strerror or error}")
    failure.errno = error.errno
    return failure


def _refuse_foreign(place: Path) -> None:
    if not place.exists():
        return
    if not place.is_dir():
        raise BuildFolderError(f"cannot build into {place}: it is a file")
    try:
        if not any(place.iterdir()):
            return
        schema = json.loads((place / _STORYBOARD).read_text("utf-8")).get("schema", "")
    except (OSError, ValueError, AttributeError):
        schema = ""
    if not str(schema).startswith("vds.storyboard/"):
        raise BuildFolderError(
            f"cannot build into {place}: it holds files that are not a build; name another folder"
        )


def _swap(stage: Path, place: Path) -> None:
    """Put ``stage`` in the place of ``place``; on any failure the old one is back where it was."""
    old = _old_name(place)
    try:
        shutil.rmtree(old, ignore_errors=True)
        had_old = place.exists()
        if had_old:
            os.rename(place, old)
        try:
            os.rename(stage, place)
        except BaseException:
            if had_old:
                os.rename(old, place)
            raise
    except OSError as error:
        raise _failure(f"cannot put the build at {place}", error) from error
    if had_old:
        _carry_over(old, place)
        shutil.rmtree(old, ignore_errors=True)


def _carry_over(old: Path, place: Path) -> None:
    for entry in old.iterdir():
        is_sheet = entry.name.startswith("sheet") and entry.suffix == ".png"
        if entry.name not in OWN and not is_sheet and not (place / entry.name).exists():
            os.rename(entry, place / entry.name)


def _recover(place: Path) -> None:
    """Undo a swap that a power cut stopped between its two steps."""
    old = _old_name(place)
    if old.is_dir() and not place.exists():
        os.rename(old, place)


def _clear_leftovers(place: Path) -> None:
    """Remove what runs that were killed outright left half made; younger ones may still be at work."""
    for stage in place.parent.glob(f".{glob.escape(place.name)}.new-*"):
        with contextlib.suppress(OSError):
            newest = max(p.stat().st_mtime for p in (stage, *stage.rglob("*")))
            if time.time() - newest > _LEFTOVER_AGE:
                shutil.rmtree(stage, ignore_errors=True)


def _old_name(place: Path) -> Path:
    return place.with_name(f".{place.name}.old")


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
