"""The strip: shot, take, timecode, frame, lens and movement written on every frame."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from . import lettering
from .words import timecode


@dataclass(frozen=True, eq=False)
class BurnIn:
    """What the strip of a take says.

    start: the take's first frame in the film; focal: float64 [T], mm
    below: the strip is added under the picture (the video gets higher) instead of laid over its foot
    """

    shot: str
    take: int
    movement: str
    fps: tuple[int, int]
    focal: NDArray[np.float64]
    start: int = 0
    below: bool = False


def strip_height(height: int) -> int:
    """Pixels of the strip for a picture of ``height`` pixels; even."""
    return max(16, 2 * round(height / 44))


def burn(frame: NDArray[np.uint8], strip: BurnIn, index: int) -> NDArray[np.uint8]:
    """A copy of the frame, uint8 [H, W, 3], with the strip for frame ``index`` of the take."""
    height, width = frame.shape[:2]
    high = strip_height(height)
    band = _lettered(strip, index, width, high)
    if strip.below:
        return np.concatenate([frame, band])
    out = frame.copy()
    out[-high:] = cv2.addWeighted(out[-high:], 0.3, band, 1.0, 0.0)
    return out


def _lettered(strip: BurnIn, index: int, width: int, high: int) -> NDArray[np.uint8]:
    image = Image.new("RGB", (width, high), "#0c0d10")
    draw = ImageDraw.Draw(image)
    size = max(10, round(high * 0.62))
    middle, edge = high / 2, size * 0.7
    focal = float(strip.focal[min(index, len(strip.focal) - 1)])
    left = lettering.shortened(f"{strip.shot}  ·  take {strip.take}  ·  {strip.movement}", size, width * 0.5)
    right = f"{focal:.0f} mm  ·  f {index:04d}  ·  {timecode(strip.start + index, strip.fps)}"
    lettering.write(draw, (edge, middle), left, size, "#f2efe8", "lm")
    lettering.write(draw, (width - edge, middle), right, size, "#f2efe8", "rm")
    return np.array(image)
