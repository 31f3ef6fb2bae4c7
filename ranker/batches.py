"""What training looks at: clips of a set in batches, each seen a little otherwise every time.

Assumes a training set that fits its words. Guarantees that what a batch holds hangs on the seed, the epoch
and its place in this alone, so that a training that was stopped goes on as if it had not been.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import NamedTuple

import cv2
import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from .config import ModelConfig, Phase, TrainConfig
from .data import MIRRORED, Dataset
from .errors import RankerError
from .guided import Guided
from .guides import Guides, joined
from .model import frame_times
from .motion import mirrored

_LUMA = (0.299, 0.587, 0.114)  # of sRGB, by channel (BT.601)


class Batch(NamedTuple):
    """Clips of one step: frames uint8 [B, T, S, S, 3] and times [B, T] of query and key; labels.

    query: None where guides alone are looked at; professional: 1 or less for good ones, by their grade,
        NaN for doubtful ones
    liked [B], how well good ones are liked among themselves; NaN is not known
    hints [B, K], marks [B, T, M] of the query's frames, mapped [B, T, M] and meant [B, T] of those that
        guides are of: NaN is not known
    moved [B, pairs, NUMBERS], likewise; guides of all frames, with zeros for maps where they are kept back
    """

    query: Tensor | None
    query_times: Tensor
    key: Tensor
    key_times: Tensor
    professional: Tensor
    liked: Tensor
    classes: Tensor
    hints: Tensor
    marks: Tensor
    mapped: Tensor
    meant: Tensor
    moved: Tensor | None
    guides: Guided | None
    clips: Tensor


def batches(
    data: Dataset,
    clips: NDArray[np.int64],
    phase: Phase,
    config: TrainConfig,
    epoch: int,
    moved: Tensor | None = None,
) -> Iterator[Batch]:
    """The clips in an order that hangs on seed and epoch alone; the next batch is read meanwhile."""
    rng = np.random.default_rng((config.seed, epoch + 1))
    order = rng.permutation(clips)
    if not phase.size:  # of bare clips only as many as are shared out, of the others all
        order = order[np.argsort(data.bare[order], kind="stable")]
    order = rng.permutation(order[: count_of(data, clips, phase)])
    parts = [order[i : i + phase.batch] for i in range(0, len(order), phase.batch)]
    if len(parts) > 1 and len(parts[-1]) == 1:  # batch norm needs company
        parts[-1] = np.append(parts[-1], order[0])
    ahead = max(2, config.threads)
    with ThreadPoolExecutor(max(1, config.threads // 2)) as readers:
        made = [
            readers.submit(_batch, data, part, phase, config, (epoch + 1, n), moved)
            for n, part in enumerate(parts[:ahead])
        ]
        for n in range(len(parts)):
            batch = made.pop(0).result()
            if n + ahead < len(parts):
                key = (epoch + 1, n + ahead)
                made.append(readers.submit(_batch, data, parts[n + ahead], phase, config, key, moved))
            yield batch


def count_of(data: Dataset, clips: NDArray[np.int64], phase: Phase) -> int:
    """How many clips an epoch goes through."""
    always = 0 if phase.size else int((~data.bare[clips]).sum())
    return max(min(2, len(clips)), always + round(phase.share * (len(clips) - always)))


def _batch(
    data: Dataset,
    clips: NDArray[np.int64],
    phase: Phase,
    config: TrainConfig,
    key: tuple[int, int],
    moved: Tensor | None,
) -> Batch:
    rng = np.random.default_rng((config.seed, 1, *key))
    glanced = bool(config.augment and rng.random() < config.glanced)
    if not phase.size:
        return _by_guides(data, clips, config, glanced, moved, rng)
    count, keyed = phase.frames, phase.key_frames if config.contrast_weight else 0
    if count + keyed > data.frames:
        raise RankerError(f"query and key need {count + keyed} frames, the clips have {data.frames}")
    views = [_view(data, int(index), phase.size, (count, keyed), glanced, config, rng) for index in clips]
    flipped = np.array([view.flipped for view in views])
    own = None if moved is None else moved[torch.from_numpy(clips)]
    for row, view in enumerate(views):
        if own is not None:
            unmoved = config.augment and rng.random() < config.unmoved
            if unmoved or (view.guides is not None and not view.kept_back):
                own[row] = torch.nan  # what guides tell need not be guessed at
            elif view.flipped:
                own[row] = mirrored(own[row])
    pictures = torch.from_numpy(np.stack([view.pictures for view in views]))
    times = torch.from_numpy(np.stack([view.times for view in views]))
    return Batch(
        pictures[:, :count],
        times[:, :count],
        pictures[:, count:],
        times[:, count:],
        *_labels(data, clips, flipped, config),
        torch.from_numpy(np.stack([view.marks for view in views])),
        torch.from_numpy(np.stack([view.mapped for view in views])),
        torch.from_numpy(np.stack([view.meant for view in views])),
        own,
        _guided(views),
        torch.from_numpy(clips),
    )


def _by_guides(
    data: Dataset,
    clips: NDArray[np.int64],
    config: TrainConfig,
    glanced: bool,
    moved: Tensor | None,
    rng: np.random.Generator,
) -> Batch:
    """A batch of which guides alone are looked at: all clips at once, which is many times as quick.

    Raises :class:`RankerError` for a set without guides.
    """
    found = data.guides(clips)
    if found is None:
        raise RankerError("there are no guides to look at")
    flipped = rng.random(len(clips)) < 0.5 if config.augment else np.zeros(len(clips), bool)
    guides = found.mirrored_where(flipped)
    times = np.tile(_times(data), (len(clips), 1))
    marks, meant = data.frame_hints[1][clips], data.meant[clips]
    turned = np.array([name.startswith(MIRRORED) for name in data.frame_hints[0]], bool)
    marks[np.ix_(flipped, np.arange(marks.shape[1]), turned)] *= -1
    if glanced:  # at two of the frames, in every clip others
        rows = np.arange(len(clips))[:, None]
        seen = np.sort(rng.permuted(np.tile(np.arange(data.frames), (len(clips), 1)), axis=1)[:, :2], axis=1)
        unknown = np.full_like(guides.flow, np.nan)
        guides = Guides(guides.maps[rows, seen], unknown, guides.marks[rows, seen])
        times, marks, meant = times[rows, seen], marks[rows, seen], meant[rows, seen]
    at, maps, flow, told = (
        torch.from_numpy(part) for part in (times, guides.maps, guides.flow, guides.marks)
    )
    return Batch(
        None,
        at,
        at[:, :0],
        at[:, :0],
        *_labels(data, clips, flipped, config),
        torch.from_numpy(marks),
        torch.from_numpy(marks),
        torch.from_numpy(meant),
        None if moved is None else torch.full_like(moved[: len(clips)], torch.nan),  # guides tell it
        Guided(maps, flow.float(), told.float(), at),
        torch.from_numpy(clips),
    )


def _labels(
    data: Dataset, clips: NDArray[np.int64], flipped: NDArray[np.bool_], config: TrainConfig
) -> tuple[Tensor, Tensor, Tensor, Tensor]:
    """What is known of clips, of which some are seen in the mirror: professional, liked, classes, hints."""
    classes, hints = data.classes[clips], data.hints[1][clips]
    turned = np.array([name.startswith(MIRRORED) for name in data.hints[0]], bool)
    hints[np.ix_(flipped, turned)] *= -1
    mirror = np.array([*mirror_words(data.words.movements), -1])  # the last for what is not known
    classes[flipped, 0] = mirror[classes[flipped, 0]]
    professional = data.professional[clips] * (1 - config.graded * (1 - data.grade[clips]))
    professional = np.where(data.doubtful[clips], np.nan, professional)
    known = (professional.astype(np.float32), data.liked[clips], classes, hints)
    good, liked, words, told = (torch.from_numpy(part) for part in known)
    return good, liked, words, told


def _times(data: Dataset) -> NDArray[np.float32]:
    """Places of the frames in a clip's time, 0..1."""
    return frame_times(ModelConfig((), (), (), frames=data.frames)).numpy()


