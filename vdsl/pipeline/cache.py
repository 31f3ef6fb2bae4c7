"""Results kept between runs, by what they were made of: one folder an entry, in the user's cache folder.

An entry is made whole beside its place and moved there in one step, and is never changed; what is read is
held against the digests in it. Guarantees that a reader finds a whole entry or none, however many runs there
are and whenever one is killed; that a damaged entry counts as none and is removed; and that all entries
together stay within a bound, the longest unused going first. A disk that is full or may not be written loses
nothing but time.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

from platformdirs import user_cache_path

#: Rises when the layout of entries changes.
VERSION = 1
#: MiB that all entries together may take; the variable in the environment says otherwise, 0 keeps nothing.
LIMIT_MIB = 4096
VARIABLE = "VDS_CACHE_MIB"
_TABLE = "entry.json"
_HALF_MADE = 3600  # seconds after which what a killed run left half made is removed
_ROOM = 0.8  # share of the bound that is kept when it is reached


def results_folder() -> Path:
    """Where the user's results are."""
    return Path(user_cache_path("vdsl")) / "results"


def limit_bytes() -> int:
    """What entries may take in all, bytes."""
    try:
        return int(float(os.environ.get(VARIABLE, LIMIT_MIB)) * 2**20)
    except ValueError:
        return LIMIT_MIB * 2**20


class Cache:
    """Entries of named files, by key. hits, misses: how often something was there, and was not.

    kept: whether anything is read or written at all
    """

    def __init__(self, folder: Path | None = None, limit: int | None = None, kept: bool = True) -> None:
        self.folder = folder or results_folder()
        self.limit = limit_bytes() if limit is None else limit
        self.kept = kept and self.limit > 0
        self.hits = 0
        self.misses = 0

    def take(self, key: str, places: Mapping[str, Path]) -> bool:
        """Put the files of an entry at places that are free; False, and nothing there, where it has none.

        They share their contents with the entry where the disk allows (hard links), and keep their times.
        """
        table = self._table(key)
        if table is None:
            return self._counted(key, False)
        done: list[Path] = []
        found = True
        try:
            for name, place in places.items():
                place.parent.mkdir(parents=True, exist_ok=True)
                _linked(self._entry(key) / name, place)
                done.append(place)
                if _digest(place.read_bytes()) != table.get(name):
                    raise ValueError(name)
        except (OSError, ValueError):
            found = False
            self._remove(key)
            for place in done:
                place.unlink(missing_ok=True)
        return self._counted(key, found)

    def has(self, key: str) -> bool:
        """Whether there is an entry; it may still turn out to be damaged."""
        return self.kept and self._entry(key).is_dir()

    def read(self, key: str, name: str = "value") -> bytes | None:
        """One file of an entry; None where there is none."""
        table = self._table(key)
        data: bytes | None = None
        if table is not None:
            try:
                data = (self._entry(key) / name).read_bytes()
            except OSError:
                data = None
            if data is None or _digest(data) != table.get(name):
                data = None
                self._remove(key)
        self._counted(key, data is not None)
        return data

    def put(self, key: str, files: Mapping[str, Path | bytes]) -> None:
        """Keep an entry of bytes, or of files, shared with it where the disk allows. The first one stays."""
        if not self.kept or self._entry(key).exists():
            return
        part: Path | None = None
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            part = Path(tempfile.mkdtemp(prefix=".new-", dir=self.folder))
            table = {}
            for name, content in files.items():
                if isinstance(content, Path):
                    _linked(content, part / name)
                    table[name] = _digest((part / name).read_bytes())
                else:
                    (part / name).write_bytes(content)
                    table[name] = _digest(content)
            (part / _TABLE).write_text(json.dumps({"version": VERSION, "digests": table}))
            self._entry(key).parent.mkdir(exist_ok=True)
            os.rename(part, self._entry(key))
        except OSError:
            if part is not None:
                shutil.rmtree(part, ignore_errors=True)

    def tidy(self) -> None:
        """Remove what was longest unused until the rest is within the bound, and what was left half made."""
        if not self.kept:
            return
        with contextlib.suppress(OSError):
            for part in [*self.folder.glob(".new-*"), *self.folder.glob(".gone-*")]:
                if time.time() - part.stat().st_mtime > _HALF_MADE:
                    shutil.rmtree(part, ignore_errors=True)
            entries = []
            for table in self.folder.glob(f"??/*/{_TABLE}"):
                with contextlib.suppress(OSError):
                    entries.append((table.stat().st_mtime, _size(table.parent), table.parent.name))
            total = sum(size for _, size, _ in entries)
            if total <= self.limit:
                return
            for _, size, key in sorted(entries):
                self._remove(key)
                total -= size
                if total <= _ROOM * self.limit:
                    return

    def _entry(self, key: str) -> Path:
        return self.folder / key[:2] / key

    def _table(self, key: str) -> dict[str, str] | None:
        """The digests of an entry's files; None where there is no entry, or a damaged one."""
        if not self.kept or not self._entry(key).is_dir():
            return None
        try:
            document = json.loads((self._entry(key) / _TABLE).read_bytes())
            if document["version"] == VERSION:
                return dict(document["digests"])
        except (OSError, ValueError, KeyError, TypeError):
            pass
        self._remove(key)
        return None

    def _counted(self, key: str, found: bool) -> bool:
        if found:
            self.hits += 1
            with contextlib.suppress(OSError):
                os.utime(self._entry(key) / _TABLE)
        else:
            self.misses += 1
        return found

    def _remove(self, key: str) -> None:
        """Take an entry away in one step, then delete it."""
        with contextlib.suppress(OSError):
            gone = Path(tempfile.mkdtemp(prefix=".gone-", dir=self.folder))
            os.rename(self._entry(key), gone / key)
            shutil.rmtree(gone, ignore_errors=True)


def _linked(source: Path, place: Path) -> None:
    """The same file at another place: shared where the disk can, else a copy of the same times."""
    try:
        os.link(source, place)
    except FileNotFoundError:
        raise
    except OSError:
        shutil.copy2(source, place)


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _size(folder: Path) -> int:
    return sum(p.stat().st_size for p in folder.iterdir())


def cleared(folder: Path | None = None) -> int:
    """Remove all entries; returns the bytes that were freed."""
    folder = folder or results_folder()
    freed = 0
    for entry in [*folder.glob("??/*"), *folder.glob(".new-*"), *folder.glob(".gone-*")]:
        with contextlib.suppress(OSError):
            freed += sum(p.stat().st_size for p in entry.rglob("*") if p.is_file())
        shutil.rmtree(entry, ignore_errors=True)
    return freed
