"""Beginning a training with other weights: what of them a network has a place for.

Numbers of L_h have names; where a training set tells others than the one the weights were taught by, what
belongs to those of the same name is kept, and the rest begins anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import torch
from torch import Tensor

from .composed import WINDOWED
from .config import ModelConfig
from .errors import RankerError
from .model import ShotRanker
from .weights import load_tensors

#: Parameters with an entry for each number of L_h: along which axis, and which numbers these are.
_TOLD = {"reader": 0, "reader_guided": 0, "reader_moved": 0, "straight": 0, "reasons": 1, "reasons_guided": 1}
_FAULTS = ("faults", "faults_guided")
#: Those that read all that describes a shot by its guides.
_READ = ("gathered.0.weight", "straight.weight")


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
    if words.meant != others.meant and model.guided is not None:
        more = WINDOWED * model.guided.frame  # what is read of these frames comes last
        for name in (name for name in _READ if name in other and name in ours):
            given, wide = other[name], ours[name].shape[1]
            if words.meant and given.shape[1] + more == wide:
                other[name] = _widened(given, wide)
                ours[name][:, given.shape[1] :] = 0.0  # so that it says nothing at first
            elif others.meant and given.shape[1] == wide + more:
                other[name] = given[:, :wide]
    if told != list(hints) and len(told) == others.measures and len(hints) == words.measures and told:
        other = {k: _in_order(k, v, ours.get(k), (told, others), (hints, words)) for k, v in other.items()}
    fit = {k: v for k, v in other.items() if k in ours and v.shape == ours[k].shape}
    for name in ("movement", "scale", "angle"):  # an output is of a word
        if getattr(words, f"{name}s") != getattr(others, f"{name}s"):
            fit = {k: v for k, v in fit.items() if not k.startswith(name)}
    model.load_state_dict(ours | {k: v.where(v.isfinite(), ours[k]) for k, v in fit.items()})
    return card.sha256, fit


def _widened(value: Tensor, columns: int) -> Tensor:
    """A matrix with so many columns, NaN in those that are new."""
    out = value.new_full((value.shape[0], columns), torch.nan)
    out[:, : value.shape[1]] = value
    return out


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
