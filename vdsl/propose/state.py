"""A scene between two lines: who is where, how, holding what; and how it opens."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from runtime.body.skeleton import Skeleton
from runtime.motion.types import ActorState, PropState
from runtime.nav import Discs, level_at, nearest_free
from runtime.world import Spot, World, WorldObject

from ..lang.diagnostics import Report
from ..lang.ir import Placement, Scene, Target

PERSON_RADIUS = 0.22  # how much room somebody else takes up on the floor, metres
_APART = 1.1  # least distance between people who are placed by default, metres


@dataclass(frozen=True, eq=False)
class SceneState:
    """A scene at the end of a line.

    actors: by name, in the storyboard's order; props: by object id, every movable thing of the set, and what
        people have taken out (what they have about them is not among them)
    room: path of the room the scene plays in, () for the whole set
    """

    world: World
    actors: dict[str, ActorState]
    props: dict[int, PropState]
    room: tuple[str, ...] = ()

    def people(self, but: str | None = None) -> Discs:
        """Everybody else as obstacles on the floor."""
        return tuple(
            (a.position[0], a.position[1], PERSON_RADIUS, a.position[2])
            for name, a in self.actors.items()
            if name != but
        )


def opening_state(
    scene: Scene, world: World, skeletons: Mapping[str, Skeleton], report: Report
) -> SceneState:
    """How a scene begins: everybody of ``skeletons`` where the script puts them, or near the middle."""
    props = {
        o.id: PropState(np.array(o.world_from_object, float), grip_of(o), hinge=o.hinge, open=o.ajar)
        for o in world.objects
        if o.mesh is not None and not o.bearer
    }
    actors: dict[str, ActorState] = {}
    placed = {p.character: p for p in scene.placements}
    for name in _one_by_one([name for name in skeletons if name in placed], placed):
        state = SceneState(world, dict(actors), props, scene.room)
        actor = _placed(placed[name], state, report)
        facing = placed[name].facing
        here = facing is not None and (facing.kind != "character" or facing.path[0] in actors)
        if actor is not None and facing is not None and here:  # who is placed by them goes by how they stand
            actor = _facing(actor, facing, state)
        if actor is not None:
            actors[name] = actor
    for name in skeletons:
        if name not in actors:
            actors[name] = _by_default(SceneState(world, dict(actors), props, scene.room))
    ordered = {name: actors[name] for name in skeletons}
    for placement in scene.placements:
        if placement.facing is not None and placement.character in ordered:
            state = SceneState(world, ordered, props, scene.room)
            ordered[placement.character] = _facing(ordered[placement.character], placement.facing, state)
    # Here: what is in a hand needs this module's state, and a scene opens with it.
    from .bringing import holding_at_first, lying_about

    return lying_about(scene, holding_at_first(scene, SceneState(world, ordered, props, scene.room)))


def _one_by_one(names: list[str], placed: Mapping[str, Placement]) -> list[str]:
    """The names so that who is placed at somebody comes after them."""
    out: list[str] = []
    for name in names:
        chain = [name]
        while (at := placed[chain[-1]].at).kind == "character" and at.path[0] in placed:
            if at.path[0] in chain:
                break
            chain.append(at.path[0])
        out += [each for each in reversed(chain) if each not in out]
    return out


def grip_of(item: WorldObject) -> tuple[float, float, float]:
    """Where a hand takes hold of what moves, in its own coordinates."""
    if item.hinge is not None:
        x, y, z = item.hinge.handle.tolist()
        return x, y, z
    return item.grip or (0.0, 0.0, 0.0)


def _placed(placement: Placement, state: SceneState, report: Report) -> ActorState | None:
    # Here: places needs this module's state, and placing people needs places.
    from .places import seat_of

    if placement.posture == "sitting":
        seat = seat_of(placement.at, state, placement.character, to_sit=True)
        if seat is None:
            report.error(
                "VDS171",
                placement.at.span,
                label=_no_seat(placement.at, state),
                help="place them at a chair or a sofa (a thing with a `seat` spot), or leave out `sitting`",
            )
            return None
        heading = seat.facing if seat.facing is not None else 0.0
        x, y, _ = seat.position
        floor = floor_under(state.world, seat.position)
        return ActorState((x, y, floor), heading, "sitting", seat.position)
    if placement.posture == "lying":
        lain = _lain(placement, state)
        if lain is not None:
            return lain
    standing = _standing(placement, state, report)
    if standing is None or placement.posture == "standing":
        return standing
    return replace(standing, posture=placement.posture)


def _lain(placement: Placement, state: SceneState) -> ActorState | None:
    """On the back on what has room to lie; None where that is the floor."""
    from .places import target_point

    bed = target_point(placement.at, state, (0.0, 0.0, 0.0)).bed
    if bed is None:
        return None
    (x, y, _), head = bed
    return ActorState((x, y, floor_under(state.world, bed[0])), head + math.pi, "lying", bed[0])


def _standing(placement: Placement, state: SceneState, report: Report) -> ActorState | None:
    from .places import approach

    if placement.at.kind == "character":
        return _with_somebody(placement, state, report)
    crowd: Discs = tuple((x, y, _APART - 0.25, z) for x, y, _, z in state.people())
    stop = approach(placement.at, state, placement.character, start=None, taken=crowd)
    stop = stop or approach(placement.at, state, placement.character, start=None)
    if stop is None:
        report.error(
            "VDS172",
            placement.at.span,
            label=f"there is no floor free for {placement.character} to stand here",
            help="place them at something with free floor beside it",
        )
        return None
    here = (stop.x, stop.y, stop.z)
    near = [a for a in state.actors.values() if math.dist(a.position, here) < 1.6]
    if placement.facing is None and placement.at.kind == "spot" and near:
        x, y, _ = near[0].position
        return ActorState(here, math.atan2(y - stop.y, x - stop.x))
    if placement.facing is None and placement.at.kind != "spot":
        middle = room_middle(state)
        away = math.hypot(middle[0] - stop.x, middle[1] - stop.y)
        heading = math.atan2(middle[1] - stop.y, middle[0] - stop.x) if away > 0.3 else stop.heading
        return ActorState(here, heading)
    return ActorState(here, stop.heading)


def _with_somebody(placement: Placement, state: SceneState, report: Report) -> ActorState | None:
    """Face to face with them, or at their side and looking where they look."""
    from .places import with_somebody

    who, other = placement.character, placement.at.path[0]
    if other not in state.actors:  # it was reported that they have no place
        return None
    stop = with_somebody(other, who, state, placement.beside)
    if stop is None:
        report.error(
            "VDS172",
            placement.at.span,
            label=f"there is no floor free for {who} to stand here",
            help=f"place {other} where there is more room",
        )
        return None
    return ActorState((stop.x, stop.y, stop.z), stop.heading)


def _no_seat(target: Target, state: SceneState) -> str:
    """Why nobody can sit at a target."""
    from .places import seats

    if target.kind == "character":
        return f"no seat is free near {target.path[0]}"
    return "somebody sits here already" if seats(target, state.world) else "nobody can sit here"


def _facing(actor: ActorState, facing: Target, state: SceneState) -> ActorState:
    from .places import target_point

    if actor.seat is not None:
        return actor  # a chair or a bed decides where one faces
    gaze = target_point(facing, state, actor.position).gaze
    dx, dy = gaze[0] - actor.position[0], gaze[1] - actor.position[1]
    if math.hypot(dx, dy) < 0.05:
        return actor
    return ActorState(actor.position, math.atan2(dy, dx), actor.posture, actor.seat, actor.held)


def floor_under(world: World, point: tuple[float, float, float]) -> float:
    """Height of the floor a point is over."""
    return world.storeys[level_at(world, point)].height


def room_of(state: SceneState) -> WorldObject | None:
    """The room or area the scene plays in, where it is one."""
    return next((o for o in state.world.objects if state.room and o.path == state.room), None)


def room_middle(state: SceneState) -> tuple[float, float, float]:
    """A point on the floor in the middle of the scene: the room's spot ``middle``, else its centre."""
    room = room_of(state)
    if room is not None:
        spot: Spot | None = room.spot("middle")
        x, y, _ = spot.position if spot is not None else room.centre
        return x, y, room.low[2]
    middles = [o.spot("middle") for o in state.world.objects if o.kind in ("room", "area")]
    found = next((s for s in middles if s is not None), None)
    if found is not None:
        return found.position
    levels = [level for level in state.world.storeys if level.floors]
    if not levels:
        return 0.0, 0.0, 0.0
    x0, y0, x1, y1 = max(levels[0].floors, key=lambda f: (f[2] - f[0]) * (f[3] - f[1]))
    return (x0 + x1) / 2, (y0 + y1) / 2, levels[0].height


def _by_default(state: SceneState) -> ActorState:
    """A free spot near the middle, facing whoever is there already."""
    middle = room_middle(state)
    crowd: Discs = tuple((x, y, _APART - 0.25, z) for x, y, _, z in state.people())
    spot = nearest_free(state.world, middle, crowd, within=50.0) or nearest_free(
        state.world, middle, (), within=50.0
    )
    x, y, z = spot if spot is not None else middle
    others = list(state.actors.values())
    heading = 0.0
    if others:
        nearest = min(others, key=lambda a: math.dist(a.position, (x, y, z)))
        heading = math.atan2(nearest.position[1] - y, nearest.position[0] - x)
    return ActorState((x, y, z), heading)
