"""What of a prop hides somebody in the picture is known to lines of sight: its solid boxes are about where it
is.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from vdsl.lang import Report
from vdsl.lang.definitions.prop import PropDef
from vdsl.library import Catalog
from vdsl.stage.props import BuiltProp, build_prop

Array = NDArray[np.float64]
CATALOG = Catalog(Report())
_RAYS = 200
#: What may be hidden by more than is known, m² and share of all it hides: knobs, feet and the like.
_LITTLE, _SHARE = 0.06, 0.2
#: Frames, posts and legs with little about them; what is larger than this, metres, is a backdrop, or a house.
_SHEER = ("cell_bars", "library_ladder", "signpost", "swing", "train_table", "window", "wire_fence")
_LARGE = 4.0


def _prop(name: str) -> BuiltProp | None:
    """A prop that stands about and is in the way."""
    found = CATALOG.get("prop", name)
    assert isinstance(found, PropDef)
    shape = found.shape()
    if shape.grip is not None or name in _SHEER:
        return None
    built = build_prop(shape)
    size = np.ptp(built.mesh.vertices, axis=0)
    return built if len(built.centre) and size.max() < _LARGE else None


def _rays(low: Array, size: Array) -> tuple[Array, Array]:
    """Looks through a box from all around, a little from above or below: where from, and which way."""
    rng = np.random.default_rng(0)
    around, down = rng.uniform(0, 2 * np.pi, _RAYS), np.radians(rng.uniform(-12, 25, _RAYS))
    ahead = np.stack([np.cos(down) * np.cos(around), np.cos(down) * np.sin(around), -np.sin(down)], axis=1)
    return low + rng.uniform(0, 1, (_RAYS, 3)) * size - 50.0 * ahead, ahead


def _met(built: BuiltProp, eye: Array, ahead: Array) -> NDArray[np.bool_]:
    """Which rays meet a face of the mesh (Möller and Trumbore 1997)."""
    corners = built.mesh.vertices[built.mesh.faces].astype(float)
    a, one, two = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    out = np.zeros(len(eye), bool)
    with np.errstate(all="ignore"):
        for k in range(len(eye)):
            across, away = np.cross(ahead[k], two), eye[k] - a
            scale = np.einsum("fi,fi->f", one, across)
            u = np.einsum("fi,fi->f", away, across) / scale
            v = np.cross(away, one) @ ahead[k] / scale
            out[k] = ((u >= 0) & (v >= 0) & (u + v <= 1)).any()
    return out


def _known(built: BuiltProp, eye: Array, ahead: Array) -> NDArray[np.bool_]:
    """Which rays meet one of the solid boxes."""
    low, high = built.centre - built.half, built.centre + built.half
    enter = (low - eye[:, None]) / ahead[:, None]
    leave = (high - eye[:, None]) / ahead[:, None]
    return np.asarray(
        (np.minimum(enter, leave).max(axis=-1) < np.maximum(enter, leave).min(axis=-1)).any(axis=1)
    )


@pytest.mark.parametrize("name", [n for n in CATALOG.names("prop") if _prop(n) is not None])
def test_what_hides_is_solid(name: str) -> None:
    built = _prop(name)
    assert built is not None
    low, size = built.mesh.vertices.min(0).astype(float), np.ptp(built.mesh.vertices, axis=0).astype(float)
    eye, ahead = _rays(low, size)
    met, known = _met(built, eye, ahead), _known(built, eye, ahead)
    area = (size[0] + size[1]) / 2 * size[2]
    assert met.any()
    assert area * (met & ~known).mean() <= max(_LITTLE, _SHARE * area * met.mean())


def test_a_fence_of_rails_is_seen_through() -> None:
    built = _prop("rail_fence")
    assert built is not None
    low, size = built.mesh.vertices.min(0).astype(float), np.ptp(built.mesh.vertices, axis=0).astype(float)
    eye, ahead = _rays(low, size)
    across = np.abs(ahead[:, 1]) > 0.5
    assert _known(built, eye[across], ahead[across]).mean() < 0.75
