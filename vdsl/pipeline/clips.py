"""Which takes of a line become training clips: the designer's picks, as many that are not, and their labels.

Assumes proposed shots of one performed line. Guarantees that what is called bad is nothing the designer would
pick: proposals that were passed over have a fault or too little appeal, and the track of a spoilt take is
measured again, and stays only if the same is true of it or it no longer shows what its line asked for; and
that a label of movement, size or angle is what the track itself reads as.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ..cinema.flaws import flaws
from ..cinema.track import CameraTrack
from ..lang.ir import Shot
from ..propose.cameras import measured_anew
from ..propose.promise import achieved
from ..propose.subjects import subject_of
from ..propose.types import CameraProposal, ProposalGrid
from .casting import Scene
from .designer import judged, picks
from .filming import segment_frames
from .guides import About, about_of
from .hints import frame_hints_of, meant
from .labels import classes
from .perturb import mistyped, perturbed

_PICKS = 4  # of each shot
#: Appeal below which nothing is picked, as good as the rest may be.
BAR = 0.72
#: Share of the negatives that are proposals passed over; of the others, of those that are of no type. The
#: rest is perturbed.
_PASSED_OVER, _MISTYPED = 0.5, 0.2
_KINDS = ("perturbed", "mistyped")
_MISTYPED_STRENGTH = 0.5
#: Strength of a proposal that was passed over, by the criteria in which it has a fault.
_A_FAULT = 0.25
#: Strengths tried for a negative, each at least that of the one before: the first that is worse counts.
_TRIES = (0.0, 0.0, 0.0, 0.3, 0.6, 1.0)
#: Share of its appeal that a take has to lose where it gets no fault of the designer's.
_LOST = 0.08
#: Movement that is seen: a share of the distance, radians, log of the focal length.
_SEEN_WAY, _SEEN_TURN, _SEEN_ZOOM = 0.04, 0.04, 0.05

Words = tuple[str | None, str | None, str | None]
_NOTHING = About((), {})


@dataclass(frozen=True, eq=False)
class Clip:
    """A take to be drawn.

    kind: ``designer``, ``passed-over``, ``perturbed`` or ``mistyped``; opinion: the designer's, as
    :func:`vdsl.pipeline.designer.judged`; words: movement, size and angle as classes, None for what it does
    not show clearly; frames: what is known of each judged frame in numbers; meant: whether its subject is to
    be in the picture of that; about: what it is about; shot: of which it is a take
    doubtful: whether it is bad for reasons that no picture shows, or hardly bad; bare: whether its guides are
    enough
    """

    camera: CameraProposal
    kind: str
    strength: float
    opinion: float
    words: Words
    frames: dict[str, list[float]] = field(default_factory=dict)
    meant: list[int] = field(default_factory=list)
    about: About = _NOTHING
    shot: Shot | None = None
    doubtful: bool = False
    bare: bool = False

    @property
    def grade(self) -> float:
        """How far a good one is above the bar, 0..1."""
        return min(max((self.opinion - BAR) / (1.0 - BAR), 0.0), 1.0)


def clips_of(scene: Scene, rng: np.random.Generator) -> list[Clip]:
    """The designer's picks of a scene's shots, and as many takes that are not; to learn from, all other
    proposals as well, and of every pick two takes that are spoilt, all bare."""
    out: list[Clip] = []
    for shot, grid in zip(scene.shots, scene.grids, strict=True):
        opinion = judged(grid.cameras)
        kept = [i for i in picks(grid.cameras, _PICKS) if opinion[i] >= BAR]
        left = [i for i in rng.permutation(len(grid.cameras)) if opinion[i] < BAR * (1 - _LOST)]
        made: list[Clip] = []
        for i in kept:
            good = grid.cameras[i]
            if left and rng.random() < _PASSED_OVER:
                worse = grid.cameras[left[0]]
                bad: Clip | None = _proposed(scene, shot, grid, worse, float(opinion[left[0]]))
                left = left[1:]
            else:
                bad = _spoilt(scene, shot, grid, good, float(opinion[i]), rng)
            if bad is not None:
                words = _read(scene, shot, grid, good)
                made += [Clip(good, "designer", 0.0, float(opinion[i]), words), bad]
            for kind in _KINDS if scene.split == "train" else ():
                more = _spoilt(scene, shot, grid, good, float(opinion[i]), rng, kind)
                made += [] if more is None else [replace(more, bare=True)]
        shown = {id(clip.camera) for clip in made}
        for camera, thought in zip(grid.cameras, opinion, strict=True):
            if id(camera) not in shown and scene.split == "train":
                made.append(replace(_proposed(scene, shot, grid, camera, float(thought)), bare=True))
        about = about_of(shot, grid, scene.filming, scene.staged)
        for clip in made:
            story = grid.story[clip.camera.story]
            subject, at = subject_of(shot, story, scene.filming), segment_frames(story.frames)
            told = frame_hints_of(clip.camera, subject, at)
            out.append(replace(clip, frames=told, meant=meant(clip.camera, at), about=about, shot=shot))
    return out


def as_seen(clip: Clip, camera: CameraProposal) -> Clip:
    """A clip as its pictures turned out, by what is measured of them in ``camera``: one that was not spoilt
    is good or bad by the opinion of now; of one that was, and is not worse any more, nobody knows."""
    thought = float(judged([camera])[0])
    seen = replace(clip, camera=camera, opinion=thought)
    if clip.kind not in _KINDS:
        return _by_opinion(seen)
    return replace(seen, doubtful=clip.doubtful or clip.opinion < BAR * (1 - _LOST) <= thought)


def _by_opinion(clip: Clip) -> Clip:
    """A proposal as the designer's opinion has it: good, or passed over."""
    if clip.opinion >= BAR:
        return replace(clip, kind="designer", strength=0.0, doubtful=False)
    wrong = sum(bool(found) for found in flaws(clip.camera.measures).values())
    doubtful = not _seen(clip.camera, clip.opinion) or clip.opinion >= BAR * (1 - _LOST)
    return replace(clip, kind="passed-over", strength=min(max(wrong, 1) * _A_FAULT, 1.0), doubtful=doubtful)


