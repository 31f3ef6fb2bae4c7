"""Things people have with them: in a hand as a scene opens, near them, or taken out where a line needs them.

What somebody has about them is in no place, and not among a state's props, until it is in a hand. It is put
away between two lines, as off the picture, when they do something that it is not for; where it was left or
given to somebody it stays.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from runtime.motion.rotations import rot_z
from runtime.motion.types import ActionClip, ActorState, PropState
from runtime.nav import nearest_free
from runtime.world import WorldObject

from ..lang.definitions.action import ActionDef
from ..lang.ir import Beat, Scene, StoryLine, Target
from ..library import Catalog
from .places import approach, near_on_foot, object_target, target_point
from .pouring import POURERS, something_to_pour
from .state import SceneState, grip_of
from .subjects import find_object

_HANDS = ("r", "l")
_ASIDE = 0.42  # metres from somebody's middle to what they set down
_SMALL = 0.32  # metres; what is no larger lies on furniture
_LOW, _HIGH = 0.35, 1.3  # metres over the floor: tops that things are put on
_NEAR = 3.0  # metres to these
_APART, _BESIDE = 0.4, 0.14  # metres between things on the floor, and on furniture


def holding_at_first(scene: Scene, state: SceneState) -> SceneState:
    """The state in which a scene opens, with what people are placed with in their hands."""
    for placement in scene.placements:
        item = _named(placement.holding, state)
        if item is not None and placement.character in state.actors:
            state = _in_hand(item, placement.character, state, "l")
    return state


def lying_about(scene: Scene, state: SceneState) -> SceneState:
    """The state with what lines do something to and the set has not, near who does it: what is small on a
    top, if there is one, else on the floor."""
    for thing in scene.carried:
        item = next((o for o in state.world.objects if o.path == thing.path), None)
        held = item is not None and item.id in state.props and state.props[item.id].holder is not None
        if item is None or held or not thing.about or thing.who not in state.actors:
            continue
        actor = state.actors[thing.who]
        size = np.asarray(item.high) - np.asarray(item.low)
        at = _on_a_top(actor, state) if size.max() < _SMALL else None
        if at is None:
            at = _on_the_floor(thing.who, state)
        stands = np.eye(4)
        stands[:3, :3], stands[:3, 3] = rot_z(np.array(actor.heading)), at
        props = {**state.props, item.id: PropState(stands, grip_of(item))}
        state = replace(state, props=props)
    return state


def _on_a_top(actor: ActorState, state: SceneState) -> tuple[float, float, float] | None:
    """A free place on the nearest furniture that one puts things on."""
    x, y, floor = actor.position
    tops = [
        (math.dist((x, y), spot.position[:2]), item)
        for item in state.world.objects
        for spot in item.spots
        if spot.name.startswith("top")
        and item.id not in state.props
        and floor + _LOW < spot.position[2] < floor + _HIGH
    ]
    things = [p.world_from_object[:3, 3] for p in state.props.values() if p.holder is None]
    for away, item in sorted(tops, key=lambda pair: pair[0]):
        if away > _NEAR:
            break
        at = target_point(object_target(item), state, actor.position).position
        stop = approach(object_target(item), state, "", start=actor.position)
        free = all(math.dist(at, thing) > _BESIDE for thing in things)
        if free and stop is not None and near_on_foot(state.world, actor.position, (stop.x, stop.y, stop.z)):
            return at
    return None


def _on_the_floor(who: str, state: SceneState) -> tuple[float, float, float]:
    """A free place before somebody, a few steps away."""
    actor, people = state.actors[who], state.people()
    x, y, floor = actor.position
    things = [p.world_from_object[:2, 3] for p in state.props.values() if p.holder is None]
    for turn in (0.5, -0.5, 0.0, 1.0, -1.0, 1.6, -1.6, 2.4, -2.4):
        for far in (1.3, 0.9):
            a = actor.heading + turn
            goal = (x + far * math.cos(a), y + far * math.sin(a), floor)
            found = nearest_free(state.world, goal, people, within=0.4, start=actor.position)
            if found is not None and all(math.dist(found[:2], t) > _APART for t in things):
                return found
    a = actor.heading + 0.7 * len(things)  # there is no room at all: not all in one place
    return x + _ASIDE * math.cos(a), y + _ASIDE * math.sin(a), floor


def with_things_at_hand(state: SceneState, line: StoryLine, catalog: Catalog | None) -> SceneState:
    """The state with what the line's actions are done with taken out, and what they are not, put away."""
    for beat in line.beats:
        if beat.character not in state.actors:
            continue
        named = [
            item for t in (beat.target, beat.second, beat.brought) if (item := _named(t, state)) is not None
        ]
        action = None if catalog is None else catalog.get("action", beat.action)
        if getattr(action, "group", "") != "going":  # one may walk with it, or sit down
            state = _put_away(beat.character, {item.id for item in named}, state)
        if isinstance(action, ActionDef) and takes_both_hands(action):
            state = _set_down(beat.character, {item.id for item in named}, state)
        for item in named:
            if (
                item.bearer in state.actors
                and item.id not in state.props
                and not _stands_about(item, beat, state)
            ):
                state = _in_hand(item, item.bearer, state, getattr(action, "needs_hand", "")[:1])
        if isinstance(action, ActionDef) and action.needs_hand:
            state = _in_the_right_hand(beat, action, state)
    return state


