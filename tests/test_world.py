"""Worlds: props at any size, rooms one can walk through, walls that come away with what hangs on them."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
import pytest
from scipy import ndimage

from runtime.materials import MATERIALS, NIGHT_GLASS
from runtime.shapes import volume
from runtime.world import World
from vdsl.lang.definitions.prop import PropDef
from vdsl.lang.definitions.set import LIGHTS, SetDef, read_set
from vdsl.lang.diagnostics import Report
from vdsl.lang.parse import parse_definition
from vdsl.lang.source import Source
from vdsl.library.loader import Catalog
from vdsl.stage.light import make_light
from vdsl.stage.props import build_prop, merged_boxes
from vdsl.stage.standing import is_clear
from vdsl.stage.world import build_world

CATALOG = Catalog()
SETS = ("apartment", "office", "suburb_street")
PROPS = CATALOG.names("prop")
BUDGET = 36_000
PROP_BUDGET = 2_500


@lru_cache
def world(name: str, time: str = "day") -> World:
    definition = CATALOG.get("set", name)
    assert isinstance(definition, SetDef)
    return build_world(definition, CATALOG, time)


def own_world(text: str) -> World:
    return own_world_at(text, "day")


def own_world_at(text: str, time: str) -> World:
    report = Report()
    parsed = parse_definition(Source("test.vds", text), "set", "s", report)
    assert parsed is not None
    definition = read_set(parsed, report)
    assert definition is not None, report.diagnostics
    assert not report.errors, report.diagnostics
    return build_world(definition, CATALOG, time)


def arguments(prop: PropDef, factor: float) -> dict[str, float | str]:
    return {
        s.name: s.default * factor
        for s in prop.parameters
        if isinstance(s.default, float) and s.kind == "length"
    }


# --- props ----------------------------------------------------------------------------


@pytest.mark.parametrize("factor", [1.0, 0.35, 1.9])
@pytest.mark.parametrize("name", PROPS)
def test_props_build_at_any_size(name: str, factor: float) -> None:
    prop = CATALOG.get("prop", name)
    assert isinstance(prop, PropDef)
    report = Report()
    shape = prop.shape(arguments(prop, factor), report)
    assert not report.errors
    built = build_prop(shape)
    assert volume(built.mesh) > 0
    assert 0 < len(built.mesh.faces) <= PROP_BUDGET
    assert (built.half > 0).all()
    if factor == 1.0:
        assert len(shape.primitives) == len(prop.shape(report=report).primitives)


@pytest.mark.parametrize("name", PROPS)
def test_every_primitive_is_the_right_way_out(name: str) -> None:
    prop = CATALOG.get("prop", name)
    assert isinstance(prop, PropDef)
    mesh = build_prop(prop.shape()).mesh
    corners = mesh.vertices[mesh.faces].astype(float)
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    agree = np.einsum("fi,fi->f", flat, mesh.normals[mesh.faces].mean(1)) > -1e-9
    assert agree.all()


@pytest.mark.parametrize("name", [n for n in PROPS if getattr(CATALOG.get("prop", n), "movable", False)])
def test_a_grip_is_on_its_prop(name: str) -> None:
    prop = CATALOG.get("prop", name)
    assert isinstance(prop, PropDef)
    shape = prop.shape()
    assert shape.grip is not None
    vertices = build_prop(shape).mesh.vertices
    near = np.linalg.norm(vertices - np.array(shape.grip), axis=1).min()
    assert near < max(0.08, 0.55 * float(np.ptp(vertices, axis=0).max()))
    assert (np.array(shape.grip) <= vertices.max(0) + 0.02).all()
    assert (np.array(shape.grip) >= vertices.min(0) - 0.02).all()


def test_boxes_are_merged_without_filling_the_space_under_a_table() -> None:
    table = CATALOG.get("prop", "table")
    assert isinstance(table, PropDef)
    built = build_prop(table.shape())
    low = built.centre - built.half
    high = built.centre + built.half
    under = np.array([0.0, 0.0, 0.3])
    assert not ((low < under) & (under < high)).all(1).any()
    on = np.array([0.0, 0.0, 0.73])
    assert ((low < on) & (on < high)).all(1).any()
    assert len(built.half) <= 7


def test_merging_keeps_everything_covered() -> None:
    rng = np.random.default_rng(4)
    low = rng.uniform(0, 2, (12, 3))
    boxes = [(a, a + s) for a, s in zip(low, rng.uniform(0.1, 1, (12, 3)), strict=True)]
    merged = merged_boxes(boxes)
    assert len(merged) <= len(boxes)
    for a, b in boxes:
        assert any((a >= c - 1e-9).all() and (b <= d + 1e-9).all() for c, d in merged)


# --- the library's sets -----------------------------------------------------------------


@pytest.mark.parametrize("name", SETS)
def test_budget_and_ids(name: str) -> None:
    w = world(name)
    assert 8_000 < len(w.mesh.faces) <= BUDGET
    assert len(w.mesh_object) == len(w.mesh_wall) == len(w.mesh.faces)
    assert [o.id for o in w.objects] == list(range(len(w.objects)))
    assert len({o.path for o in w.objects}) == len(w.objects)
    assert w.mesh_object.min() >= 0
    assert w.mesh_object.max() < len(w.objects)
    assert w.mesh_wall.max() < len(w.walls)
    moving = {o.id for o in w.objects if o.mesh is not None}
    carried = {o.id for o in w.objects if o.grip is not None}
    assert carried
    assert not moving & set(w.mesh_object.tolist())
    assert not carried & set(w.solids.object.tolist())
    assert len(w.solids.yaw) < 260


@pytest.mark.parametrize("name", SETS)
def test_stand_spots_are_free(name: str) -> None:
    w = world(name)
    count = 0
    for o in w.objects:
        prop = CATALOG.get("prop", o.kind)
        wanted = isinstance(prop, PropDef) and "stand" in prop.spots
        assert o.spot("stand") is not None or not wanted or len(o.path) > 2, o.path
        for spot in o.spots:
            if spot.name == "stand":
                count += 1
                x, y, z = spot.position
                assert z == 0
                assert is_clear(x, y, w.solids, w.storeys[0]), (o.path, spot)
    assert count > 15


@pytest.mark.parametrize("name", SETS)
def test_all_stand_spots_can_be_reached(name: str) -> None:
    """On a 10 cm grid, with a body of 0.25 m, from one to every other."""
    w = world(name)
    step = 0.1
    floors = np.array(w.floors)
    x0, y0 = floors[:, :2].min(0)
    x1, y1 = floors[:, 2:].max(0)
    gx, gy = np.meshgrid(np.arange(x0, x1, step), np.arange(y0, y1, step), indexing="ij")
    free = np.zeros(gx.shape, bool)
    for a, b, c, d in w.floors:
        free |= (gx >= a) & (gx <= c) & (gy >= b) & (gy <= d)
    s = w.solids
    for k in range(len(s.yaw)):
        if s.centre[k, 2] + s.half[k, 2] <= 0.1 or s.centre[k, 2] - s.half[k, 2] >= 1.8:
            continue
        cos, sin = math.cos(s.yaw[k]), math.sin(s.yaw[k])
        dx, dy = gx - s.centre[k, 0], gy - s.centre[k, 1]
        px = np.maximum(np.abs(cos * dx + sin * dy) - s.half[k, 0], 0)
        py = np.maximum(np.abs(-sin * dx + cos * dy) - s.half[k, 1], 0)
        free &= np.hypot(px, py) >= 0.25
    labels, _ = ndimage.label(free, np.ones((3, 3)))
    seen: dict[int, list[tuple[str, ...]]] = {}
    for o in w.objects:
        for spot in o.spots:
            if spot.name == "stand":
                i, j = round((spot.position[0] - x0) / step), round((spot.position[1] - y0) / step)
                near = labels[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2]
                found = set(near[near > 0].tolist())
                assert found, o.path
                seen.setdefault(max(found), []).append(o.path)
    assert len(seen) == 1, seen


@pytest.mark.parametrize("name", SETS)
def test_seats_are_on_something(name: str) -> None:
    w = world(name)
    seats = [(o, s) for o in w.objects for s in o.spots if s.name == "seat"]
    assert seats
    for o, seat in seats:
        assert o.low[0] <= seat.position[0] <= o.high[0]
        assert o.low[1] <= seat.position[1] <= o.high[1]
        assert 0.4 <= seat.position[2] <= 0.55
        assert seat.facing is not None


@pytest.mark.parametrize("name", SETS)
def test_movable_things_rest_on_something(name: str) -> None:
    """The foot of each is on a floor, or on the top of what it was put on."""
    w = world(name)
    by_path = {o.path: o for o in w.objects}
    for o in w.objects:
        if o.grip is None:
            continue
        foot = o.low[2]
        parent = by_path[o.path[:-1]]
        tops = [0.0, *(s.position[2] for s in parent.spots if s.name == "top")]
        assert min(abs(foot - t) for t in tops) < 0.035, o.path
        assert parent.low[0] - 0.02 <= o.centre[0] <= parent.high[0] + 0.02, o.path
        assert parent.low[1] - 0.02 <= o.centre[1] <= parent.high[1] + 0.02, o.path


@pytest.mark.parametrize("name", SETS)
def test_furniture_does_not_stand_in_furniture(name: str) -> None:
    """No two solids of different objects share more than a finger's breadth (walls and doors aside)."""
    w = world(name)
    s = w.solids
    plain = [
        k for k in range(len(s.yaw)) if s.wall[k] < 0 and abs(math.remainder(s.yaw[k], math.pi / 2)) < 0.02
    ]
    for n, i in enumerate(plain):
        for j in plain[n + 1 :]:
            if s.object[i] == s.object[j] or min(s.half[i].max(), s.half[j].max()) < 0.06:
                continue
            a, b = w.objects[s.object[i]], w.objects[s.object[j]]
            if {a.kind, b.kind} & {"tree", "hedge", "bush"} or a.path[:2] == b.path[:2]:
                continue
            hi = s.half[i] if abs(math.remainder(s.yaw[i], math.pi)) < 0.1 else s.half[i][[1, 0, 2]]
            hj = s.half[j] if abs(math.remainder(s.yaw[j], math.pi)) < 0.1 else s.half[j][[1, 0, 2]]
            shared = hi + hj - np.abs(s.centre[i] - s.centre[j])
            tucked = {a.kind, b.kind} & {"chair", "office_chair"}
            assert shared.min() < (0.25 if tucked else 0.03), (a.path, b.path, shared)


