"""Training sets on disk: shards of frames and labels, written by whoever can render them.

A folder holds ``dataset.json`` (the words of the classes, picture size, frames a clip) and shards
``shard-00000.npy`` (uint8 [N, T, H, W, 3]) each with ``shard-00000.jsonl`` (one label a line). The
label file is written last and is what makes a shard count, so writing can stop and go on anywhere. Where
clips come with guides (:mod:`ranker.guides`), these lie beside: ``shard-00000.maps.npy``, ``.flow.npy`` and
``.marks.npy``.
Guides are had and learnt from far quicker than pictures, so a shard may have more of them: its last clips are
*bare*, without frames.
"""

from __future__ import annotations

import hashlib
import json
import os
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from .errors import RankerError
from .guides import Guides, joined

SCHEMA = "vds.dataset/1"
SHARD = 64
#: Hints of such names change their sign in a mirrored picture.
MIRRORED = "right"
#: Such say that a clip has a fault: 1 for one that has, 0 for one that has not.
FAULT = "fault_"
#: Such say how good it is by some criterion.
GOOD = "good_"
_LEAST = 0.2  # of the deviation of all clips, that a hint has at least among positives


@dataclass(frozen=True)
class Label:
    """What is known of a clip.

    professional: chosen, or a negative; movement, scale, angle: words, or None where not known
    group: clips that belong together (a set with its cast, say) and never stand on both sides of the
        split; strength: 0 for a positive, else how far the negative was perturbed (0..1)
    split: ``train`` or ``test`` where who made the set says so, else ""
    about: what else is known, for evaluation and for people; plain values
    """

    professional: bool
    movement: str | None
    scale: str | None
    angle: str | None
    group: str
    strength: float
    split: str = ""
    about: dict[str, Any] = field(default_factory=dict)

    @property
    def bare(self) -> bool:
        """Whether it has guides alone, and no frames."""
        return bool(self.about.get("bare"))


@dataclass(frozen=True)
class Words:
    """The words of the three classes, in the order of the model's outputs."""

    movements: tuple[str, ...]
    scales: tuple[str, ...]
    angles: tuple[str, ...]


