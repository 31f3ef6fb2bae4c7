"""Things people have with them: in a hand when a scene opens, or taken out where a line needs them.

What somebody has about them is in no place, and not among a state's props, until it is in a hand. It is put
away between two lines, as off the picture, when they do something that it is not for; where it was left or
given to somebody it stays.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from runtime.motion.rotations import rot_z
from runtime.motion.types import ActionClip, ActorState, PropState
from runtime.world import WorldObject

from ..lang.definitions.action import ActionDef
from ..lang.ir import Beat, Scene, StoryLine, Target
from ..library import Catalog
from .places import target_point
from .pouring import POURERS, something_to_pour
from .state import SceneState, grip_of
from .subjects import find_object

_HANDS = ("r", "l")
_ASIDE = 0.42  # metres from somebody's middle to what they set down


def holding_at_first(scene: Scene, state: SceneState) -> SceneState:
    """The state in which a scene opens, with what people are placed with in their hands."""
    for placement in scene.placements:
        item = _named(placement.holding, state)
        if item is not None and placement.character in state.actors:
            state = _in_hand(item, placement.character, state, "l")
    return state


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
