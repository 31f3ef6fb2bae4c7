"""The frame encoder in whole numbers of eight bits, for processors that multiply those quickest.

Assumes a ResNet whose batch norms are folded into its convolutions, and ranges of what comes out of these,
measured on training clips (:func:`measured_ranges`). Weights get a scale for each output channel, what
passes between layers one for each layer; sums are exact, so a picture's features are the same to the bit in
any company. Where products are summed in pairs of sixteen bits (AVX2), they are only if weights have seven
bits. Only torch's own operators are used.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple, Protocol, TypeVar

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn
from torch.nn import functional

from .model import PIXEL_MEAN, PIXEL_STD

#: Lowest and highest output of every convolution, after what is added to it and its ReLU.
Ranges = dict[str, tuple[float, float]]
_BINS = 1024
V = TypeVar("V")


class _Layer(Protocol[V]):
    """Does a convolution by its name; add: what is added to its output before the ReLU."""

    def __call__(self, name: str, x: V, add: V | None = None, relu: bool = True) -> V: ...


def _through(backbone: nn.Module, x: V, layer: _Layer[V], pool: Callable[[V], V]) -> V:
    """What comes out of a ResNet's last block, before the average over the picture."""
    x = pool(layer("conv1", x))
    for stage in ("layer1", "layer2", "layer3", "layer4"):
        for number, block in enumerate(backbone.get_submodule(stage).children()):
            at = f"{stage}.{number}"
            steps = [name for name, child in block.named_children() if isinstance(child, nn.Conv2d)]
            beside, y = x, x
            if block.downsample is not None:
                beside = layer(f"{at}.downsample.0", x, relu=False)
            for name in steps[:-1]:
                y = layer(f"{at}.{name}", y)
            x = layer(f"{at}.{steps[-1]}", y, add=beside)
    return x


def layers_of(backbone: nn.Module) -> list[str]:
    """Names of a ResNet's convolutions, in the order they are used in."""
    found: list[str] = []

    def note(name: str, x: None, add: None = None, relu: bool = True) -> None:
        found.append(name)

    _through(backbone, None, note, lambda x: x)
    return found


@torch.inference_mode()
def measured_ranges(folded: nn.Module, pictures: Iterable[Tensor]) -> Ranges:
    """Ranges that lose least of a folded ResNet's outputs on the given batches of normalised pictures.

    pictures: gone through twice, each float32 [N, 3, S, S]. The ends are those with the least squared error
    of all output, counting what is cut off: outliers do not cost the rest its digits.
    """
    batches = list(pictures)
    ends: dict[str, tuple[float, float]] = {}
    counts: dict[str, NDArray[np.float64]] = {}

    def float_layer(name: str, x: Tensor, add: Tensor | None, relu: bool) -> Tensor:
        y = folded.get_submodule(name)(x)
        y = y if add is None else y + add
        return functional.relu(y) if relu else y

    def spread(name: str, x: Tensor, add: Tensor | None = None, relu: bool = True) -> Tensor:
        y = float_layer(name, x, add, relu)
        low, high = (float(v) for v in torch.aminmax(y))
        before = ends.get(name, (0.0, 1e-6))
        ends[name] = (min(before[0], low), max(before[1], high))
        return y

    def count(name: str, x: Tensor, add: Tensor | None = None, relu: bool = True) -> Tensor:
        y = float_layer(name, x, add, relu)
        found = torch.histc(y[y != 0], _BINS, *ends[name]).double().numpy()  # nothing is exact anyhow
        counts[name] = counts.get(name, np.zeros(_BINS)) + found
        return y

    for look in (spread, count):
        for batch in batches:
            _through(folded, batch, look, lambda x: functional.max_pool2d(x, 3, 2, 1))
    return {name: least_loss(counts[name], *ends[name]) for name in ends}


def least_loss(counts: NDArray[np.float64], low: float, high: float) -> tuple[float, float]:
    """The share of a range that 256 steps hold with the least squared error."""
    middles = low + (np.arange(_BINS) + 0.5) * (high - low) / _BINS

    def loss(share: float) -> float:
        step = share * (high - low) / 255
        kept = np.clip(middles, share * low, share * high)
        return float(counts @ ((middles - kept) ** 2 + step**2 / 12))

    share = min(np.linspace(0.2, 1.0, 81), key=loss)
    return float(share * low), float(share * high)


class _Eight(NamedTuple):
    """Numbers in eight bits: uint8 values [N, C, H, W], channels last, that mean scale · (value − zero)."""

    values: Tensor
    scale: float
    zero: int


