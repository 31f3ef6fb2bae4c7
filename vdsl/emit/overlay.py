"""Guides drawn over pictures: safe areas, thirds, a cross in the middle, and the mask of another aspect.

Assumes frames uint8 [H, W, 3] sRGB. Guarantees lines that can be seen on black as on white (a light line
with a dark rim), a width that follows the picture's height, and that frames given are left as they were.

Safe areas are those of SMPTE ST 2046-1: action within 93 %, titles within 90 % of width and height.
"""

from __future__ import annotations

from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from .guides import Guides

ACTION_SAFE, TITLE_SAFE = 0.93, 0.90
#: How much of a picture is left outside the mask.
_DIMMED = 0.16
_LINE, _RIM = 0.82, 0.34  # opacity

Window = tuple[float, float, float, float]


def guided(frame: NDArray[np.uint8], guides: Guides) -> NDArray[np.uint8]:
    """A copy of the frame with guides drawn over it; the frame itself where there are none."""
    if not guides:
        return frame
    height, width = frame.shape[:2]
    keep, add = _layers(guides, width, height)
    return np.asarray(cv2.add(cv2.multiply(frame, keep, scale=1 / 255), add), np.uint8)


def masked(width: int, height: int, aspect: float | None) -> Window:
    """The part (x0, y0, x1, y1) of a picture that an aspect leaves, in pixels."""
    if aspect is None:
        return 0.0, 0.0, float(width), float(height)
    w, h = min(float(width), height * aspect), min(float(height), width / aspect)
    return (width - w) / 2, (height - h) / 2, (width + w) / 2, (height + h) / 2


@lru_cache(maxsize=4)
def _layers(guides: Guides, width: int, height: int) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """What every pixel keeps of the picture (255 is all), and what light is added, uint8 [H, W, 3] each."""
    lines = np.zeros((height, width), np.uint8)
    thick = max(1, round(height / 540))
    inner = masked(width, height, guides.mask)
    if guides.safe:
        whole = (0.0, 0.0, float(width), float(height))
        _box(lines, _scaled(whole, ACTION_SAFE), thick)
        _box(lines, _scaled(whole, TITLE_SAFE), thick, dashed=True)
    if guides.thirds:
        _thirds(lines, inner, thick)
    if guides.cross:
        _cross(lines, inner, thick)
    rim = cv2.dilate(lines, np.ones((2 * thick + 1, 2 * thick + 1), np.uint8))
    keep = np.full((height, width), 255.0)
    x0, y0, x1, y1 = (round(v) for v in inner)
    outside = np.ones((height, width), bool)
    outside[y0:y1, x0:x1] = False
    keep[outside] *= _DIMMED
    keep[rim > 0] *= 1 - _RIM
    keep[lines > 0] *= 1 - _LINE
    add = np.where(lines > 0, 235 * _LINE, 0)
    three = [np.repeat(layer[..., None], 3, axis=2).round().astype(np.uint8) for layer in (keep, add)]
    return three[0], three[1]


def _scaled(window: Window, share: float) -> Window:
    x0, y0, x1, y1 = window
    cx, cy, w, h = (x0 + x1) / 2, (y0 + y1) / 2, (x1 - x0) * share / 2, (y1 - y0) * share / 2
    return cx - w, cy - h, cx + w, cy + h


def _box(lines: NDArray[np.uint8], window: Window, thick: int, dashed: bool = False) -> None:
    x0, y0, x1, y1 = (round(v) for v in window)
    for a, b in (((x0, y0), (x1, y0)), ((x1, y0), (x1, y1)), ((x1, y1), (x0, y1)), ((x0, y1), (x0, y0))):
        _stroke(lines, a, b, thick, dashed)


def _thirds(lines: NDArray[np.uint8], window: Window, thick: int) -> None:
    x0, y0, x1, y1 = window
    for k in (1, 2):
        x, y = round(x0 + k * (x1 - x0) / 3), round(y0 + k * (y1 - y0) / 3)
        _stroke(lines, (x, round(y0)), (x, round(y1)), thick)
        _stroke(lines, (round(x0), y), (round(x1), y), thick)


def _cross(lines: NDArray[np.uint8], window: Window, thick: int) -> None:
    x0, y0, x1, y1 = window
    cx, cy, arm = round((x0 + x1) / 2), round((y0 + y1) / 2), round((y1 - y0) * 0.035)
    _stroke(lines, (cx - arm, cy), (cx + arm, cy), thick)
    _stroke(lines, (cx, cy - arm), (cx, cy + arm), thick)


def _stroke(
    lines: NDArray[np.uint8], a: tuple[int, int], b: tuple[int, int], thick: int, dashed: bool = False
) -> None:
    if not dashed:
        cv2.line(lines, a, b, 255, thick)
        return
    length = float(np.hypot(b[0] - a[0], b[1] - a[1]))
    dash = 8 * thick
    for begin in np.arange(0, length, 2 * dash):
        ends = [
            (round(a[0] + (b[0] - a[0]) * s / length), round(a[1] + (b[1] - a[1]) * s / length))
            for s in (begin, min(begin + dash, length))
        ]
        cv2.line(lines, ends[0], ends[1], 255, thick)
