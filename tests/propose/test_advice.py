"""Where no camera has room: what is nudged, why it is told, and that what is named instead does work."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from filmset import shot, skeleton, standing, still_story, story, thing, world

from runtime.motion.types import ActorState
from vdsl.lang.ir import ALL_ANGLES, SIZES, Shot
from vdsl.propose.advice import advise, is_faultless
from vdsl.propose.cameras import Filming, propose_cameras, subject_of
from vdsl.propose.drawing import draw, generator, nudged
from vdsl.propose.shooting import shoot
from vdsl.propose.state import SceneState
from vdsl.propose.story import Told, film
from vdsl.propose.types import Advice

BODY = skeleton()


def corridor(width: float = 1.2) -> Filming:
    """Between two blocks that no camera can stand in, 12 m long."""
    x, y = width / 2, 6.0
    boxes = tuple((side * (x + 1.5), 0.0, 1.3, 1.5, y, 1.3, 0.0) for side in (-1, 1))
    hall = thing(7, "back_corridor", (-x, -y, 0.0), (x, y, 2.6), kind="room")
    return Filming(
        world(floors=((-x, -y, x, y),), boxes=boxes, objects=(hall,), outdoor=False), {"anna": BODY}, 24.0, 0
    )


def cupboards() -> Filming:
    """Somebody with a ring of cupboards around, nearly as high as she is."""
    turns = np.arange(8) * np.pi / 4
    boxes = tuple((1.2 * np.cos(a), 1.2 * np.sin(a), 0.85, 0.1, 0.5, 0.85, a) for a in turns)
    around = tuple(thing(k, "tall_cupboard", (0.0, 0.0, 0.0), (1.0, 1.0, 1.7)) for k in range(8))
    return Filming(world(boxes=boxes, objects=around), {"anna": BODY}, 24.0, 0)


def with_words(asked: Shot, words: str) -> Shot:
    if words in SIZES:
        return replace(asked, scales=(words,))
    if words in ALL_ANGLES:
        return replace(asked, angles=(words,))
    if words.startswith("lens "):
        focal = float(words[5:-2])
        return replace(asked, lens=(focal, focal))
    return replace(asked, movements=(words,))


def holds(advice: Advice, asked: Shot, filming: Filming) -> None:
    """Every alternative has cameras that keep to it."""
    assert advice.instead
    for words in advice.instead:
        grid = propose_cameras(with_words(asked, words), [still_story(BODY)], filming)
        assert len(grid.cameras) > grid.let_in, words


def test_a_corridor_is_too_narrow_and_says_how_narrow() -> None:
    filming, asked = corridor(), shot("arc-left", "full", lens=(60.0, 80.0))
    grid = propose_cameras(asked, [still_story(BODY)], filming)
    assert grid.let_in == len(grid.cameras)
    advice = advise(asked, still_story(BODY), filming)
    assert advice.why.startswith("the back corridor is 1.2 m wide, and a full eye-level shot stands ")
    metres = float(advice.why.split(" stands ")[1].split(" m ")[0])
    assert 4.5 < metres < 8.0
    holds(advice, asked, filming)


def test_a_cupboard_in_the_way_is_named() -> None:
    filming, asked = cupboards(), shot("static", "medium", lens=(40.0, 80.0))
    advice = advise(asked, still_story(BODY), filming)
    assert advice.why == "a medium eye-level shot sees the tall cupboard before anna"
    assert "overhead" in advice.instead or "high-angle" in advice.instead
    holds(advice, asked, filming)


def test_where_nothing_helps_nothing_is_named() -> None:
    block = ((0.0, 0.0, 15.0, 30.0, 30.0, 15.0, 0.0),)
    filming = Filming(world(boxes=block), {"anna": BODY}, 24.0, 0)
    assert advise(shot(scale="full"), still_story(BODY), filming).instead == ()


def test_what_helps_in_another_way_of_playing_is_named() -> None:
    """She stands in a block where nothing helps; in the other way the line may be played, outside of it."""
    block = ((0.0, 0.0, 15.0, 9.0, 9.0, 15.0, 0.0),)
    ground = world(boxes=block, floors=((-60.0, -60.0, 60.0, 60.0),))
    filming = Filming(ground, {"anna": BODY}, 24.0, 0)
    asked, inside = shot("push", "medium"), still_story(BODY)
    away = standing(BODY, np.tile((30.0, 0.0, 0.0), (30, 1)), np.zeros(30), 0.0)
    outside = story({"anna": away})
    near = {"medium-close-up", "cowboy", "eye-level", "static"}
    assert not near & set(advise(asked, inside, filming).instead)
    assert near & set(advise(asked, inside, filming, (outside,)).instead)


def test_two_words_are_named_where_none_alone_helps() -> None:
    """A passage 0.9 m wide has no room for an arc, nor for a wide shot that stands still."""
    filming, asked = corridor(0.9), shot("arc-left", "wide", lens=(80.0, 80.0))
    assert advise(asked, still_story(BODY), filming).instead == ("static full",)
    both = replace(asked, movements=("static",), scales=("full",))
    grid = propose_cameras(both, [still_story(BODY)], filming)
    assert len(grid.cameras) > grid.let_in


def test_nudged_cameras_stand_beside_the_usual_ones_within_the_sizes_tolerance() -> None:
    asked = shot("static", "medium", proposals=20)
    rng = generator(0, "s1", "test")
    usual = draw(asked, 1, 200, rng)
    other = nudged(usual, rng, False)
    assert np.abs(other.jitter - 0.5).max() == pytest.approx(1.25, abs=0.05)  # half way to the next azimuth
    assert np.abs(np.log(other.reach)).max() < 0.1  # more is a fault
    assert (other.lens <= usual.lens).all()
    assert other.lens.min() >= 0.0


def test_nudged_cameras_may_have_other_lenses_where_the_line_says_none() -> None:
    rng = generator(0, "s1", "test")
    sample, filming = nudged(draw(shot(), 1, 400, rng), rng, True), Filming(world(), {"anna": BODY}, 24.0, 0)
    assert 0.2 < (sample.lens < 0.0).mean() < 0.4
    assert 0.1 < (sample.lens > 1.0).mean() < 0.3
    subject = subject_of(shot(), still_story(BODY), filming)
    focal = shoot(shot(), subject, sample, np.arange(400), "cinema", filming.sensor, 24.0).draw.focal
    assert focal.min() == pytest.approx(21.0, abs=0.5)
    assert focal.max() == pytest.approx(135.0, abs=3.0)


def test_a_room_too_small_for_usual_lenses_is_shown_with_a_shorter_one() -> None:
    """Shelves 2 m around somebody who is to be seen whole: 30 mm stand farther off than their corners."""
    sides = ((5.0, 0.0, 3.0, 8.0), (-5.0, 0.0, 3.0, 8.0), (0.0, 5.0, 8.0, 3.0), (0.0, -5.0, 8.0, 3.0))
    boxes = tuple((x, y, 1.2, half_x, half_y, 1.2, 0.0) for x, y, half_x, half_y in sides)
    filming = Filming(world(boxes=boxes), {"anna": BODY}, 24.0, 0)
    usual = propose_cameras(shot("static", "full"), [still_story(BODY)], filming)
    free = propose_cameras(shot("static", "full", any_lens=True), [still_story(BODY)], filming)
    assert not len(usual.cameras) - usual.let_in
    assert len(free.cameras) - free.let_in > 8
    assert all(20.5 < float(c.params["focal"]) < 30.0 for c in free.cameras)


def test_what_the_usual_cameras_have_no_room_for_is_nudged() -> None:
    """Rows of posts stand along the eight azimuths; there is room only between them."""
    rows = [(a, r) for a in np.arange(8) * np.pi / 4 for r in np.arange(0.9, 4.0, 0.25)]
    posts = tuple((r * np.cos(a), r * np.sin(a), 1.0, 0.14, 0.1 * r, 1.0, a) for a, r in rows)
    filming = Filming(world(boxes=posts), {"anna": BODY}, 24.0, 0)
    asked = shot("static", "medium", proposals=20)
    grid = propose_cameras(asked, [still_story(BODY)], filming)
    good = len(grid.cameras) - grid.let_in
    assert good > 0
    off = [(float(c.params["azimuth"]) + np.pi / 8) % (np.pi / 4) - np.pi / 8 for c in grid.cameras]
    assert np.degrees(np.abs(off)).max() > 9.5  # farther off than usual cameras ever stand


def fenced(height: float) -> Filming:
    """Somebody within a ring of fences."""
    turns = np.arange(16) * np.pi / 8
    boxes = tuple((1.2 * np.cos(a), 1.2 * np.sin(a), height / 2, 0.05, 0.3, height / 2, a) for a in turns)
    return Filming(world(boxes=boxes), {"anna": BODY}, 24.0, 0)


def test_where_every_take_has_a_fault_it_is_told_and_what_has_takes_without_one() -> None:
    asked = replace(shot("static", "full", lens=(40.0, 80.0)), proposals=40)
    told = {}
    for height in (0.3, 0.97):
        filming = fenced(height)
        state = SceneState(filming.world, {"anna": ActorState((0.0, 0.0, 0.0), 0.0)}, {})
        acted = Told((still_story(BODY),), state)
        told[height] = film(acted, asked, state, filming, advised=True).advice
        assert film(acted, asked, state, filming).advice is None
    assert told[0.3] is None
    advice = told[0.97]
    assert advice is not None
    assert advice.faulty
    assert advice.why == "something hides anna"
    assert "medium-long" in advice.instead
    for words in advice.instead:
        grid = propose_cameras(with_words(asked, words), [still_story(BODY)], fenced(0.97))
        assert any(map(is_faultless, grid.cameras)), words
