"""Bodies, kept on disk between runs: the mesh of a spec, made where it is not there yet.

The result depends on the spec and on :data:`VERSION` alone. What makes bodies is imported only when one has
to be made.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from platformdirs import user_cache_path

from ..keeping import keep
from ..mesh import Mesh
from .proportions import make_skeleton
from .skeleton import PALETTE, Skeleton
from .spec import BodySpec

#: Raised with every change of shape, so that old cache files are not read.
VERSION = 31


@dataclass(frozen=True, eq=False)
class Body:
    """A person ready to be posed.

    mesh: in the bind pose, model coordinates; its parts index :data:`runtime.body.pieces.PARTS`
    joints: int32 [V, 4], indices into :data:`runtime.body.skeleton.PALETTE`; weights: float32 [V, 4]
    """

    spec: BodySpec
    skeleton: Skeleton
    mesh: Mesh
    joints: NDArray[np.int32]
    weights: NDArray[np.float32]


def build_body(spec: BodySpec, cache: Path | None = None) -> Body:
    """The body of a spec, from the cache folder where it is there and whole, else made and put there.

    cache: folder to use; None for the user's own. A folder that cannot be written is no error.
    """
    folder = user_cache_path("vdsl") / "bodies" if cache is None else cache
    name = hashlib.sha256(f"{VERSION};{spec.key()};{';'.join(PALETTE)}".encode()).hexdigest()[:24]
    path = folder / f"{name}.npz"
    found = _load(path, spec)
    if found is not None:
        return found
    body = make_body(spec)
    arrays = {key: getattr(body.mesh, key) for key in _ARRAYS}
    keep(path, {**arrays, "joints": body.joints, "weights": body.weights})
    return body


def make_body(spec: BodySpec) -> Body:
    """Builds a body, no cache involved."""
    from .making import make_body as make

    return make(spec)


_ARRAYS = ("vertices", "faces", "normals", "colors", "parts", "materials")


def _load(path: Path, spec: BodySpec) -> Body | None:
    """The body in a cache file; None where the file is missing, damaged or not of this version."""
    try:
        with np.load(path, allow_pickle=False) as data:
            mesh = Mesh(*(data[name] for name in _ARRAYS))
            joints, weights = data["joints"], data["weights"]
    except Exception:  # a cache file may hold anything; numpy and zipfile raise many kinds for it
        return None
    n = len(mesh.vertices)
    sound = joints.shape == (n, 4) and weights.shape == (n, 4) and joints.dtype == np.int32
    if (
        not sound
        or not n
        or joints.min() < 0
        or joints.max() >= len(PALETTE)
        or not np.isfinite(weights).all()
    ):
        return None
    return Body(spec, make_skeleton(spec), mesh, joints, weights.astype(np.float32))
