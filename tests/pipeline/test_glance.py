"""Two looks at a shot's proposals: who gets a full one, and that nothing is kept without."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from vdsl.pipeline import cache as cache_module
from vdsl.pipeline import glance
from vdsl.pipeline.compile import Result, Workshop, compile_file
from vdsl.pipeline.filming import Seen
from vdsl.pipeline.glance import GLANCED, Scored, second_looks
from vdsl.pipeline.judging import GeometryJudge, Judge
from vdsl.pipeline.options import Options
from vdsl.pipeline.progress import StageClock
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

    def __init__(self) -> None:
        self.seen: list[tuple[int, ...]] = []

    def scores(self, cameras: tuple[CameraProposal, ...], seen: Seen | None) -> NDArray[np.float64]:
        assert seen is not None
        assert seen.guides is not None
        assert seen.guides.maps.shape[:2] == seen.frames.shape[:2]
        self.seen.append(seen.frames.shape[:2])
        return super().scores(cameras, None)

    def glance(
        self, cameras: tuple[CameraProposal, ...], seen: Seen, at: Sequence[int]
    ) -> NDArray[np.float64]:
        assert seen.guides is not None
        assert seen.guides.maps.shape[:2] == (len(cameras), len(at))
        self.seen.append(seen.frames.shape[:2])
        off = np.sin(np.array([c.index for c in cameras]) * 7.0)
        return np.asarray(super().scores(cameras, None) + 0.01 * off)


class RoughShop(Workshop):
    def __init__(self) -> None:
        super().__init__()
        self.rough = Rough()

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


def takes_of(result: Result) -> list[tuple[str, float]]:
    return [(t.key, t.score) for t in result.build.shots[0].takes]


def test_takes_are_as_if_all_had_had_a_full_look(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shop = RoughShop()
    quick = compiled(project, shop)
    count = quick.build.shots[0].proposals
    full = second_looks(count)
    assert full < count
    assert shop.rough.seen == [(count, len(GLANCED)), (full, 8)]
    draw = next(s for s in quick.report.stages if s.name == "draw")
    assert draw.count == len(GLANCED) * count + 8 * full

    shop.rough.seen.clear()
    more = compiled(project, shop, takes=5)  # what was looked at before is known
    assert sum(n for n, _ in shop.rough.seen) <= 5 - 3
    assert takes_of(more)[:1] == takes_of(quick)[:1]
    assert takes_of(compiled(project, shop, takes=5, cache=False)) == takes_of(more)

    monkeypatch.setattr(glance, "second_looks", lambda count: count)
    shop.rough.seen.clear()
    assert takes_of(compiled(project, shop, cache=False)) == takes_of(quick)
    assert {frames for _, frames in shop.rough.seen} == {8}


def test_all_of_a_few_get_a_full_look_and_a_share_of_many() -> None:
    assert [second_looks(n) for n in (0, 5, 16, 17, 64, 80, 200)] == [0, 5, 16, 16, 16, 20, 50]


def test_what_was_looked_at_goes_before_what_was_not() -> None:
    true = np.linspace(1.0, 0.0, 40)
    asked: list[list[int]] = []

    def look(which: Sequence[int]) -> NDArray[np.float64]:
        asked.append(list(which))
        return true[list(which)]

    scored = Scored(lambda: true[::-1].copy(), look, {})  # the worst glance there can be
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
