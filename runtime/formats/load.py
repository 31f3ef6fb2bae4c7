"""Any model file, by its ending: :func:`load_model`."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from .errors import ModelFileError
from .model import Model
from .outline import MODELS


def load_model(path: Path, folder: Path) -> Model:
    """A model; what it names beside it has to lie inside ``folder``. Kept as long as the file is the same."""
    try:
        state = path.stat()
        key = (state.st_mtime_ns, state.st_size)
    except OSError:
        key = (0, 0)
    return _load(path, folder, key)


@lru_cache(maxsize=8)
def _load(path: Path, folder: Path, key: tuple[int, int]) -> Model:
    suffix = path.suffix.lower()
    if suffix in (".glb", ".gltf"):
        from .gltf import read_gltf

        return read_gltf(path, folder)
    if suffix in MODELS:
        from .meshes import read_mesh

        return read_mesh(path, folder)
    raise ModelFileError(path, f"files ending in {suffix or 'nothing'} are no models")
