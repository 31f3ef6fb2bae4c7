"""What changes hands: the moments of a plan at which things are taken, put down, passed on or thrown.

A plan's events are what :mod:`.scene` moves the things by; its ``held`` says what each hand holds so far.
"""

from __future__ import annotations

import numpy as np

from .plan import Event, Plan
from .timeline import Grasp
from .types import Point, TargetPoint


def grasp_at(
    plan: Plan,
    grasp: Grasp,
    hands: dict[str, str],
    time: float,
    target: TargetPoint | None,
    second: TargetPoint | None,
    partner: str | None,
) -> None:
    hand = hands.get(grasp.hand, grasp.hand)
    if grasp.kind == "take":
        thing = target.object if target is not None and _in_reach(plan, target) else None
        if thing is not None and thing not in plan.held.values() and hand not in plan.held:
            plan.held[hand] = thing
            plan.events.append(Event(time, "take", plan.name, hand, thing))
    elif grasp.kind == "send":
        thing = target.object if target is not None else None
        if thing is not None and thing not in plan.held.values():
            plan.events.append(_throw(plan, time, "", thing, target, second))
    elif hand in plan.held:
        thing = plan.held[hand]
        if grasp.kind == "put":
            place = put_place(thing, target, second) or _home(plan, thing)
            if place is None:
                return  # nowhere to put it: it stays in the hand
            del plan.held[hand]
            plan.events.append(Event(time, "put", plan.name, hand, thing, place=place))
        elif grasp.kind == "throw":
            del plan.held[hand]
            plan.events.append(_throw(plan, time, hand, thing, target, second))
        elif partner is not None:
            del plan.held[hand]
            plan.events.append(Event(time, "pass", plan.name, hand, thing, receiver=partner))


def _throw(
    plan: Plan, time: float, hand: str, thing: int, target: TargetPoint | None, second: TargetPoint | None
) -> Event:
    """To the second thing or person named, else the first unless it is the thing itself, else ahead.

    Without a ``hand`` it leaves from where it lies, and comes to lie before a person.
    """
    aim = next((p for p in (second, target) if p is not None and p.object != thing), None)
    heading = np.array([np.cos(plan.route.heading), np.sin(plan.route.heading)])
    at = np.array(aim.position[:2]) if aim is not None else plan.route.at[:2] + 2.6 * heading
    flight = float(np.clip(np.hypot(*(at - plan.route.at[:2])) / 6.0, 0.3, 1.1))
    receiver = aim.character if aim is not None else None
    if receiver and not hand:
        at, receiver = at - 0.5 * heading, None
        aim = None
    floor = (float(at[0]), float(at[1]), plan.route.floor)
    place = None if receiver else aim.position if aim is not None else floor
    return Event(time, "throw" if hand else "send", plan.name, hand, thing, place, receiver, flight)


def _in_reach(plan: Plan, target: TargetPoint) -> bool:
    """Whether a hand can get to a thing from where one stands: what is farther off is not taken."""
    away = np.hypot(*(np.array(target.position[:2]) - plan.route.at[:2]))
    return bool(away < 0.72 * plan.actor.skeleton.height)


def put_place(thing: int, target: TargetPoint | None, second: TargetPoint | None) -> Point | None:
    """Where a held thing is put: the second thing named, else the first unless it is the thing itself."""
    for point in (second, target):
        if point is not None and point.object != thing and point.character is None:
            return point.position
    return None


def _home(plan: Plan, thing: int) -> Point | None:
    """Where a thing was taken from, if one can put it back without a step."""
    place = plan.homes.get(thing)
    if place is None or np.hypot(*(np.array(place[:2]) - plan.route.at[:2])) > 1.25:
        return None
    return place
