"""Two looks at a shot's proposals: who gets a full one, and that nothing is kept without."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from proposed_shots import proposed

from ranker.evaluate import spearman
from vdsl.pipeline import cache as cache_module
from vdsl.pipeline import glance
from vdsl.pipeline.compile import Result, Workshop, compile_file
from vdsl.pipeline.filming import Camerawork, Seen
from vdsl.pipeline.glance import Looked, Scored, Screening, second_looks
from vdsl.pipeline.judging import (
    BY_GUIDES,
    BY_PICTURES,
    DiscriminatorJudge,
    GeometryJudge,
    Glance,
    Judge,
)
from vdsl.pipeline.options import Options
from vdsl.pipeline.progress import Silence, StageClock
from vdsl.pipeline.witness import MEASURE
from vdsl.propose.types import CameraProposal

SCRIPT = """\
size 64x36
proposals 32
takes {takes}
character anna = woman(top crimson)
scene room = apartment.living
anna at door
(anna wave)  / (static medium eye-level) 0.5s
"""


class Rough(GeometryJudge):
    """Sees frames, and is off by a little where it sees few of them."""

    name, looks = "ranker", True

    def __init__(self, glances: Glance) -> None:
        self.glances = glances
        self.seen: list[tuple[int, ...]] = []

    def scores(self, cameras: tuple[CameraProposal, ...], seen: Seen | None) -> NDArray[np.float64]:
        assert seen is not None
        assert seen.guides is not None
        assert seen.guides.maps.shape[:2] == seen.frames.shape[:2]
        self.seen.append(seen.frames.shape[:2])
        return super().scores(cameras, None)

    def glance(self, cameras: tuple[CameraProposal, ...], seen: Seen) -> NDArray[np.float64]:
        assert seen.guides is not None
        assert seen.guides.maps.shape[:2] == (len(cameras), len(self.glances.frames))
        assert (seen.frames.size > 0) == self.glances.pictures
        self.seen.append(seen.frames.shape[:2])
        off = np.sin(np.array([c.index for c in cameras]) * 7.0)
        return np.asarray(super().scores(cameras, None) + 0.01 * off)


class RoughShop(Workshop):
    def __init__(self, glances: Glance) -> None:
        super().__init__()
        self.rough = Rough(glances)

    def judge(self, options: Options, clock: StageClock) -> Judge:
        return self.rough


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(cache_module.VARIABLE, "512")
    monkeypatch.setattr(cache_module, "results_folder", lambda: tmp_path / "kept")
    return tmp_path


def compiled(project: Path, shop: RoughShop, takes: int = 3, cache: bool = True) -> Result:
    (project / "story.vds").write_text(SCRIPT.format(takes=takes), "utf-8")
    return compile_file(project / "story.vds", project / "build", Options(cache=cache), workshop=shop)


def takes_of(result: Result) -> list[tuple[str, float, dict[str, float]]]:
    return [(t.key, t.score, t.camera.measures) for t in result.build.shots[0].takes]


@pytest.mark.parametrize("glances", [BY_PICTURES, BY_GUIDES])
def test_takes_are_as_if_all_had_had_a_full_look(
    project: Path, monkeypatch: pytest.MonkeyPatch, glances: Glance
) -> None:
    shop, each = RoughShop(glances), len(glances.frames)
    quick = compiled(project, shop)
    count = quick.build.shots[0].proposals
    full = second_looks(count, glances)
    assert full < count
    assert {frames for _, frames in shop.rough.seen[:-1]} == {each}
    assert sum(n for n, _ in shop.rough.seen[:-1]) == count
    assert shop.rough.seen[-1] == (full, 8)
    draw = next(s for s in quick.report.stages if s.name == "draw")
    assert draw.count == each * count + 8 * full

    shop.rough.seen.clear()
    more = compiled(project, shop, takes=5)  # what was looked at before is known
    assert sum(n for n, _ in shop.rough.seen) <= 5 - 3
    assert takes_of(more)[:1] == takes_of(quick)[:1]
    assert takes_of(compiled(project, shop, takes=5, cache=False)) == takes_of(more)

    monkeypatch.setattr(glance, "second_looks", lambda count, glance: count)
    shop.rough.seen.clear()
    assert takes_of(compiled(project, shop, cache=False)) == takes_of(quick)
    assert {frames for _, frames in shop.rough.seen} == {8}


def test_takes_are_measured_by_what_was_drawn(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Chosen by it, told of it, and the same where it was kept."""
    drawn: list[int] = []

    def half_hidden(*given: Sequence[CameraProposal]) -> list[CameraProposal]:
        cameras = given[4]
        drawn.append(len(cameras))
        worse = {"legible": 0.2, "visibility": 0.25}
        return [replace(c, measures=c.measures | worse) if c.index % 2 else c for c in cameras]

    monkeypatch.setattr(glance, "as_drawn", half_hidden)
    (shot,) = compiled(project, RoughShop(BY_GUIDES)).build.shots
    assert sum(drawn) == shot.proposals + second_looks(shot.proposals, BY_GUIDES)
    assert [take.camera.index % 2 for take in shot.takes] == [0] * len(shot.takes)
    assert all(take.camera.measures[MEASURE] > 0.5 for take in shot.takes)
    monkeypatch.setattr(glance, "as_drawn", lambda *given: pytest.fail("it is known what is seen"))
    (again,) = compiled(project, RoughShop(BY_GUIDES)).build.shots
    assert [t.camera.measures for t in again.takes] == [t.camera.measures for t in shot.takes]


