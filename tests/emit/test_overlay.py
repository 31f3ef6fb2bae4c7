"""Guides over pictures, and where they are: safe areas by SMPTE ST 2046-1, thirds, cross, masks."""

from __future__ import annotations

from pathlib import Path

import emit_film as f
import numpy as np
import pytest

from runtime.video import read_video
from vdsl.emit.guides import Guides, guides_of
from vdsl.emit.overlay import guided, masked
from vdsl.emit.timeline import start_of_next
from vdsl.emit.video import write_take
from vdsl.lang.ir import Transition

W, H = 640, 360


def lit(guides: Guides, shade: int = 0) -> np.ndarray:
    """Where lines are on a picture of one shade, bool [H, W]."""
    out = guided(np.full((H, W, 3), shade, np.uint8), guides).astype(int)
    return out[..., 0] > 150


def test_words_become_guides() -> None:
    assert guides_of("") == Guides()
    assert not guides_of(" , ")
    assert guides_of("safe, Thirds,cross") == Guides(True, True, True)
    assert guides_of("2.39").mask == pytest.approx(2.39)
    assert guides_of("safe,4:3") == Guides(safe=True, mask=4 / 3)
    assert guides_of("1920x1080").mask == pytest.approx(16 / 9)


@pytest.mark.parametrize(
    ("text", "said"), [("halves", "no guide"), ("2.39,1.85", "second"), ("9", "between"), ("4:0", "between")]
)
def test_other_words_are_refused(text: str, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        guides_of(text)


def test_safe_areas_are_93_and_90_per_cent() -> None:
    lines = lit(Guides(safe=True))
    columns = np.flatnonzero(lines[H // 2 - 6 : H // 2 + 6].any(0))
    for share in (0.93, 0.90):
        for edge in (W / 2 * (1 - share), W / 2 * (1 + share)):
            assert np.abs(columns - edge).min() <= 1, share
    rows = np.flatnonzero(lines[:, W // 2 - 20 : W // 2 + 20].any(1))
    for share in (0.93, 0.90):
        for edge in (H / 2 * (1 - share), H / 2 * (1 + share)):
            assert np.abs(rows - edge).min() <= 1, share
    solid = lines[:, round(W * 0.035)].mean()
    assert solid > 0.9
    assert 0.3 < lines[:, round(W * 0.05)].mean() < 0.6  # titles dashed, to tell the two apart


def test_thirds_and_cross_lie_in_the_picture_that_is_meant() -> None:
    lines = lit(Guides(thirds=True))
    assert lines[:, round(W / 3)].all()
    assert lines[round(2 * H / 3)].all()
    square = lit(Guides(thirds=True, mask=1.0))
    x0, x1 = (W - H) / 2, (W + H) / 2
    assert square[H // 2, round(x0 + H / 3)]
    assert not square[:, : int(x0)].any()
    assert not square[:, int(x1) + 1 :].any()
    cross = lit(Guides(cross=True))
    assert cross[H // 2, W // 2]
    assert cross.mean() < 0.002


def test_a_mask_darkens_the_rest() -> None:
    assert masked(W, H, 2.0) == (0, 20, 640, 340)
    white = np.full((H, W, 3), 255, np.uint8)
    out = guided(white, Guides(mask=2.0))
    assert (out[:20] < 60).all()
    assert (out[20:340] == 255).all()
    assert (out[340:] < 60).all()
    assert (white == 255).all()  # the frame given is as it was


@pytest.mark.parametrize("shade", [0, 128, 255])
def test_lines_can_be_seen_on_anything(shade: int) -> None:
    out = guided(np.full((H, W, 3), shade, np.uint8), Guides(thirds=True)).astype(int)[..., 0]
    near = out[100, round(W / 3) - 4 : round(W / 3) + 5]
    assert near.max() - near.min() > 60
    assert out[100, 20] == shade


def test_takes_are_written_with_guides(tmp_path: Path) -> None:
    plain = write_take(tmp_path, "a", 1, f.pictures(6, 90), 6, f.FPS)
    drawn = write_take(tmp_path, "b", 1, f.pictures(6, 90), 6, f.FPS, guides=Guides(mask=1.0))
    first, second = (next(iter(read_video(m.video))).astype(int) for m in (plain, drawn))
    assert second[:, :20].mean() < first[:, :20].mean() - 40
    assert np.abs(second[10:50, 50:78] - first[10:50, 50:78]).mean() < 6
    assert np.array_equal(plain.keys[0], drawn.keys[0])  # the sheet's keyframes stay clean


def test_timecode_counts_what_dissolves_share(tmp_path: Path) -> None:
    dissolve = Transition("dissolve", 0.25)  # 6 frames
    first = f.built(tmp_path, "s1", frames=24)
    second = f.built(tmp_path, "s2", frames=24, transition=dissolve)
    assert start_of_next((), Transition("fade-in", 1.0), 24, f.FPS) == 0
    assert start_of_next((first,), dissolve, 24, f.FPS) == 18
    assert start_of_next((first, second), Transition("cut", 0.0), 12, f.FPS) == 42
    nothing = f.built(tmp_path, "s3", takes=0)
    assert start_of_next((first, nothing), dissolve, 24, f.FPS) == 18
    assert start_of_next((first,), dissolve, 6, f.FPS) == 21  # at most half of a shot
