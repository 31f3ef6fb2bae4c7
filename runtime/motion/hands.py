"""How hands lie in the bind pose: the axes along fingers, palm and thumb, and where their grip is."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, Skeleton

from .rotations import across, cross, norm, rot_zyx, rotation, unit

Array = NDArray[np.float64]
#: +1 left, -1 right, to be multiplied with [2, T] arrays.
MIRROR = np.array([1.0, -1.0])[:, None]


class Hands:
    """Both hands of a skeleton, left first, in the bind pose.

    fingers, palm, thumb: unit axes [2, 1, 3] along the fingers, out of the palm, and to the thumb
    offset: [2, 1, 3], from the wrist to the middle of the grip
    """

    def __init__(self, skeleton: Skeleton) -> None:
        bind = skeleton.bind
        reach = np.stack([bind[JOINT[f"fingers_{s}"]] - bind[JOINT[f"hand_{s}"]] for s in "lr"])
        fingers = unit(reach)
        thumb = across(np.array([1.0, 0.0, 0.0]), fingers)
        palm = MIRROR * cross(fingers, thumb)
        offset = fingers * norm(reach)[:, None] * 0.92 + palm * skeleton.height * 0.021 + thumb * 0.004
        medial = np.array([0.0, -1.0, 0.0]) * MIRROR
        ahead, up = np.broadcast_to((1.0, 0.0, 0.0), (2, 3)), np.broadcast_to((0.0, 0.0, 1.0), (2, 3))
        world = np.stack([ahead, medial, up], axis=-1)
        self.fingers, self.palm, self.thumb = fingers[:, None], palm[:, None], thumb[:, None]
        self.offset = offset[:, None]
        self._basis = (world @ np.stack([fingers, palm, thumb], axis=1))[:, None]

    def facing(self, heading: Array, inward: Array, pitch: Array, tilt: Array) -> Array:
        """World rotation of both hands [2, T, 3, 3] with thumbs up, palms facing each other.

        heading [T]; inward [2, T]: how far the fingers turn towards the middle; pitch [2, T]: fingers up;
        tilt [2, T]: the thumb's side tips towards the palm
        """
        return np.asarray(rot_zyx(heading[None] - MIRROR * inward, -pitch, MIRROR * tilt) @ self._basis)

    def turned_by(self, rotation: Array) -> Array:
        """World rotation of both hands that lie, fingers along X and thumb along Z, in the given frames
        [2, T, 3, 3]."""
        return np.asarray(rotation @ self._basis)

    def bent(self, turn: Array, side: Array, wrist: Array) -> Array:
        """Rotation of each hand against its forearm [2, T, 3, 3] in the bind frame, by angles [2, T]."""
        turned = rotation(self.fingers * (MIRROR * turn)[..., None])
        sideways = rotation(cross(self.fingers, self.thumb) * side[..., None])
        return np.asarray(turned @ sideways @ rotation(cross(self.fingers, self.palm) * wrist[..., None]))