@pytest.mark.parametrize(
    "line", ["/ (static wide eye-level) 0.5s", "(anna wave) / (static close-up eye-level) 0.5s, focus table"]
)
def test_places_and_things_are_measured_by_pictures_too(line: str) -> None:
    text = SCRIPT.format(takes=1).rsplit("(anna", 1)[0] + line + "\n"
    act, grid = proposed('storyboard "t"\n' + text)
    judge, clock, camerawork = Rough(BY_GUIDES), StageClock(Silence()), Camerawork("cpu")
    screening = Screening(act.staged, act.line.shots[0], act.filming, grid, camerawork, lambda: judge, clock)
    scores, measures = screening.look(range(len(grid.cameras)))
    assert len(scores) == len(measures) == len(grid.cameras) > 2
    for camera, found in zip(grid.cameras, measures, strict=True):
        assert found.keys() == camera.measures.keys()
        assert abs(found["visibility"] - camera.measures["visibility"]) < 0.5


def test_a_draft_is_one_until_the_judge_that_is_wanted_has_chosen(project: Path) -> None:
    """Also where another judge's choice is filmed already."""
    story, shop = project / "story.vds", RoughShop(BY_GUIDES)
    story.write_text(SCRIPT.format(takes=1), "utf-8")
    compile_file(story, project / "build", Options(rank="geometry"))
    draft = compile_file(story, project / "build", Options(draft=True), workshop=shop)
    assert draft.build.draft
    assert not shop.rough.seen
    assert not compile_file(story, project / "build", Options(), workshop=shop).build.draft
    assert not compile_file(story, project / "build", Options(draft=True), workshop=shop).build.draft


def test_all_of_a_few_get_a_full_look_and_a_share_of_many() -> None:
    some = (0, 5, 12, 16, 17, 64, 80, 200)
    assert [second_looks(n, BY_PICTURES) for n in some] == [0, 5, 12, 16, 16, 16, 20, 50]
    assert [second_looks(n, BY_GUIDES) for n in some] == [0, 5, 12, 12, 12, 12, 12, 30]


def test_a_glance_by_guides_comes_near_a_full_look() -> None:
    """Of a shot's proposals the best by a full look are among those that a glance lets through."""
    act, grid = proposed('storyboard "t"\n' + SCRIPT.format(takes=3).replace("proposals 32", "proposals 60"))
    shot, camerawork = act.line.shots[0], Camerawork("cpu")
    judge, clock = DiscriminatorJudge(None, "cpu"), StageClock(Silence())
    screening = Screening(act.staged, shot, act.filming, grid, camerawork, lambda: judge, clock)
    full, count = screening.look(range(len(grid.cameras))).scores, len(grid.cameras)
    first = screening.look(range(count), judge.glances).scores
    assert first.shape == full.shape == (count,)
    through = np.argsort(-first)[: second_looks(count, judge.glances)]
    assert set(np.argsort(-full)[:3]) <= set(through.tolist())
    order = spearman(full, first)
    assert order is not None
    assert order > 0.95


def test_what_was_looked_at_goes_before_what_was_not() -> None:
    true = np.linspace(1.0, 0.0, 40)
    asked: list[list[int]] = []

    def look(which: Sequence[int]) -> Looked:
        asked.append(list(which))
        return Looked(true[list(which)], tuple({"visibility": float(i)} for i in which))

    scored = Scored(lambda: true[::-1].copy(), look, best=16)  # the worst glance there can be
    scored.look_at_best()
    assert asked == [list(range(24, 40))]
    order = scored.order
    assert order[:24].max() < order[24:].min()
    assert (np.diff(order[:24]) > 0).all()  # among themselves by the glance
    assert np.allclose(order[24:], true[24:])
    assert scored.look((3, 30, 3))
    assert asked[1:] == [[3]]
    assert not scored.look((3, 30))
    assert scored.order.argmax() == 3
    assert {i: m["visibility"] for i, m in scored.measures.items()} == {i: i for i in (3, *range(24, 40))}


def test_the_discriminator_glances_by_guides() -> None:
    assert DiscriminatorJudge(None, "cpu").glances == BY_GUIDES


def test_a_draft_proposes_for_the_takes_that_follow(project: Path) -> None:
    story, shop = project / "story.vds", RoughShop(BY_GUIDES)
    story.write_text(SCRIPT.format(takes=2), "utf-8")
    draft = compile_file(story, project / "build", Options(draft=True), workshop=shop)
    assert "propose" in {stage.name for stage in draft.report.stages}
    full = compile_file(story, project / "build", Options(), workshop=shop)
    assert "propose" not in {stage.name for stage in full.report.stages}
    alone = compile_file(story, project / "other", Options(cache=False), workshop=RoughShop(BY_GUIDES))
    assert takes_of(alone) == takes_of(full)
