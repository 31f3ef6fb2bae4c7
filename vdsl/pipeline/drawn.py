"""Takes measured anew by what small pictures of them show, in place of lines of sight past boxes.

Assumes takes drawn at the frames that are measured, with ids and depths. Guarantees that nothing else of a
take changes.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..cinema.takes import Pictures, samples
from ..lang.ir import Shot
from ..propose.cameras import measured_anew
from ..propose.subjects import Filming, find_object, subject_of
from ..propose.types import CameraProposal, StoryProposal
from ..stage.assemble import StagedScene
from .filming import Seen, segment_frames


def as_drawn(
    shot: Shot,
    stories: Sequence[StoryProposal],
    filming: Filming,
    staged: StagedScene,
    cameras: Sequence[CameraProposal],
    seen: Seen,
) -> list[CameraProposal]:
    """Cameras of a shot with what is measured of them by their pictures. Raises ValueError without ids."""
    if seen.ids is None or seen.depth is None:
        raise ValueError("what pictures show is told by ids and depths")
    out = list(cameras)
    for story in stories:
        rows = [i for i, camera in enumerate(cameras) if camera.story == story.index]
        if not rows:
            continue
        pictures = _pictures(shot, story, filming, staged, seen.ids[rows], seen.depth[rows])
        some = measured_anew(shot, story, filming, [cameras[i] for i in rows], pictures)
        for i, camera in zip(rows, some, strict=True):
            out[i] = camera
    return out


def _pictures(
    shot: Shot,
    story: StoryProposal,
    filming: Filming,
    staged: StagedScene,
    ids: NDArray[np.int32],
    depth: NDArray[np.float32],
) -> Pictures:
    """ids, depth: [P, k, H, W] of the judged frames"""
    judged = segment_frames(story.frames)
    at = np.abs(judged[None] - samples(story.frames)[:, None]).argmin(axis=1)
    people = tuple(staged.object_ids)
    kind = np.full(len(staged.world.objects) + len(people) + 1, Pictures.THING, np.uint8)  # the last: of none
    kind[list(story.props)] = Pictures.MOVED
    kind[[staged.object_ids[name] for name in people]] = Pictures.FIRST + np.arange(len(people))
    subject = subject_of(shot, story, filming)
    item = find_object(filming.world, shot.focus) if subject.kind == "thing" and shot.focus else None
    if item is not None:
        kind[item.id] = Pictures.NOTHING
    over = tuple(shot.whose) if shot.view == "ots" else ()
    shown = kind.take(ids)
    if not np.array_equal(at, np.arange(len(judged))):
        depth, shown = depth[:, at], shown[:, at]
    return Pictures(depth, shown, people, over)
