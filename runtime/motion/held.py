"""A thing in a hand: where its grip, rim and spout are, and how it is turned."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .rotations import rot_z

Array = NDArray[np.float64]
#: Metres from a thing's foot to its grip: from the first on it hangs from an arm, from the second on it
#: stands on the floor beside one, as a broom does.
HANGS, STANDS = 0.28, 0.8


@dataclass(frozen=True, eq=False)
class Held:
    """A thing in a hand: held from time ``since`` (seconds; far below 0: all along), when it was turned by
    ``rotation`` [3, 3]; ``grip`` [3] in its own coordinates."""

    since: float
    rotation: Array
    grip: Array

    @property
    def handle(self) -> bool:
        """Whether it is held by a handle beside it, rather than around its middle."""
        return bool(np.hypot(self.grip[0], self.grip[1]) > 0.02)

    @property
    def hangs(self) -> bool:
        """Whether it is carried by a handle on top of it, at the end of a straight arm: a bag, a bucket."""
        return not self.handle and HANGS <= float(self.grip[2]) < STANDS

    @property
    def axis_yaw(self) -> float:
        """Direction from the handle to the thing's middle, as it was; of what hangs, along its handle."""
        d = self.rotation @ (np.array([1.0, 0.0, 0.0]) if self.hangs else -self.grip)
        return float(np.arctan2(d[1], d[0]))

    @property
    def ahead(self) -> Array:
        """[3, 3]: its own coordinates to those in which it points along X: from the handle on to its middle,
        its front (-Y) where it is held around the middle."""
        to = float(np.arctan2(-self.grip[1], -self.grip[0])) if self.handle else -np.pi / 2
        return np.asarray(rot_z(np.array(-to)))

    @property
    def point(self) -> Array:
        """From the grip to its far end, [3] in its own coordinates: as far beyond the middle as the handle is
        before it; the foot of what stands."""
        flat = np.array([-2.0 * self.grip[0], -2.0 * self.grip[1], 0.0])
        return flat if self.handle else np.array([0.0, 0.0, -self.grip[2]])

    @property
    def rim(self) -> Array:
        """From the grip to the rim it is poured from or drunk from, [3] in its own coordinates."""
        top = float(np.clip(self.grip[2], 0.03, 0.2))
        return np.array([-self.grip[0], -self.grip[1], top])

    @property
    def spout(self) -> Array:
        """Like ``rim``, on the side away from the handle."""
        top = float(np.clip(self.grip[2], 0.03, 0.2))
        return np.array([-2.0 * self.grip[0], -2.0 * self.grip[1], 0.8 * top if self.handle else top])
