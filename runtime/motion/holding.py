"""Who holds what, and when: the events of all plans as spans in which a thing is in a hand."""

from __future__ import annotations

from .plan import Event, Plan
from .props import Hold
from .types import PropState


def holds_of(plans: dict[str, Plan], props: dict[int, PropState]) -> dict[int, list[Hold]]:
    """Who holds each thing when, from the starting states and the planned events."""
    holds: dict[int, list[Hold]] = {}
    for name, plan in plans.items():
        for hand, thing in plan.actor.state.held:
            if thing in props:
                holds.setdefault(thing, []).append(Hold(name, hand, -1e9, 1e9, None))
    for event in sorted((e for p in plans.values() for e in p.events), key=lambda e: e.time):
        nobody = (event.kind == "pass" or event.receiver) and event.receiver not in plans
        if event.object not in props or props[event.object].hinge is not None or nobody:
            continue
        mine = holds.setdefault(event.object, [])
        if mine and event.kind != "send":
            last = mine[-1]
            mine[-1] = Hold(last.person, last.hand, last.start, event.time, event.place, event.flight)
        if event.kind == "send":
            mine.append(Hold(event.person, "", event.time, event.time, event.place, event.flight))
        elif event.kind == "take":
            mine.append(Hold(event.person, event.hand, event.time, 1e9, None))
        elif event.receiver is not None:
            caught = event.time + event.flight
            mine.append(Hold(event.receiver, _receiving(plans[event.receiver], event), caught, 1e9, None))
    return holds


def _receiving(plan: Plan, event: Event) -> str:
    window = next((w for w in plan.windows if w.partner == event.person), None)
    if window is None:
        return "r"
    reach = next((r for r in window.timeline.reaches if r.to == "meet"), None)
    return window.hands[reach.hand if reach is not None else "free"]


def spans_of(holds: list[Hold], person: str, hand: str) -> list[tuple[float, float]]:
    return [(h.start, h.end) for h in holds if h.person == person and h.hand == hand]
