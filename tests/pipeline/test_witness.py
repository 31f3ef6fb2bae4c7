"""Takes whose subject is hidden in the picture give way, however clear the lines of sight were."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from proposed_shots import proposed

from vdsl.lang import Source
from vdsl.pipeline.compile import Act, stage_acts
from vdsl.pipeline.filming import Camerawork
from vdsl.pipeline.judging import GeometryJudge
from vdsl.pipeline.script import check_source
from vdsl.pipeline.selection import choose_takes
from vdsl.pipeline.witness import MEASURE, REASON, UNLIKE, best, counted, vet
from vdsl.propose.story import propose
from vdsl.propose.types import ProposalGrid

STORY = """\
storyboard "Seen"
proposals 24
takes 3
character anna = woman
scene kitchen = apartment.kitchen
anna at door facing window
(anna wave) / (SHOT eye-level) OPTIONS
"""


@pytest.fixture(scope="module")
def camerawork() -> Camerawork:
    return Camerawork("cpu")


def filmed(shot: str, options: str = "") -> tuple[Act, ProposalGrid]:
    return proposed(STORY.replace("SHOT", shot).replace("OPTIONS", options))


def test_what_is_seen_is_as_was_promised(camerawork: Camerawork) -> None:
    act, grid = filmed("static medium")
    shot = act.line.shots[0]
    scores = GeometryJudge().scores(grid.cameras, None)
    vetted = vet(grid, scores, best(grid, 3), (act.staged, shot, act.filming), camerawork)
    assert not vetted.failed
    assert np.array_equal(vetted.order, scores)
    looked = [c.measures for c in grid.cameras if MEASURE in c.measures]
    assert len(looked) == 3
    for measures in looked:
        assert measures[MEASURE] == pytest.approx(measures["visibility"], abs=0.15)


def test_a_subject_behind_a_wall_gives_way_to_the_next(camerawork: Camerawork) -> None:
    """The walls that were promised to be taken away are put back before the best takes."""
    act, grid = filmed("static full", "lens 50mm")
    shot = act.line.shots[0]
    scores = GeometryJudge().scores(grid.cameras, None)
    scores += np.array([c.hidden_walls.any() for c in grid.cameras])  # whoever judges likes these best
    outside = choose_takes(grid.cameras, scores, 2)
    assert all(grid.cameras[i].hidden_walls.any() for i in outside)
    cameras = list(grid.cameras)
    for i in outside:
        walled = np.zeros_like(cameras[i].hidden_walls)
        cameras[i] = replace(cameras[i], hidden_walls=walled, measures=dict(cameras[i].measures))
    grid = replace(grid, cameras=tuple(cameras))
    assert set(choose_takes(grid.cameras, scores, 3)) >= set(outside)
    vetted = vet(grid, scores, best(grid, 3), (act.staged, shot, act.filming), camerawork)
    chosen = choose_takes(grid.cameras, vetted.order, 3)
    assert set(vetted.failed) >= set(outside)
    assert not set(chosen) & set(outside)
    assert all(cameras[i].measures[MEASURE] < 0.5 for i in outside)
    assert all(cameras[i].measures[MEASURE] >= 0.5 for i in chosen)
    assert counted(grid.rejected, vetted.failed, chosen)[REASON] == len(vetted.failed)
    # where nothing else is left they stay
    alone = replace(grid, cameras=tuple(cameras[i] for i in outside))
    worst = vet(alone, scores[outside], best(alone, 1), (act.staged, shot, act.filming), camerawork)
    assert len(choose_takes(alone.cameras, worst.order, 1)) == 1
    assert counted({}, worst.failed, choose_takes(alone.cameras, worst.order, 1)) == {REASON: 1}


def test_things_are_looked_at_and_places_are_not(camerawork: Camerawork) -> None:
    act, grid = filmed("static close-up", "focus table")
    scores = GeometryJudge().scores(grid.cameras, None)
    vet(grid, scores, best(grid, 2), (act.staged, act.line.shots[0], act.filming), camerawork)
    shares = [c.measures[MEASURE] for c in grid.cameras if MEASURE in c.measures]
    assert len(shares) >= 2
    assert min(shares) > 0.5
    text = STORY.replace("(anna wave) / (SHOT eye-level) OPTIONS", "/ (static wide eye-level)")
    (act,) = stage_acts(check_source(Source("seen.vds", text)))
    grid = propose(act.line, act.line.shots[0], act.state, act.filming)
    scores = GeometryJudge().scores(grid.cameras, None)
    vet(grid, scores, best(grid, 2), (act.staged, act.line.shots[0], act.filming), camerawork)
    assert not any(MEASURE in c.measures for c in grid.cameras)


def test_upstairs_too_pixels_say_what_is_hidden(camerawork: Camerawork) -> None:
    """On the storey above, the share of the subject's own pixels is what lines of sight promised."""
    text = """\
storyboard "Upstairs"
proposals 24
takes 3
character anna = woman
scene up = house.bedroom
anna at bed facing wardrobe
(anna wave) / (static full eye-level) lens 35mm
"""
    (act,) = stage_acts(check_source(Source("up.vds", text)))
    shot = act.line.shots[0]
    grid = propose(act.line, shot, act.state, act.filming)
    floor = grid.story[0].performances["anna"].position[0, 2]
    assert floor > 2.0
    scores = GeometryJudge().scores(grid.cameras, None)
    scene = (act.staged, shot, act.filming)
    vetted = vet(grid, scores, best(grid, 3), scene, camerawork)
    kept = choose_takes(grid.cameras, vetted.order, 3)
    for i in kept:
        measures = grid.cameras[i].measures
        assert grid.cameras[i].track.position[:, 2].min() > floor
        assert measures[MEASURE] == pytest.approx(measures["visibility"], abs=0.25)
    # the same cameras one storey lower see the floor from below, and nobody
    cameras = list(grid.cameras)
    for i in kept:
        low = replace(cameras[i].track, position=cameras[i].track.position - (0.0, 0.0, 2.2))
        cameras[i] = replace(cameras[i], track=low, measures=dict(cameras[i].measures))
    sunk = replace(grid, cameras=tuple(cameras))
    order = scores.copy()
    order[list(kept)] += 5.0
    assert set(vet(sunk, order, best(sunk, 3), scene, camerawork).failed) >= set(kept)


def test_what_came_out_otherwise_gives_way(camerawork: Camerawork) -> None:
    """Pushes run backwards are pulls: they are not kept under the name of a push, however much liked."""
    act, grid = filmed("push medium")
    shot, scene = act.line.shots[0], (act.staged, act.line.shots[0], act.filming)
    scores = GeometryJudge().scores(grid.cameras, None)
    assert not vet(grid, scores, best(grid, 3), scene, camerawork).failed
    liked, cameras = choose_takes(grid.cameras, scores, 2), list(grid.cameras)
    for i in liked:
        t = cameras[i].track
        back = replace(t, position=t.position[::-1], rotation=t.rotation[::-1], look_at=t.look_at[::-1])
        cameras[i] = replace(cameras[i], track=back, measures=dict(cameras[i].measures))
    turned = replace(grid, cameras=tuple(cameras))
    vetted = vet(turned, scores, best(turned, 3), (act.staged, shot, act.filming), camerawork)
    assert {i: vetted.failed.get(i) for i in liked} == dict.fromkeys(liked, UNLIKE)
    kept = choose_takes(turned.cameras, vetted.order, 3)
    assert not set(kept) & set(liked)
    assert counted(turned.rejected, vetted.failed, kept)[UNLIKE] >= 2
