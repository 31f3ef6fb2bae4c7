"""The page, the sheet, the posters and the strip."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import emit_film as f
import numpy as np
import pytest
from PIL import Image

from runtime.video import VideoError, read_video
from runtime.worker import Worker
from vdsl.emit import sheet
from vdsl.emit.burnin import BurnIn, burn, strip_height
from vdsl.emit.lettering import clean, shortened, width, wrapped
from vdsl.emit.page import page_html
from vdsl.emit.plan_ground import Ground
from vdsl.emit.stills import read_keys, write_keys
from vdsl.emit.storyboard_json import storyboard_document
from vdsl.emit.types import Build
from vdsl.emit.video import write_take
from vdsl.emit.words import timecode


def written(folder: Path, build: Build) -> list[Path]:
    """Sheets that are there."""
    with Worker(2) as worker:
        return sheet.write_sheets(folder, build, worker)


def test_sheet_shows_the_keyframes(tmp_path: Path) -> None:
    build = f.film(
        [
            f.built(tmp_path, "s1", shade=40),
            f.built(tmp_path, "s2", shade=160),
            f.built(tmp_path, "s3", takes=0),
        ]
    )
    (path,) = written(tmp_path, build)
    picture = np.asarray(Image.open(path).convert("RGB")).astype(int)
    assert picture.shape[1] == sheet.WIDTH
    x = sheet.MARGIN + sheet.TEXT + 40
    row = (picture.shape[0] - sheet.HEAD) // 3
    assert abs(picture[sheet.HEAD + 120, x] - 40).max() < 6
    assert abs(picture[sheet.HEAD + row + 120, x] - 160).max() < 6
    assert (picture[:, : sheet.TEXT] < 80).any()  # there is ink in the text column


def test_sheet_has_arrows_on_the_first_keyframe_and_the_plan_at_the_end(tmp_path: Path) -> None:
    film = f.film([f.built(tmp_path, "s1", shade=40, takes=1)])
    build = replace(film, grounds=(Ground("kitchen", "", (-1, -1, 4, 3), (), (), ()),))
    picture = np.asarray(sheet.draw_sheet(build, build.shots, 0, (1, 1))).astype(int)
    red = (picture[..., 0] > 150) & (picture[..., 1] < 100)
    rows = slice(sheet.HEAD + 22, sheet.HEAD + 200)
    right = sheet.WIDTH - sheet.MARGIN - sheet.MARGIN - sheet.TEXT
    keys = [sheet.MARGIN + sheet.TEXT + round(right * k * 0.27) for k in range(3)]
    found = [int(red[rows, a + 20 : a + 380].sum()) for a in keys]
    assert found[0] > 500, "the film pushes: an arrow in every corner"
    assert found[1] == found[2] == 0
    assert red[rows, -sheet.MARGIN - 280 : -sheet.MARGIN].sum() > 50, "the camera on the plan"
    plain = np.asarray(sheet.draw_sheet(replace(build, arrows=False), build.shots, 0, (1, 1))).astype(int)
    differs = np.argwhere(np.abs(plain - picture).max(-1) > 0)
    assert not ((plain[..., 0] > 150) & (plain[..., 1] < 100))[rows, keys[0] + 20 : keys[0] + 380].any()
    assert differs[:, 1].max() < keys[1], "and nothing else is another without them"


@pytest.mark.parametrize("size", [(128, 72), (170, 72), (72, 128)])
def test_words_stay_in_their_row(tmp_path: Path, size: tuple[int, int]) -> None:
    """However wide the picture is, and however much is said."""
    talk = "A sentence of somebody who likes to talk and talk, on and on and on"
    story = f.line(("anna", "walk", "the_counter_with_a_very_long_name"), ("ben", "wave", "window"))
    film = f.film(
        [f.built(tmp_path, name, say=talk, note=talk, takes=1, story=story) for name in ("s1", "s2")]
    )
    build = replace(film, storyboard=replace(film.storyboard, size=size))
    row = sheet.row_height(build)
    picture = np.asarray(sheet.draw_sheet(build, build.shots, 0, (1, 1))).astype(int)
    for k in (1, 2):
        foot = picture[sheet.HEAD + k * row - 8 : sheet.HEAD + k * row - 1, : sheet.MARGIN + sheet.TEXT - 10]
        assert (foot.min() > 200).all()


def test_sheet_says_what_a_cut_breaks_below_the_pictures(tmp_path: Path) -> None:
    shots = [f.built(tmp_path, "s1", takes=1), f.built(tmp_path, "s2", takes=1)]
    plain, told = f.film(shots), f.film(shots, continuity=(f.crossing("s1", "s2"),))
    before, after = (np.asarray(sheet.draw_sheet(b, b.shots, 0, (1, 1))).astype(int) for b in (plain, told))
    assert after.shape[0] > before.shape[0]
    row = (after.shape[0] - sheet.HEAD - sheet.MARGIN // 2) // 2
    ends = [sheet.HEAD + (k + 1) * row for k in (0, 1)]
    strips = [after[end - 34 : end - 4, sheet.MARGIN + sheet.TEXT :] for end in ends]
    ink = [(strip[..., 0] - strip[..., 1] > 80).sum() for strip in strips]
    assert ink[0] == 0 < ink[1], "only the shot that is cut to carries the words"


def test_a_long_film_goes_on_over_sheets(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sheet, "SHOTS_PER_SHEET", 2)
    shot = f.built(tmp_path, "s1", takes=1)
    paths = written(tmp_path, f.film([shot] * 5))
    assert [p.name for p in paths] == ["sheet.png", "sheet-2.png", "sheet-3.png"]


@pytest.mark.parametrize(
    "text", ["日本語のテキスト", "שלום עולם", "🎬🎬", "a\x00b\tc\n", "\ud83d", "", "x" * 9000, "é" * 300]
)
def test_any_text_can_be_drawn(tmp_path: Path, text: str) -> None:
    build = f.film([f.built(tmp_path, "s1", say=text, note=text, takes=1)], title=text)
    assert written(tmp_path, build)[0].exists()
    assert "s1" in page_html(storyboard_document(build))
    assert width(shortened(text, 20, 200), 20) <= 200 + width("…", 20)
    assert len(wrapped(text, 20, 200, 2)) <= 2
    assert clean(text).encode("utf-8") is not None


def test_keyframes_come_from_start_middle_and_end(tmp_path: Path) -> None:
    media = write_take(tmp_path, "s1", 1, f.pictures(26, 30), 26, f.FPS)
    bars = [int((key[66, :, 0] > 128).sum()) // 4 - 1 for key in media.keys]
    assert bars == [1, 12, 24]
    write_keys(tmp_path / "keys.png", media.keys)
    for a, b in zip(media.keys, read_keys(tmp_path / "keys.png"), strict=True):
        assert (a == b).all()
    poster = np.asarray(Image.open(media.poster)).astype(int)
    assert np.abs(poster - media.keys[1]).mean() < 4


def test_a_take_of_the_wrong_length_is_not_kept(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="expected 9 frames, got 5"):
        write_take(tmp_path, "s1", 1, f.pictures(5, 30), 9, f.FPS)
    assert not (tmp_path / "shots" / "s1" / "take-1.mp4").exists()
    (tmp_path / "keys.png").write_bytes(b"no picture")
    with pytest.raises(VideoError):
        read_keys(tmp_path / "keys.png")


@pytest.mark.parametrize("below", [False, True])
def test_strip_is_written_over_or_under_the_picture(tmp_path: Path, below: bool) -> None:
    frame = np.full((360, 640, 3), 200, np.uint8)
    strip = BurnIn("s1", 2, "push", f.FPS, np.linspace(35, 50, 9), start=30, below=below)
    first, last = burn(frame, strip, 0), burn(frame, strip, 8)
    high = strip_height(360)
    assert first.shape == (360 + (high if below else 0), 640, 3)
    assert first.shape[0] % 2 == 0
    assert (first[: 360 if below else 360 - high] == 200).all()
    assert (frame == 200).all()
    assert (first[-high:] > 180).any()
    assert (first[-high:] != last[-high:]).any()
    media = write_take(tmp_path, "s1", 1, [frame] * 9, 9, f.FPS, strip)
    assert next(read_video(media.video)).shape == first.shape


def test_timecode_counts_frames() -> None:
    assert timecode(0, (24, 1)) == "00:00:00:00"
    assert timecode(24 * 61 + 5, (24, 1)) == "00:01:01:05"
    assert timecode(24 * 3600, (24000, 1001)) == "01:00:00:00"
