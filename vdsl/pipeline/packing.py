"""Frozen values as bytes and back: dataclasses of ours, numbers, words, tuples, lists, dictionaries, sets and
arrays.

Guarantees that what is read back is equal to what was packed, that equal values give equal bytes on one
machine, and that nothing but dataclasses of this project can come out of a file.
"""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass
from functools import lru_cache
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

_OURS = ("vdsl.", "runtime.")
_KINDS = "biuf"


class PackError(ValueError):
    """The value, or the bytes, are none of those that are packed."""


def pack(value: Any) -> bytes:
    """A value as bytes: the length of a JSON text, the text, and the arrays it names. Raises PackError."""
    blob = bytearray()
    text = json.dumps(_plain(value, blob), separators=(",", ":")).encode()
    return len(text).to_bytes(8, "little") + text + bytes(blob)


def unpack(data: bytes) -> Any:
    """What :func:`pack` was given. Raises PackError."""
    try:
        length = int.from_bytes(data[:8], "little")
        return _value(json.loads(data[8 : 8 + length]), memoryview(data)[8 + length :])
    except PackError:
        raise
    except Exception as error:  # whatever a damaged file may lead to
        raise PackError(f"{type(error).__name__}: {error}") from error


def _plain(value: Any, blob: bytearray) -> Any:
    if value is None or isinstance(value, bool | int | float | str):
        return value.item() if isinstance(value, np.generic) else value
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, tuple):
        return {"t": [_plain(v, blob) for v in value]}
    if isinstance(value, frozenset):
        return {"s": sorted((_plain(v, blob) for v in value), key=json.dumps)}
    if isinstance(value, list):
        return [_plain(v, blob) for v in value]
    if isinstance(value, dict):
        return {"d": [[_plain(k, blob), _plain(v, blob)] for k, v in value.items()]}
    if isinstance(value, np.ndarray) and value.dtype.kind in _KINDS:
        blob += b"\0" * (-len(blob) % 16)
        at = len(blob)
        blob += np.ascontiguousarray(value).tobytes()
        return {"a": [value.dtype.str, list(value.shape), at]}
    kind = type(value)
    if is_dataclass(value) and kind.__module__.startswith(_OURS):
        held = [_plain(getattr(value, f.name), blob) for f in fields(value)]
        return {"o": [kind.__module__, kind.__qualname__, held]}
    raise PackError(f"{kind.__module__}.{kind.__qualname__} is not packed")


def _value(told: Any, blob: memoryview) -> Any:
    if isinstance(told, list):
        return [_value(v, blob) for v in told]
    if not isinstance(told, dict):
        return told
    ((sign, inner),) = told.items()
    if sign == "t":
        return tuple(_value(v, blob) for v in inner)
    if sign == "s":
        return frozenset(_value(v, blob) for v in inner)
    if sign == "d":
        return {_value(k, blob): _value(v, blob) for k, v in inner}
    if sign == "a":
        return _array(inner, blob)
    if sign == "o":
        module, name, held = inner
        made, names = _kind(module, name)
        if len(held) != len(names):
            raise PackError(f"{name} has other fields")
        out: Any = object.__new__(made)  # as it was: nothing is computed anew
        for field, v in zip(names, held, strict=True):
            object.__setattr__(out, field, _value(v, blob))
        return out
    raise PackError(f"unknown sign {sign!r}")


def _array(told: Any, blob: memoryview) -> NDArray[Any]:
    dtype, shape, at = np.dtype(told[0]), tuple(told[1]), told[2]
    if dtype.kind not in _KINDS:
        raise PackError("an array of objects")
    size = dtype.itemsize * int(np.prod(shape, dtype=np.int64))
    if at < 0 or at + size > len(blob):
        raise PackError("it ends too soon")
    return np.frombuffer(blob[at : at + size], dtype).reshape(shape).copy()


@lru_cache(maxsize=256)
def _kind(module: str, name: str) -> tuple[type, tuple[str, ...]]:
    if not module.startswith(_OURS):
        raise PackError(f"{module} is not ours")
    made = getattr(import_module(module), name)
    if not (isinstance(made, type) and is_dataclass(made)):
        raise PackError(f"{name} is no dataclass")
    return made, tuple(f.name for f in fields(made))