class ShardWriter:
    """Writes a training set; a folder that holds one already is gone on with.

    size: (height, width) of the frames; shard: clips after which a shard is written, None for SHARD
    made: how the set is made, kept in its header: it is gone on with only by who says the same
    ``len(writer)`` is how many clips with frames are safely on disk, so a generator that draws its clips by
    index starts again there. Use as a context manager.
    """

    def __init__(
        self,
        folder: str | Path,
        words: Words,
        size: tuple[int, int] = (224, 224),
        frames: int = 8,
        shard: int | None = None,
        made: dict[str, Any] | None = None,
    ) -> None:
        self.folder, self.words, self.shard = Path(folder), words, shard or SHARD
        self.shape = (frames, *size, 3)
        header = {"schema": SCHEMA, **asdict(words), "size": list(size), "frames": frames}
        if made:
            header["made"] = made
        header = json.loads(json.dumps(header))
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            path = self.folder / "dataset.json"
            if path.exists():
                there = json.loads(path.read_text("utf-8"))
                if there != header:
                    how = _difference(there, header)
                    raise RankerError(f"{path}: another kind of training set is there already ({how})")
            else:
                _replace(path, json.dumps(header, indent=1, ensure_ascii=False).encode())
            found = _shards(self.folder)
            self.labels = [label for p in found for label in _labels(p)]
            self._next = 1 + max((int(p.stem.split("-")[1]) for p in found), default=-1)
        except (OSError, ValueError) as error:
            raise RankerError(f"{folder}: cannot be used as a training set: {error}") from error
        self._frames: list[NDArray[np.uint8]] = []
        self._pending: list[tuple[Label, Guides | None]] = []

    def __len__(self) -> int:
        return sum(not label.bare for label in self.labels)

    @property
    def pending(self) -> int:
        """Clips with frames that are not on disk yet."""
        return len(self._frames)

    def add(
        self,
        frames: NDArray[np.uint8] | None,
        label: bool,
        movement: str | None,
        scale: str | None,
        angle: str | None,
        group: str,
        strength: float,
        split: str = "",
        about: dict[str, Any] | None = None,
        guides: Guides | None = None,
    ) -> None:
        """Append a clip: uint8 [T, H, W, 3], None for a bare one; guides: its own, of one shot, all clips of
        a shard's or none's; see :class:`Label` for the rest. Frames flagged as not to be
        written to are not copied, and have to stay as they are until they are on disk."""
        if frames is None and guides is None:
            raise ValueError("a clip without frames needs guides")
        if frames is not None and (frames.shape != self.shape or frames.dtype != np.uint8):
            raise ValueError(f"expected uint8 {self.shape}, got {frames.dtype} {frames.shape}")
        for word, known in (
            (movement, self.words.movements),
            (scale, self.words.scales),
            (angle, self.words.angles),
        ):
            if word is not None and word not in known:
                raise ValueError(f"{word!r} is not one of the set's words {known}")
        if self._pending and (guides is None) != (self._pending[0][1] is None):
            self.flush()  # a shard has guides or has none
        if guides is not None:
            guides.check(1, self.shape[0], self.shape[0])
        told = {**(about or {}), **({"bare": True} if frames is None else {})}
        made = Label(bool(label), movement, scale, angle, group, float(strength), split, told)
        self._pending.append((made, guides))
        if frames is not None:
            self._frames.append(frames.copy() if frames.flags.writeable else frames)
        if len(self._pending) >= self.shard:
            self.flush()

    def flush(self) -> None:
        """Write the clips that are not on disk yet as a shard of their own."""
        if not self._pending:
            return
        base = self.folder / f"shard-{self._next:05d}"
        ordered = sorted(self._pending, key=lambda clip: clip[0].bare)
        lines = "".join(json.dumps(vars(label), ensure_ascii=False) + "\n" for label, _ in ordered)
        part = self.folder / f".{base.name}.npy.part"
        try:
            with part.open("wb") as file:  # one after the other: together they would be copied twice
                shape = (len(self._frames), *self.shape)
                header = {"descr": np.dtype(np.uint8).str, "fortran_order": False, "shape": shape}
                np.lib.format.write_array_header_1_0(file, header)
                file.writelines(np.ascontiguousarray(frames).data for frames in self._frames)
            os.replace(part, base.with_suffix(".npy"))
            found = [guides for _, guides in ordered if guides is not None]
            if found:
                guides = joined(found)
                np.save(base.with_suffix(".maps.npy"), guides.maps)
                np.save(base.with_suffix(".flow.npy"), guides.flow)
                np.save(base.with_suffix(".marks.npy"), guides.marks)
            _replace(base.with_suffix(".jsonl"), lines.encode())
        except OSError as error:
            part.unlink(missing_ok=True)
            raise RankerError(f"{base}.npy: cannot be written: {error.strerror or error}") from error
        self.labels += [label for label, _ in ordered]
        self._next += 1
        self._frames, self._pending = [], []

    def __enter__(self) -> ShardWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:  # what is pending where something failed may be half of what belongs together
            self.flush()


