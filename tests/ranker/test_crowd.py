"""How people stand to each other in pictures, by what is told of where they are."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from ranker.crowd import (
    ASKED,
    BESIDES,
    CROWDED,
    HALVED,
    IN_THE_WAY,
    LEAST_TOGETHER,
    LOST,
    MISSING,
    READ,
    SPOILT,
    TOGETHER,
    crowd_of,
)
from ranker.guides import CHANNELS, FARTHEST, FLOW, MARKS, NEAREST, PERSON_POINTS, SIDE, Guides, pairs

FRAMES, FOCAL = 8, 35.0
_HALF = (18.0, 10.125)  # millimetres of a sensor
_NUMBERS = ASKED + 4
_HIGH = dict(zip(PERSON_POINTS, (1.75, 1.64, 1.3, 1.0, 0.0), strict=True))  # metres of points above the floor


def somebody(k: int, aside: float, depth: float, about: bool, covered: float = 0.0) -> dict[str, float]:
    """The k-th stands ``aside`` metres to the right and so far away, before a camera 1.5 m high."""
    out = {f"distance_{k}": float(np.log(np.hypot(aside, depth))), f"about_{k}": float(about)}
    for point, high in _HIGH.items():
        out[f"right_{point}_{k}"] = aside / depth * FOCAL / _HALF[0]
        out[f"up_{point}_{k}"] = float(np.clip((high - 1.5) / depth * FOCAL / _HALF[1], -3, 3))
        out[f"covered_{point}_{k}"] = covered
    return out


def shot(*people: dict[str, float], later: tuple[dict[str, float], ...] = ()) -> torch.Tensor:
    """Marks of a shot in which these people are; later: other ones in its last half."""
    told = torch.full((1, FRAMES, len(MARKS)), torch.nan)
    told[..., MARKS.index("lens")], told[..., MARKS.index("distance")] = np.log(FOCAL), np.log(3.0)
    for frames, some in ((slice(0, FRAMES), people), (slice(FRAMES // 2, FRAMES), later)):
        for one in some:
            for name, value in one.items():
                told[:, frames, MARKS.index(name)] = value
    return told


def empty() -> torch.Tensor:
    """Maps of a wall 6 m away."""
    maps = torch.zeros((1, FRAMES, SIDE, SIDE, len(CHANNELS)), dtype=torch.uint8)
    maps[..., CHANNELS.index("nearness")] = code(6.0)
    return maps


def code(metres: float) -> int:
    return round(1 + 254 * (1 - np.log(metres / NEAREST) / np.log(FARTHEST / NEAREST)))


def crowd(told: torch.Tensor, maps: torch.Tensor | None = None) -> np.ndarray:
    found = sides(told, maps)[:_NUMBERS]
    return np.sinh(found) / 5


def sides(told: torch.Tensor, maps: torch.Tensor | None = None) -> np.ndarray:
    """All that is told, and from ``_NUMBERS`` on upon which side of what film grammar asks for that is."""
    found = crowd_of(told, empty() if maps is None else maps)
    assert found.shape == (1, CROWDED)
    assert found.isfinite().all()
    return found[0].numpy()


def test_nobody_spoils_nothing() -> None:
    assert crowd(torch.full((1, FRAMES, len(MARKS)), torch.nan)) == pytest.approx(0, abs=1e-6)
    alone = crowd(shot(somebody(1, 0.0, 3.0, True)))
    assert alone[READ] == pytest.approx(1)
    assert alone[[TOGETHER, LOST, HALVED, SPOILT]] == pytest.approx(0, abs=1e-5)


def test_two_who_stand_apart_and_two_who_do_not() -> None:
    apart = crowd(shot(somebody(1, -0.9, 3.0, True), somebody(2, 0.9, 3.0, True)))
    near = crowd(shot(somebody(1, -0.15, 3.0, True), somebody(2, 0.15, 3.2, True)))
    assert apart[TOGETHER] == apart[SPOILT] == 0
    assert 0.4 < near[TOGETHER] < 0.8
    assert 0.1 < near[SPOILT] < 0.45
    assert near[READ] == pytest.approx(1, abs=1e-5)


def test_they_count_as_near_as_when_they_are_furthest_apart() -> None:
    both = somebody(1, -0.15, 3.0, True), somebody(2, 0.15, 3.2, True)
    away = somebody(1, -0.9, 3.0, True), somebody(2, 0.9, 3.0, True)
    found = crowd(shot(*both, later=away))
    assert found[TOGETHER] > 0.2
    assert found[LEAST_TOGETHER] == 0


def test_who_is_behind_somebody_has_no_head_to_see_and_is_near_them_for_all_that() -> None:
    front = somebody(1, 0.0, 3.0, True)
    hidden = crowd(shot(front, somebody(2, 0.02, 4.0, True, covered=np.log(4 / 3))))
    assert hidden[READ] == pytest.approx(0.5)
    assert hidden[TOGETHER] > 0.9
    beside = crowd(shot(front, somebody(2, 0.8, 4.0, True)))
    assert beside[READ] == pytest.approx(1, abs=1e-5)
    turned = crowd(shot(front, somebody(2, 0.02, 2.0, True)))  # now the first is behind
    assert turned[READ] == pytest.approx(0.5)


def test_somebody_beside_the_subject_who_is_cut_spoils_it() -> None:
    subject = somebody(1, 0.0, 3.0, True)
    whole = crowd(shot(subject, somebody(2, 1.0, 3.0, False)))
    assert whole[[LOST, HALVED, SPOILT]] == pytest.approx(0, abs=1e-5)
    edge = 3.0 * _HALF[0] / FOCAL
    halved = crowd(shot(subject, somebody(2, edge, 3.0, False)))
    assert halved[HALVED] == pytest.approx(1, abs=0.01)
    assert halved[SPOILT] == pytest.approx(0.5, abs=0.01)
    tall = somebody(2, 0.45, 1.0, False)  # a chest near the camera, and no head above it
    tall |= {f"up_{point}_2": tall[f"up_{point}_2"] + 1.0 for point in _HIGH}
    assert crowd(shot(subject, tall))[LOST] == pytest.approx(1)
    assert crowd(shot(subject, tall))[SPOILT] == pytest.approx(1)
    away = somebody(2, 3 * edge, 3.0, False)
    assert crowd(shot(subject, away))[[LOST, HALVED, SPOILT]] == pytest.approx(0, abs=1e-5)


def test_what_is_near_is_in_the_way_and_what_is_missing_is_told() -> None:
    told = shot(somebody(1, 0.0, 3.0, True))
    told[..., MARKS.index("up_waist")] = 0.0
    told[..., MARKS.index("open")] = 1.0
    maps = empty()
    maps[..., CHANNELS.index("rise")] = 128  # as if one looked at it from everywhere levelly
    assert crowd(told, maps)[IN_THE_WAY] == crowd(told, maps)[MISSING] == 0
    maps[:, :, :, : SIDE // 2, CHANNELS.index("nearness")] = code(1.0)
    assert crowd(told, maps)[IN_THE_WAY] == pytest.approx(0.5)
    maps[:, :, SIDE // 2 :, :, CHANNELS.index("nothing")] = 255
    assert crowd(told, maps)[MISSING] == pytest.approx(1)
    assert crowd(told, maps)[MISSING + 1] == pytest.approx(1)


def test_a_head_is_lost_from_behind_that_is_cut_above_the_brow() -> None:
    subject = somebody(1, 0.0, 3.0, True)
    cut = somebody(2, 0.6, 2.0, False)
    lower = 1.02 - cut["up_crown_2"]  # the crown just out of the frame, the eyes well within
    cut |= {f"up_{point}_2": cut[f"up_{point}_2"] + lower for point in _HIGH}
    assert cut["up_eyes_2"] < 0.9
    assert crowd(shot(subject, cut | {"turned_2": 0.5}))[LOST] == 0
    assert crowd(shot(subject, cut | {"turned_2": -0.5}))[LOST] == pytest.approx(1)


def alone(depth: float) -> dict[str, float]:
    """A shot's one subject, before the same camera, who faces it."""
    out = {"distance": float(np.log(depth)), "right_face": 0.0, "up_face": 0.0, "away_face": -1.0}
    for point, high in _HIGH.items():
        out[f"right_{point}"], out[f"covered_{point}"] = 0.0, 0.0
        out[f"up_{point}"] = (high - 1.5) / depth * FOCAL / _HALF[1]
    return out


