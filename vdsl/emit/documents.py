"""JSON as the build writes it: stable to the byte, short numbers, rows of numbers on one line."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .folder import write_text

#: Decimals of lengths (m), angles (deg) and focal lengths (mm) in tracks.
TRACK_DECIMALS = 9
#: Decimals of scores and measures.
MEASURE_DECIMALS = 6


def rounded(value: float, decimals: int) -> float | None:
    """A number that prints the same everywhere: no negative zero, null where it is not finite."""
    number = float(value)
    return round(number, decimals) + 0.0 if math.isfinite(number) else None


def rows(array: NDArray[np.floating], decimals: int = TRACK_DECIMALS) -> list[Any]:
    """An array of one or two dimensions as nested lists of rounded numbers."""
    if array.ndim == 1:
        return [rounded(x, decimals) for x in array.tolist()]
    return [[rounded(x, decimals) for x in row] for row in array.tolist()]


def numbers(values: Mapping[str, float | str], decimals: int = MEASURE_DECIMALS) -> dict[str, Any]:
    """Named values with the numbers rounded, words kept, in the order of their names."""
    return {k: v if isinstance(v, str) else rounded(v, decimals) for k, v in sorted(values.items())}


def dump(document: Mapping[str, Any]) -> str:
    """The document as indented text that ends in a line end."""
    # Lone surrogates cannot be written as UTF-8: replaced here as everywhere else.
    return (_lines(document, 0) + "\n").encode("utf-8", "replace").decode("utf-8")


def write_document(path: Path, document: Mapping[str, Any]) -> None:
    """Write the document to a file."""
    write_text(path, dump(document))


_flat = json.JSONEncoder(ensure_ascii=False, allow_nan=False).encode


def _lines(value: Any, depth: int) -> str:
    pad = " " * (depth + 1)
    if isinstance(value, Mapping) and value:
        items = [f"{pad}{_flat(str(k))}: {_lines(v, depth + 1)}" for k, v in value.items()]
        return "{\n" + ",\n".join(items) + "\n" + " " * depth + "}"
    if isinstance(value, list | tuple) and any(isinstance(v, list | tuple | Mapping) for v in value):
        inner = (
            _rows(value, pad) if _tabular(value) else ",\n".join(pad + _lines(v, depth + 1) for v in value)
        )
        return "[\n" + inner + "\n" + " " * depth + "]"
    return _flat(value)


def _tabular(value: list[Any] | tuple[Any, ...]) -> bool:
    """Whether these are rows of numbers, and of nothing in which a bracket could stand."""
    return all(isinstance(row, list) and row and all(type(v) in _NUMBERS for v in row) for row in value)


def _rows(value: list[Any] | tuple[Any, ...], pad: str) -> str:
    """All rows at once, which is many times as fast as one by one."""
    return pad + _flat(value)[1:-1].replace("], [", "],\n" + pad + "[")


_NUMBERS = (float, int, type(None))
