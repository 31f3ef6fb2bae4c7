"""Files in scripts: what may be said, what is reported where, and that the sample models play their parts."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from runtime.body.skeleton import JOINT
from tests.formats.files import box, bvh, figure, obj
from tests.formats.test_models import SHARED, needs_shared
from vdsl.lang import Report, Source, check, parse
from vdsl.lang.codes import CODES
from vdsl.library import Catalog
from vdsl.pipeline.compile import stage_acts
from vdsl.pipeline.script import ScriptError, load_storyboard
from vdsl.propose.story import tell
from vdsl.stage.models import check_models, file_prop
from vdsl.stage.world import build_world

STORY = "\nset lot {\n    area floor, size (9, 9)m\n}\ncharacter anna = woman\nscene lot\n(anna wave)\n"


def found(folder: Path, text: str, decode: bool = False) -> list[tuple[str, str]]:
    """Codes and underlined texts of what is wrong with a script in a folder."""
    path = folder / "story.vds"
    path.write_text(text)
    report = Report()
    script, _ = parse(Source(str(path), text), report)
    catalog = Catalog.for_script(script, report)
    check(script, catalog, report)
    if decode:
        check_models(catalog, report)
    return [(d.code, d.span.text) for d in report.diagnostics if d.severity == "error"]


@pytest.fixture
def files(tmp_path):
    box(tmp_path / "box.glb")
    obj(tmp_path / "yard.obj")
    figure(tmp_path / "robo.glb")
    bvh(tmp_path / "step.bvh")
    return tmp_path


@pytest.mark.parametrize(
    "line",
    [
        'prop lamp = "box.glb"',
        'prop lamp = "box.glb", height 40cm, up y, turn 90deg',
        'prop lamp = "box.glb", scale 1cm {\n    grip (0, 0, 1cm)\n    spot top, at (0, 0, 2cm)\n}',
        'prop lamp = "box.glb" {\n    solid no\n    cylinder 3cm, height 10cm\n}',
        'set yard = "yard.obj"',
        'set yard = "yard.obj", scale 3m {\n time dusk\n spot gate, at (1, 1)m\n place bench, at (2, 2)m\n}',
        'cast robo = "robo.glb", height 1.9m',
        'character robo = "robo.glb"',
        'cast robo = "robo.glb"\ncharacter rob = robo(height 1.2m)',
        'action step = "step.bvh"',
        'action step = "step.bvh", from 0.2s, to 0.8s, times 2, stay',
        'action squat = "robo.glb", clip "Squat" {\n    target optional character\n    faces target\n}',
    ],
)  # fmt: skip
def test_what_may_be_said(files, line):
    assert found(files, line + STORY, decode=True) == []


@pytest.mark.parametrize(
    ("line", "code", "text"),
    [
        ('prop lamp = "none.glb"', "VDS200", '"none.glb"'),
        ('prop lamp = "step.bvh"', "VDS200", '"step.bvh"'),
        ('action step = "yard.obj"', "VDS200", '"yard.obj"'),
        ('character robo = "none.glb"', "VDS200", '"none.glb"'),
        ('prop lamp = "../lamp.glb"', "VDS015", '"../lamp.glb"'),
        ('prop lamp = "/etc/passwd"', "VDS015", '"/etc/passwd"'),
        ('character robo = "../robo.glb"', "VDS015", '"../robo.glb"'),
        ('prop lamp = "empty.glb"', "VDS201", '"empty.glb"'),
        ('character robo = "empty.glb"', "VDS201", '"empty.glb"'),
        ('prop lamp = "box.glb", height 1m, scale 1cm', "VDS202", None),
        ('action step = "step.bvh", from 2s, to 1s', "VDS202", None),
        ('action step = "step.bvh", times 0', "VDS202", None),
        ('cast lamp = "box.glb"', "VDS203", '"box.glb"'),
        ('action lamp = "box.glb"', "VDS204", '"box.glb"'),
        ('action squat = "robo.glb", clip "Squad"', "VDS204", None),
        ('prop lamp = "box.glb", size 3m', "VDS030", "size"),
        ('prop lamp = "box.glb", height 0m', "VDS101", None),
        ('prop lamp = "box.glb", height 3', "VDS020", "3"),
        ('prop lamp = "box.glb", up x', "VDS026", "x"),
        ('prop lamp = "box.glb" {\n    wheel 3cm\n}', "VDS033", "wheel"),
        ('cast robo = "robo.glb", height 9m', "VDS067", None),
        ('set yard = "yard.obj" {\n    place x = nothing_such\n}', "VDS115", "nothing_such"),
    ],
)
def test_what_is_reported(files, line, code, text):
    (files / "empty.glb").write_bytes(b"")
    got = found(files, line + STORY)
    assert code in [c for c, _ in got], got
    assert code in CODES
    if text is not None:
        assert (code, text) in got


def test_a_mistake_is_told_once(files):
    assert len(found(files, 'prop lamp = "none.glb"\nset lot { area a, size (3, 3)m { place lamp } }')) == 1


def test_what_only_decoding_shows_is_reported_at_the_path(files):
    (files / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n")
    assert found(files, 'prop lamp = "a.obj"' + STORY) == []
    assert found(files, 'prop lamp = "a.obj"' + STORY, decode=True) == [("VDS201", '"a.obj"')]
    with pytest.raises(ScriptError) as error:
        stage_acts(load_storyboard(files / "story.vds"))
    assert error.value.diagnostics[0].code == "VDS201"


def test_paths_are_relative_to_the_file_they_stand_in(files):
    (files / "sub").mkdir()
    shutil.copy(files / "box.glb", files / "sub" / "inner.glb")
    (files / "sub" / "things.vds").write_text('prop lamp = "inner.glb"\nprop other = "../box.glb"\n')
    assert found(files, 'use "sub/things.vds"' + STORY, decode=True) == []


def test_a_prop_has_its_size_and_a_place_to_stand(files):
    text = 'prop lamp = "box.glb", height 1m\nset lot { area a, size (6, 6)m { place lamp, at (3, 3)m } }'
    catalog = catalog_of(files, text)
    world = build_world(catalog.get("set", "lot"), catalog)
    lamp = next(o for o in world.objects if o.kind == "lamp")
    assert np.allclose(lamp.low, (2.75, 2.75, 0), atol=1e-3)
    assert np.allclose(lamp.high, (3.25, 3.25, 1), atol=1e-3)
    assert lamp.spot("stand") is not None
    assert (world.solids.object == lamp.id).any()


def catalog_of(folder: Path, text: str) -> Catalog:
    report = Report()
    script, _ = parse(Source(str(folder / "s.vds"), text), report)
    catalog = Catalog.for_script(script, report)
    assert not report.diagnostics, report.diagnostics
    return catalog


def test_the_sample_of_the_documentation(files):
    page = Path(__file__).resolve().parents[2] / "docs" / "import.md"
    (text,) = re.findall(r"^```vds\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    for folder in ("models", "motion"):
        (files / folder).mkdir()
    for source, name in (("box.glb", "models/lamp.glb"), ("robo.glb", "models/robot.glb")):
        shutil.copy(files / source, files / name)
    obj(files / "models" / "yard.obj", YARD)
    bvh(files / "motion" / "walk.bvh", seconds=0.2)
    text = text.replace('clip "Bow"', 'clip "Squat"').replace("scale 1cm", "scale 2m")
    assert found(files, text + "\nscene yard\n(robo stroll)\n(other bow kid)\n", decode=True) == []


def test_a_file_that_changes_is_read_again(files):
    text = 'prop lamp = "box.glb"'
    model = catalog_of(files, text).get("prop", "lamp").model
    before = file_prop(model)
    assert file_prop(model) is before
    box(
        files / "box.glb",
        materials=[{"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 1, 1]}, "name": "blue"}],
    )
    assert file_prop(model).mesh.colors[0].tolist() == [0, 0, 1]


YARD = """o Ground
v 0 -0.2 0
v 10 -0.2 0
v 10 -0.2 -6
v 0 -0.2 -6
v 0 0 0
v 10 0 0
v 10 0 -6
v 0 0 -6
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
o Big Stone
v 4 0 -2
v 5 0 -2
v 5 0 -3
v 4 0 -3
v 4.5 1 -2.5
f 9 10 13
f 10 11 13
f 11 12 13
f 12 9 13
"""


def test_a_set_finds_its_ground_and_its_things(tmp_path):
    obj(tmp_path / "yard.obj", YARD)
    text = 'set yard = "yard.obj" {\n    spot gate, at (9, 1)m\n    place bin = bin, at (1, 1)m\n}'
    catalog = catalog_of(tmp_path, text)
    definition = catalog.get("set", "yard")
    (ground,) = definition.root.children
    assert [n.name for n in ground.children] == ["bin", "ground", "big_stone"]
    world = build_world(definition, catalog)
    (x0, y0), (x1, y1) = np.array(world.floors)[:, :2].min(0), np.array(world.floors)[:, 2:].max(0)
    assert np.allclose((x0, y0, x1, y1), (0, 0, 10, 6), atol=0.01)
    by_path = {o.path: o for o in world.objects}
    stone = by_path["ground", "big_stone"]
    assert np.allclose(stone.low, (4, 2, 0), atol=1e-4)
    assert (world.solids.object == stone.id).any()
    assert not (world.solids.object == by_path["ground", "ground"].id).any()
    assert np.allclose(by_path["ground", "bin"].centre[:2], (1, 1), atol=0.05)
    gate = by_path["ground",].spot("gate")
    assert gate is not None
    assert np.allclose(gate.position, (9, 1, 0))


# --- the sample models in scenes ------------------------------------------------------


def performed(folder: Path, text: str):
    """Each line's first performance, with the world and bodies it is in."""
    (folder / "story.vds").write_text(text)
    for act in stage_acts(load_storyboard(folder / "story.vds")):
        told = tell(act.state, act.line, act.filming, most=1)
        yield act, told.proposals[0]