@dataclass(frozen=True, eq=False)
class _View:
    """A clip as it is looked at once.

    pictures: uint8 [query + key frames, S, S, 3]; times: of these; marks: of the query's frames
    guides: None in a set without; told_at, mapped, meant: times and marks of the frames they are of, and
        whether these are meant to show the subject
    flipped: whether it is seen in the mirror; kept_back: whether its guides are not to be known
    """

    pictures: NDArray[np.uint8]
    times: NDArray[np.float32]
    marks: NDArray[np.float32]
    guides: Guides | None
    told_at: NDArray[np.float32]
    mapped: NDArray[np.float32]
    meant: NDArray[np.float32]
    flipped: bool
    kept_back: bool


def _view(
    data: Dataset,
    index: int,
    size: int,
    counts: tuple[int, int],
    glanced: bool,
    config: TrainConfig,
    rng: np.random.Generator,
) -> _View:
    """counts: frames of query and key; glanced: whether guides are told of the query's frames alone"""
    count, keyed = counts
    times = _times(data)
    chosen = rng.permutation(data.frames)
    picked = np.concatenate([np.sort(chosen[:count]), np.sort(chosen[count : count + keyed])])
    pictures = data.clip(index, picked.tolist(), size)
    pictures, flipped = varied(pictures, rng) if config.augment else (pictures, False)
    marks = data.frame_hints[1][index]
    if flipped:
        marks = np.where([name.startswith(MIRRORED) for name in data.frame_hints[0]], -marks, marks)
    guides = data.guides(np.array([index])) if config.guides else None
    seen = picked[:count] if glanced else np.arange(data.frames)
    kept_back = guides is not None and bool(rng.random() < config.unguided or not data.guided[index])
    if guides is not None:
        guides = guides.mirrored() if flipped else guides
        unknown = np.float16(np.nan if glanced or kept_back else 1)
        guides = Guides(
            guides.maps[:, seen] * np.uint8(not kept_back), guides.flow * unknown, guides.marks[:, seen]
        )
    known = np.float32(np.nan if kept_back else 1)
    mapped, meant = marks[seen] * known, data.meant[index][seen] * known
    return _View(
        pictures, times[picked], marks[picked[:count]], guides, times[seen], mapped, meant, flipped, kept_back
    )


