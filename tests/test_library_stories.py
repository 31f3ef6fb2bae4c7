"""The library at work: a walk through every set, filmed; everybody of the cast walks and turns round."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from runtime.motion.types import SceneMotion
from vdsl.lang import Report, Source
from vdsl.lang.definitions.set import SetDef
from vdsl.library import Catalog
from vdsl.pipeline.compile import Act, stage_acts
from vdsl.pipeline.judging import GeometryJudge
from vdsl.pipeline.script import check_source
from vdsl.propose.story import motions, propose

sys.path.insert(0, str(Path(__file__).parent))

from motion.checks import measure, violations

CATALOG = Catalog()
SETS = CATALOG.names("set")
CAST = CATALOG.names("cast")


def acts(text: str) -> list[Act]:
    report = Report()
    checked = check_source(Source("library.vds", text), report)
    found = stage_acts(checked)
    assert not report.diagnostics, [(d.code, d.label, d.span.text) for d in report.diagnostics]
    return found


def wrong(act: Act) -> list[str]:
    """What is out of bounds in any way a line is played."""
    found = []
    for variant, motion in motions(act.state, act.line, act.filming, Report(), most=6):
        assert isinstance(motion, SceneMotion)
        for who, skeleton in act.filming.skeletons.items():
            measured = measure(motion, who, skeleton, act.filming.fps, act.state.world)
            found += [f"{variant}: {what}" for what in violations(measured)]
    return found


def places(definition: SetDef) -> list[str]:
    """Named spots of the set's first place that has two or more, as one would write them."""
    for node in definition.root.children:
        spots = [f"{node.name}.{spot}" for spot in dict.fromkeys(node.spots)]
        if len(spots) > 1:
            return spots
    # no place has two: the middles of two places, or one and a thing beside it
    spots = [f"{n.name}.{s}" for n in definition.root.children for s in n.spots]
    things = [
        f"{n.name}.{c.name}" for n in definition.root.children for c in n.children if c.kind == "object"
    ]
    return (spots + things)[:2]


@pytest.mark.parametrize("name", SETS)
def test_a_walk_through_every_set_can_be_filmed(name: str) -> None:
    definition = CATALOG.get("set", name)
    assert isinstance(definition, SetDef)
    start, goal = places(definition)[:2]
    walk, look = acts(
        f'storyboard "walk"\ncharacter anna = woman\nscene here = {name}\nanna at {start}\n'
        f"(anna walk {goal}) / (* * eye-level) proposals 6\n"
        "(anna look around) / (static medium|full *) proposals 6\n"
    )
    assert wrong(walk) == []
    for act in (walk, look):
        grid = propose(act.line, act.line.shots[0], act.state, act.filming)
        assert len(grid.cameras) >= 3, grid.rejected
        assert GeometryJudge().scores(grid.cameras, None).max() > 0.5


@pytest.mark.parametrize("name", CAST)
def test_everybody_walks_and_turns_round(name: str) -> None:
    walk, turn = acts(
        'storyboard "turn"\nset bare { area floor, at (-4, -4)m, size (8, 8)m, floor plain { '
        "spot here, at (2, 4)m, facing 0deg; spot there, at (6, 5)m, facing 90deg } }\n"
        f"character anna = {name}\nscene s = bare\nanna at here\n(anna walk there)\n(anna turn)\n"
    )
    assert wrong(walk) == []
    assert wrong(turn) == []
    heading = (
        propose(turn.line, turn.line.shots[0], turn.state, turn.filming).story[0].performances["anna"].heading
    )
    assert abs(heading[-1] - heading[0]) > 2.0