def _stands_about(item: WorldObject, beat: Beat, state: SceneState) -> bool:
    """Whether there is something near to pour from, so that nobody needs a bottle of their own."""
    if item.kind not in POURERS or beat.second is not None or beat.target is None:
        return False
    near = state.actors[beat.character].position
    return something_to_pour(beat, target_point(beat.target, state, near), state)[1] is not None


def takes_both_hands(action: ActionDef) -> bool:
    """Whether what it is done with in one hand leaves nothing for the other to hold."""
    hands = {move.words[0] for move in action.variants[0].part.moves if move.kind == "reach"}
    return action.needs in ("target", "second") and len(hands) > 1


def with_brought(beat: Beat, clip: ActionClip, state: SceneState) -> Beat:
    """The beat as if its line named what its action is done with, where that is in a hand."""
    item = _named(beat.brought, state)
    if item is None or item.id not in state.props:
        return beat
    if clip.needs == "target" and beat.target is None:
        return replace(beat, target=beat.brought)
    if clip.needs == "second" and beat.second is None:
        return replace(beat, second=beat.brought)
    return beat


def _named(target: Target | None, state: SceneState) -> WorldObject | None:
    return find_object(state.world, target) if target is not None and target.kind == "object" else None


def _in_hand(item: WorldObject, who: str, state: SceneState, wished: str = "") -> SceneState:
    """The thing in a free hand, the right one if none is wished for; as before where both are full."""
    actor = state.actors[who]
    full = {hand for hand, _ in actor.held}
    hand = next((h for h in dict.fromkeys((wished or "r", *_HANDS)) if h not in full), None)
    if hand is None:
        return state
    x, y, z = actor.position
    c, s = np.cos(actor.heading), np.sin(actor.heading)
    ahead = np.array([[-s, -c, 0, x], [c, -s, 0, y], [0, 0, 1, z], [0, 0, 0, 1]], float)  # its front is -Y
    props = {**state.props, item.id: PropState(ahead, grip_of(item), (who, hand))}
    held = tuple(sorted((*actor.held, (hand, item.id))))
    return _with_actor(who, replace(actor, held=held), replace(state, props=props))


def _put_away(who: str, kept: set[int], state: SceneState) -> SceneState:
    """Without what somebody took out themselves, but for some of it."""
    actor = state.actors[who]
    objects = state.world.objects
    away = {k for _, k in actor.held if objects[k].bearer == who and k not in kept}
    if not away:
        return state
    props = {k: p for k, p in state.props.items() if k not in away}
    held = tuple(pair for pair in actor.held if pair[1] not in away)
    return _with_actor(who, replace(actor, held=held), replace(state, props=props))


def _in_the_right_hand(beat: Beat, action: ActionDef, state: SceneState) -> SceneState:
    """With what the action is done with in the hand it has to be in, and what was there in the other."""
    needed = _named(getattr(beat, action.needs, None) or beat.brought, state)
    actor, wished = state.actors[beat.character], action.needs_hand[:1]
    hand = next((h for h, k in actor.held if needed is not None and k == needed.id), wished)
    if hand == wished:
        return state
    swapped = {"l": "r", "r": "l"}
    held = tuple(sorted((swapped[h], k) for h, k in actor.held))
    props = dict(state.props)
    for h, k in held:
        if k in props:
            props[k] = replace(props[k], holder=(beat.character, h))
    return _with_actor(beat.character, replace(actor, held=held), replace(state, props=props))


def _set_down(who: str, kept: set[int], state: SceneState) -> SceneState:
    """With all else that somebody holds standing on the floor beside them."""
    actor = state.actors[who]
    props, (x, y, floor) = dict(state.props), actor.position
    for hand, k in actor.held:
        if k not in kept and k in props:
            side = actor.heading + (1.9 if hand == "l" else -1.9)
            at = np.array([x + _ASIDE * np.cos(side), y + _ASIDE * np.sin(side), floor])
            stands = np.eye(4)
            stands[:3, :3], stands[:3, 3] = rot_z(np.array(actor.heading)), at
            props[k] = replace(props[k], world_from_object=stands, holder=None, home=None)
    held = tuple(pair for pair in actor.held if pair[1] in kept)
    return _with_actor(who, replace(actor, held=held), replace(state, props=props))


def _with_actor(who: str, actor: ActorState, state: SceneState) -> SceneState:
    return replace(state, actors={**state.actors, who: actor})
