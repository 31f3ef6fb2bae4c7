"""Chosen takes among what is proposed: keys of proposals, and finding the one a choice names.

Assumes a grid proposed for the shot as its line is now. Guarantees that a proposal is found again as long as
it looks the same, whatever its place in the grid.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version

import numpy as np

from runtime.raster.types import LOOK_VERSION

from ..lang import Report
from ..lang.ir import Shot
from ..propose.types import CameraProposal, ProposalGrid, StoryProposal
from .lock import Choice, Lock
from .placing import find, placed

#: Moments of a take by which it is told from others, and what is one place, angle or length (m, rad, mm).
_MOMENTS = 5
_STEP = 2e-3


def made_with() -> tuple[tuple[str, str], ...]:
    """Versions that proposals and pictures go by, as a lock pins them."""
    try:
        ours = version("vdsl")
    except PackageNotFoundError:
        ours = "0+unknown"
    return (("vdsl", ours), ("look", str(LOOK_VERSION)))


def proposal_key(camera: CameraProposal, story: StoryProposal) -> str:
    """``17-3f9a2c1b``: the proposal's number, and a digest of how it is acted and filmed."""
    track = camera.track
    at = np.linspace(0, len(track.focal) - 1, _MOMENTS).round().astype(int)
    ways = [story.performances[name].position[at] for name in sorted(story.performances)]
    parts = (track.position[at], track.rotation[at], track.focal[at], *ways)
    steps = np.concatenate([np.ravel(p) for p in parts]) / _STEP
    told = hashlib.sha256(f"{camera.movement} {camera.scale} {camera.angle} {story.variant}".encode())
    told.update(str(len(track.focal)).encode() + np.round(steps).astype("<i8").tobytes())
    return f"{camera.index}-{told.hexdigest()[:8]}"


def keys_of(grid: ProposalGrid) -> list[str]:
    """The key of every proposal of a grid, in order."""
    stories = {s.index: s for s in grid.story}
    return [proposal_key(c, stories[c.story]) for c in grid.cameras]


def find_again(choice: Choice, grid: ProposalGrid, surely: bool) -> int | None:
    """The same in a grid that was proposed as the choice's was, from a line that is as it was.

    surely: whether the grid was drawn under the name it was drawn under then: only so another machine's last
    digits are no other take, and the number and the words are enough
    """
    found = find(choice, keys_of(grid))
    if found is not None or not surely:
        return found
    number = choice.key.partition("-")[0]
    for i, camera in enumerate(grid.cameras):
        if str(camera.index) == number and f"{camera.movement} {camera.scale} {camera.angle}" == choice.words:
            return i
    return None


class Choices:
    """The choices of a lock, looked up shot by shot; what is no longer there is reported.

    depends: of every shot of the script, the digest of what its line depends on
    """

    def __init__(self, lock: Lock, depends: Mapping[str, str], report: Report) -> None:
        self.lock, self.depends, self.report = lock, depends, report
        self._choices = placed(lock.choices, depends)
        placed_ones = set(self._choices.values())
        warn_of_strays(lock, [c for c in lock.choices if c not in placed_ones], report)

    def of(self, shot: Shot) -> Choice | None:
        """The choice for a shot, under its id or under one it had before."""
        return self._choices.get(shot.id)

    def same_line(self, shot: Shot, choice: Choice) -> bool:
        """Whether all that the line depends on is as it was."""
        return self.depends[shot.id] == choice.depends

    def lost(self, shot: Shot, choice: Choice) -> None:
        """Say that a choice no longer exists; the lock keeps it."""
        warn_of_lost(self.lock, choice, shot, self.same_line(shot, choice), self.report)


def warn_of_lost(lock: Lock, choice: Choice, shot: Shot, same_line: bool, report: Report) -> None:
    """Say that a choice no longer exists; the lock keeps it."""
    was = dict(lock.versions)
    newer = [f"{k} {was[k]} to {v}" for k, v in made_with() if was.get(k) not in (None, v)]
    if not same_line:
        why = "its line, or what it depends on, has changed since"
    elif newer:
        why = f"what is proposed has changed with {' and '.join(newer)}"
    else:
        why = "it is not among what is proposed"
    report.warn(
        "VDS311",
        shot.span,
        label=f"the chosen take ({choice.words}) no longer exists: {why}",
        help=f"choose again with `vdsc pick FILE {shot.id} TAKE`; the lock keeps the old choice",
        notes=((lock.span(shot.id), "chosen here"),),
    )


def warn_of_strays(lock: Lock, strays: Sequence[Choice], report: Report) -> None:
    """Say which choices are for shots that are not in the script; the lock keeps them."""
    for choice in strays:
        report.warn(
            "VDS312",
            lock.span(choice.shot),
            label=f"there is no shot `{choice.shot}`",
            help=f"bring the line back, or take the choice back: `vdsc pick FILE {choice.shot} --clear`",
        )