def test_two_builds_are_the_same() -> None:
    definition = CATALOG.get("set", "apartment")
    assert isinstance(definition, SetDef)
    a, b = build_world(definition, Catalog(), "dusk"), build_world(definition, Catalog(), "dusk")
    assert a.mesh.vertices.tobytes() == b.mesh.vertices.tobytes()
    assert a.mesh.colors.tobytes() == b.mesh.colors.tobytes()
    assert a.solids.centre.tobytes() == b.solids.centre.tobytes()
    assert [o.spots for o in a.objects] == [o.spots for o in b.objects]


# --- walls ------------------------------------------------------------------------------

TWO_ROOMS = """set s {
    room a, size (4, 3, 2.6)m, wall-color white {
        door way, wall east, at 1.5m, to b
        window, wall west, at 1.5m
        place shelf = wall_cupboard, wall north, at 2m, up 1.4m
        place low = sideboard(width 1m), wall south, at 2m
    }
    room b, at (4, 0)m, size (3, 3, 2.6)m, wall-color sage { }
}"""


def solid_at(w: World, x: float, y: float, z: float) -> bool:
    s = w.solids
    inside = np.abs(np.array([x, y, z]) - s.centre) < s.half
    return bool((inside.all(1) & (s.wall >= 0) & np.isin(s.object, [0, 1])).any())


