"""Scores for shot proposals, as fast as the machine allows.

The backbone runs with batch norm folded into the convolutions, channels last, in the numbers that are
quickest here (:mod:`ranker.engine`): whole numbers, or bfloat16, on a CPU as a frozen graph, or float32.
Fusion and heads stay in float32. Pictures go through in batches of one fixed size, the last one padded, so
that a shot's score does not depend on its company.
"""

from __future__ import annotations

import copy
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn
from torch.nn.utils.fusion import fuse_conv_bn_eval

from .config import ModelConfig
from .data import scaled
from .engine import HIGHEST, engine_for
from .errors import RankerError
from .guided import Guided
from .guides import Guides
from .int8 import Int8Backbone, Ranges
from .model import Output, ShotRanker, frame_times, normalised
from .motion import motion
from .weights import load_model, load_ranges

#: Shots in a batch. On a CPU more are hardly quicker, and bfloat16 convolutions round differently at
#: different places of a batch.
CPU_BATCH, CUDA_BATCH = 1, 32
CPU_THREADS = 2
#: Pictures uint8 [N, S, S, 3] -> features float32 [N, D], for one fixed N.
Encoder = Callable[[Tensor], Tensor]


@dataclass(frozen=True, eq=False)
class Scores:
    """What the ranker says of P shots.

    professional: float32 [P], p_b; logit: float32 [P], its own, which does not saturate
    margin: float32 [P], what puts them in order: the logit, and how much good ones of this kind are liked
    movement, scale, angle: float32 [P, classes], p_c in the order of the model's words
    feature: float32 [P, D], for telling takes apart
    """

    professional: NDArray[np.float32]
    logit: NDArray[np.float32]
    margin: NDArray[np.float32]
    movement: NDArray[np.float32]
    scale: NDArray[np.float32]
    angle: NDArray[np.float32]
    feature: NDArray[np.float32]