class _Packed(NamedTuple):
    """A convolution as the operators want it; none: int32 zeros [C], weights are not shifted."""

    weight: Tensor
    scales: Tensor
    none: Tensor
    bias: Tensor
    place: tuple[list[int], list[int], list[int], int]  # stride, padding, dilation, groups
    scale: float
    zero: int


class Int8Backbone:
    """Features of pictures: uint8 [N, S, S, 3] sRGB -> float32 [N, D], for one fixed N.

    highest: the largest weight, in whole numbers; see :data:`ranker.engine.HIGHEST`. Raises RuntimeError or
    AttributeError where this torch lacks the operators.
    """

    def __init__(self, folded: nn.Module, ranges: Ranges, count: int, size: int, highest: int = 127) -> None:
        self._highest = highest
        self._folded, self._ranges, self._pool = folded, ranges, folded.get_submodule("avgpool")
        self._packed: dict[str, _Packed] = {}  # by the first pass: what comes in is known only on the way
        self._border = torch.tensor([round(255 * m) for m in PIXEL_MEAN], dtype=torch.uint8)
        self(torch.zeros(count, size, size, 3, dtype=torch.uint8))

    @torch.inference_mode()
    def __call__(self, pictures: Tensor) -> Tensor:
        count, size = pictures.shape[:2]
        edge = int(_conv(self._folded, "conv1").padding[0])
        bordered = self._border.expand(count, size + 2 * edge, size + 2 * edge, 3).contiguous()
        bordered[:, edge:-edge, edge:-edge] = pictures  # black is not what a ResNet's border means
        out = _through(self._folded, _Eight(bordered.movedim(-1, 1), 1.0, 0), self._layer, _pooled)
        return self._pool((out.values.float() - out.zero) * out.scale)

    def _layer(self, name: str, x: _Eight, add: _Eight | None = None, relu: bool = True) -> _Eight:
        if name not in self._packed:
            self._packed[name] = self._pack(name, x)
        p = self._packed[name]
        asked = (x.values, x.scale, x.zero, p.weight, p.scales, p.none)
        operator = torch.ops.onednn.qconv2d_pointwise
        told = (p.bias, *p.place, p.scale, p.zero, torch.uint8)
        if add is None:
            values = operator(*asked, *told, "relu" if relu else "none", [], "")
        else:  # in the place of what is added, which nobody needs any more
            sums = (add.scale, add.zero, "sum", 1.0)
            values = operator.binary(*asked, add.values, *told, *sums, "relu", [], "")
        return _Eight(values, p.scale, p.zero)

    def _pack(self, name: str, x: _Eight) -> _Packed:
        conv = _conv(self._folded, name)
        weight, padding = conv.weight.detach().float(), [int(side) for side in conv.padding]
        bias = torch.zeros(len(weight)) if conv.bias is None else conv.bias.detach().float()
        mean, std = (255 * torch.tensor(v)[:, None, None] for v in (PIXEL_MEAN, PIXEL_STD))
        if name == "conv1":  # pixels come as they are, with their border
            weight, padding = weight / std, [0, 0]
        scales = weight.abs().amax((1, 2, 3)).clamp_min(1e-12) / self._highest
        whole = (weight / scales[:, None, None, None]).round().clamp(-self._highest, self._highest)
        if name == "conv1":  # what weights lose by rounding must not count with the mean
            bias = bias - (whole * mean).sum((1, 2, 3)) * scales
        place = (list(conv.stride), padding, list(conv.dilation), conv.groups)
        packed = torch.ops.onednn.qconv_prepack(
            whole.to(torch.int8), scales, x.scale, x.zero, *place, list(x.values.shape)
        )
        low, high = self._ranges[name]
        scale = max(high - low, 1e-12) / 255
        none = torch.zeros(len(scales), dtype=torch.int32)
        return _Packed(packed, scales, none, bias, place, scale, round(-low / scale))


def _conv(backbone: nn.Module, name: str) -> nn.Conv2d:
    found = backbone.get_submodule(name)
    assert isinstance(found, nn.Conv2d)
    return found


def _pooled(x: _Eight) -> _Eight:
    """The highest of every 3 x 3 places, every second one: torch has no such thing for eight bits."""
    values = x.values
    for axis in (2, 3):
        even, odd = (values[_every_second(axis, k)] for k in (0, 1))
        out = even.clone(memory_format=torch.channels_last)
        here = out.narrow(axis, 0, odd.shape[axis])
        torch.maximum(here, odd, out=here)
        later = out.narrow(axis, 1, out.shape[axis] - 1)
        torch.maximum(later, odd.narrow(axis, 0, out.shape[axis] - 1), out=later)
        values = out
    return x._replace(values=values)


def _every_second(axis: int, start: int) -> tuple[slice, ...]:
    return tuple(slice(start, None, 2) if k == axis else slice(None) for k in range(4))
