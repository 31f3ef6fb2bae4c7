"""Arrows in stills: where they point, for what moves, in the picture's own space."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import emit_film as f
import numpy as np
import pytest
from PIL import Image

from vdsl.cinema.track import CameraTrack, look_at_rotation
from vdsl.emit.overlay_arrows import CAMERA, arrowed, camera_arrows
from vdsl.emit.types import BuiltTake, Walk
from vdsl.lang.ir import FURTHER_MOVEMENTS, MOVEMENTS

FRAMES = 24
SIZE = (480, 270)


def standing(z: float = 1.5, lens: float = 35.0, goes: tuple[float, float, float] = (0, 0, 0)) -> CameraTrack:
    """A camera 5 m south of the middle, looking north at it."""
    t = np.linspace(0, 1, FRAMES)[:, None]
    position = np.array([0.0, -5.0, z]) + t * np.array(goes)
    aim = np.broadcast_to([0.0, 0.0, 1.0], position.shape)
    return CameraTrack(position, look_at_rotation(position, aim), np.full(FRAMES, lens), aim, (36.0, 20.25))


def take(folder: Path, movement: str, camera: CameraTrack, *ways: np.ndarray) -> BuiltTake:
    made = f.take(folder, "s1", 1, FRAMES, 90)
    people = tuple(Walk(f"p{i}", way, np.zeros(len(way)), way) for i, way in enumerate(ways))
    return replace(made, camera=replace(made.camera, movement=movement, track=camera), people=people)


def walking(start: tuple[float, float], end: tuple[float, float]) -> np.ndarray:
    way = np.linspace(start, end, FRAMES)
    return np.concatenate([way, np.zeros((FRAMES, 1))], 1)


def whites(made: BuiltTake) -> np.ndarray:
    """Where people's arrows are, bool [H, W]."""
    out = np.asarray(arrowed(Image.new("RGB", SIZE, (90, 90, 90)), made, 0)).astype(int)
    return out.min(-1) > 200


def extent(polygons: list[list[tuple[float, float]]]) -> tuple[float, float, float, float]:
    points = np.array([p for polygon in polygons for p in polygon])
    return points[:, 0].min(), points[:, 1].min(), points[:, 0].max(), points[:, 1].max()


def tip(polygon: list[tuple[float, float]]) -> np.ndarray:
    """The point of an arrow: the middle of its outline."""
    return np.array(polygon[len(polygon) // 2])


@pytest.mark.parametrize("movement", [*MOVEMENTS, *FURTHER_MOVEMENTS])
def test_every_movement_stays_inside_the_picture(movement: str) -> None:
    arrows = camera_arrows(movement, standing(goes=(2, 0, 0)), 0)
    assert bool(arrows) == (movement not in ("static", "handheld", "rack-focus"))
    if arrows:
        x0, y0, x1, y1 = extent(arrows)
        assert 0 < x0 < x1 < 1
        assert 0 < y0 < y1 < 1


@pytest.mark.parametrize(
    ("movement", "way"),
    [("pan-left", (-1, 0)), ("dolly-right", (1, 0)), ("tilt-up", (0, -1)), ("pedestal-down", (0, 1)),
     ("arc-right", (1, 0)), ("whip-pan-right", (1, 0))],
)  # fmt: skip
def test_arrows_point_where_the_camera_goes(movement: str, way: tuple[int, int]) -> None:
    (arrow,) = camera_arrows(movement, standing(), 0)
    tail = (np.array(arrow[0]) + arrow[-1]) / 2
    assert (tip(arrow) - tail) @ way > 0.1


def test_push_points_inwards_and_pull_outwards() -> None:
    for movement, sign in (("push", -1), ("zoom-in", -1), ("pull", 1), ("dolly-zoom-out", 1)):
        arrows = camera_arrows(movement, standing(), 0)
        assert len(arrows) == 4
        for arrow in arrows:
            tail = (np.array(arrow[0]) + arrow[-1]) / 2
            away = np.linalg.norm(tip(arrow) - 0.5) - np.linalg.norm(tail - 0.5)
            assert sign * away > 0.05, movement


def test_two_movements_have_both_arrows() -> None:
    assert len(camera_arrows("push+pan-left", standing(), 0)) == 5


def test_a_following_camera_shows_where_it_goes() -> None:
    assert len(camera_arrows("follow", standing(goes=(0, 2, 0)), 0)) == 4  # into depth
    (arrow,) = camera_arrows("follow", standing(goes=(-2, 0, 0)), 0)
    assert tip(arrow)[0] < 0.2
    assert camera_arrows("follow", standing(goes=(0.1, 0, 0)), 0) == []


def test_an_arrow_lies_on_the_floor_where_somebody_walks(tmp_path: Path) -> None:
    made = take(tmp_path, "static", standing(z=2.5, lens=24), walking((-1.5, 0), (1.5, 0)))
    seen = np.argwhere(whites(made))
    assert len(seen) > 300
    # The floor in the middle of the picture is seen at this height; the arrow goes on to the right of it.
    drop = np.arctan2(2.5, 5) - np.arctan2(1.5, 5)
    floor = SIZE[1] / 2 + np.tan(drop) * 24 / 20.25 * SIZE[1]
    assert abs(np.median(seen[:, 0]) - floor) < 10
    columns = seen[:, 1] / SIZE[0]
    assert columns.min() > 0.5 - 1.5 / 5.1 * 24 / 36 + 0.02  # it does not begin under the feet
    assert columns.max() > 0.5 + 1.2 / 5.6 * 24 / 36


def test_arrows_end_inside_the_picture(tmp_path: Path) -> None:
    columns = np.argwhere(whites(take(tmp_path, "static", standing(lens=30), walking((-1, 0), (9, 0)))))[:, 1]
    assert SIZE[0] * 0.85 < columns.max() < SIZE[0] * 0.98


def test_close_up_the_arrow_is_at_the_body(tmp_path: Path) -> None:
    rows = np.argwhere(whites(take(tmp_path, "static", standing(lens=120), walking((-0.6, 0), (0.9, 0)))))[
        :, 0
    ]
    assert len(rows) > 100
    assert 0.2 * SIZE[1] < np.median(rows) < 0.8 * SIZE[1]  # the floor is far below


@pytest.mark.parametrize(
    "way",
    [
        walking((0, 0), (0, 0)),
        walking((0, 0), (0.3, 0)),
        walking((0, -9), (2, -9)),
        walking((40, 0), (44, 0)),
    ],
)
def test_no_arrow_for_what_does_not_go_or_is_not_seen(tmp_path: Path, way: np.ndarray) -> None:
    assert not whites(take(tmp_path, "static", standing(), way)).any()


def test_the_still_given_is_left_as_it_was_and_camera_arrows_are_red(tmp_path: Path) -> None:
    still = Image.new("RGB", SIZE, (90, 90, 90))
    out = np.asarray(arrowed(still, take(tmp_path, "push", standing()), 0)).astype(int)
    assert np.asarray(still).max() == 90
    assert (np.abs(out - CAMERA[:3]).max(-1) < 12).mean() > 0.005
