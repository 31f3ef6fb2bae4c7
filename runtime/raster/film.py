"""How scene light becomes picture: exposure, a soft shoulder, and the sRGB curve."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

EXPOSURE = 0.62
KNEE = 0.7  # above it, tones bend softly towards white
FILM_RANGE = 2.5  # most scene light told apart
FILM_SIZE = 8192  # steps of the table


def to_linear(color: NDArray[np.floating]) -> NDArray[np.float64]:
    """sRGB-encoded 0..1 to linear light (IEC 61966-2-1)."""
    color = np.clip(np.asarray(color, np.float64), 0.0, 1.0)
    return np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)


def to_encoded(light: NDArray[np.floating]) -> NDArray[np.float64]:
    """Linear light to sRGB-encoded 0..1 (IEC 61966-2-1)."""
    light = np.clip(np.asarray(light, np.float64), 0.0, 1.0)
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


def exposed(light: NDArray[np.floating]) -> NDArray[np.float64]:
    """Scene light to linear picture light 0..1: even up to the knee, then approaching 1."""
    x = np.asarray(light, np.float64) * EXPOSURE
    bent = 1.0 - (1.0 - KNEE) ** 2 / (np.maximum(x, KNEE) - 2.0 * KNEE + 1.0)
    return np.where(x > KNEE, bent, x)


def unexposed(picture: NDArray[np.floating]) -> NDArray[np.float64]:
    """The scene light that :func:`exposed` turns into ``picture``, at most FILM_RANGE."""
    y = np.clip(np.asarray(picture, np.float64), 0.0, 0.9999)
    x = np.where(y > KNEE, (1.0 - KNEE) ** 2 / (1.0 - y) + 2.0 * KNEE - 1.0, y)
    return np.minimum(x / EXPOSURE, FILM_RANGE)


def film_table() -> NDArray[np.uint16]:
    """sRGB for scene light 0..FILM_RANGE in even steps.

    In 256ths of a byte, with half a byte added, so that the upper byte is rounded.
    """
    light = np.linspace(0.0, FILM_RANGE, FILM_SIZE)
    return np.round(to_encoded(exposed(light)) * 255.0 * 256.0 + 128.0).astype(np.uint16)
