"""A plan: what one person does in a shot, where, when and with which hand. No poses yet.

A plan has a :class:`~runtime.motion.route.Route`, windows in which timelines play, and the moments at
which things change hands; :mod:`.planning` makes it of tasks.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from .manner import PLAIN, Manner
from .postures import WAYS
from .replay import Replay
from .route import Route
from .timeline import Timeline
from .types import Actor, Kept, Point, TargetPoint

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Window:
    """A timeline played from ``start`` for ``duration`` seconds by one person.

    hands: hand words to ``l`` / ``r``; partner: the other person's name
    """

    timeline: Timeline
    start: float
    duration: float
    hands: dict[str, str]
    target: TargetPoint | None
    second: TargetPoint | None
    partner: str | None
    until: float = np.inf  # seconds, when what stays of it is over

    def at(self, share: float) -> float:
        return self.start + share * self.duration


@dataclass(frozen=True)
class Event:
    """At ``time`` a hand takes, puts down (at ``place``), passes on (to ``receiver``), throws or (without
    a hand) sends off a thing, which then flies for ``flight`` seconds."""

    time: float
    kind: str
    person: str
    hand: str
    object: int
    place: Point | None = None
    receiver: str | None = None
    flight: float = 0.0


@dataclass(eq=False)
class Plan:
    """One person's shot. Busy until ``end`` seconds; ``held`` is what each hand holds as planned so far.

    feelings: (word, start, end in seconds) of what shows on the face
    kept: the window of which the last pose stays
    """

    name: str
    actor: Actor
    route: Route
    held: dict[str, int]
    homes: dict[int, Point] = field(default_factory=dict)
    windows: list[Window] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    replays: list[Replay] = field(default_factory=list)
    opened: set[int] = field(default_factory=set)
    feelings: list[tuple[str, float, float]] = field(default_factory=list)
    end: float = 0.0
    acts: bool = False
    kept: Window | None = None
    manner: Manner = PLAIN


def begin(name: str, actor: Actor) -> Plan:
    """A plan in which nothing happens yet."""
    state = actor.state
    person = np.random.default_rng([*name.encode(), 77])
    seat = state.seat if state.posture == "sitting" else None
    if state.posture == "sitting" and seat is None:
        seat = (*state.position[:2], state.position[2] + 0.45)
    if state.posture in WAYS:
        seat = state.seat
    route = Route(actor.skeleton, state.position, state.heading, seat, person, state.posture)
    plan = Plan(name, actor, route, dict(state.held))
    if state.kept is not None:
        k = state.kept
        plan.kept = Window(k.timeline, -k.since, k.duration, dict(k.hands), k.target, k.second, k.partner)
        plan.windows.append(plan.kept)
    return plan


def keep(plan: Plan, seconds: float) -> Kept | None:
    """The pose that stays for the next shot, which begins after ``seconds``."""
    w = plan.kept
    if w is None or np.isfinite(w.until):
        return None
    still = replace(w.timeline, beats=(), grasps=(), talks=(), drives=(), steps=(), jumps=())
    return Kept(still, seconds - w.start, w.duration, tuple(w.hands.items()), w.target, w.second, w.partner)


def choose_hands(plan: Plan, target: TargetPoint | None, time: float) -> dict[str, str]:
    """What the hand words mean for this person now."""
    xy, yaw, _ = plan.route.root(np.array([time]))
    side = "r"
    if target is not None:
        d = np.array(target.position[:2]) - xy[0]
        across = -np.sin(yaw[0]) * d[0] + np.cos(yaw[0]) * d[1]
        side = "l" if across > 0.08 else "r"
    if target is not None and target.object in plan.held.values():
        holding = next(h for h, o in plan.held.items() if o == target.object)
    else:
        holding = next(iter(sorted(plan.held, reverse=True)), side)
    near = side if side not in plan.held or len(plan.held) == 2 else other(side)
    free = other(holding) if holding in plan.held else near
    return {
        "left": "l", "right": "r", "l": "l", "r": "r",
        "near": near, "other": other(near), "holding": holding, "free": free,
    }  # fmt: skip


def other(hand: str) -> str:
    return "r" if hand == "l" else "l"
