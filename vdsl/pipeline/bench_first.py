"""The first picture of a process: what starting costs before anything is drawn in earnest."""

from __future__ import annotations

import numpy as np

from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, Camera, RenderScene, Views
from runtime.shapes import box
from runtime.world import Light

SIZE = (1280, 720)
_LIGHT = Light(
    sun=(0.35, -0.55, 0.76),
    sun_color=(0.72, 0.68, 0.6),
    sky=(0.42, 0.46, 0.54),
    ground=(0.24, 0.22, 0.2),
    backdrop=((0.86, 0.89, 0.92), (0.62, 0.74, 0.88)),
)


def first_picture(device: str, style: str = "board") -> None:
    """Draw one picture at 720p of a floor and a box that moves: every kernel of the style is needed."""
    drawer = Renderer(device, STYLES[style])
    drawer.load(_scene())
    camera = Camera(
        np.array([[0.0, -4.0, 1.5]], np.float32),
        np.array([[[1, 0, 0], [0, 0, 1], [0, 1, 0]]], np.float32),
        np.array([35.0], np.float32),
        (36.0, 20.25),
    )
    still = np.eye(4, dtype=np.float32)[None, None, :3]
    drawer.render(still, Views(camera, np.zeros(1, np.int32), np.zeros((1, 0), np.bool_)), SIZE)


def _scene() -> RenderScene:
    floor, thing = box((6.0, 6.0, 0.01), color=(0.8, 0.74, 0.66)), box((0.4, 0.4, 1.6), 0.05)
    count = len(thing.vertices)
    weights = np.zeros((count, 4), np.float32)
    weights[:, 0] = 1.0
    return RenderScene(
        static=floor,
        static_object=np.zeros(len(floor.faces), np.int32),
        static_wall=np.full(len(floor.faces), -1, np.int32),
        skinned=thing,
        skinned_object=np.ones(len(thing.faces), np.int32),
        joints=np.zeros((count, 4), np.int32),
        weights=weights,
        wall_count=0,
        light=_LIGHT,
    )
