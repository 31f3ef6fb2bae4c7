"""Training, from clips to weights: read it from top to bottom.

Assumes a training set written by :class:`ranker.data.ShardWriter`. Leaves ``weights/`` (to be loaded
by :class:`ranker.infer.Ranker`), ``log.jsonl``, ``curves.svg`` and ``checkpoint.pt`` in the output folder.
Stopped at any time, it goes on from the last whole epoch with the same result as if it had not been stopped.
"""

from __future__ import annotations

import json
import math
import os
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from .batches import Batch, batches, count_of
from .config import APPEALING, LIKING, PAPER, ModelConfig, Phase, TrainConfig, to_json
from .curves import draw_curves
from .data import Dataset
from .dictionary import Dictionary, follow, momentum_copy
from .engine import quick_bfloat16
from .errors import RankerError
from .evaluate import agreement_with_fp32, evaluate, mean
from .guided import Guided
from .heads import teach_heads
from .infer import Ranker, fold_batch_norm
from .int8 import Ranges, measured_ranges
from .losses import (
    binary_loss,
    class_loss,
    contrast_loss,
    fault_loss,
    hint_loss,
    liking_loss,
    measures_loss,
)
from .model import OF_GUIDES, ShotRanker, frame_times, normalised
from .motion import motions
from .starting import take_over
from .weights import load_model, save_weights

#: Clips by which eight bits are fitted, and by which they are compared with float32.
_MEASURED, _COMPARED = 64, 200
_APPEAL = "good_all"  # the measure that says how well a shot is composed
_WIDE_PACE = 0.1  # of the learning rate, for layers that read all that describes a shot
#: Seconds of work that a checkpoint has to be worth: short epochs do not all write one.
_WORTH_KEEPING = 20.0
#: Clips by which one tells what is usual in guides.
_USUAL = 4096
#: Clips looked at together when eight bits are fitted.
_TOGETHER = 8
Report = Callable[[dict[str, Any]], None]


