"""What a take turned out to be, held against the words of its line."""

from __future__ import annotations

from dataclasses import dataclass

from ..cinema.classify import achieved_angles, achieved_size
from ..cinema.focus import shows_rack
from ..cinema.reading import canonical, read_movement
from ..cinema.subject import Subject
from ..lang.ir import RACK
from .types import CameraProposal


@dataclass(frozen=True)
class Achieved:
    """Size, angle and movement read off a take's track, whatever was asked.

    Where a take may be called by several names, the line's own is told if it is among them.
    """

    movement: str
    scale: str
    angle: str

    def kept(self, camera: CameraProposal) -> dict[str, bool]:
        """Which of the take's own words came out as they were meant."""
        return {
            "movement": camera.movement == self.movement,
            "scale": camera.scale == self.scale,
            "angle": camera.angle == self.angle,
        }


def _read(movement: str, racks: bool) -> str:
    """A movement of the camera as it is told together with what the lens does."""
    if not racks:
        return movement
    return RACK if movement == "static" else f"{movement}+{RACK}"


def achieved(camera: CameraProposal, subject: Subject, rig: str) -> Achieved:
    """Read a take: its size and angle at the frame the framing is of, its movement over all of it."""
    key = subject.frames - 1 if camera.params.get("reference") == "end" else 0
    movements = read_movement(camera.track, subject)
    racks = shows_rack(camera.track, subject.heads.values() or (subject.landmarks["eyes"],))
    kept = canonical(camera.movement) in movements and racks == (RACK in camera.movement.split("+"))
    angles = achieved_angles(camera.track, subject, key)
    return Achieved(
        camera.movement if kept else _read(movements[0], racks),
        achieved_size(camera.track, subject, key, rig == "paper"),
        camera.angle if camera.angle in angles else angles[0],
    )