@needs_shared
def test_both_figures_walk_to_a_chair_sit_and_wave(tmp_path):
    for name in ("CesiumMan.glb", "RiggedFigure.glb"):
        shutil.copy(SHARED / name, tmp_path)
    text = """
set stage_a {
    area floor, size (8, 6)m { place chair, at (6, 3)m; place chair_b = chair, at (2, 4)m }
}
cast tin = "CesiumMan.glb", height 1.75m
character robo = tin
character fig = "RiggedFigure.glb"
scene stage_a
robo at floor
fig at floor
(robo walk chair)
(robo sit chair)
(robo wave)
(fig walk chair_b)
(fig sit chair_b)
(fig wave robo)
"""
    for act, proposal in performed(tmp_path, text):
        who = act.line.beats[0].character
        joints = proposal.performances[who].world_from_joint
        skeleton = act.staged.bodies[who].skeleton
        assert np.isfinite(joints).all()
        if act.line.beats[0].action == "sit":
            hips = joints[-1, JOINT["hips"], 2, 3]
            assert hips < 0.8 * skeleton.bind[JOINT["hips"], 2]
        if act.line.beats[0].action == "wave":
            hands = np.maximum(joints[:, JOINT["hand_r"], 2, 3], joints[:, JOINT["hand_l"], 2, 3])
            assert hands.max() > joints[:, JOINT["upperarm_l"], 2, 3].min()


@needs_shared
def test_the_captured_walk_drives_our_cast_and_the_truck_stands_in_the_street(tmp_path):
    for name in ("walk01.bvh", "CesiumMilkTruck.glb"):
        shutil.copy(SHARED / name, tmp_path)
    text = """
prop truck = "CesiumMilkTruck.glb", height 2.4m
action stroll = "walk01.bvh"
set lane {
    area road, size (20, 12)m { place truck, at (10, 9)m; spot start, at (3, 3)m, facing 0deg }
}
character anna = woman
scene lane
anna at start
(anna stroll)
(anna walk truck)
"""
    acts = list(performed(tmp_path, text))
    act, walk = acts[0]
    way = walk.performances["anna"].position
    assert way[-1, 0] - way[0, 0] > 3.5
    truck = next(o for o in act.staged.world.objects if o.kind == "truck")
    assert truck.high[2] == pytest.approx(2.4, abs=1e-3)
    end = acts[1][1].performances["anna"].position[-1]
    assert truck.low[0] - 1 < end[0] < truck.high[0] + 1
    assert not (np.array(truck.low[:2]) < end[:2]).all() or not (end[:2] < np.array(truck.high[:2])).all()
