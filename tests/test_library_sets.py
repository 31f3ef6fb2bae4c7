"""Every set of the library: whole, walkable, furnished with sense, and not too heavy."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from runtime.nav import nearest_free, reachable
from runtime.world import Solids, World, WorldObject
from vdsl.cinema.sight import clear_lines
from vdsl.lang.definitions.set import SetDef, check_set
from vdsl.lang.diagnostics import Report
from vdsl.lang.source import Source
from vdsl.library.loader import Catalog
from vdsl.pipeline.script import check_source
from vdsl.stage.world import build_world

Array = NDArray[np.float64]

CATALOG = Catalog()
SETS = tuple(CATALOG.names("set"))
MOST_TRIANGLES = 36_000
#: How far a thing may hang over, or sink into, what it lies on, metres.
FLOATS, SINKS = 0.012, 0.02
STRUCTURE = ("room", "area", "wall", "part", "door", "window", "doorway", "platform", "stairs")
#: Share of a solid that may lie within a wall, or within a solid of another prop.
IN_WALL, IN_OTHER = 0.15, 0.4


def definition(name: str) -> SetDef:
    found = CATALOG.get("set", name)
    assert isinstance(found, SetDef)
    return found


@cache
def world(name: str) -> World:
    return build_world(definition(name), CATALOG)


def rooms(built: World) -> list[WorldObject]:
    return [o for o in built.objects if o.kind in ("room", "area")]


def middle(built: World) -> tuple[float, float, float]:
    """Where somebody stands in the main room: the first spot of the set's own."""
    return next(s.position for o in rooms(built) for s in o.spots)


@pytest.mark.parametrize("name", SETS)
def test_it_is_whole_and_light(name: str) -> None:
    report = Report()
    check_set(definition(name), CATALOG, report)
    assert [d.label for d in report.diagnostics] == []
    assert len(world(name).mesh.faces) <= MOST_TRIANGLES


@pytest.mark.parametrize("name", SETS)
def test_all_named_places_can_be_walked_to(name: str) -> None:
    built = world(name)
    start = middle(built)
    missed = []
    for item in built.objects:
        for spot in item.spots:
            own = item.kind in ("room", "area", "platform")
            if not own and spot.name != "stand":
                continue
            free = nearest_free(built, spot.position)
            off = math.dist(free[:2], spot.position[:2]) if free else math.inf
            if (own and off > 0.3) or not reachable(built, start, spot.position):
                missed.append((*item.path, spot.name))
    assert missed == []


@pytest.mark.parametrize("name", SETS)
def test_one_can_get_to_everything_there_is_to_use(name: str) -> None:
    """A prop that is made to be stood at keeps a place to stand, unless it is in the way of nothing."""
    alone = []
    for item in world(name).objects:
        prop = CATALOG.get("prop", item.kind)
        spots = {s.name for s in item.spots}
        wanted = getattr(prop, "spots", ())
        if "stand" in wanted and ("seat" in wanted or "lie" in wanted) and "stand" not in spots:
            alone.append(item.path)
    assert alone == []


@pytest.mark.parametrize("name", SETS)
def test_doors_are_free(name: str) -> None:
    built, shut = world(name), []
    for item in built.objects:
        if item.kind not in ("door", "doorway"):
            continue
        across = item.world_from_object[:3, 1]
        for side in (-1.0, 1.0):
            at = item.world_from_object[:3, 3] + across * side * 0.6
            if not any(o.low[0] < at[0] < o.high[0] and o.low[1] < at[1] < o.high[1] for o in rooms(built)):
                continue
            free = nearest_free(built, tuple(at))
            if free is None or math.dist(free[:2], at[:2]) > 0.3:
                shut.append((item.path, side))
    assert shut == []