def test_a_door_cuts_the_wall_both_rooms_share() -> None:
    w = own_world(TWO_ROOMS)
    assert not solid_at(w, 4.0, 1.5, 1.0)
    assert solid_at(w, 4.0, 1.5, 2.3)
    assert solid_at(w, 4.0, 0.5, 1.0)
    assert not solid_at(w, 0.0, 1.5, 1.5)
    assert solid_at(w, 0.0, 1.5, 0.4)
    assert any(x0 < 4.0 < x1 and y0 < 1.5 < y1 for x0, y0, x1, y1 in w.floors)
    # no face of the wall itself is left in the opening
    centres = w.mesh.vertices[w.mesh.faces].mean(1)
    wall = int(np.flatnonzero([abs(v.low[0] - 4) + abs(v.high[0] - 4) < 1e-6 for v in w.walls])[0])
    of_wall = (w.mesh_wall == wall) & (w.mesh_object < 2)
    gap = (np.abs(centres[:, 1] - 1.5) < 0.3) & (centres[:, 2] < 1.9)
    assert not (of_wall & gap).any()


def test_both_faces_of_a_shared_wall_have_their_rooms_colour() -> None:
    w = own_world(TWO_ROOMS)
    centres = w.mesh.vertices[w.mesh.faces].mean(1)
    wall = (w.mesh_object < 2) & (w.mesh_wall >= 0) & (centres[:, 2] > 0.5)  # not the ends in the corners
    high = wall & (np.abs(centres[:, 0] - 4) < 0.07) & (np.abs(centres[:, 1] - 1.5) < 1.3)
    west = high & (np.abs(centres[:, 0] - 3.94) < 0.01)
    east = high & (np.abs(centres[:, 0] - 4.06) < 0.01)
    assert west.any()
    assert east.any()
    assert set(w.mesh_object[west].tolist()) == {0}
    assert set(w.mesh_object[east].tolist()) == {1}
    assert not np.allclose(w.mesh.colors[west].mean(0), w.mesh.colors[east].mean(0), atol=0.02)


