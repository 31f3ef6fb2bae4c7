"""Textures, as far as flat colours need them: bounded, decoded once, and sampled."""

from __future__ import annotations

import io
import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from . import limits
from .errors import ModelFileError

Pixels = NDArray[np.uint8]
#: Textures are read at most this large: what is drawn has one colour a triangle.
_KEPT = 1024
#: Where on a face its texture is looked at, as shares of its corners.
_PLACES = ((1 / 3, 1 / 3, 1 / 3), (0.6, 0.2, 0.2), (0.2, 0.6, 0.2), (0.2, 0.2, 0.6))
_FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "TGA")


def decode(path: Path, data: bytes) -> Pixels:
    """uint8 [H, W, 4]. A picture that declares too many pixels is refused before it is unpacked."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            image: Image.Image = Image.open(io.BytesIO(data), formats=_FORMATS)
            width, height = image.size
            if width * height > limits.IMAGE_PIXELS:
                raise ModelFileError(path, f"a texture of it has {width} x {height} pixels; that is too many")
            image.draft("RGB", (_KEPT, _KEPT))
            image = image.convert("RGBA")
            image.thumbnail((_KEPT, _KEPT))
            return np.asarray(image, np.uint8)
    except ModelFileError:
        raise
    except Exception as error:  # Pillow's decoders raise whatever they come upon
        raise ModelFileError(path, f"a texture of it cannot be read: {str(error)[:80]}") from None


def sampled(pixels: Pixels, uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """RGBA 0..1 [N, 4] at texture coordinates [N, 2] (v down, repeating)."""
    height, width = pixels.shape[:2]
    clean = np.nan_to_num(uv, nan=0.0, posinf=0.0, neginf=0.0)
    part = clean - np.floor(clean)
    x = np.minimum((part[:, 0] * width).astype(np.int64), width - 1)
    y = np.minimum((part[:, 1] * height).astype(np.int64), height - 1)
    out: NDArray[np.float64] = pixels[y, x] / 255.0
    return out


def on_faces(pixels: Pixels, uv: NDArray[np.float64], faces: NDArray[np.integer]) -> NDArray[np.float64]:
    """Linear RGBA [F, 4] of faces [F, 3] whose corners lie at ``uv`` [V, 2]: the mean of a few places."""
    out = np.zeros((len(faces), 4))
    for share in _PLACES:
        rgba = sampled(pixels, np.einsum("k,fkc->fc", np.array(share), uv[faces]))
        rgba[:, :3] = linear(rgba[:, :3])
        out += rgba / len(_PLACES)
    return out


def srgb(linear: NDArray[np.float64]) -> NDArray[np.float64]:
    """Linear 0..1 as sRGB."""
    x = np.clip(linear, 0.0, 1.0)
    out: NDArray[np.float64] = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    return out


def linear(encoded: NDArray[np.float64]) -> NDArray[np.float64]:
    """sRGB 0..1 as linear."""
    x = np.clip(encoded, 0.0, 1.0)
    out: NDArray[np.float64] = np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)
    return out
