"""What a take turned out to be, held against the words of its line."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..cinema.classify import (
    achieved_angle,
    achieved_angles,
    achieved_movement,
    achieved_size,
    shows_movement,
)
from ..cinema.moves import families, family
from ..cinema.subject import Subject
from .types import CameraProposal


@dataclass(frozen=True)
class Achieved:
    """Size, angle and movement read off a take's track, whatever was asked; the movement is a family."""

    movement: str
    scale: str
    angle: str

    def kept(self, camera: CameraProposal) -> dict[str, bool]:
        """Which of the take's own words came out as they were meant.

        Tilts and pedestals pass through angles.
        A camera that the floor held up looks up less than a low angle does, and counts as one.
        """
        return {
            "movement": family(camera.movement) == self.movement,
            "scale": camera.scale == self.scale,
            "angle": camera.angle == self.angle
            or "lifted" in camera.params
            or bool(families(camera.movement) & {"tilt", "pedestal"}),
        }


def achieved(camera: CameraProposal, subject: Subject, rig: str) -> Achieved:
    """Read a take: its size and angle at the frame the framing is of, its movement over all of it."""
    key = subject.frames - 1 if camera.params.get("reference") == "end" else 0
    elevation = math.radians(camera.measures["elevation"])
    angles = achieved_angles(elevation, camera.measures["height"], subject, key)
    return Achieved(
        _movement(camera, subject),
        achieved_size(camera.track, subject, key, rig == "paper"),
        camera.angle if camera.angle in angles else achieved_angle(elevation),
    )


def _movement(camera: CameraProposal, subject: Subject) -> str:
    """The family of what the track does: that which was asked for where it may be called so."""
    asked = family(camera.movement)
    if asked != "static" and shows_movement(asked, camera.track, subject.position):
        return asked
    return achieved_movement(camera.track, subject.position)
