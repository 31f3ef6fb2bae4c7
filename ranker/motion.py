"""How the picture as a whole moves from frame to frame: what tells a pan from a push.

A network that looks at single frames hardly sees movement, as the two-stream networks that TSN stems from
found (Simonyan and Zisserman 2014; Wang et al. 2016). So between pairs of frames blocks of brightness are
matched, and one affine motion is fitted to them, in such a way that people who move by themselves count
little (iteratively reweighted least squares). Assumes frames evenly spaced in time. Guarantees the same
numbers for a shot whatever it is worked out with, up to rounding.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor
from torch.nn import functional

from .data import Dataset
from .guides import pairs

SIDE = 56  # pixels of the small pictures that are matched
GRID = 7  # blocks along one
REACH = 8  # pixels that a block may have moved, either way
NUMBERS = 8  # of a pair: shift x, y; x and y along x; x and y along y; what is left over; share that fits
_LUMA = (0.299, 0.587, 0.114)  # of sRGB, by channel (BT.601)
_WINDOW = 9  # pixels over which brightness is made even
_NOISE = 4.0  # steps of 255 that count for nothing
_ROUNDS, _OUTLIER = 4, 0.5  # of the fit; pixels off it at which a block counts half
_AT_ONCE = 2  # clips
#: Signs of the numbers of a pair in the mirror.
_MIRROR = (-1.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0, 1.0)


def motion(frames: Tensor) -> Tensor:
    """uint8 [B, T, H, W, 3] sRGB -> float32 [B, pairs, NUMBERS]; shifts in pixels of SIDE, from -1 to 1."""
    count, times = frames.shape[:2]
    matched = pairs(times)
    if not matched:
        return torch.zeros(count, 0, NUMBERS, device=frames.device)
    even = _evened(frames.flatten(0, 1)).view(count, times, SIDE, SIDE)
    before = even[:, [i for i, _ in matched]].flatten(0, 1).unsqueeze(1)
    after = even[:, [j for _, j in matched]].flatten(0, 1).unsqueeze(1)
    shift, trust = _shifts(before, after)
    return _fitted(shift, trust).view(count, len(matched), NUMBERS)


def mirrored(moved: Tensor) -> Tensor:
    """The motion of the same shots in the mirror."""
    return moved * moved.new_tensor(_MIRROR)


def motions(data: Dataset) -> NDArray[np.float32]:
    """The motion of all clips of a training set, float32 [N, pairs, NUMBERS]; NaN for bare ones.

    What was worked out is kept beside each shard, ``shard-00000.motion.npy``, where that can be written.
    """
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    shape = (len(pairs(data.frames)), NUMBERS)
    found = [np.zeros((0, *shape), np.float32)]
    for path, frames in data.shards():
        kept = path.with_suffix(".motion.npy")
        with suppress(OSError, ValueError, EOFError):
            moved = np.load(kept, allow_pickle=False)
            if moved.shape == (len(frames), *shape) and moved.dtype == np.float32:
                found.append(moved)
                continue
        found.append(_of_shard(frames, device))
        with suppress(OSError):
            np.save(kept, found[-1])
    out = np.full((len(data), *shape), np.nan, np.float32)
    out[~data.bare] = np.concatenate(found)
    return out


def _of_shard(frames: NDArray[np.uint8], device: torch.device) -> NDArray[np.float32]:
    """The motion of clips [n, T, H, W, 3]; a core to each few of them, as single steps are small.

    On a GPU by this thread alone: torch loads what solves equations there with its first call, and fails
    where several threads make that at a time (pytorch issue 90613).
    """

    @torch.inference_mode()
    def moved(begin: int) -> NDArray[np.float32]:
        clips = torch.from_numpy(np.array(frames[begin : begin + _AT_ONCE]))
        return motion(clips.to(device)).float().cpu().numpy()

    if not len(frames):
        return np.zeros((0, len(pairs(frames.shape[1])), NUMBERS), np.float32)
    begins = range(0, len(frames), _AT_ONCE)
    if device.type != "cpu":
        return np.concatenate([moved(begin) for begin in begins])
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        with ThreadPoolExecutor(threads) as pool:
            return np.concatenate(list(pool.map(moved, begins)))
    finally:
        torch.set_num_threads(threads)


def _evened(pictures: Tensor) -> Tensor:
    """Brightness of pictures [N, H, W, 3] less that around and by its contrast, small: [N, SIDE, SIDE]."""
    gray = (pictures.float() @ pictures.new_tensor(_LUMA, dtype=torch.float32)).unsqueeze(1)
    gray = functional.interpolate(gray, (SIDE, SIDE), mode="area")

    def around(values: Tensor) -> Tensor:
        return functional.avg_pool2d(values, _WINDOW, 1, _WINDOW // 2, count_include_pad=False)

    mean = around(gray)
    spread = (around(gray * gray) - mean * mean).clamp_min(0).sqrt()
    return ((gray - mean) / (spread + _NOISE)).squeeze(1)


def _shifts(before: Tensor, after: Tensor) -> tuple[Tensor, Tensor]:
    """Where blocks of pictures [N, 1, SIDE, SIDE] have gone, pixels [N, GRID², 2], and how sure that is."""
    size, steps = SIDE // GRID, 2 * REACH + 1
    padded = functional.pad(after, (REACH,) * 4)
    energy = functional.avg_pool2d(before * before, size)
    there = functional.avg_pool2d(padded * padded, size, 1)
    likeness = before.new_empty(len(before), steps, steps, GRID, GRID)
    for j in range(steps):
        for i in range(steps):
            product = functional.avg_pool2d(before * padded[:, :, j : j + SIDE, i : i + SIDE], size)
            other = there[:, :, j : j + SIDE : size, i : i + SIDE : size]
            likeness[:, j, i] = (product / ((energy * other).clamp_min(0).sqrt() + 0.05)).squeeze(1)
    flat = likeness.flatten(1, 2)
    best, at = flat.max(1)
    row, column = at // steps, at % steps

    def beside(y: int, x: int) -> Tensor:
        place = (row + y).clamp(0, steps - 1) * steps + (column + x).clamp(0, steps - 1)
        return flat.gather(1, place.unsqueeze(1)).squeeze(1)

    def between(low: Tensor, high: Tensor) -> Tensor:
        """The top of the parabola through the best and its neighbours."""
        bend = (low - 2 * best + high).clamp(max=-1e-4)
        return (0.5 * (low - high) / bend).clamp(-0.5, 0.5)

    right = column - REACH + between(beside(0, -1), beside(0, 1))
    down = row - REACH + between(beside(-1, 0), beside(1, 0))
    trust = best.clamp(0, 1) ** 2 * energy.squeeze(1).sqrt().clamp(0, 1) + 1e-3
    return torch.stack([right, down], -1).flatten(1, 2), trust.flatten(1).unsqueeze(2)


def _fitted(shift: Tensor, trust: Tensor) -> Tensor:
    """One affine motion for the blocks' [N, GRID², 2], by trust [N, GRID², 1]: [N, NUMBERS]."""
    along = torch.linspace(-1, 1, GRID, device=shift.device)
    y, x = torch.meshgrid(along, along, indexing="ij")
    place = torch.stack([torch.ones_like(x), x, y], -1).view(1, GRID * GRID, 3)
    steady = 1e-3 * torch.eye(3, device=shift.device)
    weight = trust
    for _ in range(_ROUNDS):
        weighted = (place * weight).transpose(1, 2)
        found = torch.linalg.solve(weighted @ place + steady, weighted @ shift)
        off = (shift - place @ found).norm(dim=2, keepdim=True)
        weight = trust / (1 + (off / _OUTLIER) ** 2)
    total = trust.sum(1)
    return torch.cat([found.flatten(1), (off * trust).sum(1) / total, weight.sum(1) / total], 1)