def _guided(views: list[_View]) -> Guided | None:
    """Guides of a batch; None in a set without."""
    found = [view.guides for view in views if view.guides is not None]
    if not found:
        return None
    guides = joined(found)
    flow = torch.from_numpy(guides.flow).float()
    times, marks = np.stack([v.told_at for v in views]), torch.from_numpy(guides.marks).float()
    return Guided(torch.from_numpy(guides.maps), flow, marks, torch.from_numpy(times))


def varied(clip: NDArray[np.uint8], rng: np.random.Generator) -> tuple[NDArray[np.uint8], bool]:
    """The clip uint8 [T, H, W, 3] in another light and perhaps mirrored; whether it was.

    Brightness, contrast and the colours say nothing about how well a shot is taken.
    """
    gain = rng.uniform(0.85, 1.15) * rng.uniform(0.95, 1.05, 3)
    gray = max(0.0, rng.uniform(-0.5, 1.0))
    mixed = gain[:, None] * ((1 - gray) * np.eye(3) + gray * np.asarray(_LUMA))
    lift = rng.uniform(-18, 18) + 128 - 128 * gain
    count, height, width = clip.shape[:3]
    tall = np.ascontiguousarray(clip).reshape(count * height, width, 3)
    turned = cv2.transform(tall, np.column_stack([mixed, lift]))
    out = np.asarray(turned, np.uint8).reshape(clip.shape)
    flipped = bool(rng.random() < 0.5)
    return (out[:, :, ::-1] if flipped else out), flipped


def mirror_words(words: tuple[str, ...]) -> list[int]:
    """For each word the index of its mirror image: ``pan-left`` for ``pan-right``, itself for most."""
    swap = {"left": "right", "right": "left"}
    mirrored = ["-".join(swap.get(part, part) for part in word.split("-")) for word in words]
    return [words.index(m) if m in words else i for i, m in enumerate(mirrored)]