def _proposed(scene: Scene, shot: Shot, grid: ProposalGrid, camera: CameraProposal, opinion: float) -> Clip:
    """A proposal, picked or not: good or bad as the designer says."""
    return _by_opinion(Clip(camera, "designer", 0.0, opinion, _read(scene, shot, grid, camera)))


def _seen(camera: CameraProposal, opinion: float) -> bool:
    """Whether one can see what is wrong with a take: it has little appeal, or a fault that shows."""
    return opinion >= 0 or any(bool(found) for found in flaws(camera.measures, seen=True).values())


def _spoilt(
    scene: Scene,
    shot: Shot,
    grid: ProposalGrid,
    good: CameraProposal,
    appeal: float,
    rng: np.random.Generator,
    kind: str = "",
) -> Clip | None:
    """A worse take made of a good one, of a kind or of any; None where nothing that was tried made it
    worse."""
    kind = kind or _KINDS[int(rng.random() < _MISTYPED)]
    if kind == "mistyped":
        strengths = [_MISTYPED_STRENGTH] * len(_TRIES)
        tracks = [mistyped(good.track, rng) for _ in strengths]
    else:
        drawn = float(rng.uniform(0.1, 1.0))
        strengths = [max(drawn, least) for least in _TRIES]
        tracks = [perturbed(good.track, strength, rng) for strength in strengths]
    tried = [replace(good, track=track) for track in tracks]
    tried = measured_anew(shot, grid.story[good.story], scene.filming, tried)
    least = min(BAR, (1.0 - _LOST) * appeal)
    for camera, strength, thought in zip(tried, strengths, judged(tried), strict=True):
        words = _read(scene, shot, grid, camera)
        lost = [asked and not shown for asked, shown in zip(_asked(good), words, strict=True)]
        if thought < least or any(lost):
            known = (None, None, None) if kind == "mistyped" else words
            doubtful = not any(lost) and not _seen(camera, thought)
            return Clip(camera, kind, strength, float(thought), known, doubtful=doubtful)
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