def test_what_hangs_on_a_wall_goes_with_it() -> None:
    w = own_world(TWO_ROOMS)
    ids = {o.path[-1]: o.id for o in w.objects}
    for name in ("shelf", "way", "window"):
        assert (w.mesh_wall[w.mesh_object == ids[name]] >= 0).all(), name
    assert (w.mesh_wall[w.mesh_object == ids["low"]] == -1).all()
    shelf = int(w.mesh_wall[w.mesh_object == ids["shelf"]][0])
    assert w.walls[shelf].low[1] == w.walls[shelf].high[1] == pytest.approx(3.0)


def test_walls_are_split_at_corners() -> None:
    w = own_world(TWO_ROOMS)
    assert len(w.walls) == 7
    assert sorted(math.dist(v.low, v.high) for v in w.walls) == pytest.approx([3, 3, 3, 3, 3, 4, 4])


def test_a_prop_at_a_wall_touches_it() -> None:
    w = own_world(TWO_ROOMS)
    shelf = next(o for o in w.objects if o.path[-1] == "shelf")
    low = next(o for o in w.objects if o.path[-1] == "low")
    assert shelf.high[1] == pytest.approx(2.94, abs=0.005)
    assert low.low[1] == pytest.approx(0.06, abs=0.03)
    stand = low.spot("stand")
    assert stand is not None
    assert stand.position[1] > 0.6
    assert math.cos((stand.facing or 0) + math.pi / 2) == pytest.approx(1, abs=1e-6)


# --- light ------------------------------------------------------------------------------


@pytest.mark.parametrize("time", ["dawn", "day", "dusk", "night"])
@pytest.mark.parametrize("name", SETS)
def test_light_has_a_direction_and_is_never_mud(name: str, time: str) -> None:
    light = world(name, time).light
    assert math.hypot(*light.sun) == pytest.approx(1)
    assert light.sun[2] > 0.3
    assert min(light.sky) > (0.3 if time == "night" else 0.4)  # at dusk lamps are on
    assert max(light.sun_color) > 0.4


def test_light_comes_from_the_windows() -> None:
    apartment = CATALOG.get("set", "apartment")
    assert isinstance(apartment, SetDef)
    assert make_light(apartment, "day", ("kitchen",)).sun[0] < -0.3
    assert make_light(apartment, "day", ("living",)).sun[1] < -0.3
    assert make_light(apartment, "day", ("bedroom",)).sun[0] > 0.3


def test_the_rest_steps_back_before_lamps_and_before_candles_hardly() -> None:
    """At night a café with lamps has less key light than one without would; a church with candles has it."""
    for name, low, high in (("cafe", 0.4, 0.7), ("office", 0.4, 0.7), ("church", 0.8, 1.0)):
        definition = CATALOG.get("set", name)
        assert isinstance(definition, SetDef)
        without = make_light(definition, "night")
        share = world(name, "night").light.sun_color[0] / without.sun_color[0]
        assert low < share <= high, (name, share)
        assert world(name, "day").light == make_light(definition, "day")


def test_windows_are_dark_at_night() -> None:
    day, night = world("apartment", "day"), world("apartment", "night")
    changed = (day.mesh.colors != night.mesh.colors).any(1)
    assert changed.any()
    assert night.mesh.colors[changed].mean() < 0.6 * day.mesh.colors[changed].mean()
    panes = night.mesh.colors[night.mesh.materials == NIGHT_GLASS]
    assert len(panes)
    assert (panes[:, 2] > 1.3 * panes[:, 0]).all(), "and blue before the light of lamps"


