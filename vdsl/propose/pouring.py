"""What is poured from, where a line only says what into: the nearest vessel that stands about."""

from __future__ import annotations

import math
from dataclasses import replace

from runtime.motion.types import TargetPoint

from ..lang.ir import Beat, Target
from .places import object_target, target_point
from .state import SceneState

#: Kinds of props one pours from, where the script does not say which.
POURERS = ("coffee_pot", "teapot", "kettle", "jug", "pitcher", "bottle", "carton", "watering_can")


def something_to_pour(
    beat: Beat, target: TargetPoint | None, state: SceneState
) -> tuple[Beat, TargetPoint | None]:
    """The nearest vessel to what is poured into, as the beat's second target."""
    near = state.actors[beat.character].position
    at = target.position if target is not None else near
    best: tuple[float, Target, TargetPoint] | None = None
    for item in state.world.objects:
        if item.id in state.props and item.kind in POURERS and state.props[item.id].holder is None:
            vessel = object_target(item)
            found = target_point(vessel, state, near)
            away = math.dist(found.position, at)
            if best is None or away < best[0]:
                best = (away, vessel, found)
    if best is None or best[0] > 2.5:
        return beat, None
    return replace(beat, second=best[1]), best[2]
