"""How steady pictures are under a moving camera.

Each frame is compared with the one before, carried over by depth: what a surface showed there, it should
show here. Carrying over by part of a pixel blurs, which is no change of the picture; so the earlier frame is
carried half of that part on, the later one as far back, and both are blurred alike. Assumes that nothing but
the camera moves. The sky is compared as what is very far away; what came into view only now is left out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from runtime.raster.renderer import Renderer
from runtime.raster.types import Camera, Views
from runtime.raster.views import pack_views

#: Differences up to this many steps of 255 go unseen.
SEEN = 16
_SKY = 1e6  # metres that what lies behind everything is away: it turns with the camera and does not move
_SAME_DEPTH = 0.02  # share of the depth by which a surface may lie elsewhere and still be the same


@dataclass(frozen=True, eq=False)
class Steadiness:
    """share: of the pixels compared, those that changed by more than SEEN beyond what the carried-over frame
    explains; worst: share of the worst frame; changed: bool [H, W], where that was"""

    share: float
    worst: float
    changed: NDArray[np.bool_]


def panned(camera: Camera, frames: int, degrees: float) -> Camera:
    """The first of ``camera``'s poses, turned about the vertical by ``degrees`` from frame to frame."""
    angle = np.radians(degrees) * np.arange(frames)
    turn = np.zeros((frames, 3, 3))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(angle)
    turn[:, 0, 1], turn[:, 1, 0] = np.sin(angle), -np.sin(angle)
    turn[:, 2, 2] = 1.0
    axes = np.einsum("nij,kj->nki", turn, camera.axes[0].astype(float))
    return replace(
        camera,
        position=np.repeat(camera.position[:1], frames, axis=0),
        axes=axes.astype(np.float32),
        focal=np.repeat(camera.focal[:1], frames),
        focus=None if camera.focus is None else np.repeat(camera.focus[:1], frames),
    )


def steadiness(
    drawer: Renderer,
    palette: NDArray[np.float32],
    camera: Camera,
    hidden: NDArray[np.bool_],
    size: tuple[int, int],
) -> Steadiness:
    """How steady the frames of ``camera`` are, of one moment of the scene that ``drawer`` has loaded.

    palette: float32 [P, 3, 4]; hidden: bool [W + people]
    """
    count = len(camera.focal)
    views = Views(camera, np.zeros(count, np.int32), np.repeat(hidden[None], count, axis=0))
    frames = drawer.render(palette[None], views, size, depth=True)
    assert frames.depth is not None
    packed = pack_views(camera, count, *size)
    parts = [
        _changed(frames.color[k - 1 : k + 1], frames.depth[k - 1 : k + 1], packed[k - 1 : k + 1])
        for k in range(1, count)
    ]
    shares = [float(changed.sum() / max(known.sum(), 1)) for changed, known in parts]
    return Steadiness(float(np.mean(shares)), max(shares), parts[int(np.argmax(shares))][0])


def _changed(
    color: NDArray[np.uint8], depth: NDArray[np.float32], packed: NDArray[np.float32]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which pixels of the second of two frames changed, and which could be compared, bool [H, W] each."""
    height, width = depth.shape[1:]
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    before, now = packed.astype(float)
    rays = (
        now[9:12]
        + ((x - now[14]) / now[12])[..., None] * now[3:6]
        - ((y - now[15]) / now[13])[..., None] * now[6:9]
    )
    far = np.minimum(depth[1], _SKY)
    offset = now[0:3] + rays * far[..., None] - before[0:3]
    z = offset @ before[9:12]
    ahead = z > 1e-3
    safe = np.where(ahead, z, 1.0)
    u = before[14] + before[12] * (offset @ before[3:6]) / safe - 0.5
    v = before[15] - before[13] * (offset @ before[6:9]) / safe - 0.5
    known = ahead & (u >= 1) & (v >= 1) & (u <= width - 2) & (v <= height - 2)
    known &= (x > 1) & (y > 1) & (x < width - 1) & (y < height - 1)  # the later one is carried, too
    # it must have been in view: the pixel it comes from shows the same surface
    was = _taken(np.minimum(depth[0], _SKY), u, v, cv2.INTER_NEAREST)
    known &= np.abs(was - z) < _SAME_DEPTH * z
    right, down = ((d - np.round(d)) / 2 for d in (u - (x - 0.5), v - (y - 0.5)))
    earlier = _taken(color[0], u - right, v - down, cv2.INTER_LINEAR)
    later = _taken(color[1], x - 0.5 - right, y - 0.5 - down, cv2.INTER_LINEAR)
    return (np.abs(earlier - later).max(axis=-1) > SEEN) & known, known


def _taken(
    picture: NDArray[np.generic], x: NDArray[np.float64], y: NDArray[np.float64], how: int
) -> NDArray[np.float32]:
    """What a picture shows at places [H, W] in pixels."""
    places = (x.astype(np.float32), y.astype(np.float32))
    return np.asarray(cv2.remap(picture.astype(np.float32), *places, how), np.float32)