def test_houses_are_lit_at_night_and_shelters_are_not() -> None:
    w = world("suburb_street", "night")
    glow = set(w.mesh_object[w.mesh.materials == MATERIALS.index("glow")].tolist())
    kinds = {w.objects[i].kind for i in glow}
    assert "house" in kinds
    assert "far_house" in kinds
    assert not kinds & {"bus_shelter", "car"}
    assert not (w.mesh.materials == MATERIALS.index("glass")).any()


def test_stained_glass_keeps_its_colours_at_night() -> None:
    day, night = world("church"), world("church", "night")
    glass = day.mesh.materials == MATERIALS.index("glass")
    own, late = day.mesh.colors[glass], night.mesh.colors[glass]
    red = own[:, 0] > 1.5 * own[:, 2]
    assert red.any()
    assert (late[red, 0] > late[red, 2]).all()
    assert late.mean() < own.mean()


@pytest.mark.parametrize("time", ["dawn", "dusk", "night"])
def test_low_light_indoors_is_warm_where_it_falls_and_cool_where_not(time: str) -> None:
    light = world("apartment", time).light
    assert light.sun_color[0] > light.sun_color[1] > light.sun_color[2]
    assert light.sky[2] >= light.sky[0]


# --- what a set brings of its own -------------------------------------------------------


def test_walls_are_of_the_rooms_material_and_only_some_have_skirting() -> None:
    text = "set s {{\n  room r, size (4, 3, 2.6)m, floor stone{} {{\n    spot middle, at (2, 1.5)m\n  }}\n}}"
    plain, hewn = own_world(text.format("")), own_world(text.format(", wall stone, wall-color grey"))

    def upright(w: World, material: str) -> int:
        tall = np.ptp(w.mesh.vertices[w.mesh.faces][..., 2], axis=1) > 2
        return int(((w.mesh.materials == MATERIALS.index(material)) & tall & (w.mesh_wall >= 0)).sum())

    assert upright(plain, "stone") == 0
    assert upright(hewn, "stone") == 8  # the insides of four walls; the outsides stay plaster
    assert upright(plain, "plaster") == 16
    assert len(hewn.mesh.faces) < len(plain.mesh.faces)


def test_a_yard_lies_under_the_sky() -> None:
    text = (
        "set s {{\n  ground sand, material sand, deep 2m\n  room yard, size (6, 5, 4)m{} {{\n"
        "    spot middle, at (3, 2)m\n  }}\n}}"
    )
    yard, cellar = own_world(text.format(", ceiling no")), own_world(text.format(""))
    assert yard.outdoor
    assert not cellar.outdoor
    assert yard.light.backdrop != cellar.light.backdrop
    corners = yard.mesh.vertices[yard.mesh.faces]
    land = corners[yard.mesh.materials == MATERIALS.index("sand")]
    assert len(land)
    assert land[..., 2] == pytest.approx(-2.0)
    level = np.ptp(corners[..., 2], axis=1) < 1e-6
    assert corners[level][..., 2].max() == pytest.approx(4.0)  # the walls' tops only
    narrow = np.ptp(corners[level & (corners[..., 2].min(1) > 3)], axis=1)[:, :2].min(1)
    assert narrow.max() < 0.2


@pytest.mark.parametrize("light", LIGHTS[1:])
def test_lamps_do_not_mind_the_hour_but_are_lowered_at_night(light: str) -> None:
    text = (
        f"set s {{\n  light {light}\n  room r, size (4, 3, 2.6)m {{\n    spot middle, at (2, 1.5)m\n  }}\n}}"
    )
    parsed = parse_definition(Source("test.vds", text), "set", "s", Report())
    assert parsed is not None
    definition = read_set(parsed, Report())
    assert definition is not None
    day, dusk, night = (make_light(definition, t) for t in ("day", "dusk", "night"))
    assert day == dusk
    assert 0.75 < night.sky[1] / day.sky[1] < 0.95
    assert min(night.sky) > 0.5
    assert max(night.sun_color) > 0.4


def test_stars_shine_at_any_hour() -> None:
    day, dusk = (own_world_at("set s {\n  light cool\n  room r, size (6, 5, 3)m {\n    "
                              "place view = star_window, wall north, at 3m, up 0.5m\n  }\n}", t)
                 for t in ("day", "dusk"))  # fmt: skip
    assert (day.mesh.colors == dusk.mesh.colors).all()
    assert (day.mesh.materials == dusk.mesh.materials).all()
