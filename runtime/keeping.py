"""Files kept between runs: arrays written in one step, so that a reader never finds half a file."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray


def keep(path: Path, arrays: Mapping[str, NDArray[np.generic]], most: int | None = None) -> None:
    """Write arrays as .npz. A folder or a disk that refuses is passed over: nothing is lost but time.

    most: files of its kind the folder may hold; the longest unused go first
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, suffix=".part")
    except OSError:
        return
    try:
        with os.fdopen(handle, "wb") as file:
            np.savez(file, **arrays)  # type: ignore[arg-type]
        os.replace(name, path)
        if most is not None:
            kept = sorted(path.parent.glob("*.npz"), key=lambda p: p.stat().st_mtime)
            for old in kept[: max(len(kept) - most, 0)]:
                old.unlink(missing_ok=True)
    except OSError:
        Path(name).unlink(missing_ok=True)
