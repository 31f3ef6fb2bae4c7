"""Camera tracks: seven numbers a frame, and what they mean.

The camera frame is X_C right, Y_C up, Z_C along the optical axis. Yaw γ turns about Y_C (at rest the
world's Z): 0 looks along +X, positive to the left. Pitch β turns about X_C, positive looks up.
Roll α turns about Z_C, positive leans the camera to its right (the horizon tips to the left side
down in the picture's own frame). Arrays may carry leading batch axes: [..., T, 3].
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class CameraTrack:
    """A take's camera over T frames (float64; metres, radians, mm).

    position [..., T, 3]; rotation [..., T, 3] as (roll, pitch, yaw); focal [..., T];
    look_at [..., T, 3], the aimed-at point; sensor (width, height) in mm
    focus [..., T], metres along the optical axis to what is sharp, None where everything is; aperture [...],
        f-number of the lens, 0 where everything is sharp
    """

    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    focal: NDArray[np.float64]
    look_at: NDArray[np.float64]
    sensor: tuple[float, float]
    focus: NDArray[np.float64] | None = None
    aperture: NDArray[np.float64] | float = 0.0

    def __getstate__(self) -> dict[str, Any]:
        """The fields alone: tracks that are the same are written the same, whatever was asked of them."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @cached_property
    def axes(self) -> NDArray[np.float64]:
        """Right, up and forward of the camera as rows, [..., T, 3, 3]."""
        return camera_axes(self.rotation)

    def only(self, rows: NDArray[np.int64] | int) -> CameraTrack:
        """Some of the tracks of a batch, or one of them by itself."""
        return CameraTrack(
            self.position[rows],
            self.rotation[rows],
            self.focal[rows],
            self.look_at[rows],
            self.sensor,
            None if self.focus is None else self.focus[rows],
            self.aperture if isinstance(self.aperture, float) else self.aperture[rows],
        )


def look_at_rotation(
    position: NDArray[np.float64], target: NDArray[np.float64], roll: float | NDArray[np.float64] = 0.0
) -> NDArray[np.float64]:
    """Roll, pitch, yaw [..., 3] that aim from ``position`` [..., 3] at ``target`` with a level horizon."""
    d = target - position
    yaw = np.arctan2(d[..., 1], d[..., 0])
    pitch = np.arctan2(d[..., 2], np.hypot(d[..., 0], d[..., 1]))
    return np.stack([np.broadcast_to(roll, yaw.shape), pitch, yaw], axis=-1)


def camera_axes(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Right, up and forward as rows, [..., 3, 3], from roll, pitch, yaw [..., 3]."""
    roll, pitch, yaw = rotation[..., 0], rotation[..., 1], rotation[..., 2]
    cb, sb, cg, sg = np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    ca, sa = np.cos(roll), np.sin(roll)
    out = np.empty((*np.shape(roll), 3, 3))
    forward = out[..., 2, :]
    forward[..., 0], forward[..., 1], forward[..., 2] = cb * cg, cb * sg, sb
    level = (sg, -cg, 0.0)  # to the right, and over the picture, of a camera that does not lean
    over = (-cg * sb, -sg * sb, sg * forward[..., 1] + cg * forward[..., 0])
    for k in range(3):
        out[..., 0, k] = ca * level[k] - sa * over[k]
        out[..., 1, k] = sa * level[k] + ca * over[k]
    return out


def project(
    points: NDArray[np.float64],
    position: NDArray[np.float64],
    axes: NDArray[np.float64],
    focal: NDArray[np.float64],
    sensor: tuple[float, float],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Picture coordinates of points: x right, y down, both 0..1 inside the frame; and depth in metres.

    points [..., K, 3]; position [..., 3]; axes [..., 3, 3]; focal [...] -> ([..., K, 2], [..., K])
    """
    local = np.einsum("...ij,...kj->...ki", axes, points - position[..., None, :])
    depth = local[..., 2]
    safe = np.where(np.abs(depth) < 1e-9, 1e-9, depth)
    x = 0.5 + focal[..., None] * local[..., 0] / safe / sensor[0]
    y = 0.5 - focal[..., None] * local[..., 1] / safe / sensor[1]
    return np.stack([x, y], axis=-1), depth
