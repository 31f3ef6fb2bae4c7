"""What goes into the rasteriser and what comes out.

Everything that moves is one skinned mesh over one palette of matrices: a person contributes as
many palette entries as joints, a movable prop one. A *moment* is one palette, a *view* is one
camera looking at one moment; a launch draws many views of many moments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh
from ..world import Light

#: Rises whenever the same scene and views may give other pixels than before; kept results go by it.
LOOK_VERSION: int = 29
#: In ``fitting``: a person, or a thing that is carried about.
LOOSE = -2
#: What guides tell of each cell of a picture: shares of the subject, of its head, of the front of that, of
#: other people and of nothing at all, 0..255; and how near what is seen is, 255 at NEAREST metres and 1 at
#: FAR on a scale of logarithms, 0 for nothing.
GUIDES = ("subject", "head", "face", "others", "nothing", "nearness")
GUIDE_SIDE = 32  # cells along a picture
NEAREST, FAR = 0.25, 64.0  # metres
#: Roles of objects in a view.
NO_ROLE, SUBJECT, OTHERS = 0, 1, 2
#: In ``static_wall``: a face seen from its front only, such as a ceiling.
ONE_SIDED = -2


@dataclass(frozen=True)
class Style:
    """Frozen look of the pictures; kernels are compiled per style.

    outline: ink lines on silhouettes, creases and part borders; tones: number of light steps
    (0 for smooth); quiet: 0..1, how far static geometry is drawn towards pale tints; plain: smooth shading
    alone, without shadows, lines, patterns, haze, smoothing or lens: the other fields but quiet say nothing;
    clay: one neutral material under a wide sky, deep in corners; hatch: strokes of black on white paper
    """

    name: str = "board"
    outline: bool = True
    tones: int = 3
    quiet: float = 0.33
    shadows: bool = True
    occlusion: bool = True
    plain: bool = False
    clay: bool = False
    hatch: bool = False


#: The looks a storyboard can ask for by name.
STYLES = {
    "board": Style(),
    "clay": Style("clay", outline=False, tones=0, quiet=0.0, clay=True),
    "ink": Style("ink", tones=0, quiet=0.9, hatch=True),
    "plain": Style("plain", outline=False, tones=0, quiet=0.0, shadows=False, occlusion=False, plain=True),
}


@dataclass(frozen=True, eq=False)
class RenderScene:
    """Everything drawable of one scene; loaded once.

    static: world coordinates, never moves; static_object: int32 [F]; static_wall: int32 [F],
        the wild wall of a face, -1 for none, or :data:`ONE_SIDED`
    skinned: bind-pose mesh of everything that moves; skinned_object: int32 [F], object ids that
        continue after the static ones; joints: int32 [V, 4] palette indices; weights: float32 [V, 4]
    wall_count: number of wild walls
    fitting: int32 [F] of skinned faces: :data:`LOOSE` for things, ``LOOSE − 1 − k`` for the k-th person, who
        may be left out of a view;  what moves in the set itself
        (a door's leaf) is drawn like the set: the wild wall it is in, or -1. None: all are loose
    levels: heights of its floors, rising; on them people leave contact shadows
    heads: palette indices of the joints of heads; in the bind pose their faces look along X
    home: float32 [P, 3, 4], the matrices of things while they are where the set puts them; NaN for what is at
        home nowhere, as joints of people are. Their shadows are kept apart from those of what moves about.
        None: of nothing is it known
    """

    static: Mesh
    static_object: NDArray[np.int32]
    static_wall: NDArray[np.int32]
    skinned: Mesh
    skinned_object: NDArray[np.int32]
    joints: NDArray[np.int32]
    weights: NDArray[np.float32]
    wall_count: int
    light: Light
    fitting: NDArray[np.int32] | None = None
    levels: tuple[float, ...] = (0.0,)
    heads: tuple[int, ...] = ()
    home: NDArray[np.float32] | None = None


def people_of(scene: RenderScene) -> int:
    """How many people of a scene may be left out of a view."""
    fitting = scene.fitting if scene.fitting is not None else np.zeros(0, np.int32)
    return max(LOOSE - int(fitting.min(initial=LOOSE)), 0)


@dataclass(frozen=True, eq=False)
class Camera:
    """Poses of N cameras, one per view.

    position: float32 [N, 3], metres
    axes: float32 [N, 3, 3], rows are the camera's right, up and forward in the world
    focal: float32 [N], mm
    sensor: (width, height) of the sensor in mm; the picture fills it exactly
    focus: float32 [N], metres along the optical axis to what is sharp; aperture: f-number. Without a focus,
        or with an aperture of 0, everything is sharp, and costs nothing
    """

    position: NDArray[np.float32]
    axes: NDArray[np.float32]
    focal: NDArray[np.float32]
    sensor: tuple[float, float]
    focus: NDArray[np.float32] | None = None
    aperture: float = 0.0


@dataclass(frozen=True, eq=False)
class Views:
    """N views: moment int32 [N] indexes the palettes; hidden bool [N, W] or [N, W + people], what
    is not drawn in the view: walls, then people; detail int32 [N, B], the level that each detailed body is
    drawn by (``Renderer.levels``), None: what each view by itself would take."""

    camera: Camera
    moment: NDArray[np.int32]
    hidden: NDArray[np.bool_]
    detail: NDArray[np.int32] | None = None


class Probed(NamedTuple):
    """What pixels [N, K] show.

    near: float32, 1/z (metres along the axis); role: uint8, of the object; both 0 where nothing is
    """

    near: NDArray[np.float32]
    role: NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Frames:
    """color: uint8 [N, H, W, 3] sRGB; ids: int32 [N, H, W] object id or -1, None unless asked for
    depth: float32 [N, H, W], metres along the optical axis, inf where nothing is; None unless asked for
    guides: uint8 [N, GUIDE_SIDE, GUIDE_SIDE, len(GUIDES)]; None unless asked for
    probed: at the pixels that were asked for
    """

    color: NDArray[np.uint8]
    ids: NDArray[np.int32] | None
    depth: NDArray[np.float32] | None = None
    guides: NDArray[np.uint8] | None = None
    probed: Probed | None = None
