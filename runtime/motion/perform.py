"""Turns tasks into a performed scene: :func:`perform`.

Assumes skeletons and floors are sound and paths are walkable. Guarantees: everybody has a pose on every
frame, planted feet do not move, the result depends on its arguments alone (seeded, no global state).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT

from .acting import Performer
from .plan import Plan, begin, keep
from .planning import add_partner, listen, plan_task
from .scene import Scene, seeded
from .types import (
    Actor,
    ActorState,
    Point,
    PropState,
    SceneMotion,
    Task,
)

Array = NDArray[np.float64]
IDLE_TIME = 3.0
TAIL = 0.3


def perform(
    actors: dict[str, Actor],
    tasks: dict[str, Task],
    props: dict[int, PropState],
    fps: float,
    seed: int,
    duration: float | None = None,
    feelings: dict[str, str] | None = None,
) -> SceneMotion:
    """Everybody over one shot: those with a task act, the others idle and watch.

    feelings: by person, a word of :data:`runtime.motion.feelings.FEELINGS`; it wins over the manner's, and
        that over the action's own

    duration: seconds of the shot; None: as long as the longest task (3 s where nobody has one). A shot
    shorter than its action is cut off, and ends in the state the action would have led to.
    """
    plans = _plan(actors, tasks, props, seed)
    _feel(plans, tasks, feelings or {})
    asked = duration or max((x.duration or 0.0 for x in tasks.values()), default=0.0) or None
    busy = max((p.end for p in plans.values() if p.acts), default=IDLE_TIME - TAIL) + TAIL
    wanted = asked or busy
    frames = max(2, round(wanted * fps))
    span = max(frames, round(max([busy, *(p.route.now for p in plans.values())]) * fps))
    t = np.arange(span) / fps
    scene = Scene(plans, tasks, props, t, fps, seed)
    scene.run()
    return SceneMotion(
        frames,
        {n: p.figure.matrices()[:frames] for n, p in scene.performers.items()},
        {n: _floor_points(p)[:frames] for n, p in scene.performers.items()},
        {n: p.yaw[:frames] for n, p in scene.performers.items()},
        {k: x[:frames].astype(np.float32) for k, x in scene.props.items()},
        {n: _end_state(p, scene.held_at_end(n), frames / fps) for n, p in plans.items()},
        scene.end_props(),
        {n: p.touches(frames) for n, p in scene.performers.items()},
    )


def _plan(
    actors: dict[str, Actor], tasks: dict[str, Task], props: dict[int, PropState], seed: int
) -> dict[str, Plan]:
    plans = {name: begin(name, actor) for name, actor in actors.items()}
    for k, (name, task) in enumerate(tasks.items()):
        rng = seeded(seed, name, 1)
        plan_task(plans[name], task, props, rng, 0.08 if k == 0 else float(rng.uniform(0.1, 0.45)))
    for name, task in tasks.items():
        partner = task.clip.variant(task.variant).partner
        giver = plans[name]
        window = giver.windows[-1] if giver.windows else None
        if window is None or window.partner is None or window.partner not in plans or window.partner == name:
            continue
        other = plans[window.partner]
        if any((partner.tracks, partner.reaches, partner.gazes, partner.beats, partner.talks)):
            add_partner(other, partner, window, giver, task.clip.apart > 0)
        elif window.timeline.talks and not other.acts and other.kept is None:
            listen(other, giver, window)
    return plans


def _feel(plans: dict[str, Plan], tasks: dict[str, Task], feelings: dict[str, str]) -> None:
    for name, plan in plans.items():
        if name in feelings:
            plan.feelings.append((feelings[name], -1e6, 1e6))
        elif plan.manner.feeling:
            plan.feelings.append((plan.manner.feeling, -1e6, 1e6))
        elif name in tasks and tasks[name].clip.feeling and plan.windows:
            window = plan.windows[-1]
            plan.feelings.append((tasks[name].clip.feeling, window.start, window.at(1.0)))


def _floor_points(performer: Performer) -> Array:
    floor = performer.ground[:, None]
    hips = performer.figure.position[:, JOINT["hips"], :2]
    return np.concatenate([0.5 * (hips + performer.root), floor], axis=1)


def _end_state(plan: Plan, held: tuple[tuple[str, int], ...], seconds: float) -> ActorState:
    route = plan.route
    at = (float(route.at[0]), float(route.at[1]), route.floor)
    seat: Point | None = route.seat
    if route.low and route.bed != route.floor:
        seat = (at[0], at[1], route.bed)
    return ActorState(at, float(route.heading), route.posture, seat, held, keep(plan, seconds))