def train(
    data_dir: str | Path,
    out_dir: str | Path,
    config: TrainConfig = PAPER,
    report: Report | None = None,
    start: str | Path | None = None,
) -> dict[str, Any]:
    """Train a ranker and return what it measures on the held-out groups.

    start: a folder of weights to start from, as far as they fit; without one they are random
    report: called with every line of the log: ``epoch``, ``step``, ``steps``, ``loss`` and its parts,
    ``held_out`` (accuracies on some of the held-out clips, at the phase's size), ``seconds``; at last
    ``measured``
    """
    out = Path(out_dir)
    out.mkdir(parents=True, exist_ok=True)
    check_start(config, start)
    torch.set_num_threads(config.threads)
    torch.manual_seed(config.seed)
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")

    # The clips: whole groups are kept back.
    data = Dataset(data_dir)
    learn, held = data.split(config.held_out, config.seed)
    held = held[~data.bare[held]]
    framed = learn[~data.bare[learn]]  # the others are for phases that look at guides alone
    guided = learn[data.guided[learn]]  # films of cameras are for those that look at pictures
    if len(framed) < 2:
        raise RankerError(f"{data_dir}: there are too few clips to train on")

    # The network, the encoder of the keys that follows it, and the dictionary of keys.
    words = data.words
    taught_of = list(data.hints[0]) if config.hint_weight else []
    liking = LIKING if config.order_weight and np.isfinite(data.liked).any() else 0.0
    shape = ModelConfig(
        words.movements,
        words.scales,
        words.angles,
        config.backbone,
        data.frames,
        config.size,
        min(config.inner, config.size),
        motion=config.motion,
        moments=config.moments,
        measures=len(taught_of),
        first_fault=data.faults.start if config.hint_weight else 0,
        faults=data.faults.stop - data.faults.start if config.hint_weight else 0,
        marks=len(data.frame_hints[0]) if config.hint_weight and data.hints[0] else 0,
        guides=config.guides if len(guided) else 0,
        meant=_tells_meant(config, data),
        people=config.guides > 0 and len(guided) > 0,
        crowd=config.guides > 0 and len(guided) > 0,
        liking=liking,
        appeal=taught_of.index(_APPEAL) if _APPEAL in taught_of else 0,
        appealing=APPEALING if liking and _APPEAL in taught_of else 0.0,
    )
    if not shape.guides and any(phase.size == 0 for phase in config.phases):
        config = replace(config, phases=tuple(phase for phase in config.phases if phase.size))
        if not config.phases:
            raise RankerError(f"{data_dir}: its clips have no guides, and the recipe looks at nothing else")
    moved = torch.from_numpy(motions(data)) if config.motion else None
    model = ShotRanker(shape)
    began, anchor = take_over(model, start, data.hints[0]) if start else (None, {})
    if config.phases:  # heads alone go by what was usual before
        settle(model, data, guided, config.seed)
    model.to(device)
    model.to(memory_format=torch.channels_last)  # type: ignore[call-overload]
    keys = momentum_copy(model)
    dictionary = Dictionary(config.dictionary, shape.contrast, config.seed).to(device)
    optimizer = _optimizer(model, config)

    # Where an earlier run stopped.
    schedule = [phase for phase in config.phases for _ in range(phase.epochs)]
    pools = [framed if phase.size else guided for phase in schedule]
    # Guides are taught by many more clips than have pictures, which do not change what that taught.
    apart = any(phase.size == 0 for phase in schedule)
    lengths = [math.ceil(count_of(data, *of) / of[1].batch) for of in zip(pools, schedule, strict=True)]
    state = out / "checkpoint.pt"
    learning = {"model": model, "keys": keys, "dictionary": dictionary, "optimizer": optimizer}
    done, step = _resume(state, config, learning)
    clock = kept = time.monotonic()

    with (out / "log.jsonl").open("a", encoding="utf-8") as log:
        for epoch in range(done, len(schedule)):
            phase = schedule[epoch]
            torch.manual_seed(config.seed + 1 + epoch)  # what is dropped out hangs on the epoch alone
            model.train()
            sums = np.zeros(6)
            alike = [n for n, other in enumerate(schedule) if (other.size > 0) == (phase.size > 0)]
            before, total = (sum(lengths[n] for n in alike if n < m) for m in (epoch, len(schedule)))
            for number, batch in enumerate(batches(data, pools[epoch], phase, config, epoch, moved)):
                for group in optimizer.param_groups:
                    pace = 0.0 if apart and group["guided"] and phase.size else 1.0
                    group["lr"] = pace * group["pace"] * learning_rate(config, before + number, total)

                parts = _losses(model, keys, dictionary, batch, config, device, data.goods)
                loss = parts[0] + config.class_weight * parts[1] + config.contrast_weight * parts[2]
                loss = loss + config.hint_weight * parts[3] + config.order_weight * parts[4]
                optimizer.zero_grad(set_to_none=True)
                loss.backward()
                nn.utils.clip_grad_norm_(model.parameters(), 5.0)
                optimizer.step()
                if batch.query is not None:
                    follow(keys, model, config.momentum)

                step += 1
                sums += [float(loss.detach()), *(float(p.detach()) for p in parts)]

            names = ("loss", "binary", "class", "contrast", "hint", "order")
            line: dict[str, Any] = {
                "epoch": epoch + 1,
                "epochs": len(schedule),
                "size": phase.size,
                "step": step,
            }
            line |= {n: round(float(v) / lengths[epoch], 5) for n, v in zip(names, sums, strict=True)}
            line["held_out"] = watch(model, data, held, phase.size, config, device, moved)
            if phase.size and shape.guides:  # and by pictures alone, as real clips are judged
                alone = replace(config, unguided=1.0)
                line["pictures_alone"] = watch(model, data, held, phase.size, alone, device, moved)
            line |= {"steps": sum(lengths), "seconds": round(time.monotonic() - clock, 1)}
            _tell(log, line, report)
            draw_curves(out)
            if epoch + 1 == len(schedule) or time.monotonic() - kept >= _WORTH_KEEPING:
                _keep(state, config, learning, epoch + 1, step)
                kept = time.monotonic()

        with torch.no_grad():  # after the checkpoint, so that a run that goes on does it once
            for name, parameter in model.named_parameters():
                if name in anchor:
                    first = anchor[name].to(parameter)  # NaN where there is nothing to go back to
                    parameter.lerp_(first.where(first.isfinite(), parameter), config.anchored)
        if config.heads:
            teach_heads(model.cpu(), data, learn, config, lambda told: _tell(log, told, report))
        # Small pictures leave batch norm with the wrong statistics for full ones.
        if config.phases:
            calibrate(model.to(device), data, framed, config, device)
        ranges = int8_ranges(model.cpu(), data, framed, config.seed)
        save_weights(out / "weights", model, ranges=ranges)

        # Measured as it will be used: from the disk.
        measured: dict[str, Any] = {"clips": 0}
        if len(held):
            ranker, model = Ranker.load(out / "weights", "cpu"), load_model(out / "weights")[0]
            some = np.random.default_rng(config.seed).permutation(held)[:_COMPARED]
            measured = evaluate(ranker, data, held)
            measured |= {
                "engine": ranker.engine,
                "spearman_fp32": agreement_with_fp32(model, ranker, data, some),
            }
        _tell(log, {"measured": measured}, report)

    training = to_json(config) | ({"start": began} if began else {})
    about = {"training": training, "data": data.about(), "measured": measured}
    save_weights(out / "weights", model, **about, ranges=ranges)
    return measured


