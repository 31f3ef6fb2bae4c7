"""The discriminator's training set: random stories, filmed well and filmed badly.

Positives are what a geometry-only designer picks from the proposals of a line (the best by
:func:`vdsl.cinema.score.geometry_score` that do not look alike); negatives are picks shaken about
(:mod:`vdsl.pipeline.perturb`). Every draw is keyed by the seed and the story's number.
"""

from __future__ import annotations

import json
import random
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter

import numpy as np

from ranker.data import ShardWriter, Words

from ..cinema.score import geometry_score
from ..lang import Report, Settings, Source
from ..lang.ir import ANGLES, MOVEMENT_FAMILIES, SCALES
from ..lang.words import paper_word
from ..library import Catalog
from ..propose.story import propose
from ..propose.types import CameraProposal, ProposalGrid
from .compile import stage_acts
from .filming import Camerawork
from .perturb import perturbed
from .progress import Progress, Silence
from .script import ScriptError, check_source
from .selection import choose_takes
from .staging import Stagehand
from .stories import places, random_story

WORDS = Words(tuple(MOVEMENT_FAMILIES), SCALES, ANGLES)
_LINES = 5  # lines of a random story
_PICKS = 4  # clips of each kind a line
_PROPOSALS = 64
_LEAST_SCORE = 0.6
#: Negatives at least this strong no longer show the type their line asked for.
_STILL_THE_TYPE = 0.35
_FAMILY = {word: name for name, words in MOVEMENT_FAMILIES.items() for word in words}


@dataclass(frozen=True, eq=False)
class _Clip:
    camera: CameraProposal
    strength: float

    @property
    def shows_type(self) -> bool:
        return self.strength < _STILL_THE_TYPE


def generate(
    folder: Path, clips: int, seed: int = 0, device: str = "auto", progress: Progress | None = None
) -> int:
    """Write at least ``clips`` clips into ``folder``, going on where an earlier call stopped.

    Returns how many there are. Raises OSError or :class:`ranker.RankerError` for a folder that cannot
    be used.
    """
    watcher = progress or Silence()
    catalog = Catalog(Report())
    grounds = places(catalog)
    cast = tuple(sorted(catalog.names("cast")))
    camerawork = Camerawork(device)
    hand = Stagehand(catalog)
    marker = folder / "stories.json"
    with ShardWriter(folder, WORDS) as writer:
        number = json.loads(marker.read_text("utf-8"))["next"] if marker.exists() else 0
        watcher.begin("clips", max(0, clips - len(writer)), "clips")
        while len(writer) < clips:
            place = grounds[number % len(grounds)]
            rng = random.Random(f"{seed} story {number}")
            text = random_story(catalog, place, rng, _LINES, cast)
            before, begun = len(writer), perf_counter()
            _film_story(text, number, seed, f"{place.set}.{place.room}", hand, camerawork, writer)
            writer.flush()
            number += 1
            marker.write_text(json.dumps({"next": number}), "utf-8")
            watcher.advance("clips", len(writer) - before, perf_counter() - begun)
        return len(writer)


def _film_story(
    text: str,
    number: int,
    seed: int,
    group: str,
    hand: Stagehand,
    camerawork: Camerawork,
    writer: ShardWriter,
) -> None:
    """Film one story's lines; one that cannot be played (a way blocked, say) gives nothing."""
    try:
        checked = check_source(Source(f"<story {number}>", text), overrides=Settings(seed=seed + number))
        acts = stage_acts(checked, hand)
    except ScriptError:
        return
    rng = np.random.default_rng((seed, number))
    for act in acts:
        shot = replace(act.line.shots[0], proposals=_PROPOSALS)
        grid = propose(act.line, shot, act.state, act.filming)
        picked = _clips(grid, rng)
        if not picked:
            continue
        cameras = tuple(c.camera for c in picked)
        frames = camerawork.judge_frames(act.staged, shot.style, grid.story, cameras)
        for clip, pictures in zip(picked, frames, strict=True):
            c = clip.camera
            movement, scale, angle = (
                (_FAMILY[paper_word(c.movement)], paper_word(c.scale), paper_word(c.angle))
                if clip.shows_type
                else (None, None, None)
            )
            writer.add(pictures, clip.strength == 0.0, movement, scale, angle, group, clip.strength)


def _clips(grid: ProposalGrid, rng: np.random.Generator) -> list[_Clip]:
    """The designer's picks of a line, and as many spoilt ones at graded strengths."""
    scores = np.array([geometry_score(c.measures) for c in grid.cameras])
    good = (
        [i for i in choose_takes(grid.cameras, scores, _PICKS) if scores[i] >= _LEAST_SCORE]
        if len(scores)
        else []
    )
    out = [_Clip(grid.cameras[i], 0.0) for i in good]
    for i in good:
        strength = float(rng.uniform(0.1, 1.0))
        out.append(_Clip(_spoilt(grid.cameras[i], strength, rng), strength))
    return out


def _spoilt(camera: CameraProposal, strength: float, rng: np.random.Generator) -> CameraProposal:
    return replace(camera, track=perturbed(camera.track, strength, rng))