def test_over_a_shoulder_spoils_nothing_besides() -> None:
    owner = somebody(1, 0.35, 1.0, False)  # near, and no head above it
    owner |= {f"up_{point}_1": owner[f"up_{point}_1"] + 1.2 for point in _HIGH}
    back, face = (crowd(shot(alone(2.0), owner | {"turned_1": turned})) for turned in (-0.8, 0.8))
    assert back[SPOILT] == face[SPOILT] == face[BESIDES] == pytest.approx(1)
    assert back[BESIDES] == 0
    behind = somebody(1, 0.7, 4.0, False)
    behind |= {f"covered_{point}_1": 1.0 for point in ("crown", "eyes")} | {"turned_1": -0.8}
    assert crowd(shot(alone(2.0), behind))[BESIDES] == crowd(shot(alone(2.0), behind))[SPOILT] > 0.5


def test_in_a_place_whoever_lost_their_head_spoils_it() -> None:
    covered = {f"covered_{point}_2": 1.0 for point in ("crown", "eyes")}
    two = somebody(1, -0.9, 3.0, True), somebody(2, 0.9, 3.0, True) | covered
    face = {"right_face": 1.0, "up_face": 0.0, "away_face": 0.0}
    assert crowd(shot(*two, face))[LOST] == 0  # the shot is about them
    place = crowd(shot(*two, dict.fromkeys(face, 0.0)))
    assert place[LOST] == pytest.approx(1)
    assert place[SPOILT] == pytest.approx(1)


def test_it_is_told_on_which_side_of_a_bound_a_shot_is() -> None:
    told, maps = shot(alone(3.0)), empty()
    clear = sides(told, maps)[_NUMBERS:]
    maps[:, :, :, : SIDE // 8, CHANNELS.index("nearness")] = code(0.5)
    maps[..., CHANNELS.index("rise")] = 128
    hidden = sides(told, maps)[_NUMBERS:]
    count = len(clear) // 2
    assert crowd(told, maps)[ASKED] > 0.05
    assert (clear[:3] < -0.7).all()
    assert (hidden[:2] > 0.7).all()
    assert not clear[count:].any()  # those of a place
    assert not hidden[count:].any()


def test_the_mirror_changes_nothing() -> None:
    people = somebody(1, -0.3, 3.0, True), somebody(2, 0.1, 3.4, False), somebody(3, 1.4, 2.5, False)
    rng = np.random.default_rng(0)
    maps = rng.integers(0, 255, (1, FRAMES, SIDE, SIDE, len(CHANNELS)), np.uint8)
    flow = np.zeros((1, len(pairs(FRAMES)), FLOW, FLOW, 2), np.float16)
    guides = Guides(maps, flow, shot(*people).numpy().astype(np.float16))
    mirrored = guides.mirrored()
    one, other = (
        crowd_of(torch.from_numpy(g.marks).float(), torch.from_numpy(np.ascontiguousarray(g.maps)))
        for g in (guides, mirrored)
    )
    np.testing.assert_allclose(one, other, atol=2e-3)
