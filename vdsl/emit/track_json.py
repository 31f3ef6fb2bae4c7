"""``take-<k>.json``: a take's camera, seven numbers a frame, and where its subject was (docs/output.md)."""

from __future__ import annotations

from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from .documents import TRACK_DECIMALS, dump, numbers, rounded, rows
from .folder import write_text
from .remember import remembering
from .types import Build, BuiltTake, TakeMedia
from .video import take_paths

SCHEMA = "vds.track/1"
#: In place of a take's pictures, which change from build to build, and make no difference here.
_UNSAID = TakeMedia(Path(), Path(), 0, ())


def write_tracks(folder: Path, build: Build) -> None:
    """Write the track of every take of a build into its folder."""
    for built in build.shots:
        for take in built.takes:
            _, _, path = take_paths(folder, built.shot.id, take.rank)
            path.parent.mkdir(parents=True, exist_ok=True)
            plain = replace(take, media=_UNSAID)
            write_text(path, _text(plain, built.shot.id, build.storyboard.fps, build.storyboard.rig))


@remembering(500)
def _text(take: BuiltTake, shot: str, fps: tuple[int, int], rig: str) -> str:
    """The document as it is written."""
    return dump(track_document(take, shot, fps, rig))


def track_document(take: BuiltTake, shot: str, fps: tuple[int, int], rig: str) -> dict[str, Any]:
    """The document as plain values: metres, degrees, millimetres."""
    camera, track = take.camera, take.camera.track
    subject = take.subject
    return {
        "schema": SCHEMA,
        "shot": shot,
        "rank": take.rank,
        "proposal": camera.index,
        "fps": list(fps),
        "frames": len(track.focal),
        "rig": rig,
        "sensor_mm": [rounded(x, TRACK_DECIMALS) for x in track.sensor],
        "movement": camera.movement,
        "scale": camera.scale,
        "angle": camera.angle,
        "achieved": asdict(take.achieved),
        "params": numbers(camera.params, 12),
        "camera": {
            "position": rows(track.position),
            "rotation_deg": rows(np.rad2deg(track.rotation)),
            "focal_mm": rows(track.focal),
            "look_at": rows(track.look_at),
            "focus_m": None if track.focus is None else rows(track.focus),
            "aperture": rounded(float(track.aperture), TRACK_DECIMALS),
        },
        "subject": None
        if subject is None
        else {
            "name": subject.name,
            "height": rounded(subject.height, TRACK_DECIMALS),
            "position": rows(subject.position),
        },
        "people": [
            {
                "name": walk.name,
                "position": rows(walk.position),
                "facing_deg": rows(np.rad2deg(walk.heading)),
                "head": rows(walk.head),
            }
            for walk in take.people
        ],
        "measures": numbers(camera.measures),
    }
