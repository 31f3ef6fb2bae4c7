"""Whom and what cameras are about: the subject of a shot, what is sharp, and who else is in the way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import Skeleton
from runtime.nav import level_at
from runtime.world import Spot, World, WorldObject

from ..cinema import rig_cinema, rig_paper
from ..cinema.bodies import Pillar, pillars
from ..cinema.subject import Subject, group, peopled, person, place, thing
from ..lang.ir import Shot, Target
from ..library import Catalog
from .focusing import Foci, Held
from .holding import in_hand
from .types import STILL, Performance, StoryProposal

Array = NDArray[np.float64]

_BESIDE, _TALLER = 1.0, 0.25  # metres to somebody whose head is to be in the picture too, and over it
_SOMETIME = 0.2  # share of the time they are that near
_STANDS = 1.65  # metres: what a spot in a room is as tall as
_NECK = 0.09  # of one over whose shoulder one looks


@dataclass(frozen=True, eq=False)
class Filming:
    """What cameras need to know of a scene.

    skeletons: of everyone in it; fps: frames a second; rig: cinema or paper; aspect: picture width/height
    room: path of the room an establishing shot shows, () for the whole set
    catalog: where the actions of story lines are defined; cameras alone need none
    """

    world: World
    skeletons: Mapping[str, Skeleton]
    fps: float
    seed: int
    rig: str = "cinema"
    aspect: float = 16 / 9
    room: tuple[str, ...] = ()
    catalog: Catalog | None = None

    @property
    def sensor(self) -> tuple[float, float]:
        return (rig_paper if self.rig == "paper" else rig_cinema).sensor(self.aspect)


# Asked for again for every few cameras. Shots are equal whatever words stand for their focus, which matters
# to what they establish; but of the shots of one performance no two have the same id.
@lru_cache(maxsize=64)
def subject_of(shot: Shot, story: StoryProposal, filming: Filming) -> Subject:
    """Whom or what the shot's cameras are about; its arrays are not to be written to."""
    subject = _subject(shot, story, filming)
    if subject.kind == "thing":
        return subject  # whose hands are beside it does not matter
    known = {*subject.heads, *(shot.whose if shot.view in ("ots", "pov") else ())}
    known |= {subject.name} if subject.kind == "person" else set()
    others = [_person(name, story, filming) for name in story.performances if name not in known]
    if subject.kind == "place":
        others = [one for one in others if subject.holds(one).any()]
        subject = peopled(subject, others)
    return replace(subject, company=tuple(others))


def _subject(shot: Shot, story: StoryProposal, filming: Filming) -> Subject:
    if shot.view in ("two-shot", "group"):
        everybody = _together(shot, story, filming)
        return everybody if everybody is not None else _focused(shot, story, filming)
    subject = _focused(shot, story, filming)
    if not shot.view and subject.kind == "person":
        return _with_room(subject, story, filming)
    owner = shot.whose[0] if shot.view and shot.whose else ""
    if owner not in story.performances or owner == subject.name:
        return subject
    near = _person(owner, story, filming)
    return replace(subject, via=near.landmarks["eyes"], via_face=near.face)


def people_beside(
    subject: Subject, shot: Shot, story: StoryProposal, filming: Filming
) -> tuple[tuple[Subject, ...], tuple[Subject, ...]]:
    """Who is to be told of beside what a shot is about: those it is of if they are several, or who are in a
    place; and the others, first over whose shoulder it looks."""
    if subject.kind == "place":
        return subject.company, ()
    owner = shot.whose[0] if shot.view == "ots" and shot.whose else ""
    near = (_person(owner, story, filming),) if subject.via is not None and owner else ()
    return subject.members, (*near, *subject.company)


def _person(name: str, story: StoryProposal, filming: Filming) -> Subject:
    return _holding(name, story, filming)


@lru_cache(maxsize=64)
def _holding(name: str, story: StoryProposal, filming: Filming) -> Subject:
    one = performed(name, story.performances[name], filming.skeletons[name])
    held = in_hand(one, story, filming.world)
    return replace(one, in_hand=held) if held else one


@lru_cache(maxsize=64)  # asked for again for every camera, and in every story of a line by most of the cast
def performed(name: str, acted: Performance, skeleton: Skeleton) -> Subject:
    """Somebody as they are over a shot; its arrays are not to be written to."""
    return person(name, skeleton, acted.world_from_joint, acted.position, acted.heading)


