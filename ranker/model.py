"""The shot ranking discriminator: a temporal segment network over a few frames of a shot.

Every frame goes through the same ResNet; what comes out is fused over time at the end (paper,
section 3.3). The fusion is TSN's average consensus and, beside it, the slope and the spread of the
features over time: an average alone cannot tell a pan to the left from one to the right.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional

from .config import ModelConfig
from .vision import torchvision_models

#: Of sRGB in 0..1, by channel, as ResNets are used to.
PIXEL_MEAN = (0.485, 0.456, 0.406)
PIXEL_STD = (0.229, 0.224, 0.225)


class Output(NamedTuple):
    """What the network says of B shots.

    logit [B], of p_b; movement, scale, angle [B, classes], logits of p_c; feature [B, D], the average
    of the frames' features; contrast [B, C], unit vectors z of L_q
    """

    logit: Tensor
    movement: Tensor
    scale: Tensor
    angle: Tensor
    feature: Tensor
    contrast: Tensor


class ShotRanker(nn.Module):
    """Backbone, fusion and heads. Untrained until weights are loaded; built without any download."""

    def __init__(self, config: ModelConfig) -> None:
        super().__init__()
        self.config = config
        backbone = getattr(torchvision_models(), config.backbone)(weights=None, zero_init_residual=True)
        width = backbone.fc.in_features
        backbone.fc = nn.Identity()
        self.backbone: nn.Module = backbone
        self.width = width
        self.professional = nn.Linear(3 * width, 1)
        self.movement = nn.Linear(3 * width, len(config.movements))
        self.scale = nn.Linear(3 * width, len(config.scales))
        self.angle = nn.Linear(3 * width, len(config.angles))
        self.contrast = nn.Sequential(nn.Linear(width, 256), nn.ReLU(), nn.Linear(256, config.contrast))

    def forward(self, frames: Tensor, times: Tensor) -> Output:
        """Judge shots: ``frames`` [B, T, 3, H, W] as :func:`normalised`, ``times`` [B, T] in 0..1."""
        batch, count = frames.shape[:2]
        flat = frames.flatten(0, 1).contiguous(memory_format=torch.channels_last)
        features = self.backbone(flat).float().view(batch, count, self.width)
        return self.judge(features, times)

    def judge(self, features: Tensor, times: Tensor) -> Output:
        """The heads over features of single frames [B, T, D], in float32."""
        with torch.autocast(features.device.type, enabled=False):
            average = features.mean(1)
            fused = fuse(features, times)
            return Output(
                self.professional(fused).squeeze(1),
                self.movement(fused),
                self.scale(fused),
                self.angle(fused),
                average,
                functional.normalize(self.contrast(average), dim=1),
            )


def fuse(features: Tensor, times: Tensor) -> Tensor:
    """Average, least-squares slope and spread over time: [B, T, D] and [B, T] -> [B, 3 D].

    All three mean the same for any subset of a shot's frames. One frame has no slope and no spread.
    """
    average = features.mean(1)
    offset = (times - times.mean(1, keepdim=True)).unsqueeze(2)
    change = features - average.unsqueeze(1)
    slope = (offset * change).sum(1) / offset.square().sum(1).clamp_min(1e-6)
    spread = (change.square().mean(1) + 1e-6).sqrt()
    return torch.cat([average, slope, spread], 1)


def normalised(frames: Tensor) -> Tensor:
    """uint8 [..., H, W, 3] sRGB -> float32 [..., 3, H, W] as ResNets are used to."""
    mean = torch.tensor(PIXEL_MEAN, device=frames.device) * 255
    std = torch.tensor(PIXEL_STD, device=frames.device) * 255
    return ((frames.float() - mean) / std).movedim(-1, -3)


def frame_times(config: ModelConfig) -> Tensor:
    """Places of a shot's stored frames in its time, 0..1, float32 [frames]."""
    return torch.linspace(0, 1, config.frames) if config.frames > 1 else torch.zeros(1)
