"""Whether takes show their subject, by the object ids of small pictures of them: sight tested, not hoped for;
and whether they are what their line says, by what their tracks turn out to be.

Cameras are proposed by lines of sight past upright boxes; curtains, branches and arms are none. Assumes
judged proposals. Guarantees that of the takes about to be kept, those whose subject is less in the picture
than was promised, or whose track does not come out as the size, the angle and the movement asked for, give
way to the next best, where there are such.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.mesh import Mesh

from ..cinema.subject import Subject
from ..cinema.track import project
from ..lang.ir import Shot
from ..propose.cameras import Filming, find_object, subject_of
from ..propose.promise import achieved
from ..propose.types import CameraProposal, ProposalGrid, StoryProposal
from ..stage.assemble import StagedScene
from .filming import SEGMENTS, Camerawork, segment_frames, story_palettes
from .selection import choose_takes

#: Indices of proposals to keep, by scores [P] and by what has failed so far.
Chosen = Callable[[NDArray[np.float64], Collection[int]], Sequence[int]]
#: The reasons under which those that fail are counted, and the measure of those that were looked at.
REASON, UNLIKE = "hidden_in_picture", "not_as_asked"
MEASURE = "picture_visibility"
_SIZE = (96, 54)
_POINTS = 1500  # of the subject's surface
_PROMISED = 0.6  # least visibility of what is offered
_SLACK = 0.1  # by how much pixels may fall short of it
_ROUNDS = 6
_OUT = 10.0  # taken from the score of what fails, so that anything else goes before it


@dataclass(frozen=True, eq=False)
class Vetted:
    """order: [P], scores to choose takes by; failed: by index, why each is not to be kept."""

    order: NDArray[np.float64]
    failed: dict[int, str]


def counted(rejected: Mapping[str, int], failed: Mapping[int, str], kept: Sequence[int]) -> dict[str, int]:
    """What was rejected, with those that failed and were replaced."""
    gone = Counter(why for i, why in failed.items() if i not in kept)
    return dict(sorted((dict(rejected) | gone).items()))


def best(grid: ProposalGrid, count: int) -> Chosen:
    """The best so many, as takes are chosen."""
    return lambda order, failed: choose_takes(grid.cameras, order, count)


def vet(
    grid: ProposalGrid,
    scores: NDArray[np.float64],
    chosen: Chosen,
    scene: tuple[StagedScene, Shot, Filming],
    camerawork: Camerawork,
) -> Vetted:
    """Look at the takes about to be kept, and at those that would follow, until none more has to go.

    chosen: gives those about to be kept, by the scores and by what has failed so far
    Notes the share of what was looked at among its measures.
    """
    _, shot, filming = scene

    def wrong(fresh: Sequence[int]) -> dict[int, str]:
        failed = _unlike(grid, fresh, shot, filming)
        for i, share in zip(fresh, _shares(grid, fresh, scene, camerawork), strict=True):
            if np.isnan(share):
                continue
            measures = grid.cameras[i].measures
            measures[MEASURE] = float(share)
            if share < min(_PROMISED, measures["visibility"]) - _SLACK:
                failed[i] = REASON
        return failed

    return _vetted(scores, chosen, wrong)


def vet_tracks(
    grid: ProposalGrid, scores: NDArray[np.float64], chosen: Chosen, shot: Shot, filming: Filming
) -> Vetted:
    """As :func:`vet`, by tracks alone: nothing is drawn."""
    return _vetted(scores, chosen, lambda fresh: _unlike(grid, fresh, shot, filming))


def _vetted(
    scores: NDArray[np.float64], chosen: Chosen, wrong: Callable[[Sequence[int]], dict[int, str]]
) -> Vetted:
    """wrong: of those looked at now, why some are not to be kept"""
    order = np.asarray(scores, float).copy()
    looked: set[int] = set()
    failed: dict[int, str] = {}
    for _ in range(_ROUNDS):
        fresh = [i for i in chosen(order, failed) if i not in looked]
        if not fresh:
            break
        looked.update(fresh)
        failed |= wrong(fresh)
        order[[i for i in fresh if i in failed]] -= _OUT
    return Vetted(order, failed)


def _unlike(grid: ProposalGrid, some: Sequence[int], shot: Shot, filming: Filming) -> dict[int, str]:
    return dict.fromkeys((i for i in some if not _as_asked(grid, i, shot, filming)), UNLIKE)


def _as_asked(grid: ProposalGrid, i: int, shot: Shot, filming: Filming) -> bool:
    """Whether a take of somebody came out as the line's words; through somebody's eyes there is no angle."""
    camera = grid.cameras[i]
    subject = subject_of(shot, next(s for s in grid.story if s.index == camera.story), filming)
    if subject.kind != "person" or filming.rig == "paper":
        return True
    kept = achieved(camera, subject, filming.rig).kept(camera)
    return all(came for word, came in kept.items() if shot.view != "pov" or word == "movement")


def _shares(
    grid: ProposalGrid,
    chosen: Sequence[int],
    scene: tuple[StagedScene, Shot, Filming],
    camerawork: Camerawork,
) -> NDArray[np.float64]:
    """Of each proposal the share of its subject's outline in which the subject is seen; NaN without one."""
    staged, shot, filming = scene
    cameras = tuple(grid.cameras[i] for i in chosen)
    stories = {s.index: s for s in grid.story}
    surfaces = {c.story: _surface(staged, shot, stories[c.story], filming) for c in cameras}
    if all(s is None for s in surfaces.values()):
        return np.full(len(cameras), np.nan)
    ids = camerawork.judge_ids(staged, shot.style, grid.story, cameras, _SIZE)
    return np.array([_share(c, surfaces[c.story], picture) for c, picture in zip(cameras, ids, strict=True)])


