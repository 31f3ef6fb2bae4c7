"""The last layers taught alone, while what describes a shot stays as it is.

Whoever describes the clips they were taught by knows these too well: of such clips faults are told right that
are told wrong of others, and heads that learn from them believe what they are told. Clips of other stories,
by which the rest was not taught, show the heads what it is worth (stacking, Wolpert 1992; last layers taught
anew, Kirichenko et al. 2022, "Last layer re-training"). Assumes weights that others taught, and a set of
clips that they were not taught by. Guarantees that descriptions of frames and shots, and what is told by
pictures alone, do not change.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from .batches import batches
from .config import Phase, TrainConfig
from .data import Dataset
from .errors import RankerError
from .guided import Guided
from .losses import binary_loss, class_loss, liking_loss, measures_loss
from .model import ShotRanker

#: Learning rates: of what heads add, of their sizes, and of those that judge by what is told.
_RATE, _SIZES, _JUDGES = 1e-3, 3e-3, 3e-4
_KEPT = 0.03  # what it costs to leave what heads were, by squared deviations
_FRESH = 5.0  # by how much quicker they learn what nothing was read of before: there is nothing to leave
_FAULTS = 4.0  # what faults count beside what they do else
_READ = ("straight", "gathered.0")  # what reads descriptions of shots
_WARM = 0.1  # share of the steps in which the learning rate rises
_BATCH = 1024


@dataclass(frozen=True, eq=False)
class _Known:
    """Clips as heads see them: what describes them, [N, D] in half precision, the fused marks [N, M], and
    labels as in :class:`ranker.batches.Batch`."""

    described: Tensor
    marked: Tensor
    professional: Tensor
    liked: Tensor
    classes: Tensor
    hints: Tensor


def teach_heads(
    model: ShotRanker,
    data: Dataset,
    clips: NDArray[np.int64],
    config: TrainConfig,
    report: Callable[[dict[str, Any]], None] | None = None,
) -> None:
    """Teach what a network tells and judges by guides, ``config.heads`` times over these clips.

    report: called after each time with its number and the mean loss. Clips without guides are left out.
    Raises :class:`RankerError` for weights or clips without guides or measures.
    """
    clips = clips[data.guided[clips]]
    if model.guided is None or not model.config.measures or not len(clips):
        raise RankerError("heads alone are taught by guides and what is known in numbers: there are none")
    model.eval()
    known = _described(model, data, clips, config)
    added = _Added(known.described, model)
    judges = [*model.reasons_guided.parameters(), model.faults_guided]
    paces = [(_RATE, [added.deltas]), (_SIZES, [added.size, added.shift]), (_JUDGES, judges)]
    optimizer = torch.optim.Adam([{"params": params, "lr": pace} for pace, params in paces])
    was = {p: p.requires_grad for p in model.parameters()}
    for parameter in was:
        parameter.requires_grad_(any(parameter is own for own in judges))
    count = math.ceil(len(clips) / _BATCH)
    for epoch in range(config.heads):
        total = 0.0
        model.reasons_guided.train()
        for number, rows in enumerate(_shuffled(len(clips), config.seed + epoch)):
            pace = _pace((epoch * count + number) / (config.heads * count))
            for group, (rate, _) in zip(optimizer.param_groups, paces, strict=True):
                group["lr"] = rate * pace
            loss = _loss(model, added, known, rows, config, data.goods) + _KEPT * added.left
            optimizer.zero_grad(set_to_none=True)
            loss.backward()
            nn.utils.clip_grad_norm_([p for _, params in paces for p in params], 5.0)
            optimizer.step()
            total += float(loss.detach())
        if report:
            report({"heads": epoch + 1, "epochs": config.heads, "loss": round(total / count, 5)})
    for parameter, asked in was.items():
        parameter.requires_grad_(asked)
    added.settle(model)
    model.eval()


class _Added(nn.Module):
    """What heads tell beside what they told: weights of deviations from the usual, and another size of it."""

    def __init__(self, described: Tensor, model: ShotRanker) -> None:
        super().__init__()
        some = described[:: max(1, len(described) // 20_000)].float()
        self.middle, self.spread = some.mean(0), some.std(0) + 1e-2
        self.known = torch.ones(described.shape[1], dtype=torch.bool)
        readers = torch.cat([model.get_parameter(f"{name}.weight").detach() for name in _READ])
        self.known[: readers.shape[1]] = readers.abs().amax(0) > 0
        self.spread = torch.where(self.known, self.spread, self.spread / _FRESH)
        rows = len(model.straight.weight)
        self.deltas = nn.Parameter(torch.zeros(rows, described.shape[1]))
        self.size, self.shift = nn.Parameter(torch.ones(rows)), nn.Parameter(torch.zeros(rows))

    def forward(self, described: Tensor, before: Tensor) -> Tensor:
        """described [B, D]; before [B, rows]: what heads told of them before"""
        usual = (described - self.middle) / self.spread
        return before * self.size + usual @ self.deltas.T + self.shift

    @property
    def left(self) -> Tensor:
        """How far heads have left what they told of what they read before."""
        return self.deltas[:, self.known].square().sum()

    @torch.no_grad()
    def settle(self, model: ShotRanker) -> None:
        """Put it into the heads, so that they tell it by themselves."""
        judged = sum(model.judgements)
        added = self.deltas / self.spread
        shift = self.shift - added @ self.middle
        shot = model.straight.in_features
        model.straight.weight.mul_(self.size.unsqueeze(1)).add_(added[:, :shot])
        for head, rows in ((model.judged, slice(0, judged)), (model.reader_guided, slice(judged, None))):
            head.weight.mul_(self.size[rows].unsqueeze(1)).add_(added[rows, shot:])
            head.bias.mul_(self.size[rows]).add_(shift[rows])


@torch.no_grad()
def _described(model: ShotRanker, data: Dataset, clips: NDArray[np.int64], config: TrainConfig) -> _Known:
    """What describes clips, each as it is seen once."""
    assert model.guided is not None
    found: list[tuple[Tensor, ...]] = []
    for batch in batches(data, clips, Phase(1, 0, batch=512), config, -1):
        assert batch.guides is not None
        told = model.guided(Guided(*batch.guides))
        both = torch.cat([told.shot, model.gathered(told.shot)], 1)
        marked = model.marker_guided(told.frames) if model.config.marks else told.frames[..., :0]
        marked = model.over_time(marked, batch.guides.times)
        labels = (batch.professional, batch.liked, batch.classes, batch.hints)
        found.append((both.half(), marked.half(), *labels))
    return _Known(*(torch.cat(parts) for parts in zip(*found, strict=True)))


def _shuffled(count: int, seed: int) -> Iterator[Tensor]:
    order = torch.randperm(count, generator=torch.Generator().manual_seed(seed))
    yield from order.split(_BATCH)


def _pace(along: float) -> float:
    """A straight warm-up, then half a cosine down to a hundredth."""
    return min(1.0, along / _WARM + 1e-3) * (0.01 + 0.99 * 0.5 * (1 + math.cos(math.pi * along)))


def _loss(
    model: ShotRanker, added: _Added, known: _Known, rows: Tensor, config: TrainConfig, goods: slice
) -> Tensor:
    """L_b + L_c + L_h + L_o, as everything else is taught by."""
    described, hints = known.described[rows].float(), known.hints[rows]
    shot = model.straight.in_features
    gathered = described[:, shot:]
    before = torch.cat([model.judged(gathered), model.reader_guided(gathered)], 1)
    now = added(described, before + model.straight(described[:, :shot]))
    judged, told = now.split((sum(model.judgements), model.config.measures), 1)
    judged = model.by_reasons(judged, told, known.marked[rows].float())
    professional, liked, *classes = judged.split(model.judgements, 1)
    hint = measures_loss(
        told, hints, model.config.of_faults, goods, config.fault_weight + _FAULTS, config.good_weight
    )
    labels = tuple(known.classes[rows].unbind(1))
    loss = binary_loss(professional.squeeze(1), known.professional[rows], config.smoothing)
    loss = loss + config.class_weight * class_loss(tuple(classes), labels, config.smoothing)
    return loss + config.hint_weight * hint + config.order_weight * liking_loss(liked, known.liked[rows])