@pytest.mark.parametrize("name", SETS)
def test_nothing_floats_or_sinks(name: str) -> None:
    built = world(name)
    movable = [o for o in built.objects if o.mesh is not None and o.grip is not None]
    ground = built.mesh.vertices[built.mesh.faces].astype(np.float64)
    low, high = ground.min(1), ground.max(1)
    placed = {o.id: triangles(o) for o in movable}
    wrong = []
    for item in movable:
        own = placed[item.id].reshape(-1, 3)
        foot = own[own[:, 2] < item.low[2] + 0.01]
        reach = np.array([0.0, 0.0, 0.1])
        close = ((low <= np.array(item.high) + reach) & (high >= np.array(item.low) - reach)).all(1)
        under = [ground[close], *(placed[o.id] for o in movable if o is not item and touches(o, item))]
        spots = [foot[:, :2].mean(0), *foot[:: max(1, len(foot) // 6), :2]]
        heights = [
            h for at in spots for h in [support(np.concatenate(under), at, item.low[2])] if h is not None
        ]
        gap = item.low[2] - max(heights) if heights else math.inf
        if not -SINKS <= gap <= FLOATS:
            wrong.append((item.path, round(gap, 3)))
    assert wrong == []


@pytest.mark.parametrize("name", SETS)
def test_nothing_stands_in_something_else(name: str) -> None:
    built = world(name)
    solids, objects = built.solids, built.objects
    wrong = []
    for i in np.flatnonzero((solids.wall < 0) & (solids.object >= 0)):
        points = inside(solids, int(i))
        own = objects[int(solids.object[i])].path
        if len(own) < 2:  # a room's own: what keeps people from falling down its stairs
            continue
        for j in np.flatnonzero(near(solids, int(i))):
            if solids.object[j] == solids.object[i]:
                continue
            structure = solids.wall[j] >= 0 and objects[int(solids.object[j])].kind in ("room", "area")
            other = objects[int(solids.object[j])].path if solids.object[j] >= 0 else ()
            if not structure and (other[: len(own)] == own or own[: len(other)] == other):
                continue
            share = within(solids, int(j), points)
            if share > (IN_WALL if structure else IN_OTHER):
                wrong.append((own, "wall" if structure else other, round(share, 2)))
    assert wrong == []


@pytest.mark.parametrize("name", SETS)
def test_what_a_camera_sees_but_cannot_bump_into_goes_with_its_wall(name: str) -> None:
    """A column without a solid that stays when its wall goes would fill the picture from behind it."""
    built = world(name)
    solid = set(built.solids.object.tolist())
    staying = []
    for item in built.objects:
        faces = built.mesh_object == item.id
        wide, deep, tall = (b - a for a, b in zip(item.low, item.high, strict=True))
        large = tall > 0.5 and max(wide, deep) > 0.35 and item.low[2] < 1.6
        if item.kind in STRUCTURE or item.id in solid or not (large and faces.any()):
            continue
        if (built.mesh_wall[faces] < 0).all():
            staying.append(item.path)
    assert staying == []


@pytest.mark.parametrize("name", SETS)
def test_a_script_finds_its_places_by_name(name: str) -> None:
    lines = [
        f"(anna walk {room.name}.{spot})"
        for room in definition(name).root.children
        for spot in room.spots
        if room.kind in ("room", "area")
    ]
    assert lines, "a set has a spot of its own to stand on"
    text = 'storyboard "a walk"\ncharacter anna = woman\nscene here = ' + name + "\n"
    text += (
        "anna at " + lines[0].removeprefix("(anna walk ").removesuffix(")") + "\n" + "\n".join(lines) + "\n"
    )
    assert [d.label for d in check_source(Source("walk.vds", text)).report.diagnostics] == []


@pytest.mark.parametrize(("name", "lamp"), [("apartment", "pendant"), ("garage", "lamp"), ("cafe", "lamp")])
def test_lamps_that_hang_in_a_room_hide_what_is_behind(name: str, lamp: str) -> None:
    built = world(name)
    x, y, z = next(o for o in built.objects if o.path[-1] == lamp).low
    x, y, z = x + 0.2, y + 0.2, z + 0.1  # inside its shade
    camera = np.array([[[x - 0.8, y, z]]])
    points = np.array([[(x + 0.8, y, z), (x + 0.8, y, z - 0.6)]])
    hidden = np.zeros((1, len(built.walls)), bool)
    assert clear_lines(built.solids, camera, points, hidden)[0, 0].tolist() == [False, True]


# --- measuring ------------------------------------------------------------------------


def triangles(item: WorldObject) -> Array:
    """[F, 3, 3] of a movable thing where it lies."""
    assert item.mesh is not None
    return item.mesh.transformed(item.world_from_object).vertices[item.mesh.faces].astype(np.float64)


def touches(a: WorldObject, b: WorldObject) -> bool:
    return all(a.low[k] < b.high[k] + 0.02 and b.low[k] < a.high[k] + 0.02 for k in range(3))


def support(under: Array, at: Array, foot: float) -> float | None:
    """Height of the surface at a place that is nearest to ``foot``; None where there is none close."""
    low, high = under[:, :, :2].min(1), under[:, :, :2].max(1)
    a, b, c = np.moveaxis(under[((low <= at) & (at <= high)).all(1)], 1, 0)
    u, v, w = b[:, :2] - a[:, :2], c[:, :2] - a[:, :2], at - a[:, :2]
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    flat = np.abs(area) > 1e-9
    a, b, c, u, v, w, area = (x[flat] for x in (a, b, c, u, v, w, area))
    s = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / area
    t = (u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]) / area
    hit = (s >= -1e-6) & (t >= -1e-6) & (s + t <= 1 + 1e-6)
    heights = (a[:, 2] + s * (b[:, 2] - a[:, 2]) + t * (c[:, 2] - a[:, 2]))[hit]
    close = heights[np.abs(heights - foot) < 0.08]
    return float(close[np.argmin(np.abs(close - foot))]) if len(close) else None


def inside(solids: Solids, i: int) -> Array:
    """[125, 3]: points spread through a box."""
    k = (np.arange(5) + 0.5) / 2.5 - 1
    local = np.stack(np.meshgrid(k, k, k), -1).reshape(-1, 3) * solids.half[i]
    c, s = math.cos(solids.yaw[i]), math.sin(solids.yaw[i])
    turned = np.stack([c * local[:, 0] - s * local[:, 1], s * local[:, 0] + c * local[:, 1], local[:, 2]], 1)
    return np.asarray(turned + solids.centre[i])


def near(solids: Solids, i: int) -> NDArray[np.bool_]:
    """[B]: boxes whose bounding spheres meet that of ``i``."""
    radius = np.linalg.norm(solids.half, axis=1)
    away = np.linalg.norm(solids.centre - solids.centre[i], axis=1)
    return np.asarray(away < radius + radius[i])


def within(solids: Solids, j: int, points: Array) -> float:
    """Share of the points that lie in box ``j``."""
    d = points - solids.centre[j]
    c, s = math.cos(solids.yaw[j]), math.sin(solids.yaw[j])
    local = np.stack([c * d[:, 0] + s * d[:, 1], -s * d[:, 0] + c * d[:, 1], d[:, 2]], 1)
    return float((np.abs(local) < solids.half[j]).all(1).mean())
