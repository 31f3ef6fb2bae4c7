"""Which of the judged proposals are kept as takes: the best ones that are not the same picture twice."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from ..propose.types import CameraProposal

#: Two tracks nearer than this in every respect would look alike: metres relative to the distance of
#: the subject, radians, and the ratio of focal lengths.
_NEAR_SHARE = 0.25
_NEAR_ANGLE = np.deg2rad(10.0)
_NEAR_FOCAL = 0.12
_SAMPLES = 5


def ranked(scores: NDArray[np.floating]) -> list[int]:
    """Indices by falling score; equal scores keep their order."""
    return [int(i) for i in np.argsort(-np.asarray(scores, np.float64), kind="stable")]


def choose_takes(cameras: tuple[CameraProposal, ...], scores: NDArray[np.floating], count: int) -> list[int]:
    """Indices of up to ``count`` proposals, best first.

    Goes down the ranking and passes over what looks like a take already chosen; if the shot does not
    offer enough different ones, the best of those passed over fill the rest, in their order.
    """
    order = ranked(scores)
    chosen: list[int] = []
    for i in order:
        if len(chosen) == count:
            break
        if not any(alike(cameras[i], cameras[j]) for j in chosen):
            chosen.append(i)
    spare = [i for i in order if i not in set(chosen)]
    chosen += spare[: count - len(chosen)]
    return sorted(chosen, key=order.index)


def further_takes(
    cameras: tuple[CameraProposal, ...],
    scores: NDArray[np.floating],
    known: Sequence[int],
    failed: Collection[int],
    count: int,
) -> list[int]:
    """Indices of up to ``count`` proposals more, best first: none that looks like one already known or like
    another, and none that failed. Where the shot does not offer as many, there are fewer.
    """
    found: list[int] = []
    for i in ranked(scores):
        if len(found) == count:
            break
        if i not in failed and not any(alike(cameras[i], cameras[j]) for j in (*known, *found)):
            found.append(i)
    return found


def unlike(cameras: Sequence[CameraProposal], chosen: int) -> list[int]:
    """Indices of the takes that look different from a chosen one; where none does, of all others."""
    others = [i for i in range(len(cameras)) if i != chosen]
    return [i for i in others if not alike(cameras[i], cameras[chosen])] or others


def alike(a: CameraProposal, b: CameraProposal) -> bool:
    """Whether two takes would look the same."""
    one, two = _sampled(a), _sampled(b)
    distance = np.linalg.norm(one[0] - two[0], axis=-1)
    reach = np.linalg.norm(one[0] - one[1], axis=-1)
    cosine = np.sum(_direction(one) * _direction(two), axis=-1)
    focal = np.abs(np.log(one[2] / two[2]))
    return bool(
        np.all(distance < _NEAR_SHARE * reach)
        and np.all(np.arccos(np.clip(cosine, -1, 1)) < _NEAR_ANGLE)
        and np.all(focal < _NEAR_FOCAL)
    )


def _sampled(
    proposal: CameraProposal,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    track = proposal.track
    at = np.linspace(0, len(track.focal) - 1, _SAMPLES).round().astype(int)
    return track.position[at], track.look_at[at], track.focal[at]


def _direction(
    sample: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
) -> NDArray[np.float64]:
    d = sample[1] - sample[0]
    return np.asarray(d / np.maximum(np.linalg.norm(d, axis=-1, keepdims=True), 1e-9))
