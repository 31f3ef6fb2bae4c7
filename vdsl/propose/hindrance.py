"""Why a line cannot be acted: no seat, no way, nothing that opens; and what would do instead."""

from __future__ import annotations

import math

from runtime.nav import obstacles, reachable

from ..lang.diagnostics import Report
from ..lang.ir import Beat, Target
from .places import object_target, seat_of, seats, target_point
from .state import SceneState, floor_under


def report_nothing_opens(target: Target, state: SceneState, report: Report) -> None:
    """Nothing of the target opens; says what does."""
    report.warn("VDS242", target.span, label=f"nothing of `{target.written}` opens",
                help=_listing("what opens here: ", _openers(state)))  # fmt: skip


def _openers(state: SceneState) -> list[str]:
    """Names of what can be opened in the scene's room, or all of the set."""
    paths = [o.path[:-1] for o in state.world.objects if o.hinge is not None]
    near = [p for p in paths if p[: len(state.room)] == state.room] or paths
    return list(dict.fromkeys(p[-1] for p in near))


def report_no_seat(beat: Beat, state: SceneState, report: Report) -> None:
    """Nobody can sit there; says where one can."""
    span = beat.target.span if beat.target is not None else beat.span
    taken = beat.target is not None and bool(seats(beat.target, state.world))
    report.error(
        "VDS171",
        span,
        label="somebody sits here already" if taken else "nobody can sit here",
        help=_listing("free seats: ", _free_seats(state, beat.character)),
    )


def report_no_support(beat: Beat, report: Report) -> None:
    """There is nothing to have one's back against."""
    span = beat.target.span if beat.target is not None else beat.span
    written = (
        f"no free place before `{beat.target.written}`" if beat.target is not None else "no wall near by"
    )
    report.error("VDS173", span, label=f"{beat.character} cannot lean here: {written}",
                 help="name what to lean against: a tree, a car, a counter")  # fmt: skip


def _free_seats(state: SceneState, who: str) -> list[str]:
    names = []
    for item in state.world.objects:
        target = object_target(item)
        if any(s.name.startswith("seat") for s in item.spots) and seat_of(target, state, who) is not None:
            names.append(item.path[-1])
    return names


def _listing(before: str, names: list[str]) -> str | None:
    return before + ", ".join(f"`{n}`" for n in names[:6]) if names else None


def report_unreachable(
    beat: Beat, target: Target, state: SceneState, here: tuple[float, float, float], report: Report
) -> None:
    """Says what stands in the way, and what can be reached."""
    people = state.people(but=beat.character)
    goal = target_point(target, state, here).position
    blocking = obstacles(state.world, here, goal)
    names = _blockers(state, blocking, target)
    crowd = [
        f"`{name}`"
        for name, a in state.actors.items()
        if name != beat.character and math.hypot(a.position[0] - goal[0], a.position[1] - goal[1]) < 0.7
    ]
    what = list(dict.fromkeys(names + crowd))
    label = f"{beat.character} cannot get to `{target.written}`"
    upstairs = abs(floor_under(state.world, goal) - here[2]) > 0.05
    nothing = "no stairs lead there" if upstairs else "no floor leads there"
    label += f": {', '.join(what[:6])} in the way" if what else f": {nothing}"
    reach = []
    for item in state.world.objects:
        stand = next((s for s in item.spots if s.name.startswith("stand")), None)
        elsewhere = stand is not None and item.path != target.path
        if stand is not None and elsewhere and reachable(state.world, here, stand.position, people):
            reach.append(item.path[-1])
    report.error(
        "VDS170",
        target.span,
        label=label,
        help=_listing(f"{beat.character} can get to ", reach) or f"give {beat.character} room to walk",
    )


def _blockers(state: SceneState, blocking: list[int], target: Target) -> list[str]:
    """Names of what stands in the way: parts by what they belong to, walls as such; not the target itself."""
    names = []
    for i in blocking:
        item = state.world.objects[i] if i >= 0 else None
        if item is not None and item.hinge is not None:
            item = state.world.objects[item.hinge.owner]
        if item is None or item.kind in ("room", "area"):
            names.append("a wall")
        elif item.path != target.path:
            names.append(f"`{item.path[-1]}`")
    return names