class Dataset:
    """A training set that can be read clip by clip; frames stay on disk until asked for."""

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        try:
            header = json.loads((self.folder / "dataset.json").read_text("utf-8"))
            if header["schema"] != SCHEMA:
                raise ValueError(f"schema {header['schema']}")
            self.words = Words(*(tuple(header[k]) for k in ("movements", "scales", "angles")))
            self.frames, self.made = int(header["frames"]), dict(header.get("made") or {})
            self.labels: list[Label] = []
            self._where: list[tuple[int, int]] = []
            self._arrays: list[NDArray[np.uint8]] = []
            self._guided: list[Guides | None] = []
            for number, path in enumerate(_shards(self.folder)):
                labels = _labels(path)
                array = np.load(path.with_suffix(".npy"), mmap_mode="r", allow_pickle=False)
                if (
                    array.dtype != np.uint8
                    or array.ndim != 5
                    or array.shape[:2] != (sum(not label.bare for label in labels), self.frames)
                ):
                    raise ValueError(f"{path.name} does not fit its frames")
                self._arrays.append(array)
                self._guided.append(_guides(path, len(labels), self.frames))
                self._where += [(number, i) for i in range(len(labels))]
                self.labels += labels
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise RankerError(f"{folder}: is not a training set, or a damaged one: {error}") from error

    def __len__(self) -> int:
        return len(self.labels)

    def clip(self, index: int, frames: Sequence[int], size: int) -> NDArray[np.uint8]:
        """Chosen frames of a clip, scaled to a square: uint8 [len(frames), size, size, 3]."""
        shard, row = self._where[index]
        return scaled(np.asarray(self._arrays[shard][row, list(frames)]), size)

    def guides(self, clips: NDArray[np.int64], frames: Sequence[int] | None = None) -> Guides | None:
        """Guides of chosen clips, or of some of their frames; of those without (``guided``) as of what is
        kept back (:meth:`ranker.guides.Guides.unknown`). None in a set without any."""
        if not self.guided.any():
            return None
        some = slice(None) if frames is None else list(frames)
        nothing = Guides.unknown(1, self.frames)
        maps, flow, marks = [], [], []
        for shard, row in (self._where[i] for i in clips):
            known = self._guided[shard]
            of, row = (nothing, 0) if known is None else (known, row)
            maps.append(of.maps[row][some])
            flow.append(of.flow[row])
            marks.append(of.marks[row][some])
        return Guides(np.stack(maps), np.stack(flow), np.stack(marks))

    def shards(self) -> Iterator[tuple[Path, NDArray[np.uint8]]]:
        """The files of the frames in order, and what is in each: uint8 [n, T, H, W, 3]."""
        for path, array in zip(_shards(self.folder), self._arrays, strict=True):
            yield path.with_suffix(".npy"), array

    @cached_property
    def classes(self) -> NDArray[np.int64]:
        """int64 [N, 3]: indices of movement, scale and angle, −1 where not known."""
        known = [{w: i for i, w in enumerate(words)} for words in asdict(self.words).values()]
        rows = [(la.movement, la.scale, la.angle) for la in self.labels]
        table = [
            [k.get(w, -1) if w is not None else -1 for w, k in zip(row, known, strict=True)] for row in rows
        ]
        return np.array(table, np.int64).reshape(-1, 3)

    @cached_property
    def hints(self) -> tuple[tuple[str, ...], NDArray[np.float32]]:
        """What whoever made the set knows of its clips in numbers (``hints`` of a label's ``about``): their
        names, and float32 [N, K], NaN where not known: in deviations from the mean of positives, asinh of
        them, so that what tells good ones apart is not lost beside how far off bad ones are. Faults stay as
        they are.
        """
        return _standard(
            [label.about.get("hints") or {} for label in self.labels], (), self.professional > 0.5
        )

    @property
    def faults(self) -> slice:
        """Which of the hints are of faults: one after the other, since they stand in the order of their
        names."""
        return self._named(FAULT)

    @property
    def goods(self) -> slice:
        """Which of them say how good a clip is by some criterion."""
        return self._named(GOOD)

    def _named(self, begin: str) -> slice:
        names = self.hints[0]
        first = next((k for k, name in enumerate(names) if name.startswith(begin)), 0)
        return slice(first, first + sum(name.startswith(begin) for name in names))

    @cached_property
    def frame_hints(self) -> tuple[tuple[str, ...], NDArray[np.float32]]:
        """The same of single frames (``frames`` of a label's ``about``): float32 [N, T, K]."""
        told = [label.about.get("frames") or {} for label in self.labels]
        return _standard(told, (self.frames,), self.professional > 0.5)

    @cached_property
    def meant(self) -> NDArray[np.float32]:
        """Whether the subject is meant to be in the picture of a frame (``meant`` of a label's ``about``),
        float32 [N, T]: 1 or 0, NaN where not known."""
        unknown = [np.nan] * self.frames
        told = [label.about.get("meant") or unknown for label in self.labels]
        return np.array(told, np.float32).reshape(-1, self.frames)

    @cached_property
    def professional(self) -> NDArray[np.float32]:
        """float32 [N]: 1 for positives."""
        return np.array([la.professional for la in self.labels], np.float32)

    @cached_property
    def bare(self) -> NDArray[np.bool_]:
        """Clips [N] that have guides alone, and no frames."""
        return np.array([label.bare for label in self.labels], bool)

    @cached_property
    def guided(self) -> NDArray[np.bool_]:
        """Clips [N] that have guides; films of cameras have none."""
        return np.array([self._guided[shard] is not None for shard, _ in self._where], bool)

    @cached_property
    def doubtful(self) -> NDArray[np.bool_]:
        """Clips [N] whose label is not to be learnt or measured by (``doubtful`` of a label's ``about``): bad
        ones for reasons that no picture shows, say. Everything else that is known of them counts."""
        return np.array([bool(label.about.get("doubtful")) for label in self.labels], bool)

    @cached_property
    def grade(self) -> NDArray[np.float32]:
        """How good positives are among themselves, float32 [N], 0..1: ``grade`` of a label's ``about``, 1
        where that does not say; 0 for negatives."""
        told = [float(label.about.get("grade", 1.0)) if label.professional else 0.0 for label in self.labels]
        return np.array(told, np.float32)

    @cached_property
    def liked(self) -> NDArray[np.float32]:
        """How well clips are liked, float32 [N]: ``opinion`` of a label's ``about``, as deviations from the
        mean of positives, within 3; -3 for negatives, NaN where not known or doubtful."""
        told = np.array([float(label.about.get("opinion", np.nan)) for label in self.labels])
        told[self.professional < 0.5] = np.nan
        if not np.isfinite(told).any():
            return told.astype(np.float32)
        middle, spread = np.nanmean(told), max(np.nanstd(told), 1e-6)
        told = np.clip((told - middle) / spread, -3, 3)
        told[self.professional < 0.5] = -3.0
        told[self.doubtful] = np.nan
        return told.astype(np.float32)

    def split(self, share: float, seed: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Indices to train on, and held out: whole groups in a random order until ``share`` is reached.

        With a share above 0 and more than one group both sides have at least one. Where the labels say
        themselves what is for testing, that is held out, whatever the share, unless it is 0.
        """
        told = np.array([label.split == "test" for label in self.labels], bool)
        if share > 0 and told.any():
            return np.flatnonzero(~told), np.flatnonzero(told)
        groups: dict[str, list[int]] = {}
        for i, label in enumerate(self.labels):
            groups.setdefault(label.group, []).append(i)
        order = sorted(
            groups, key=lambda g: hashlib.sha256(f"{seed}:{g}".encode("utf-8", "replace")).digest()
        )
        held: list[int] = []
        for group in order[: len(order) - 1 if share > 0 else 0]:
            if len(held) >= share * len(self.labels):
                break
            held += groups[group]
        train = sorted(set(range(len(self.labels))) - set(held))
        return np.array(train, np.int64), np.array(sorted(held), np.int64)

    def about(self) -> dict[str, Any]:
        """Counts, for the record beside the weights."""
        framed = self.professional[~self.bare]
        return {
            "clips": len(framed),
            "positives": int(framed.sum()),
            "negatives": len(framed) - int(framed.sum()),
            **({"bare": int(self.bare.sum())} if self.bare.any() else {}),
            "groups": len({la.group for la in self.labels}),
            **({"hints": list(self.hints[0])} if self.hints[0] else {}),
            **({"made": self.made} if self.made else {}),
        }


def _standard(
    told: list[dict[str, Any]], shape: tuple[int, ...], good: NDArray[np.bool_]
) -> tuple[tuple[str, ...], NDArray[np.float32]]:
    """Numbers of ``shape`` by name as a table of all names [N, *shape, K], scaled as ``hints``."""
    names = tuple(sorted({name for hints in told for name in hints}))
    unknown = np.full(shape, np.nan)
    table = np.array(
        [[np.asarray(hints.get(n, unknown), float) for n in names] for hints in told], np.float64
    )
    table = table.reshape(len(told), len(names), *shape)
    if not table.size:
        return (), np.zeros((len(told), *shape, 0), np.float32)
    table = np.moveaxis(table, 1, -1)
    across = tuple(range(table.ndim - 1))
    usual = table[good] if good.any() else table
    with warnings.catch_warnings():  # what is known of no good one counts as what is known of all
        warnings.simplefilter("ignore", RuntimeWarning)
        middle = np.nanmean(usual, across)
        middle = np.where(np.isfinite(middle), middle, np.nanmean(table, across))
        signed = np.array([name.startswith(MIRRORED) for name in names])
        middle = np.where(signed, 0.0, middle)  # so that a mirrored one is the negative
        own, every = (np.sqrt(np.nanmean((t - middle) ** 2, across)) for t in (usual, table))
    spread = np.maximum(np.nan_to_num(own), _LEAST * every)
    scaled = np.arcsinh((table - middle) / np.maximum(spread, 1e-6))
    plain = np.array([name.startswith(FAULT) for name in names])
    return names, np.where(plain, table, scaled).astype(np.float32)


def scaled(frames: NDArray[np.uint8], size: int) -> NDArray[np.uint8]:
    """Pictures uint8 [N, H, W, 3] as squares: [N, size, size, 3]."""
    if frames.shape[1:3] == (size, size):
        return frames
    out = np.empty((len(frames), size, size, 3), np.uint8)
    how = cv2.INTER_AREA if size < frames.shape[1] else cv2.INTER_LINEAR
    for frame, small in zip(frames, out, strict=True):
        cv2.resize(frame, (size, size), dst=small, interpolation=how)
    return out


def _shards(folder: Path) -> list[Path]:
    return sorted(folder.glob("shard-*.jsonl"))


def _guides(path: Path, clips: int, frames: int) -> Guides | None:
    """What lies beside a shard; the maps stay on disk until asked for."""
    if not all(path.with_suffix(f".{name}.npy").exists() for name in ("maps", "flow", "marks")):
        return None
    found = Guides(
        np.load(path.with_suffix(".maps.npy"), mmap_mode="r", allow_pickle=False),
        np.load(path.with_suffix(".flow.npy"), allow_pickle=False),
        np.load(path.with_suffix(".marks.npy"), allow_pickle=False),
    )
    try:
        found.check(clips, frames, frames)
    except ValueError as error:
        raise ValueError(f"{error}; of another kind than are looked at now, or damaged") from error
    return found


def _labels(path: Path) -> list[Label]:
    return [Label(**json.loads(line)) for line in path.read_text("utf-8").splitlines() if line.strip()]


def made_of(folder: str | Path) -> dict[str, Any] | None:
    """How the training set in a folder says it is made; None where there is none, or it does not say."""
    try:
        found = json.loads((Path(folder) / "dataset.json").read_text("utf-8")).get("made")
    except (OSError, ValueError, AttributeError):
        return None
    return found if isinstance(found, dict) else None


def _difference(there: Any, asked: dict[str, Any]) -> str:
    """In what a training set is of another kind than is asked for."""
    one, other = (_flat(header) for header in (there, asked))
    keys = [key for key in (one | other) if one.get(key) != other.get(key)]
    return ", ".join(f"{key} {one.get(key, 'unsaid')} there, {other.get(key, 'unsaid')} here" for key in keys)


def _flat(header: Any) -> dict[str, Any]:
    """A set's header with how it is made beside the rest; empty for what is none."""
    told = dict(header) if isinstance(header, dict) else {}
    how = told.pop("made", None)
    return told | how if isinstance(how, dict) else told


def _replace(path: Path, content: bytes) -> None:
    part = path.with_name(f".{path.name}.part")
    part.write_bytes(content)
    os.replace(part, path)
