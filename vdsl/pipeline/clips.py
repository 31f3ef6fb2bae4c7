"""Which takes of a line become training clips: the designer's picks, as many spoilt ones, and their labels.

Assumes proposed shots of one performed line. Guarantees that a spoilt take is truly worse: its track is
measured again, and it stays only if the geometry says so or it no longer shows what its line asked for; and
that a label of movement, size or angle is what the track itself reads as.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ..cinema.track import CameraTrack
from ..lang.ir import Shot
from ..propose.cameras import measured_anew
from ..propose.promise import achieved
from ..propose.subjects import subject_of
from ..propose.types import CameraProposal, ProposalGrid
from .casting import Scene
from .designer import appeal, judged, picks
from .filming import segment_frames
from .hints import frame_hints_of
from .labels import classes
from .perturb import mistyped, perturbed

_PICKS = 4  # of each shot
#: Share of the negatives that are of no type; the others are perturbed.
_MISTYPED = 1 / 6
_MISTYPED_STRENGTH = 0.5
#: Strengths tried for a negative, each at least that of the one before: the first that is worse counts.
_TRIES = (0.0, 0.0, 0.4, 1.0)
#: Share of its appeal that a take has to lose where it gets no fault of the designer's.
_LOST = 0.08
#: Movement that is seen: a share of the distance, radians, log of the focal length.
_SEEN_WAY, _SEEN_TURN, _SEEN_ZOOM = 0.04, 0.04, 0.05

Words = tuple[str | None, str | None, str | None]


@dataclass(frozen=True, eq=False)
class Clip:
    """A take to be drawn. kind: ``designer``, ``perturbed`` or ``mistyped``; words: movement, size and angle
    as classes, None for what it does not show clearly; frames: what is known of each judged frame in numbers
    """

    camera: CameraProposal
    kind: str
    strength: float
    words: Words
    frames: dict[str, list[float]] = field(default_factory=dict)


def clips_of(scene: Scene, rng: np.random.Generator) -> list[Clip]:
    """The designer's picks of a scene's shots, and as many spoilt ones."""
    out: list[Clip] = []
    for shot, grid in zip(scene.shots, scene.grids, strict=True):
        kept = [grid.cameras[i] for i in picks(grid.cameras, _PICKS)]
        bad = [_spoilt(scene, shot, grid, camera, rng) for camera in kept]
        pairs = [(good, clip) for good, clip in zip(kept, bad, strict=True) if clip is not None]
        made = [Clip(good, "designer", 0.0, _read(scene, shot, grid, good)) for good, _ in pairs]
        made += [clip for _, clip in pairs]
        out += [replace(clip, frames=_frames(scene, shot, grid, clip.camera)) for clip in made]
    return out


def _frames(scene: Scene, shot: Shot, grid: ProposalGrid, camera: CameraProposal) -> dict[str, list[float]]:
    story = grid.story[camera.story]
    return frame_hints_of(camera, subject_of(shot, story, scene.filming), segment_frames(story.frames))


def _spoilt(
    scene: Scene, shot: Shot, grid: ProposalGrid, good: CameraProposal, rng: np.random.Generator
) -> Clip | None:
    """A worse take made of a good one; None where nothing that was tried made it worse."""
    if rng.random() < _MISTYPED:
        kind, strengths = "mistyped", [_MISTYPED_STRENGTH] * len(_TRIES)
        tracks = [mistyped(good.track, rng) for _ in strengths]
    else:
        drawn = float(rng.uniform(0.1, 1.0))
        kind, strengths = "perturbed", [max(drawn, least) for least in _TRIES]
        tracks = [perturbed(good.track, strength, rng) for strength in strengths]
    tried = [replace(good, track=track) for track in tracks]
    tried = measured_anew(shot, grid.story[good.story], scene.filming, tried)
    opinion = judged(tried)
    least = (1.0 - _LOST) * float(appeal({k: np.asarray(v) for k, v in good.measures.items()}))
    for camera, strength, thought in zip(tried, strengths, opinion, strict=True):
        words = _read(scene, shot, grid, camera)
        lost = [asked and not shown for asked, shown in zip(_asked(good), words, strict=True)]
        if thought < least or any(lost):
            return Clip(camera, kind, strength, (None, None, None) if kind == "mistyped" else words)
    return None


def _asked(camera: CameraProposal) -> Words:
    return classes(camera.movement, camera.scale, camera.angle)


def _read(scene: Scene, shot: Shot, grid: ProposalGrid, camera: CameraProposal) -> Words:
    """Movement, size and angle as classes, where the track reads as what was asked."""
    story = grid.story[camera.story]
    found = achieved(camera, subject_of(shot, story, scene.filming), scene.filming.rig).kept(camera)
    movement, scale, angle = _asked(camera)
    # who is followed may stay where they are, and then nobody can tell it from a still camera
    shown = found["movement"] and (movement != "follow" or moves(camera.track))
    return (
        movement if shown else None,
        scale if found["scale"] else None,
        angle if found["angle"] else None,
    )


def moves(track: CameraTrack) -> bool:
    """Whether one sees that a camera is not still: it turns, gets on or zooms enough at some time."""
    distance = np.maximum(np.linalg.norm(track.look_at - track.position, axis=-1), 0.2)
    way = np.linalg.norm(track.position - track.position[0], axis=-1) / distance[0]
    turn = np.abs((track.rotation - track.rotation[0] + np.pi) % (2 * np.pi) - np.pi).max(axis=-1)
    zoom = np.abs(np.log(track.focal / track.focal[0]))
    return bool(max(way.max() / _SEEN_WAY, turn.max() / _SEEN_TURN, zoom.max() / _SEEN_ZOOM) > 1.0)