@dataclass(frozen=True, eq=False)
class _Surface:
    """Points of a subject's surface at the segments' frames [SEGMENTS, V, 3], and its id."""

    id: int
    points: NDArray[np.float64]


def _surface(staged: StagedScene, shot: Shot, story: StoryProposal, filming: Filming) -> _Surface | None:
    """None for a place, which is everything there is."""
    subject = subject_of(shot, story, filming)
    number = _id_of(subject, staged, shot, filming)
    if number is None:
        return None
    frames = segment_frames(story.frames)
    still = _vertices(staged.render.static, staged.render.static_object, number)
    if len(still):
        points = np.asarray(staged.render.static.vertices[still], float)
        return _Surface(number, np.tile(points, (len(frames), 1, 1)))
    moving = _vertices(staged.render.skinned, staged.render.skinned_object, number)
    if not len(moving):
        return None
    matrices = story_palettes(staged, story, frames)[:, staged.render.joints[moving]]  # [F, V, 4, 3, 4]
    blended = np.einsum("fvjab,vj->fvab", matrices, staged.render.weights[moving])
    rest = staged.render.skinned.vertices[moving]
    return _Surface(number, np.einsum("fvab,vb->fva", blended[..., :3], rest).astype(float) + blended[..., 3])


def _id_of(subject: Subject, staged: StagedScene, shot: Shot, filming: Filming) -> int | None:
    if subject.kind == "person":
        return staged.object_ids.get(subject.name)
    item = find_object(filming.world, shot.focus) if subject.kind == "thing" and shot.focus else None
    return item.id if item is not None else None


def _vertices(mesh: Mesh, owner: NDArray[np.int32], number: int) -> NDArray[np.int64]:
    """Some of the vertices of an object, spread over it."""
    found = np.unique(mesh.faces[owner == number])
    step = max(1, len(found) // _POINTS)
    return np.asarray(found[::step], np.int64)


def _share(camera: CameraProposal, surface: _Surface | None, ids: NDArray[np.int32]) -> float:
    """Over the frames in which the subject is meant to be seen; ids: [SEGMENTS, H, W]."""
    if surface is None:
        return float("nan")
    track, frames = camera.track, segment_frames(len(camera.track.focal))
    xy, depth = project(
        surface.points, track.position[frames], track.axes[frames], track.focal[frames],
        track.sensor,
    )  # fmt: skip
    height, width = ids.shape[1:]
    mine = _grown(ids == surface.id)
    shares = []
    for k in _meant(camera):
        inside = (depth[k] > 0.05) & ((xy[k] > 0) & (xy[k] < 1)).all(axis=-1)
        cells = np.unique((xy[k][inside] * (width, height)).astype(int) @ np.array((1, width)))
        if len(cells):
            shares.append(float(mine[k].ravel()[cells].mean()))
    return float(np.mean(shares)) if shares else 0.0


def _meant(camera: CameraProposal) -> range:
    """The segments in which a take is on its subject: the first or last two where it turns off or onto it."""
    ending = "on" if "whip-pan" in camera.movement else camera.params.get("ending")
    if ending is None:
        return range(SEGMENTS)
    return range(SEGMENTS - 2, SEGMENTS) if ending == "on" else range(2)


def _grown(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Masks [N, H, W] grown by one pixel: outlines are no wider than that, and belong to either side."""
    padded = np.pad(mask, ((0, 0), (1, 1), (1, 1)))
    out = mask.copy()
    height, width = mask.shape[1:]
    for y in range(3):
        for x in range(3):
            out |= padded[:, y : y + height, x : x + width]
    return out