def _with_room(subject: Subject, story: StoryProposal, filming: Filming) -> Subject:
    """The same, whose top is that of somebody a little taller who comes as near as to hug: neither head is to
    be cut."""
    own, rise = subject.landmarks, 0.0
    for name in story.performances:
        if name != subject.name:
            top = _person(name, story, filming).landmarks["top"]
            apart = top - own["top"]
            near = np.linalg.norm(apart[:, :2], axis=1) < _BESIDE
            if near.mean() >= _SOMETIME:
                over = float(np.quantile(apart[near, 2], 0.9))
                rise = max(rise, over if over <= _TALLER else 0.0)
    return replace(subject, landmarks=own | {"top": own["top"] + (0.0, 0.0, rise)}) if rise else subject


def _together(shot: Shot, story: StoryProposal, filming: Filming) -> Subject | None:
    """Two people, or all, as one subject: those of the line first, then who is nearest to them."""
    first = [name for name in shot.whose if name in story.performances]
    if shot.focus is not None and shot.focus.path[-1] in story.performances:
        first.insert(0, shot.focus.path[-1])
    people = {name: _person(name, story, filming) for name in story.performances}
    if not people:
        return None
    middle = people[(first or list(people))[0]].position.mean(axis=0)
    away = {n: float(np.linalg.norm(p.position.mean(axis=0) - middle)) for n, p in people.items()}
    by_distance = sorted(people, key=lambda name: away[name])
    order = list(dict.fromkeys((*first, *by_distance)))
    return group([people[name] for name in (order[:2] if shot.view == "two-shot" else order)])


def _focused(shot: Shot, story: StoryProposal, filming: Filming) -> Subject:
    focus = shot.focus
    if focus is None or establishes(shot, story.variant != STILL):
        return _room_subject(filming, story.frames)
    if focus.kind == "character" and focus.path[-1] in story.performances:
        return _person(focus.path[-1], story, filming)
    item = find_object(filming.world, focus)
    if item is None:
        return _room_subject(filming, story.frames)
    spot = item.spot(focus.path[-1]) if focus.kind == "spot" and item.kind in ("room", "area") else None
    return _thing_subject(item, story, filming.world) if spot is None else _spot_subject(spot, story.frames)


def establishes(shot: Shot, acted: bool) -> bool:
    """Whether a shot shows the place: nobody acts, it is wide, and nobody was named as its focus."""
    named = shot.focus is not None and shot.focus.span.text == shot.focus.written
    return not acted and not named and set(shot.scales) <= {"extreme-wide", "wide", "full"}


def films_place(shot: Shot, acted: bool) -> bool:
    """Whether what a shot is about is a room or an area, as :func:`subject_of` has it."""
    if shot.view in ("two-shot", "group"):
        return False
    return shot.focus is None or shot.focus.kind == "room" or establishes(shot, acted)


def find_object(world: World, target: Target) -> WorldObject | None:
    """The object a target names, or the one its spot belongs to: the longest path that matches."""
    paths = {item.path: item for item in world.objects}
    for end in range(len(target.path), 0, -1):
        if target.path[:end] in paths:
            return paths[target.path[:end]]
    return None


def _room_subject(filming: Filming, frames: int) -> Subject:
    item = next((o for o in filming.world.objects if o.path == filming.room and filming.room), None)
    if item is not None:
        return place(item.path[-1], item.low, item.high, frames)
    floors = np.array(filming.world.floors or ((-2.0, -2.0, 2.0, 2.0),))
    low, high = floors[:, :2].min(axis=0), floors[:, 2:].max(axis=0)
    whole = place(filming.world.name, (*low.tolist(), 0.0), (*high.tolist(), 2.6), frames)
    return replace(whole, bounds=None)  # everybody is in it, on whatever floor


def _spot_subject(spot: Spot, frames: int) -> Subject:
    """A place in a room, framed as if somebody stood there."""
    x, y, z = spot.position
    low, high = (
        np.tile(corner, (frames, 1)) for corner in ((x - 0.3, y - 0.3, z), (x + 0.3, y + 0.3, z + _STANDS))
    )
    facing = 0.0 if spot.facing is None else spot.facing
    return thing(spot.name, low, high, facing, z)


