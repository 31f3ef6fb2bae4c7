"""The momentum dictionary of L_q: keys of earlier shots, by an encoder that follows slowly."""

from __future__ import annotations

import copy

import torch
from torch import Tensor, nn
from torch.nn import functional

from .model import ShotRanker


class Dictionary(nn.Module):
    """A ring of ``size`` unit vectors with the index of the clip each came from.

    ``size`` need not be a multiple of the batch: a batch that reaches the end goes on at the start.
    It starts with random directions, which belong to no clip (−1).
    """

    vectors: Tensor
    clips: Tensor
    place: Tensor

    def __init__(self, size: int, width: int, seed: int = 0) -> None:
        super().__init__()
        start = torch.randn(size, width, generator=torch.Generator().manual_seed(seed))
        self.register_buffer("vectors", functional.normalize(start, dim=1))
        self.register_buffer("clips", torch.full((size,), -1, dtype=torch.long))
        self.register_buffer("place", torch.zeros((), dtype=torch.long))

    @torch.no_grad()
    def push(self, keys: Tensor, clips: Tensor) -> None:
        """Put keys [B, C] of clips [B] in the place of the oldest; of more than fit, the last stay."""
        size = len(self.vectors)
        first = max(0, len(keys) - size)
        at = (int(self.place) + torch.arange(first, len(keys), device=keys.device)) % size
        self.vectors[at] = keys[first:].detach().to(self.vectors.dtype)
        self.clips[at] = clips[first:].to(self.clips.device)
        self.place.fill_((int(self.place) + len(keys)) % size)

    def same(self, clips: Tensor) -> Tensor:
        """bool [B, K]: which entries came from the clips of the batch [B]."""
        return clips[:, None] == self.clips[None, :]


def momentum_copy(model: ShotRanker) -> ShotRanker:
    """The key encoder at the start: the same weights, never trained by gradient."""
    keys = copy.deepcopy(model)
    keys.requires_grad_(False)
    return keys.eval()


@torch.no_grad()
def follow(keys: ShotRanker, model: ShotRanker, momentum: float) -> None:
    """One step of the key encoder: θ_k ← m θ_k + (1 − m) θ_q; batch-norm statistics are taken over."""
    ours: list[Tensor] = list(keys.parameters())
    theirs: list[Tensor] = list(model.parameters())
    torch._foreach_lerp_(ours, theirs, 1 - momentum)
    for mine, other in zip(keys.buffers(), model.buffers(), strict=True):
        mine.copy_(other)
