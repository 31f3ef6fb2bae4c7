"""Beginning a training with other weights: what of them a network has a place for.

Numbers of L_h have names; where a training set tells others than the one the weights were taught by, what
belongs to those of the same name is kept, and the rest begins anew.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import torch
from torch import Tensor

from .composed import SUMMED, WINDOWED
from .config import ModelConfig
from .crowd import CROWDED
from .errors import RankerError
from .framed import FRAMED
from .guided import GuideNet, People
from .model import ShotRanker
from .weights import load_tensors

#: Parameters with an entry for each number of L_h: along which axis, and which numbers these are.
_TOLD = {"reader": 0, "reader_guided": 0, "reader_moved": 0, "straight": 0, "reasons": 1, "reasons_guided": 1}
_FAULTS = ("faults", "faults_guided")
#: What a column reads: a part, which of several such, and which number of it.
_Column = tuple[str, int, int]


def take_over(
    model: ShotRanker, folder: str | Path, hints: Sequence[str] = ()
) -> tuple[str, dict[str, Tensor]]:
    """Give a network all of other weights that it has a place for; their digest, and what was taken of them.

    hints: names of the numbers of L_h in the network's order; what is taken of a parameter that has entries
    for others too is NaN there. Raises :class:`RankerError` for weights of another kind of network.
    """
    other, card = load_tensors(folder)
    ours = model.state_dict()
    words, others = model.config, card.model
    if words.backbone != others.backbone:
        raise RankerError(
            f"{folder}: are weights of a {others.backbone}, and no {words.backbone} can start from them"
        )
    told: list[str] = list(card.data.get("hints") or ())
    if model.guided is not None:
        crowded = _crowded(model, words, others, other)
        before = _columns(model.guided, words, others, crowded)
        now = _columns(model.guided, words, words, CROWDED)
        for name in (name for name in now if name in other and name in ours and before[name] != now[name]):
            if other[name].shape[1] != len(before[name]) or ours[name].shape[1] != len(now[name]):
                continue
            other[name], new = _placed(other[name], before[name], now[name])
            ours[name][:, new] = 0.0  # so that it says nothing at first
    if told != list(hints) and len(told) == others.measures and len(hints) == words.measures and told:
        other = {k: _in_order(k, v, ours.get(k), (told, others), (hints, words)) for k, v in other.items()}
    fit = {k: v for k, v in other.items() if k in ours and v.shape == ours[k].shape}
    for name in ("movement", "scale", "angle"):  # an output is of a word
        if getattr(words, f"{name}s") != getattr(others, f"{name}s"):
            fit = {k: v for k, v in fit.items() if not k.startswith(name)}
    model.load_state_dict(ours | {k: v.where(v.isfinite(), ours[k]) for k, v in fit.items()})
    return card.sha256, fit


def _crowded(model: ShotRanker, own: ModelConfig, config: ModelConfig, other: Mapping[str, Tensor]) -> int:
    """How many numbers told how people stand to each other when other weights were taught: the first of
    those there are now."""
    if model.guided is None or "straight.weight" not in other:
        return CROWDED
    without = len(_columns(model.guided, own, replace(config, crowd=False), 0)["straight.weight"])
    return other["straight.weight"].shape[1] - without if config.crowd else CROWDED


def _columns(
    guided: GuideNet, own: ModelConfig, config: ModelConfig, crowded: int
) -> dict[str, list[_Column]]:
    """What the columns of matrices that read what is told by guides are of, in a network of that config.

    guided: that part of a network whose config is ``own``; crowded: numbers of how people stand to each other
    """
    frame = guided.frame + (config.people - own.people) * People.described
    window = WINDOWED * guided.frame + FRAMED if own.meant else 0
    rest = guided.shot - SUMMED * guided.frame - window - CROWDED * own.crowd
    described = [("frame", 0, i) for i in range(frame)]
    shot = [("summed", k, i) for k in range(SUMMED) for i in range(frame)]
    shot += [("moved", 0, i) for i in range(rest)]
    if config.meant:
        shot += [("meant", k, i) for k in range(WINDOWED) for i in range(frame)]
        shot += [("framed", 0, i) for i in range(FRAMED)]
    shot += [("crowd", 0, i) for i in range(crowded * config.crowd)]
    found = {"gathered.0.weight": shot, "straight.weight": shot, "marker_guided.weight": described}
    if guided.window is not None:
        more = guided.window.frame.in_features - guided.frame
        found["guided.window.frame.weight"] = [*described, *(("moment", 0, i) for i in range(more))]
    return found


def _placed(value: Tensor, before: list[_Column], now: list[_Column]) -> tuple[Tensor, list[int]]:
    """A matrix with the columns of now, NaN in those that are new; which these are."""
    places = {column: k for k, column in enumerate(before)}
    from_ = [places.get(column, -1) for column in now]
    new = [k for k, place in enumerate(from_) if place < 0]
    out = value[:, from_]
    out[:, new] = torch.nan
    return out, new


def _in_order(
    name: str,
    value: Tensor,
    ours: Tensor | None,
    before: tuple[Sequence[str], ModelConfig],
    now: tuple[Sequence[str], ModelConfig],
) -> Tensor:
    """A parameter with its entries for numbers of L_h in the order of now; NaN for those that are new."""
    whose = name.split(".")[0]
    steps = name.split(".")[1:]
    if ours is None or (whose not in _FAULTS and whose not in _TOLD) or steps[:1] == ["3"]:
        return value
    if whose in _TOLD and whose.startswith("reasons") and steps != ["0", "weight"]:
        return value
    axis = _TOLD.get(whose, 0)
    old, new = ([*names] if whose in _TOLD else list(names[c.of_faults]) for names, c in (before, now))
    first = value.shape[axis] - len(old) if whose == "straight" else 0
    places = {word: k for k, word in enumerate(old)}
    out = torch.full_like(ours, torch.nan, dtype=value.dtype).movedim(axis, 0)
    given = value.movedim(axis, 0)
    out[:first] = given[:first]
    for k, word in enumerate(new):
        if word in places:
            out[first + k] = given[first + places[word]]
    out[first + len(new) :] = given[first + len(old) :]
    return out.movedim(0, axis).contiguous()