def _thing_subject(item: WorldObject, story: StoryProposal, world: World) -> Subject:
    name = item.path[-1]
    low, high = (np.tile(corner, (story.frames, 1)) for corner in (item.low, item.high))
    if item.kind in ("room", "area"):
        return replace(place(name, item.low, item.high, story.frames), name=name)
    moved = story.props.get(item.id)
    if moved is not None:
        shift = moved[:, :3, 3].astype(float) - item.world_from_object[:3, 3]
        low, high = low + shift, high + shift
    stand = item.spot("stand")
    facing = 0.0 if stand is None or stand.facing is None else stand.facing + np.pi
    x, y, _ = item.centre
    floor = world.storeys[level_at(world, (x, y, item.low[2]))].height
    return thing(name, low, high, facing, floor)


def foci_of(shot: Shot, subject: Subject, story: StoryProposal, filming: Filming) -> Foci:
    """What is to be sharp: the eyes of a person, the middle of a thing, of several all alike."""
    end = None if shot.focus_to is None else _point(shot.focus_to, story, filming)
    if subject.heads:
        named = subject.heads.get(shot.focus.path[-1]) if shot.focus is not None else None
        heads = tuple(subject.heads.values())
        return Foci(heads if end is None else (heads[0] if named is None else named,), end)
    if shot.focus is not None and shot.focus.kind == "spot" and subject.kind != "place":
        return Foci((_point(shot.focus, story, filming),), end)
    return Foci((subject.landmarks["eyes"],), end)


def held_by(
    shot: Shot, subject: Subject, story: StoryProposal, filming: Filming, foci: Foci
) -> tuple[Held | None, Held | None]:
    """What a rack-focus rests on at first and in the end; None for a place, which is all around."""
    named = shot.focus.path[-1] if shot.focus is not None else ""
    heads = (named, *subject.heads) if named in subject.heads else tuple(subject.heads)
    first = heads[0] if heads else subject.name if subject.kind == "person" else ""
    start = None if subject.kind == "place" else _held(first, shot.focus, foci.start[0], shot, story, filming)
    if foci.end is None:
        return start, None
    goal = shot.focus_to.path[-1] if shot.focus_to is not None else ""
    return start, _held(goal, shot.focus_to, foci.end, shot, story, filming)


def _held(
    name: str, target: Target | None, points: Array, shot: Shot, story: StoryProposal, filming: Filming
) -> Held:
    person = name in story.performances
    item = find_object(filming.world, target) if target is not None and not person else None
    others = pillars_of(shot, story, filming, {name} if person else set())
    return Held(points, person, others, item.id if item is not None else None)


def _point(target: Target, story: StoryProposal, filming: Filming) -> Array:
    """Where somebody's eyes, a spot or the middle of a thing is at every frame, [T, 3]."""
    if target.kind == "character" and target.path[-1] in story.performances:
        return _person(target.path[-1], story, filming).landmarks["eyes"]
    item = find_object(filming.world, target)
    if item is None:
        return _room_subject(filming, story.frames).landmarks["eyes"]
    spot = item.spot(target.path[-1]) if target.kind == "spot" else None
    if spot is None:
        return _thing_subject(item, story, filming.world).landmarks["eyes"]
    moved, local = story.props.get(item.id), np.array([*spot.position, 1.0])
    if moved is None:
        return np.tile(local[:3], (story.frames, 1))
    own = np.linalg.inv(item.world_from_object) @ local
    return np.asarray((moved.astype(float) @ own)[:, :3])


def company_of(
    shot: Shot, story: StoryProposal, filming: Filming, subject: Subject
) -> list[tuple[Array, Array, float]]:
    """Everybody but a shot's subject, and whoever it looks through the eyes of, as :func:`pillars_of`."""
    owner = shot.whose if shot.view == "pov" else ()
    return pillars_of(shot, story, filming, {subject.name, *subject.heads, *owner})


def pillars_of(shot: Shot, story: StoryProposal, filming: Filming, without: set[str]) -> list[Pillar]:
    """Everybody else as pillars that hide what is behind them; of whom it looks over the shoulder, a thin
    one."""
    out = []
    for name, acted in story.performances.items():
        if name in without:
            continue
        one = performed(name, acted, filming.skeletons[name])
        if shot.view == "ots" and name in shot.whose:
            foot = np.column_stack([one.landmarks["waist"][:, :2], one.position[:, 2]])
            out.append((foot, one.landmarks["crown"], _NECK))
        else:
            out += pillars(one)
    return out
