"""Top plans: what is on them, that they can stand in a page, and that the painted form shows the same."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import emit_film as f
import numpy as np
import pytest

from runtime.world import Light, Solids, Wall, World, WorldObject
from vdsl.emit.plan import COLOURS, ROLES, plan_of, plan_picture, plan_svg, write_plans
from vdsl.emit.plan_ground import Ground, Thing, Walker, action_line, extent, ground_of, scene_plan, shot_plan
from vdsl.emit.plan_marks import HEIGHT, WIDTH, marks_of
from vdsl.emit.types import Build

SVG = "{http://www.w3.org/2000/svg}"


def thing(number: int, path: str, kind: str, low: tuple, high: tuple) -> WorldObject:
    return WorldObject(number, tuple(path.split(".")), kind, (), low, high, np.eye(4))


@pytest.fixture
def world() -> World:
    """A room 4 by 3 m: a door in its south wall, a turned table, a rug, a lamp above, a window."""
    objects = (
        thing(0, "kitchen", "room", (0, 0, 0), (4, 3, 2.6)),
        thing(1, "kitchen.table", "table", (1, 1, 0), (2, 2, 0.74)),
        thing(2, "kitchen.table.cup", "cup", (1.4, 1.4, 0.74), (1.5, 1.5, 0.84)),
        thing(3, "kitchen.rug", "rug", (2, 1, 0), (3, 2, 0.01)),
        thing(4, "kitchen.lamp", "lamp", (2, 2, 1.9), (2.2, 2.2, 2.5)),
        thing(5, "kitchen.door", "door", (1.5, -0.05, 0), (2.5, 0.05, 2.1)),
        thing(6, "kitchen.window", "window", (-0.05, 1, 0.9), (0.05, 2, 2.0)),
    )
    centre = np.array([(0.75, 0, 1.3), (3.25, 0, 1.3), (2.0, 0, 2.35), (1.5, 1.5, 0.37), (0, 1.5, 0.45)])
    half = np.array(
        [(0.75, 0.06, 1.3), (0.75, 0.06, 1.3), (0.5, 0.06, 0.25), (0.5, 0.3, 0.37), (0.06, 0.5, 0.45)]
    )
    yaw = np.array([0, 0, 0, math.pi / 4, 0])
    solids = Solids(
        centre, half, yaw, np.array([0, 0, 0, -1, 1], np.int32), np.array([0, 0, 0, 1, 0], np.int32)
    )
    light = Light((0, 0, 1), (1, 1, 1), (1, 1, 1), (1, 1, 1), ((1, 1, 1), (1, 1, 1)))
    walls = (Wall((0, 0), (4, 0), 2.6), Wall((0, 0), (0, 3), 2.6))
    empty = np.zeros(0, np.int32)
    return World("home", None, empty, empty, objects, solids, walls, (), light, False)


def boxes(build: Build) -> Build:
    """The same build with plans."""
    table = Thing(("kitchen", "table"), ((1, 1), (2, 1), (2, 2), (1, 2)))
    wall = ((-1, 2.9), (4, 2.9), (4, 3), (-1, 3))
    ground = Ground("kitchen", "", (-1, -1, 4, 3), ((0, wall),), (), (table,))
    return Build(build.storyboard, build.shots, grounds=(ground,))


def test_a_room_is_cut_at_breast_height(world: World) -> None:
    ground = ground_of(world, ("kitchen",), "kitchen")
    assert ground.room == (0, 0, 4, 3)
    # Both pieces beside the door are cut; the lintel above it and the sill below the window are not.
    assert sorted(min(x for x, _ in piece) for _, piece in ground.walls) == [0.0, 2.5]
    assert {o.kind: o.ends for o in ground.openings} == {
        "door": ((1.5, 0.0), (2.5, 0.0)),
        "window": ((0.0, 1.0), (0.0, 2.0)),
    }
    assert {t.name: t.flat for t in ground.things} == {
        "table": False,
        "rug": True,
    }  # no lamp above, no cup on it
    table = next(t for t in ground.things if t.name == "table")
    reach = 0.5 * math.cos(math.pi / 4) + 0.3 * math.sin(math.pi / 4)
    assert max(x for x, _ in table.outline) == pytest.approx(
        1.5 + reach, abs=1e-3
    )  # turned by 45°, not its bounds
    assert len(table.outline) == 4


def test_a_shot_shows_people_camera_and_the_line_between_two(tmp_path: Path) -> None:
    build = boxes(f.film([f.built(tmp_path, "s1")]))
    plan = plan_of(build, 0)
    anna, ben = plan.people
    assert anna.path[0] == (0.0, 0.5)
    assert anna.path[-1] == (2.0, 0.5)
    assert anna.facing == (0.0, 0.0)
    assert plan.line == (anna.path[0], ben.path[0])
    (camera,) = plan.cameras
    assert camera.path[0] == (1.0, 0.0)
    assert camera.spread[0] == pytest.approx(2 * math.atan(18 / 50))
    assert camera.label == "50 mm"
    roles = [mark.role.split()[0] for mark in marks_of(plan)]
    for role in (
        "wall",
        "thing",
        "view",
        "view-end",
        "way",
        "arrow",
        "start",
        "end",
        "action-line",
        "camera",
        "scale",
    ):
        assert role in roles, role
    assert {r for r in roles} <= set(ROLES)


def test_names_never_cover_each_other() -> None:
    outline = ((0, 0), (0.9, 0), (0.9, 0.9), (0, 0.9))
    things = tuple(
        Thing(("room", f"wardrobe_{i}"), tuple((x + i * 0.3, y) for x, y in outline)) for i in range(12)
    )
    people = tuple(Walker(f"person {i}", ((0.2 * i, 0.3),), (0.0, 0.0)) for i in range(6))
    ground = Ground("room", "", (0, 0, 5, 4), (), (), things)
    plan = shot_plan(ground, f.built(Path(), "s1", takes=0), "t")
    texts = [m for m in marks_of(type(plan)("t", ground, people)) if m.shape == "text" and "name" in m.role]
    assert len(texts) > 5
    from vdsl.emit.lettering import width

    spans = [
        (x - width(m.text, 11) / 2, y, x + width(m.text, 11) / 2, m.size) for m in texts for x, y in m.points
    ]
    for i, a in enumerate(spans):
        for b in spans[:i]:
            assert a[2] <= b[0] or b[2] <= a[0] or abs(a[1] - b[1]) >= 0.9 * min(a[3], b[3])


def test_the_plan_shows_the_room_or_what_surrounds_the_action() -> None:
    def at(*points: tuple[float, float]) -> Walker:
        return Walker("anna", points, (0, 0))

    small = Ground("room", "", (0, 0, 4, 3), (), (), ())
    street = Ground("street", "", (0, 0, 80, 20), (), (), ())
    plan = shot_plan(small, f.built(Path(), "s1", takes=0), "t")
    x0, y0, x1, y1 = extent(type(plan)("t", small, (at((1, 1)),)), 4 / 3)
    assert x0 < 0 < 4 < x1
    assert y0 < 0 < 3 < y1
    x0, y0, x1, y1 = extent(type(plan)("t", street, (at((30, 10), (34, 10)),)), 4 / 3)
    assert 20 < x0 < 30 < 34 < x1 < 45
    assert (x1 - x0) / (y1 - y0) == pytest.approx(4 / 3)


def test_the_line_is_between_those_who_act() -> None:
    people = [Walker(n, ((x, 0.0),), (0, 0)) for n, x in (("anna", 0.0), ("ben", 2.0), ("cleo", 4.0))]
    assert action_line(people, ["anna", "cleo"]) == ((0.0, 0.0), (4.0, 0.0))
    assert action_line(people, ["anna"]) is None  # with three there, who is it with?
    assert action_line(people[:2], ["anna"]) == ((0.0, 0.0), (2.0, 0.0))
    assert action_line(people[:1], ["anna"]) is None


def test_svg_is_safe_and_can_stand_in_a_page(tmp_path: Path) -> None:
    build = boxes(f.film([f.built(tmp_path, "s1", story=f.line(("a<b>&\"c'", "walk", "<script>")))]))
    text = plan_svg(plan_of(build, 0))
    root = ET.fromstring(text)  # well-formed whatever people are called
    assert root.get("viewBox") == f"0 0 {WIDTH} {HEIGHT}"
    assert "<script>" in (root.findtext(f"{SVG}title") or "")
    assert "<script" not in text
    assert not any("id" in e.attrib or "href" in e.attrib for e in root.iter())
    assert "prefers-color-scheme" in text
    used = {c for c in COLOURS if f"--plan-{c}," in text}
    assert {"paper", "ink", "camera", "person-0", "person-1"} <= used


def test_nothing_is_drawn_beyond_the_sheet(tmp_path: Path) -> None:
    build = boxes(f.film([f.built(tmp_path, "s1")]))
    far = Thing(("next", "bed"), ((50, 50), (52, 50), (52, 52), (50, 52)))
    near = Thing(("next", "desk"), ((3.5, -9), (30, -9), (30, 9), (3.5, 9)))  # reaches far out of the picture
    ground = replace(build.grounds[0], things=(*build.grounds[0].things, far, near))
    sheet = ET.fromstring(plan_svg(plan_of(replace(build, grounds=(ground,)), 0))).find(f"{SVG}svg")
    assert sheet is not None, "a page may show the plan wider than it is: what lies beyond must be cut off"
    assert (sheet.get("width"), sheet.get("height"), sheet.get("style")) == (str(WIDTH), str(HEIGHT), None)
    shapes = [[float(n) for n in e.get("points", "").replace(",", " ").split()] for e in sheet.iter()]
    assert any(max(row, default=0) > WIDTH for row in shapes)
    assert not any(row and min(row[::2]) > WIDTH + 20 for row in shapes)


def test_every_shot_and_scene_gets_a_plan(tmp_path: Path) -> None:
    shots = [f.built(tmp_path, name, takes=n) for name, n in (("s1", 3), ("s2", 1), ("s3", 0))]
    build = boxes(f.film(shots))
    write_plans(tmp_path, build)
    for name in ("s1", "s2", "s3"):
        ET.parse(tmp_path / "shots" / name / "plan.svg")
    drawn = sorted(p.name for p in (tmp_path / "shots" / "s1").glob("plan*.svg"))
    assert drawn == ["plan-2.svg", "plan-3.svg", "plan.svg"]
    assert not list((tmp_path / "shots" / "s2").glob("plan-*.svg"))
    scene = ET.parse(tmp_path / "plans" / "1.svg").getroot()
    words = [e.text for e in scene.iter(f"{SVG}text")]
    assert words.count("1") == 1
    assert words.count("2") == 1
    assert "3" not in words  # the third shot has no camera
    bare = f.film([f.built(tmp_path / "bare", "s1")])
    write_plans(tmp_path / "bare", bare)
    assert not (tmp_path / "bare" / "plans").exists()


def test_a_scene_joins_the_ways_of_its_shots(tmp_path: Path) -> None:
    build = boxes(f.film([f.built(tmp_path, "s1"), f.built(tmp_path, "s2")]))
    plan = scene_plan(build.grounds[0], list(enumerate(build.shots, 1)), "t")
    anna = next(p for p in plan.people if p.name == "anna")
    assert anna.path[0] == anna.path[len(anna.path) // 2] == (0.0, 0.5)  # back at the start with the second
    assert [c.label for c in plan.cameras] == ["1", "2"]


def test_painted_it_shows_the_same(tmp_path: Path) -> None:
    build = boxes(f.film([f.built(tmp_path, "s1")]))
    image = plan_picture(plan_of(build, 0), 400)
    assert image.size == (WIDTH, HEIGHT)
    pixels = np.asarray(image).reshape(-1, 3).astype(int)

    def share(colour: str) -> float:
        value = int(COLOURS[colour][0][1:], 16)
        near = np.abs(pixels - [value >> 16, value >> 8 & 255, value & 255]).max(1) < 24
        return float(near.mean())

    assert share("paper") > 0.5
    for colour in ("ink", "camera", "person-0", "person-1", "thing"):
        assert share(colour) > 5e-4, colour
