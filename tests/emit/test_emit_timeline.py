"""Transitions in whole frames, and the pictures of the animatic."""

from __future__ import annotations

from pathlib import Path

import emit_film as f
import numpy as np
import pytest

from runtime.video import read_video, video_info
from vdsl.emit.timeline import film_frames, film_timeline, place_shots
from vdsl.emit.video import wipe, write_animatic
from vdsl.lang.ir import Transition

CUT = Transition("cut", 0.0)


def test_cuts_stand_end_to_end() -> None:
    placed = place_shots([10, 20, 30], [CUT] * 3, (24, 1))
    assert [p.start for p in placed] == [0, 10, 30]


@pytest.mark.parametrize("kind", ["dissolve", "wipe"])
def test_overlaps_shorten_the_film(kind: str) -> None:
    placed = place_shots([20, 20], [CUT, Transition(kind, 0.25)], (24, 1))
    assert [p.start for p in placed] == [0, 14]
    assert (placed[0].leave, placed[0].leave_frames, placed[1].enter_frames) == (kind, 6, 6)


def test_fades_do_not_and_nothing_is_longer_than_half_a_shot() -> None:
    out = place_shots([20, 20], [CUT, Transition("fade-out", 5.0)], (24, 1))
    assert (out[1].start, out[0].leave, out[0].leave_frames, out[1].enter) == (20, "fade-out", 10, "cut")
    into = place_shots([20, 8], [CUT, Transition("fade-in", 5.0)], (24, 1))
    assert (into[1].start, into[1].enter, into[1].enter_frames, into[0].leave) == (20, "fade-in", 4, "cut")
    both = place_shots([9, 9, 9], [Transition("dissolve", 1.0)] * 3, (24, 1))
    assert [(p.start, p.enter_frames, p.leave_frames) for p in both] == [(0, 0, 4), (5, 4, 4), (10, 4, 0)]


def test_a_film_can_fade_out_and_in_and_end_dark() -> None:
    through_black = Transition("fade-in", 0.25, out=0.125)
    placed = place_shots([20, 20], [CUT, through_black], (24, 1), Transition("fade-out", 0.5))
    assert [(p.start, p.enter, p.enter_frames, p.leave, p.leave_frames) for p in placed] == [
        (0, "cut", 0, "fade-out", 3),
        (20, "fade-in", 6, "fade-out", 10),
    ]
    assert place_shots([], [], (24, 1), Transition("fade-out", 0.5)) == ()


@pytest.mark.parametrize("kind", ["cut", "dissolve", "wipe", "fade-in", "fade-out"])
def test_animatic_shows_every_shot(tmp_path: Path, kind: str) -> None:
    shots = [
        f.built(tmp_path, "a", 12, 40, takes=1),
        f.built(tmp_path, "b", 16, 120, Transition(kind, 0.25), takes=1),
        f.built(tmp_path, "empty", takes=0),
        f.built(tmp_path, "c", 12, 200, takes=1),
    ]
    build = f.film(shots)
    write_animatic(tmp_path / "animatic.mp4", build)
    length = 40 - (6 if kind in ("dissolve", "wipe") else 0)
    assert film_frames(build) == length
    assert video_info(tmp_path / "animatic.mp4") == (f.SIZE, f.FPS, length)
    frames = np.stack(list(read_video(tmp_path / "animatic.mp4"))).astype(float)
    assert len(frames) == length
    place = film_timeline(build)
    assert "empty" not in place
    middle = frames[:, 20, 64].mean(-1)
    assert abs(middle[3] - 40) < 6
    assert abs(middle[place["b"].start + 8] - 120) < 6
    assert abs(middle[place["c"].start + 6] - 200) < 6
    join = place["b"].start
    if kind == "dissolve":
        assert np.all(np.diff(middle[join : join + 6]) > 5)
    if kind == "wipe":
        early = frames[join + 1, 20]
        assert early[3].mean() > 110
        assert early[-4].mean() < 50
    if kind == "fade-in":
        assert middle[join] < 40
    if kind == "fade-out":
        assert middle[join - 1] < 15
    assert sorted(p.name for p in tmp_path.iterdir()) == ["animatic.mp4", "shots"]


def test_wipe_is_half_and_half_in_the_middle() -> None:
    old, new = np.zeros((4, 8, 3), np.uint8), np.full((4, 8, 3), 9, np.uint8)
    assert wipe(old, new, 0.5)[:, :, 0].tolist() == [[9] * 4 + [0] * 4] * 4