def check_start(config: TrainConfig, start: str | Path | None) -> None:
    """Raises :class:`RankerError` for a recipe that teaches on top of weights, without such."""
    if config.heads and not config.phases and start is None:
        raise RankerError("heads alone are taught on top of weights: name some to start from (--weights)")


def _tells_meant(config: TrainConfig, data: Dataset) -> bool:
    """Whether a network learns which frames are meant to show the subject."""
    taught = config.hint_weight > 0 and bool(data.hints[0]) and bool(np.isfinite(data.meant).any())
    return taught and config.guides > 0 and bool(data.guided.any())


def settle(model: ShotRanker, data: Dataset, clips: NDArray[np.int64], seed: int = 0) -> None:
    """Tell a network what is usual in guides of good clips, from some of the clips."""
    some = np.random.default_rng(seed).permutation(clips)[:_USUAL]
    guides = data.guides(np.sort(some)) if model.guided is not None else None
    if model.guided is not None and guides is not None:
        good = torch.from_numpy(data.professional[np.sort(some)] > 0.5)
        model.guided.fit(Guided.of(guides, frame_times(model.config)), good)


def int8_ranges(model: ShotRanker, data: Dataset, clips: NDArray[np.int64], seed: int = 0) -> Ranges:
    """What computing in eight bits needs to know of a network: its outputs on some of the clips."""
    some = np.random.default_rng(seed).permutation(clips)[:_MEASURED]
    size, at = model.config.inner, (0, data.frames // 2)
    groups = (some[i : i + _TOGETHER] for i in range(0, len(some), _TOGETHER))
    pictures = [
        normalised(torch.from_numpy(np.concatenate([data.clip(int(i), at, size) for i in group])))
        for group in groups
    ]
    return measured_ranges(fold_batch_norm(model.backbone), pictures)


def learning_rate(config: TrainConfig, step: int, steps: int) -> float:
    """A straight warm-up, then half a cosine down to a hundredth."""
    warm = max(1, round(config.warmup * steps))
    if step < warm:
        return config.learning_rate * (step + 1) / warm
    along = (step - warm) / max(1, steps - warm)
    return config.learning_rate * (0.01 + 0.99 * 0.5 * (1 + math.cos(math.pi * along)))


@torch.no_grad()
def watch(
    model: ShotRanker,
    data: Dataset,
    held: NDArray[np.int64],
    size: int,
    config: TrainConfig,
    device: torch.device,
    moved: Tensor | None = None,
) -> dict[str, float | None]:
    """Shares of some of the held-out clips that are judged rightly, at a picture size: for the curves."""
    some = np.random.default_rng(config.seed).permutation(held)[: config.watched]
    phase = Phase(1, size, data.frames, 0, batch=16)
    plain = replace(config, augment=False, contrast_weight=0.0, unguided=float(config.unguided == 1.0))
    was = model.training
    model.eval()
    right: list[NDArray[np.float64]] = []
    for batch in batches(data, some, phase, plain, -1, moved) if len(some) else ():
        with _autocast(config, device):
            out = model(*_seen(batch, device))
        good, classes = batch.professional.numpy() > 0.5, batch.classes.numpy()
        found = np.stack([p.argmax(1).cpu().numpy() for p in (out.movement, out.scale, out.angle)], 1)
        known = (classes >= 0) & good[:, None]
        judged = ((out.logit > 0).cpu().numpy() == good).astype(float)[:, None]
        judged[batch.professional.isnan().numpy()] = np.nan
        right.append(np.concatenate([judged, np.where(known, found == classes, np.nan)], 1))
    model.train(was)
    if not right:
        return {}
    columns = zip(("professional", "movement", "scale", "angle"), np.concatenate(right).T, strict=True)
    return {name: mean(column) for name, column in columns}


@torch.no_grad()
def calibrate(
    model: ShotRanker, data: Dataset, clips: NDArray[np.int64], config: TrainConfig, device: torch.device
) -> None:
    """Take batch-norm statistics anew, from ``config.calibration`` batches as large as at inference."""
    norms = [m for m in model.modules() if isinstance(m, nn.BatchNorm2d)]
    kept = [m.momentum for m in norms]
    phase = Phase(1, model.config.inner, frames=2, key_frames=0, batch=16)
    for norm in norms:
        norm.reset_running_stats()
        norm.momentum = None  # the plain average of all batches
    model.train()
    for count, batch in enumerate(batches(data, clips, phase, config, epoch=-1)):
        if count == config.calibration:
            break
        with _autocast(config, device):
            assert batch.query is not None
            model(normalised(batch.query.to(device)), batch.query_times.to(device))
    for norm, momentum in zip(norms, kept, strict=True):
        norm.momentum = momentum
    model.eval()


def _autocast(config: TrainConfig, device: torch.device) -> torch.autocast:
    """Compute in bfloat16, if that is wanted and the machine is not slower by it."""
    wanted = config.autocast and quick_bfloat16(device.type)
    return torch.autocast(device.type, torch.bfloat16, enabled=wanted)


def _seen(batch: Batch, device: torch.device) -> tuple[Tensor | None, Tensor, Tensor | None, Guided | None]:
    """What the network sees of a batch."""
    moved = None if batch.moved is None else batch.moved.to(device)
    guides = None if batch.guides is None else Guided(*(part.to(device) for part in batch.guides))
    pictures = None if batch.query is None else normalised(batch.query.to(device))
    return pictures, batch.query_times.to(device), moved, guides


def _losses(
    model: ShotRanker,
    keys: ShotRanker,
    dictionary: Dictionary,
    batch: Batch,
    config: TrainConfig,
    device: torch.device,
    goods: slice,
) -> tuple[Tensor, Tensor, Tensor, Tensor, Tensor]:
    """L_b, L_c, L_q, L_h and L_o of a batch; its keys go into the dictionary afterwards.

    goods: which of the numbers of L_h say how good a shot is by each criterion
    """
    with _autocast(config, device):
        out = model(*_seen(batch, device))
    binary = binary_loss(out.logit, batch.professional.to(device), config.smoothing)
    labels = tuple(batch.classes.to(device).unbind(1))
    classes = class_loss((out.movement, out.scale, out.angle), labels, config.smoothing)
    hint = torch.zeros((), device=device)
    if config.hint_weight and batch.hints.shape[1]:
        hints, faults = batch.hints.to(device), model.config.of_faults
        hint = measures_loss(out.told, hints, faults, goods, config.fault_weight, config.good_weight)
        if out.marked.shape[2] and batch.query is not None:
            hint = hint + hint_loss(out.marked, batch.marks.to(device))
        if out.mapped.shape[2]:
            hint = hint + hint_loss(out.mapped, batch.mapped.to(device))
        if out.meant.shape[1]:
            hint = hint + fault_loss(out.meant, batch.meant.to(device))
    order = torch.zeros((), device=device)
    if config.order_weight:
        order = liking_loss(out.liked, batch.liked.to(device))
    if config.contrast_weight == 0 or batch.query is None:
        return binary, classes, torch.zeros((), device=device), hint, order
    with torch.no_grad(), _autocast(config, device):
        key = keys(normalised(batch.key.to(device)), batch.key_times.to(device)).contrast
    clips = batch.clips.to(device)
    others = dictionary.vectors.clone()
    contrast = contrast_loss(out.contrast, key, others, config.temperature, dictionary.same(clips))
    dictionary.push(key, clips)
    return binary, classes, contrast, hint, order


def _optimizer(model: ShotRanker, config: TrainConfig) -> torch.optim.Optimizer:
    kinds: dict[tuple[bool, bool, bool], list[nn.Parameter]] = {}
    for name, p in model.named_parameters():
        # what sums up thousands of features would leap at the pace of the rest
        wide, guided = p.ndim == 2 and p.shape[1] >= 3 * model.width, name.startswith(OF_GUIDES)
        kinds.setdefault((p.ndim > 1, wide, guided), []).append(p)
    groups = [
        {
            "params": params,
            "weight_decay": config.weight_decay if decays else 0.0,
            "pace": _WIDE_PACE if wide else 1.0,
            "guided": guided,
        }
        for (decays, wide, guided), params in kinds.items()
    ]
    if config.optimizer == "adamw":
        return torch.optim.AdamW(groups, lr=config.learning_rate)
    if config.optimizer == "sgd":
        return torch.optim.SGD(groups, lr=config.learning_rate, momentum=0.9, nesterov=True)
    raise RankerError(f"unknown optimizer {config.optimizer!r}: adamw or sgd")


def _keep(
    path: Path,
    config: TrainConfig,
    learning: dict[str, Any],
    epochs: int,
    step: int,
) -> None:
    part = path.with_suffix(".part")
    states = {name: value.state_dict() for name, value in learning.items()}
    try:
        torch.save({"config": json.dumps(to_json(config)), "epochs": epochs, "step": step, **states}, part)
        os.replace(part, path)
    except (OSError, RuntimeError) as error:
        part.unlink(missing_ok=True)
        raise RankerError(f"{path}: cannot be written: {error}") from error


def _resume(
    path: Path,
    config: TrainConfig,
    learning: dict[str, Any],
) -> tuple[int, int]:
    """Epochs and steps done by an earlier run with the same settings, its state loaded."""
    if not path.exists():
        return 0, 0
    try:
        state = torch.load(path, map_location="cpu", weights_only=True)
        if state["config"] != json.dumps(to_json(config)):
            raise RankerError(
                f"{path}: is of a training with other settings; name another folder or remove it"
            )
        for name, value in learning.items():
            value.load_state_dict(state[name])
        return int(state["epochs"]), int(state["step"])
    except RankerError:
        raise
    except Exception as error:  # whatever a damaged file makes torch raise
        raise RankerError(f"{path}: is damaged; remove it to start anew") from error


def _tell(log: Any, line: dict[str, Any], report: Report | None) -> None:
    log.write(json.dumps(line) + "\n")
    log.flush()
    if report is not None:
        report(line)
