"""Story proposals (section 3.1): every way to act a line, s = (a_n, p_{n,m}), performed.

Assumes a checked line and the state its scene is in. Guarantees that all proposals of a line lead to the
same state, from which the next line starts, and that the same line in the same state under the same seed
is performed the same way.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain, product

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, Skeleton
from runtime.motion.perform import perform
from runtime.motion.types import ActionClip, Actor, SceneMotion, Task
from runtime.nav import Discs
from runtime.world import World

from ..lang.definitions.action import ActionDef
from ..lang.diagnostics import Report
from ..lang.ir import Shot, StoryLine
from ..stage.actions import build_clip
from .advice import advise, advise_on_faults, is_faultless
from .arriving import arrival, shows_arrival
from .beholding import beholding
from .bringing import with_things_at_hand
from .cameras import Filming, propose_cameras
from .drawing import generator
from .state import SceneState, opening_state
from .tasks import Errand, as_said, disc, errand, speaking
from .types import STILL, Performance, ProposalGrid, StoryProposal

__all__ = [
    "Begun",
    "SceneState",
    "Told",
    "begin",
    "film",
    "opening_state",
    "propose",
    "propose_story",
    "tell",
]

MOST = 4  # story proposals a line: more are ways nobody would tell apart
_STILL = 4.0  # seconds of a shot in which nobody does anything, where the script does not say


@dataclass(frozen=True, eq=False)
class Told:
    """A line performed: its story proposals and the state it ends in."""

    proposals: tuple[StoryProposal, ...]
    end: SceneState


@dataclass(frozen=True, eq=False)
class Begun:
    """A line performed in the first of its ways, which is all that its end takes.

    state: the one it starts from; first: variant, path and motion
    """

    state: SceneState
    errands: dict[str, Errand]
    first: tuple[str, int, SceneMotion]

    @property
    def end(self) -> SceneState:
        """The state it ends in, whichever way it is performed."""
        motion = self.first[2]
        opened = {k: p.open for k, p in motion.end_props.items() if p.hinge is not None}
        world = self.state.world.opened(opened)
        return replace(self.state, world=world, actors=motion.end_actors, props=motion.end_props)


def begin(
    state: SceneState,
    line: StoryLine,
    filming: Filming,
    report: Report | None = None,
    shot: Shot | None = None,
) -> Begun:
    """Perform a line in its first way. report, shot: as for :func:`tell`"""
    shot = shot if shot is not None else _first_of(line)
    state = beholding(with_things_at_hand(state, line, filming.catalog), line)
    errands = _errands(state, line, filming, shot, report if report is not None else Report())
    return Begun(state, errands, next(_motions(state, errands, filming, shot, _ways(errands, 1))))


def tell(
    state: SceneState,
    line: StoryLine,
    filming: Filming,
    report: Report | None = None,
    shot: Shot | None = None,
    most: int = MOST,
    begun: Begun | None = None,
) -> Told:
    """Perform a line in up to ``most`` ways.

    shot: whose duration, speed and speech count (the first of the line's if None), and whose camera says from
        where on the line is shown
    begun: what :func:`begin` made of the same in the same state, where that is at hand; what it reported is
        not reported again
    What cannot be done is reported and left out: the person idles instead.
    """
    begun = begun if begun is not None else begin(state, line, filming, report, shot)
    cuts = shot is not None and filming.rig != "paper" and shows_arrival(shot)
    shot = shot if shot is not None else _first_of(line)
    state, errands = begun.state, begun.errands
    cuts, proposals = cuts and _comes_first(line, errands, filming), []
    further = _motions(state, errands, filming, shot, _ways(errands, most)[1:])
    for index, (name, path, motion) in enumerate(chain([begun.first], further)):
        start = arrival(motion.position[next(iter(errands))], filming.fps) if cuts else 0
        proposals.append(_proposal(index, name, path, motion, _interest(errands, motion, state.world), start))
    return Told(tuple(proposals), begun.end)


def _first_of(line: StoryLine) -> Shot | None:
    return line.shots[0] if line.shots else None


def motions(
    state: SceneState, line: StoryLine, filming: Filming, report: Report, most: int = MOST
) -> list[tuple[str, SceneMotion]]:
    """The motions :func:`tell` makes of a line, by the names of their variants, with all the engine says."""
    begun = begin(state, line, filming, report)
    ways = _ways(begun.errands, most)[1:]
    further = _motions(begun.state, begun.errands, filming, _first_of(line), ways)
    return [(name, motion) for name, _, motion in chain([begun.first], further)]


def _motions(
    state: SceneState,
    errands: dict[str, Errand],
    filming: Filming,
    shot: Shot | None,
    ways: Iterable[tuple[int, int]],
) -> Iterator[tuple[str, int, SceneMotion]]:
    """Variant, path and motion of every way."""
    seed = int(generator(filming.seed, shot.drawn_as if shot else "", "performance").integers(2**31))
    for variant, path in ways:
        motion = _perform(state, errands, filming.skeletons, (variant, path), filming.fps, seed, shot)
        name = next(iter(errands.values())).task.clip.variants[variant].name if errands else STILL
        yield name, path, motion


def propose_story(
    state: SceneState,
    line: StoryLine,
    filming: Filming,
    report: Report | None = None,
    shot: Shot | None = None,
) -> tuple[StoryProposal, ...]:
    """The story proposals of a line: clip variants times paths."""
    return tell(state, line, filming, report, shot).proposals


def propose(
    line: StoryLine, shot: Shot, state: SceneState, filming: Filming, advised: bool = False
) -> ProposalGrid:
    """S · C proposals of one shot: the line performed, and cameras on it.

    advised: where no camera does what the line says, or none without a fault, find out why, and what would
        work
    """
    return film(tell(state, line, filming, shot=shot), shot, state, filming, advised)


def film(told: Told, shot: Shot, state: SceneState, filming: Filming, advised: bool = False) -> ProposalGrid:
    """Cameras on a line that is performed already: several shots of one line may share its performances."""
    filming = as_filmed(told, state, filming)
    grid = propose_cameras(shot, told.proposals, filming)
    if advised and told.proposals and grid.let_in == len(grid.cameras):
        return replace(grid, advice=advise(shot, told.proposals[0], filming, told.proposals[1:]))
    if advised and filming.rig == "cinema" and grid.cameras and not any(map(is_faultless, grid.cameras)):
        return replace(grid, advice=advise_on_faults(shot, told.proposals[0], filming, grid.cameras))
    return grid


def as_filmed(told: Told, state: SceneState, filming: Filming) -> Filming:
    """The scene as cameras on a performed line find it: what opens hides most when it is open."""
    moved = [p for p in told.end.world.objects if p.hinge is not None]
    widest = {p.id: max(p.ajar, state.world.objects[p.id].ajar) for p in moved}
    return replace(filming, world=state.world.opened(widest))


def _errands(
    state: SceneState,
    line: StoryLine,
    filming: Filming,
    shot: Shot | None,
    report: Report,
) -> dict[str, Errand]:
    out: dict[str, Errand] = {}
    taken: Discs = ()
    for number, beat in enumerate(line.beats):
        if filming.catalog is None:
            raise ValueError("propose: story lines need the catalogue their actions are defined in")
        definition = filming.catalog.get("action", beat.action)
        if not isinstance(definition, ActionDef) or beat.character not in state.actors:
            continue
        clip: ActionClip = as_said(build_clip(definition), beat.ways)
        if number == 0 and shot is not None and shot.say:
            clip = speaking(clip)
        found = errand(beat, clip, shot, state, filming.skeletons, taken, report)
        if found is not None:
            out[beat.character] = found
            if found.stop is not None:
                taken = (*taken, disc(found.stop))
    return out


def _comes_first(line: StoryLine, errands: Mapping[str, Errand], filming: Filming) -> bool:
    """Whether one person acts, alone, and it is neither to go somewhere nor done on the way."""
    if len(errands) != 1 or filming.catalog is None:
        return False
    name, item = next(iter(errands.items()))
    action = next(beat.action for beat in line.beats if beat.character == name)
    definition = filming.catalog.get("action", action)
    going = isinstance(definition, ActionDef) and definition.group == "going"
    return not going and not item.task.clip.lead


def _ways(errands: Mapping[str, Errand], most: int) -> list[tuple[int, int]]:
    """(variant, path) pairs of whoever acts first: each way and variant once, then the other pairs."""
    if not errands:
        return [(0, 0)]
    first = next(iter(errands.values()))
    variants, paths = len(first.task.clip.variants), max(len(first.paths), 1)
    first_of_all = [(k % variants, k % paths) for k in range(max(variants, paths))]
    return list(dict.fromkeys([*first_of_all, *product(range(variants), range(paths))]))[:most]


def _perform(
    state: SceneState,
    errands: Mapping[str, Errand],
    skeletons: Mapping[str, Skeleton],
    way: tuple[int, int],
    fps: float,
    seed: int,
    shot: Shot | None,
) -> SceneMotion:
    """One performance: the given variant and path, everybody else idling."""
    variant, path = way
    tasks: dict[str, Task] = {}
    for name, item in errands.items():
        variants = item.task.clip.variants
        k = path % max(len(item.paths), 1)
        line = item.paths[k] if item.paths else None
        doors = (*item.task.passages, *(item.doors[k] if item.doors else ()))
        word = variants[variant % len(variants)].name
        tasks[name] = replace(item.task, variant=word, path=line, passages=doors)
    actors = {name: Actor(skeletons[name], actor) for name, actor in state.actors.items()}
    duration = shot.duration if shot is not None else None
    if duration is None and not tasks:
        duration = _STILL
    feelings = dict(shot.feelings) if shot is not None else {}
    return perform(actors, tasks, state.props, fps, seed, duration, feelings)


def _interest(
    errands: Mapping[str, Errand], motion: SceneMotion, world: World
) -> tuple[NDArray[np.float64], ...]:
    """Paths of what the line is about besides whoever acts first: its targets, and all others who act.

    Of what moves by a hinge the path of its handle, of other things that of their middle.
    """
    out: list[NDArray[np.float64]] = []
    names = dict.fromkeys(list(errands)[1:])
    for item in list(errands.values())[:1]:
        for point in (item.task.target, item.task.second):
            if point is None:
                continue
            if point.character is not None:
                names[point.character] = None
            elif point.object in motion.props:
                hinge, moved = motion.end_props[point.object].hinge, motion.props[point.object].astype(float)
                mesh = world.objects[point.object].mesh
                middle = np.zeros(3) if hinge is None else hinge.handle
                if hinge is None and mesh is not None:
                    middle = (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
                out.append(moved[:, :3, :3] @ middle + moved[:, :3, 3])
            else:
                out.append(np.tile(point.position, (motion.frames, 1)).astype(float))
    if not errands:
        names = dict.fromkeys(motion.position)
    heads = (motion.world_from_joint[n][:, JOINT["head"], :3, 3].astype(float) for n in names)
    return (*out, *heads)


def _proposal(
    index: int,
    variant: str,
    path: int,
    motion: SceneMotion,
    interest: tuple[NDArray[np.float64], ...],
    begin: int,
) -> StoryProposal:
    """What is shown of a motion: from the frame ``begin`` on."""
    joints, position, heading = motion.world_from_joint, motion.position, motion.heading
    performances = {
        name: Performance(joints[name][begin:], position[name][begin:], heading[name][begin:])
        for name in joints
    }
    props = {number: moved[begin:] for number, moved in motion.props.items()} if begin else motion.props
    points = tuple(path[begin:] for path in interest)
    return StoryProposal(index, variant, path, motion.frames - begin, performances, props, points)
