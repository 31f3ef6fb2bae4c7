"""The build folder: staged beside its place and swapped in at the end.

A run that fails or is interrupted leaves the last good build as it was. A folder that holds
something else than a build is never replaced.
"""

from __future__ import annotations

import contextlib
import filecmp
import glob
import json
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from .exchange import exchange

#: Everything the compiler puts at the top of a build; other entries in an old build are the
#: writer's own and are carried over to the new one.
OWN = ("index.html", "animatic.mp4", "storyboard.json", "report.json", "status.json", "shots", "plans")
#: What somebody wants of the builds to come; it is carried over too, and removed with the build.
WISHES = "further.json"
_STORYBOARD = "storyboard.json"
#: What ``vdsc watch`` tells, also before there is a build.
STATUS = "status.json"
#: Seconds without a change after which a half-made build is nobody's.
_LEFTOVER_AGE = 6 * 3600


Turn = Callable[[Path], contextlib.AbstractContextManager[None]]


class BuildFolderError(OSError):
    """The build cannot go where it was asked to go; the message says why."""


def _at_once(place: Path) -> contextlib.AbstractContextManager[None]:
    return contextlib.nullcontext()


@contextlib.contextmanager
def staged_build(target: str | Path, turn: Turn = _at_once) -> Iterator[Path]:
    """An empty folder to write a build into; it becomes ``target`` when the block ends well.

    Files that are as they were in the build before keep their times.
    turn: a block in which nobody else changes a folder
    Raises :class:`BuildFolderError` before anything is computed if ``target`` cannot be written or
    is a folder of something else.
    """
    place = Path(os.path.realpath(target))
    if not place.name:
        raise BuildFolderError(f"cannot build into {place}: name a folder in it")
    try:
        with turn(place):
            _recover(place)
        _refuse_foreign(place)
        place.parent.mkdir(parents=True, exist_ok=True)
        _clear_leftovers(place)
        stage = Path(tempfile.mkdtemp(prefix=f".{place.name}.new-{os.getpid()}-", dir=place.parent))
        stage.chmod(0o777 & ~_umask())
    except BuildFolderError:
        raise
    except OSError as error:
        raise _failure(f"cannot write to {place.parent}", error) from error
    try:
        yield stage
        with turn(place):
            _recover(place)
            _keep_times(stage, place)
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
        if all(entry.name == STATUS for entry in place.iterdir()):
            return
        schema = json.loads((place / _STORYBOARD).read_text("utf-8")).get("schema", "")
    except (OSError, ValueError, AttributeError):
        schema = ""
    if not str(schema).startswith("vds.storyboard/"):
        raise BuildFolderError(
            f"cannot build into {place}: it holds files that are not a build; name another folder"
        )


def _swap(stage: Path, place: Path) -> None:
    """Put ``stage`` in the place of ``place``, in one step where the system can; the old build is removed."""
    old = _old_name(place)
    try:
        if not place.exists():
            os.rename(stage, place)
            return
        if exchange(stage, place):
            old = stage
        else:
            os.rename(place, old)
            try:
                os.rename(stage, place)
            except BaseException:
                os.rename(old, place)
                raise
    except OSError as error:
        raise _failure(f"cannot put the build at {place}", error) from error
    _retire(old, place)


def _retire(old: Path, place: Path) -> None:
    """Remove an old build, but not what was the writer's own in it."""
    for entry in old.iterdir():
        is_sheet = entry.name.startswith("sheet") and entry.suffix == ".png"
        if entry.name not in OWN and not is_sheet and not (place / entry.name).exists():
            os.rename(entry, place / entry.name)
    shutil.rmtree(old, ignore_errors=True)


def _recover(place: Path) -> None:
    """Finish a swap in which a run was stopped: put a build back, or remove what it replaced."""
    old = _old_name(place)
    for stage in place.parent.glob(f".{glob.escape(place.name)}.new-*"):
        if (stage / _STORYBOARD).exists() and (stage / "report.json").exists() and not _at_work(stage):
            _retire(stage, place)  # stopped right after the exchange: this is the old build
    if old.is_dir():
        if place.exists():
            _retire(old, place)
        else:
            os.rename(old, place)


def _keep_times(stage: Path, place: Path) -> None:
    """Give files that are as they were before the times they had."""
    for path in stage.rglob("*"):
        before = place / path.relative_to(stage)
        with contextlib.suppress(OSError):
            if path.is_file() and before.is_file() and not path.samefile(before):
                now, then = path.stat(), before.stat()
                if now.st_size == then.st_size and filecmp.cmp(path, before, shallow=False):
                    os.utime(path, ns=(then.st_atime_ns, then.st_mtime_ns))


def _clear_leftovers(place: Path) -> None:
    """Remove what runs that were killed outright left half made; younger ones may still be at work."""
    for stage in place.parent.glob(f".{glob.escape(place.name)}.new-*"):
        with contextlib.suppress(OSError):
            newest = max(p.stat().st_mtime for p in (stage, *stage.rglob("*")))
            if not _at_work(stage) or time.time() - newest > _LEFTOVER_AGE:
                shutil.rmtree(stage, ignore_errors=True)


def _at_work(stage: Path) -> bool:
    """Whether the run that makes this build is still there."""
    number = stage.name.rpartition(".new-")[2].partition("-")[0]
    try:
        os.kill(int(number), 0)
    except ProcessLookupError:
        return False
    except (OSError, ValueError, OverflowError):
        return True
    return True


def _old_name(place: Path) -> Path:
    return place.with_name(f".{place.name}.old")


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def builds_in(folder: Path) -> list[Path]:
    """The builds in a folder, and what stopped runs left of some; the folder itself where it is one."""
    if _is_build(folder):
        return [folder]
    if not folder.is_dir():
        return []
    left = (p for p in folder.iterdir() if p.name.startswith(".") and _left_over(p))
    return sorted([*(p for p in folder.iterdir() if _is_build(p)), *left])


def _left_over(path: Path) -> bool:
    half = ".new-" in path.name and not _at_work(path)
    return path.is_dir() and not path.is_symlink() and (half or path.name.endswith(".old"))


def _is_build(place: Path) -> bool:
    try:
        schema = json.loads((place / _STORYBOARD).read_text("utf-8")).get("schema", "")
    except (OSError, ValueError, AttributeError):
        return False
    return str(schema).startswith("vds.storyboard/") and not place.is_symlink()


def remove_build(place: Path) -> int:
    """Remove what the compiler wrote into a build; returns the bytes it took. Anything else in it stays."""
    freed = 0
    for entry in list(place.iterdir()):
        if entry.name in (*OWN, WISHES) or (entry.name.startswith("sheet") and entry.suffix == ".png"):
            files = [entry] if entry.is_file() else [p for p in entry.rglob("*") if p.is_file()]
            freed += sum(p.stat().st_size for p in files)
            shutil.rmtree(entry) if entry.is_dir() and not entry.is_symlink() else entry.unlink()
    if not any(place.iterdir()):
        place.rmdir()
    return freed
