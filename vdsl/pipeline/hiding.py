"""Designer's picks hidden among proposals: how high a ranker puts them, and how often it agrees.

The paper's test of its section 4.4 on stories for testing only: of every shot all proposals are drawn and
scored, and one of them is the designer's pick. Assumes stories nobody trained on. Scores are kept shot by
shot, so that a stopped evaluation goes on; frames are not.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ranker.evaluate import agreement, hidden
from ranker.infer import Ranker

from ..cinema.score import geometry_score, parts
from ..lang.ir import Shot
from ..propose.types import CameraProposal, ProposalGrid
from .ahead import one_ahead
from .casting import TEST_EVERY, Scene, Troupe
from .dataset import made
from .designer import judged, picks
from .drawn import as_drawn
from .filming import Camerawork, Seen
from .guides import about_of
from .judging import prior
from .progress import Progress, Silence

_A_SHOT = 100  # proposals
_CHOICES = 20  # of a shot
_SEED = 1_000_003  # added to the data's seed: other stories than its own
_AT_ONCE = 16


@dataclass(frozen=True)
class Scored:
    """The proposals of a shot [P]: what the ranker says of each, and the designer, who has seen them drawn.

    picked: the one the designer likes best; choices: all that may be picked, no two alike, best first;
        opinions: of all, as :func:`vdsl.pipeline.designer.judged`
    logits: log odds of p_b; margins: what the ranker puts takes in order by; priors: what compile adds to
        that for the geometry
    geometry: parts of the geometry score, by name
    """

    shot: str
    picked: int
    choices: list[int]
    opinions: list[float]
    logits: list[float]
    margins: list[float]
    priors: list[float]
    geometry: dict[str, list[float]]


def hide(
    ranker: Ranker,
    kept: Path,
    proposals: int,
    seed: int = 0,
    device: str = "auto",
    progress: Progress | None = None,
    pictures: bool = True,
) -> list[Scored]:
    """Score at least so many proposals of shots of test stories, going on with what ``kept`` holds.

    kept: a file of JSON lines, of these weights alone; pictures: whether they are looked at beside the
    guides. Raises OSError, ValueError for weights that need pictures.
    """
    watcher = progress or Silence()
    head = {**made(seed), "schema": 4}
    done, numbers = _read(kept, head)
    count = sum(len(s.margins) for s in done)
    watcher.begin("proposals", max(0, proposals - count), "proposals")
    troupe, camerawork = Troupe(seed + _SEED), Camerawork(device)
    kept.parent.mkdir(parents=True, exist_ok=True)
    with kept.open("a", encoding="utf-8") as file:
        if not kept.stat().st_size:
            file.write(json.dumps(head) + "\n")
        for name, scene, shot, grid in _shots(troupe):
            if count >= proposals:
                break
            if name in numbers:
                continue
            if not picks(grid.cameras, 1):
                continue
            begun = perf_counter()
            scored = _scored(name, scene, shot, grid, ranker, camerawork, pictures)
            if scored is None:
                continue
            file.write(json.dumps(asdict(scored)) + "\n")
            file.flush()
            done.append(scored)
            count += len(scored.margins)
            watcher.advance("proposals", len(scored.margins), perf_counter() - begun)
    return done


def told(shots: list[Scored]) -> dict[str, Any]:
    """``picks``, ``proposals``, how high the picks are among all, and agreement within each shot.

    ``by_p_b``: the same without how well they would be liked; ``with_prior``: as ``compile`` puts takes in
    order. As in the paper one in a hundred of all proposals is picked: those the designer likes best,
    whatever shot they are of. ``best_of_each_shot``: the same of the one that is liked best in every shot,
    though it may be no good one, by the ranker, and by the designer's own opinion, which no ranker can outdo.
    """
    if not shots:
        return {"picks": 0, "proposals": 0, **hidden(np.zeros(0), np.zeros(0, bool)), "agreement": {}}
    margins = np.concatenate([s.margins for s in shots])
    opinions = np.concatenate([s.opinions for s in shots])
    picked = np.concatenate([np.arange(len(s.margins)) == s.picked for s in shots])
    best = best_of_all(shots)
    names = [s.shot for s in shots for _ in s.margins]
    by = {"ranker": margins, "ranker with prior": margins + np.concatenate([s.priors for s in shots])}
    for key in shots[0].geometry:
        by[key] = np.concatenate([s.geometry[key] for s in shots])
    return {
        "picks": int(best.sum()),
        "proposals": len(margins),
        **hidden(margins, best),
        "by_p_b": hidden(np.concatenate([s.logits for s in shots]), best),
        "with_prior": hidden(by["ranker with prior"], best),
        "best_of_each_shot": {"ranker": hidden(margins, picked), "designer": hidden(opinions, picked)},
        "agreement": agreement(by, picked, names),
    }


def best_of_all(shots: Sequence[Scored]) -> NDArray[np.bool_]:
    """Which of all proposals [P] the designer picks: one in a hundred, the best liked of what may be
    picked."""
    begins = np.cumsum([0, *(len(s.margins) for s in shots)])
    may = np.array([begin + i for s, begin in zip(shots, begins, strict=False) for i in s.choices])
    liked = np.concatenate([s.opinions for s in shots])
    out = np.zeros(len(liked), bool)
    out[may[np.argsort(-liked[may], kind="stable")[: round(len(liked) / _A_SHOT)]]] = True
    return out


def _shots(troupe: Troupe) -> Iterator[tuple[str, Scene, Shot, ProposalGrid]]:
    number = TEST_EVERY - 1
    while True:
        for scene in troupe.scenes(number, _A_SHOT, "test"):
            for shot, grid in zip(scene.shots, scene.grids, strict=True):
                yield f"{number} {shot.id}", scene, shot, grid
        number += TEST_EVERY


def _scored(
    name: str,
    scene: Scene,
    shot: Shot,
    grid: ProposalGrid,
    ranker: Ranker,
    camerawork: Camerawork,
    pictures: bool,
) -> Scored | None:
    """Of a shot; None where there is none that the designer would pick."""
    logits: list[float] = []
    margins: list[float] = []
    size = ranker.config.size

    subject = about_of(shot, grid, scene.filming, scene.staged)

    def drawn(begin: int) -> Seen:
        cameras = grid.cameras[begin : begin + _AT_ONCE]
        about = [subject] * len(cameras)
        return camerawork.judge_frames(
            *(scene.staged, shot.style, grid.story, cameras, (size, size)),
            about=about,
            pictures=pictures,
            depths=True,
        )

    found: list[CameraProposal] = []
    for begin, seen in one_ahead(drawn, range(0, len(grid.cameras), _AT_ONCE)):
        assert seen.guides is not None
        cameras = grid.cameras[begin : begin + _AT_ONCE]
        found += as_drawn(shot, grid.story, scene.filming, scene.staged, cameras, seen)
        scores = ranker.score(seen.frames, seen.guides) if pictures else ranker.by_guides(seen.guides)
        logits += [round(float(m), 5) for m in scores.logit]
        margins += [round(float(m), 5) for m in scores.margin]
    measures = {k: np.array([c.measures[k] for c in grid.cameras]) for k in grid.cameras[0].measures}
    alone = {k: [round(float(v), 4) for v in values] for k, values in parts(measures).items()}
    alone["geometry score"] = [round(geometry_score(c.measures), 4) for c in grid.cameras]
    priors = [round(float(prior(c.measures)), 4) for c in found]  # as they were drawn, as compile has them
    choices = picks(found, _CHOICES)
    if not choices:
        return None
    opinions = [round(float(o), 5) for o in judged(found)]
    return Scored(name, choices[0], choices, opinions, logits, margins, priors, alone)


def _read(kept: Path, head: dict[str, Any]) -> tuple[list[Scored], set[str]]:
    """What an earlier run scored; a file of something else is begun anew, one that was cut off mended."""
    try:
        lines = kept.read_text("utf-8").split("\n")
        if json.loads(lines[0]) != head:
            raise ValueError
    except FileNotFoundError:
        return [], set()
    except ValueError:
        kept.unlink()
        return [], set()
    done: list[Scored] = []
    for line in lines[1:-1]:  # the last is empty, or was not written to its end
        done.append(Scored(**json.loads(line)))
    if lines[-1]:
        kept.write_text("\n".join(lines[:-1]) + "\n", "utf-8")
    return done, {s.shot for s in done}
