"""Results that are remembered by the contents of what they were made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from vdsl.cinema.track import CameraTrack
from vdsl.emit.remember import remembering


@dataclass(frozen=True, eq=False)
class Track:
    position: NDArray[np.float64]
    name: str = ""


def counted(most: int = 3):  # type: ignore[no-untyped-def]
    made: list[object] = []

    @remembering(most)
    def total(track: Track, scale: float = 1.0) -> float:
        made.append(track)
        return float(track.position.sum()) * scale

    return total, made


def test_new_objects_that_hold_the_same_are_the_same() -> None:
    total, made = counted()
    assert total(Track(np.arange(6.0))) == 15
    assert total(Track(np.arange(6.0))) == 15
    assert len(made) == 1


def test_what_differs_is_made_anew() -> None:
    total, made = counted()
    assert total(Track(np.arange(6.0))) == 15
    assert total(Track(np.arange(6.0) + 1e-9)) != 15
    assert total(Track(np.arange(6.0), "other")) == 15
    assert total(Track(np.arange(6.0)), scale=2.0) == 30
    assert len(made) == 4


def test_an_array_changed_in_place_is_another() -> None:
    total, made = counted()
    track = Track(np.arange(6.0))
    assert total(track) == 15
    track.position[0] = 5.0
    assert total(track) == 20
    assert len(made) == 2


def test_no_more_than_the_last_are_kept() -> None:
    total, made = counted(most=2)
    for first in (0.0, 1.0, 0.0, 2.0, 0.0, 1.0):
        total(Track(np.array([first])))
    assert [float(t.position[0]) for t in made] == [0.0, 1.0, 2.0, 1.0]


def test_what_cannot_be_pickled_is_made_every_time() -> None:
    calls = []

    @remembering(3)
    def call(function: object) -> int:
        calls.append(function)
        return len(calls)

    assert (call(lambda: 1), call(lambda: 1)) == (1, 2)


def test_errors_are_not_remembered() -> None:
    calls = []

    @remembering(3)
    def call(x: int) -> int:
        calls.append(x)
        raise ValueError(x)

    for _ in range(2):
        with pytest.raises(ValueError, match="7"):
            call(7)
    assert calls == [7, 7]


def test_what_was_asked_of_a_track_makes_it_no_other() -> None:
    made: list[CameraTrack] = []

    @remembering(3)
    def called(track: CameraTrack) -> float:
        made.append(track)
        return float(track.axes.sum())

    def track() -> CameraTrack:
        return CameraTrack(
            np.ones((9, 3)), np.zeros((9, 3)), np.full(9, 35.0), np.zeros((9, 3)), (36.0, 24.0)
        )

    looked_at = track()
    assert looked_at.axes.shape == (9, 3, 3)
    assert called(looked_at) == called(track()) == called(looked_at)
    assert len(made) == 1