class Ranker:
    """A loaded ranker; ``config`` holds its words. Make one with :meth:`load` and keep it.

    ranges: of the network's outputs, which computing in whole numbers needs; engine: in which numbers its
        frame encoder computes, as :func:`ranker.engine.engine_for` names them
    judges_guides: whether guides alone say enough to judge by, since it was taught by some without pictures
    """

    def __init__(
        self,
        model: ShotRanker,
        device: str = "auto",
        ranges: Ranges | None = None,
        judges_guides: bool = False,
    ) -> None:
        self.config: ModelConfig = model.config
        self.device = _device(device)
        self._batch = CPU_BATCH if self.device.type == "cpu" else CUDA_BATCH
        if self.device.type == "cpu":
            torch.set_num_threads(CPU_THREADS)
        self.judges_guides = judges_guides and self.config.guides > 0
        self._model = model.eval().requires_grad_(False).to(self.device)
        self._times = frame_times(self.config).to(self.device)
        folded = fold_batch_norm(self._model.backbone)
        self.engine = engine_for(self.device.type, ranges is not None)
        self._features = self._encoder(folded, ranges)

    @classmethod
    def load(cls, path: str | Path | None = None, device: str = "auto") -> Ranker:
        """The weights in the folder ``path``, or the shipped ones; raises :class:`RankerError`."""
        model, card = load_model(path)
        phases = card.training.get("phases") or ()
        heads = bool(card.training.get("heads"))  # which are taught by guides alone
        alone = heads or any(dict(phase).get("size") == 0 for phase in phases)
        return cls(model, device, load_ranges(path, model, card), alone)

    def fits(self, frames: int, size: int | None = None) -> None:
        """Raises :class:`RankerError` where shots of so many frames, of that size, are not what it judges."""
        c = self.config
        if c.frames != frames or (size is not None and c.size != size):
            drawn = f"{frames} frames" if size is None else f"{frames} frames of {size} × {size}"
            raise RankerError(
                f"these weights judge shots by {c.frames} frames of {c.size} × {c.size}, and not by {drawn}; "
                "train others with `vdsc train`, or go on without the ranker with `--rank geometry`"
            )

    def score(self, frames: NDArray[np.uint8], guides: Guides | None = None) -> Scores:
        """Judge shots: uint8 [P, frames, size, size, 3] sRGB, frames evenly spaced from first to last.

        guides: theirs, where whoever drew them tells; weights that know nothing of such leave them out
        """
        size = self.config.size
        expected = (self.config.frames, size, size, 3)
        if frames.ndim != 5 or frames.shape[1:] != expected or frames.dtype != np.uint8:
            raise ValueError(
                f"expected uint8 [P, {', '.join(map(str, expected))}], got {frames.dtype} {frames.shape}"
            )
        guides = self._used(guides, frames)
        rows = [slice(i, i + self._batch) for i in range(0, max(len(frames), 1), self._batch)]
        parts = [self._score(frames[r], None if guides is None else guides[r]) for r in rows]
        joined = {f.name: np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Scores)}
        return Scores(**joined)

    @torch.inference_mode()
    def glance(self, frames: NDArray[np.uint8], at: Sequence[int], guides: Guides | None = None) -> Scores:
        """Judge shots by some of their frames: uint8 [P, k, size, size, 3], the frames ``at`` of all.

        guides: of these frames. In the last bits scores depend on what is looked at together.
        """
        size, at = self.config.size, list(at)
        if not at or frames.shape[1:] != (len(at), size, size, 3) or frames.dtype != np.uint8:
            raise ValueError(
                f"expected uint8 [P, {len(at)}, {size}, {size}, 3], got {frames.dtype} {frames.shape}"
            )
        flat = frames.reshape(-1, size, size, 3)
        room = self._batch * self.config.frames
        parts = [self._encoded(flat[i : i + room]) for i in range(0, max(len(flat), 1), room)]
        features = torch.cat(parts).view(len(frames), len(at), self._model.described)
        guides, times = self._used(guides, frames), self._times[at]
        guided = None if guides is None else Guided.of(guides, times)
        return self._scores(self._model.judge(features, times.expand(len(frames), -1), None, guided))

    @torch.inference_mode()
    def by_guides(self, guides: Guides) -> Scores:
        """Judge shots nobody has drawn pictures of, by the guides of all their frames; features are zeros.

        In the last bits scores depend on what is looked at together. Raises ValueError for weights that
        need pictures (``judges_guides``).
        """
        if not self.judges_guides:
            raise ValueError("these weights need pictures to judge by")
        count, frames = len(guides), self.config.frames
        guides.check(count, frames, frames)
        nothing = self._times.new_zeros(count, frames, self._model.described)
        times, guided = self._times.expand(count, -1), Guided.of(guides, self._times)
        return self._scores(self._model.judge(nothing, times, None, guided, pictures=False))

    def _used(self, guides: Guides | None, frames: NDArray[np.uint8]) -> Guides | None:
        """The guides of shots, if these weights take any. Raises ValueError where they do not fit the
        frames."""
        if guides is None or not self.config.guides:
            return None
        guides.check(frames.shape[0], frames.shape[1], self.config.frames)
        return guides

    def _encoded(self, pictures: NDArray[np.uint8]) -> Tensor:
        """Features [N, D] of N pictures, no more than go through at once."""
        room, count, side = self._batch * self.config.frames, len(pictures), self.config.inner
        padded = np.zeros((room, side, side, 3), np.uint8)
        padded[:count] = scaled(pictures, side)
        return self._features(torch.from_numpy(padded).to(self.device))[:count]

    @torch.inference_mode()
    def _score(self, frames: NDArray[np.uint8], guides: Guides | None) -> Scores:
        count = len(frames)
        features = self._encoded(frames.reshape(-1, *frames.shape[2:]))
        features = features.view(count, self.config.frames, self._model.described)
        times, moved = self._times.expand(count, -1), None
        if guides is None and self.config.motion:  # guides tell how the camera moves
            moved = motion(torch.from_numpy(frames).to(self.device))
        guided = None if guides is None else Guided.of(guides, self._times)
        return self._scores(self._model.judge(features, times, moved, guided))

    def _scores(self, out: Output) -> Scores:
        classes = (p.softmax(1) for p in (out.movement, out.scale, out.angle))
        told = (out.logit.sigmoid(), out.logit, self._model.margin(out), *classes, out.feature)
        return Scores(*(values.float().cpu().numpy() for values in told))

    def _encoder(self, folded: nn.Module, ranges: Ranges | None) -> Encoder:
        """The frame encoder in the numbers of the engine, or of the next best where this torch lacks them."""
        if ranges is not None and self.engine in HIGHEST:
            room, side = self._batch * self.config.frames, self.config.inner
            try:
                return Int8Backbone(folded, ranges, room, side, HIGHEST[self.engine])
            except (AttributeError, RuntimeError):  # a torch without the operators
                self.engine = engine_for(self.device.type, False)
        return self._floating(folded, torch.bfloat16 if self.engine == "bfloat16" else torch.float32)

    def _floating(self, folded: nn.Module, kind: torch.dtype) -> Encoder:
        """The frame encoder in floating point."""
        backbone = folded.to(kind).to(memory_format=torch.channels_last)  # type: ignore[call-overload]
        frozen = self.device.type == "cpu" and kind is torch.bfloat16  # float32 gains nothing by it
        network = self._frozen(backbone) if frozen else backbone

        def encode(pictures: Tensor) -> Tensor:
            flat = normalised(pictures).to(kind)
            return network(flat.contiguous(memory_format=torch.channels_last)).float()

        return encode

    def _frozen(self, backbone: nn.Module) -> Callable[[Tensor], Tensor]:
        side = self.config.inner
        example = torch.zeros(self._batch * self.config.frames, 3, side, side)
        example = example.to(torch.bfloat16).contiguous(memory_format=torch.channels_last)
        with torch.inference_mode(), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # tracing is deprecated, and still the quickest here
            try:
                graph = torch.jit.optimize_for_inference(
                    torch.jit.trace(backbone, example, check_trace=False)
                )
                graph(example), graph(example)  # the first two runs specialise the graph
            except RuntimeError:
                return backbone
        return graph


def fold_batch_norm(backbone: nn.Module) -> nn.Module:
    """A copy of a ResNet with every batch norm folded into the convolution before it."""
    names = [name for name, module in backbone.named_modules() if isinstance(module, nn.BatchNorm2d)]
    folded = copy.deepcopy(backbone).eval()
    for name in names:
        parent_name, _, leaf = name.rpartition(".")
        parent = folded.get_submodule(parent_name)
        conv = leaf.replace("bn", "conv") if leaf.startswith("bn") else str(int(leaf) - 1)  # or `downsample`
        before, norm = parent.get_submodule(conv), parent.get_submodule(leaf)
        assert isinstance(before, nn.Conv2d)
        assert isinstance(norm, nn.BatchNorm2d)
        parent.add_module(conv, fuse_conv_bn_eval(before, norm))
        parent.add_module(leaf, nn.Identity())
    return folded


def _device(name: str) -> torch.device:
    if name == "auto":
        return torch.device("cuda" if torch.cuda.is_available() else "cpu")
    if name == "cuda" and not torch.cuda.is_available():
        raise RankerError("no CUDA device for the ranker; `--device cpu` uses the processor")
    return torch.device("cuda" if name == "cuda" else "cpu")
