"""Which takes of a line become training clips: the designer's picks, as many that are not, and their labels.

Assumes proposed shots of one performed line. Guarantees that what is called bad is nothing the designer would
pick: proposals that were passed over have a fault or too little appeal, and the track of a spoilt take is
measured again, and stays only if the same is true of it or it no longer shows what its line asked for; and
that a label of movement, size or angle is what the track itself reads as.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

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
from .perturb import mistyped, perturbation

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
        made = _made(scene, shot, grid, rng)
        about = about_of(shot, grid, scene.filming, scene.staged)
        subjects = [subject_of(shot, story, scene.filming) for story in grid.story]
        told: dict[int, dict[str, list[float]]] = {}
        for k, story in enumerate(grid.story):
            rows = [i for i, clip in enumerate(made) if clip.camera.story == k]
            cameras = [made[i].camera for i in rows]
            told |= zip(rows, frame_hints_of(cameras, subjects[k], segment_frames(story.frames)), strict=True)
        for i, clip in enumerate(made):
            at = segment_frames(grid.story[clip.camera.story].frames)
            out.append(replace(clip, frames=told[i], meant=meant(clip.camera, at), about=about, shot=shot))
    return out


def _made(scene: Scene, shot: Shot, grid: ProposalGrid, rng: np.random.Generator) -> list[Clip]:
    """The clips of a shot. All that is left to chance is drawn first, so that what has to be measured is
    measured together."""
    opinion = judged(grid.cameras)
    kept = [i for i in picks(grid.cameras, _PICKS) if opinion[i] >= BAR]
    left = [i for i in rng.permutation(len(grid.cameras)) if opinion[i] < BAR * (1 - _LOST)]
    passed_over: dict[int, int] = {}  # in place of a spoilt one, by the pick it stands beside
    attempts: list[_Attempts] = []
    for i in kept:
        good = grid.cameras[i]
        if left and rng.random() < _PASSED_OVER:
            passed_over[i] = left[0]
            left = left[1:]
        else:
            attempts.append(_attempts(i, good, float(opinion[i]), rng))
        for kind in _KINDS if scene.split == "train" else ():
            attempts.append(_attempts(i, good, float(opinion[i]), rng, kind, bare=True))
    spoilt: dict[int, list[Clip]] = {i: [] for i in kept}
    beside: dict[int, Clip] = {}
    for tried, clip in zip(attempts, _spoilt(scene, shot, grid, attempts), strict=True):
        if clip is not None and tried.bare:
            spoilt[tried.pick].append(replace(clip, bare=True))
        elif clip is not None:
            beside[tried.pick] = clip
    made: list[Clip] = []
    for i in kept:
        good = grid.cameras[i]
        if i in passed_over:
            k = passed_over[i]
            beside[i] = _proposed(scene, shot, grid, grid.cameras[k], float(opinion[k]))
        if i in beside:
            words = _read(scene, shot, grid, good)
            made += [Clip(good, "designer", 0.0, float(opinion[i]), words), beside[i]]
        made += spoilt[i]
    shown = {id(clip.camera) for clip in made}
    for camera, thought in zip(grid.cameras, opinion, strict=True):
        if id(camera) not in shown and scene.split == "train":
            made.append(replace(_proposed(scene, shot, grid, camera, float(thought)), bare=True))
    return made


def as_seen(clips: Sequence[Clip], cameras: Sequence[CameraProposal]) -> list[Clip]:
    """Clips as their pictures turned out, by what is measured of them in ``cameras``: one that was not spoilt
    is good or bad by the opinion of now; of one that was, and is not worse any more, nobody knows."""
    out = []
    for clip, camera, thought in zip(clips, cameras, judged(cameras).tolist(), strict=True):
        seen = replace(clip, camera=camera, opinion=thought)
        unsure = clip.doubtful or clip.opinion < BAR * (1 - _LOST) <= thought
        out.append(replace(seen, doubtful=unsure) if clip.kind in _KINDS else _by_opinion(seen))
    return out


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


@dataclass(frozen=True, eq=False)
class _Attempts:
    """A good take spoilt in ways that are tried one after the other.

    pick: index of the good one; least: opinion from which on it is not worse; bare: whether its guides are
    enough
    """

    pick: int
    good: CameraProposal
    kind: str
    least: float
    strengths: list[float]
    tracks: Sequence[Callable[[], CameraTrack]]
    bare: bool


def _attempts(
    pick: int,
    good: CameraProposal,
    appeal: float,
    rng: np.random.Generator,
    kind: str = "",
    bare: bool = False,
) -> _Attempts:
    """Ways to spoil a good take, of a kind or of any."""
    tracks: list[partial[CameraTrack]]
    kind = kind or _KINDS[int(rng.random() < _MISTYPED)]
    if kind == "mistyped":
        strengths = [_MISTYPED_STRENGTH] * len(_TRIES)
        tracks = [partial(_as_it_is, mistyped(good.track, rng)) for _ in strengths]
    else:
        drawn = float(rng.uniform(0.1, 1.0))
        strengths = [max(drawn, least) for least in _TRIES]
        tracks = [partial(perturbation(strength, rng), good.track) for strength in strengths]
    return _Attempts(pick, good, kind, min(BAR, (1.0 - _LOST) * appeal), strengths, tracks, bare)


def _as_it_is(track: CameraTrack) -> CameraTrack:
    return track


def _spoilt(scene: Scene, shot: Shot, grid: ProposalGrid, attempts: Sequence[_Attempts]) -> list[Clip | None]:
    """Of each the first that is worse; None where nothing that was tried made it worse. What is tried at a
    time of takes of one performance is measured together."""
    found: list[Clip | None] = [None] * len(attempts)
    open_ = list(range(len(attempts)))
    for turn in range(len(_TRIES)):
        for story in sorted({attempts[k].good.story for k in open_}):
            some = [k for k in open_ if attempts[k].good.story == story]
            tried = [replace(attempts[k].good, track=attempts[k].tracks[turn]()) for k in some]
            tried = measured_anew(shot, grid.story[story], scene.filming, tried)
            for k, camera, thought in zip(some, tried, judged(tried), strict=True):
                found[k] = _worse(scene, shot, grid, attempts[k], turn, camera, float(thought))
        open_ = [k for k in open_ if found[k] is None]
    return found


def _worse(
    scene: Scene,
    shot: Shot,
    grid: ProposalGrid,
    attempts: _Attempts,
    turn: int,
    camera: CameraProposal,
    thought: float,
) -> Clip | None:
    """A spoilt take where it is worse than the good one: by the designer, or it lost what was asked."""
    nothing = (None, None, None)
    if attempts.kind == "mistyped" and thought < attempts.least and _seen(camera, thought):
        return Clip(camera, attempts.kind, attempts.strengths[turn], thought, nothing)  # whatever it shows
    words = _read(scene, shot, grid, camera)
    lost = any(asked and not shown for asked, shown in zip(_asked(attempts.good), words, strict=True))
    if thought >= attempts.least and not lost:
        return None
    known = nothing if attempts.kind == "mistyped" else words
    doubtful = not lost and not _seen(camera, thought)
    return Clip(camera, attempts.kind, attempts.strengths[turn], thought, known, doubtful=doubtful)


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
