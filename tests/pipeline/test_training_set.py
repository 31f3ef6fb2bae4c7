"""Random stories, and what is good and bad of their takes."""

from __future__ import annotations

import random
from dataclasses import fields, replace

import numpy as np
import pytest

from ranker.data import MIRRORED
from vdsl.cinema.flaws import LEAST, MOST, flaws
from vdsl.cinema.subject import Subject
from vdsl.cinema.track import CameraTrack, camera_axes, look_at_rotation
from vdsl.lang import Report, Source
from vdsl.lang.ir import ALL_ANGLES, FURTHER_MOVEMENTS, MOVEMENTS, SIZES
from vdsl.library import Catalog
from vdsl.pipeline.acts import stage_acts
from vdsl.pipeline.casting import Scene, Troupe, split_of_story
from vdsl.pipeline.clips import BAR, Clip, clips_of, moves
from vdsl.pipeline.designer import judged, picks
from vdsl.pipeline.hints import frame_hints_of, hints_of
from vdsl.pipeline.labels import WORDS, classes
from vdsl.pipeline.perturb import mistyped, perturbation
from vdsl.pipeline.script import check_source
from vdsl.pipeline.stories import places, random_story, split_of
from vdsl.propose.cameras import measured_anew
from vdsl.propose.story import tell
from vdsl.propose.types import CameraProposal


def _track(frames: int = 40) -> CameraTrack:
    t = np.linspace(0, 1, frames)[:, None]
    position = np.array([0.0, -3.0, 1.5]) + t * np.array([0.5, 0.0, 0.0])
    look_at = np.tile([0.0, 0.0, 1.3], (frames, 1))
    rotation = look_at_rotation(position, look_at)
    return CameraTrack(position, rotation, np.full(frames, 50.0), look_at, (36, 20.25))


def test_strength_grades_how_far_a_negative_is_off():
    track = _track()

    def off(strength: float, seed: int) -> float:
        spoilt = perturbation(strength, np.random.default_rng(seed))(track)
        moved = np.linalg.norm(spoilt.position - track.position, axis=1).max()
        turned = np.abs(spoilt.rotation - track.rotation).max()
        return float(moved + turned + np.abs(np.log(spoilt.focal / track.focal)).max())

    assert off(0.0, 3) == pytest.approx(0.0, abs=1e-12)
    weak, strong = (np.mean([off(s, k) for k in range(40)]) for s in (0.2, 0.9))
    assert strong > 2.5 * weak > 0
    assert off(0.7, 5) == off(0.7, 5)


def test_negatives_stay_above_the_floor_and_keep_their_length():
    for seed in range(30):
        spoilt = perturbation(1.0, np.random.default_rng(seed))(_track())
        assert spoilt.position[:, 2].min() >= 0.08
        assert spoilt.position.shape == (40, 3)
        assert (spoilt.focal > 0).all()


def test_random_stories_pass_the_same_check_as_a_writers():
    catalog = Catalog(Report())
    cast = tuple(sorted(catalog.names("cast")))
    grounds = places(catalog)
    assert {p.set for p in grounds} >= {"apartment", "office", "suburb_street"}
    seen, established = set(), 0
    for number in range(60):
        place = grounds[number % len(grounds)]
        text = random_story(catalog, place, random.Random(number), 5, cast)
        storyboard = check_source(Source("<story>", text)).storyboard
        acted = [line for line in storyboard.lines if line.beats]
        established += len(storyboard.lines) - len(acted)
        assert len(acted) == 5
        seen |= {beat.action for line in storyboard.lines for beat in line.beats}
    assert len(seen) >= 15, seen
    assert 15 < established < 45


def test_no_set_and_nobody_is_on_both_sides() -> None:
    catalog = Catalog(Report())
    for kind in ("set", "cast"):
        names = sorted(catalog.names(kind))
        train, test = split_of(names)
        assert set(train) | set(test) == set(names)
        assert not set(train) & set(test)
        assert 0.1 < len(test) / len(names) < 0.3
        assert split_of(list(reversed(names))) == (train, test)
    troupe = Troupe(seed=3)
    sides: dict[str, list[set[str]]] = {"train": [set(), set()], "test": [set(), set()]}
    for number in range(48):
        side = split_of_story(number)
        text, place = troupe.text(number, side)
        storyboard = check_source(Source("<story>", text)).storyboard
        sides[side][0].add(place.set)
        sides[side][1] |= {c.cast for c in storyboard.characters}
    for seen in zip(sides["train"], sides["test"], strict=True):
        assert all(seen)
        assert not seen[0] & seen[1]


def test_stories_use_the_whole_vocabulary_of_the_camera() -> None:
    troupe = Troupe(seed=1)
    shots = [
        shot
        for number in range(40)
        for line in check_source(Source("<s>", troupe.text(number, "train")[0])).storyboard.lines
        for shot in line.shots
    ]
    assert {s for shot in shots for s in shot.scales} == set(SIZES)
    assert {a for shot in shots for a in shot.angles} == set(ALL_ANGLES)
    movements = {m for shot in shots for m in shot.movements}
    assert movements >= set(MOVEMENTS) | (set(FURTHER_MOVEMENTS) - {"rack-focus"})
    assert any("+" in m for m in movements)
    assert {shot.view for shot in shots} >= {"", "ots", "two-shot"}


def test_classes_are_what_a_person_can_tell() -> None:
    words = [*MOVEMENTS, *FURTHER_MOVEMENTS]
    found = [classes(m, s, a) for m in words for s in SIZES for a in ALL_ANGLES]
    assert {f[0] for f in found} == set(WORDS.movements)
    assert {f[1] for f in found} == set(WORDS.scales)
    assert {f[2] for f in found} - {None} == set(WORDS.angles)
    assert classes("push+pan-left", "cowboy", "knee-level") == (None, "medium", None)
    assert classes("push+rack-focus", "medium", "overhead") == ("push/pull", "medium", "overhead")


def test_what_shows_no_type_is_another_take() -> None:
    track = _track()
    for seed in range(30):
        spoilt = mistyped(track, np.random.default_rng(seed))
        assert spoilt.position.shape == (40, 3)
        off = [
            np.abs(getattr(spoilt, k) - getattr(track, k)).max() for k in ("position", "rotation", "focal")
        ]
        assert max(off) > 0.05


def test_what_turns_round_half_way_does_not_judder() -> None:
    """Else it is told apart by that, and not by showing no type."""
    track = _track()
    along = np.linspace(0, 1, 40)
    even = replace(
        track,
        position=track.position[:1] + along[:, None] * (1.0, 0.5, 0.0),
        rotation=np.tile(track.rotation[:1], (40, 1))
        + along[:, None] * (0.0, 0.0, 0.4)
        + (0.0, 0.0, np.pi - 0.2),
    )
    turning = 0
    for seed in range(40):
        spoilt = mistyped(even, np.random.default_rng(seed))
        assert np.abs(np.diff(spoilt.rotation, axis=0)).max() < 0.5  # and not once round
        step = np.linalg.norm(np.diff(spoilt.position, axis=0), axis=1)
        if np.ptp(spoilt.position, axis=0).max() < 0.99 * np.ptp(even.position, axis=0).max():
            continue
        changes = np.abs(np.diff(step)) > 0.3 * step.max()
        assert changes.sum() <= 2  # where it turns
        turning += bool(changes.any() or np.allclose(spoilt.position[0], spoilt.position[-1]))
    assert turning >= 5


def test_what_two_did_together_may_have_begun_before_a_shot() -> None:
    text = """storyboard "dance"
character anna = soldier
character ben = dancer
scene here = farmyard.yard at day
(anna dance-with ben)
(anna stagger)
"""
    for act in stage_acts(check_source(Source("<story>", text))):  # once an IndexError
        assert tell(act.state, act.line, act.filming).proposals


@pytest.fixture(scope="module")
def scenes() -> list[Scene]:
    """Lines with proposals the designer likes some of."""
    found: list[Scene] = []
    for number in range(12):
        found += Troupe(seed=4, lines=1, cameras=2).scenes(number, 16)
        if sum(len(picks(grid.cameras, 4)) for scene in found for grid in scene.grids) >= 6:
            break
    return found


def test_a_track_measured_anew_measures_the_same(scenes: list[Scene]) -> None:
    compared = 0
    for scene in scenes:
        for shot, grid in zip(scene.shots, scene.grids, strict=True):
            for story in grid.story:
                cameras = [c for c in grid.cameras if c.story == story.index]
                for before, after in zip(
                    cameras, measured_anew(shot, story, scene.filming, cameras), strict=True
                ):
                    assert after.measures == pytest.approx(before.measures, abs=1e-9)
                    np.testing.assert_array_equal(after.hidden_walls, before.hidden_walls)
                    compared += 1
    assert compared > 20


def test_negatives_are_truly_worse_and_labels_are_what_the_track_shows(scenes: list[Scene]) -> None:
    found = [clip for n, scene in enumerate(scenes) for clip in drawn_of(scene, n)]
    good, bad = found[::2], found[1::2]
    assert all(clip.kind == "designer" for clip in good)
    assert len(good) == len(bad) >= 5
    for clip, other in zip(good, bad, strict=True):
        assert judged([clip.camera])[0] == pytest.approx(clip.opinion)
        assert clip.opinion >= BAR
        assert 0 <= clip.grade <= 1
        movement, *others = classes(*_asked(clip))
        seen = movement != "follow" or moves(clip.camera.track)
        assert clip.words == (movement if seen else None, *others)
        assert judged([other.camera])[0] == pytest.approx(other.opinion)
        if other.kind == "passed-over":
            assert other.opinion < BAR
            continue
        assert other.opinion < BAR or other.words != clip.words
        assert other.camera.measures != clip.camera.measures
        assert all(word in (None, own) for word, own in zip(other.words, clip.words, strict=True))
    assert np.mean([clip.opinion < 0 for clip in bad]) > 0.5
    assert all(0.1 <= clip.strength <= 1 for clip in bad)


def drawn_of(scene: Scene, seed: int) -> list[Clip]:
    return [clip for clip in clips_of(scene, np.random.default_rng(seed)) if not clip.bare]


def test_what_is_not_drawn_is_every_other_proposal_as_the_designer_says(scenes: list[Scene]) -> None:
    for scene in scenes:
        found = clips_of(scene, np.random.default_rng(2))
        every = {id(c) for grid in scene.grids for c in grid.cameras}
        drawn = {id(clip.camera) for clip in found if not clip.bare} & every
        bare = [clip for clip in found if clip.bare and clip.kind in ("designer", "passed-over")]
        assert {id(clip.camera) for clip in bare} == every - drawn
        for clip in bare:
            thought = judged([clip.camera])[0]
            assert clip.opinion == pytest.approx(thought)
            assert (clip.kind == "designer") == (thought >= BAR)
            wrong = flaws(clip.camera.measures, seen=True)
            shows = any(bool(f) for f in wrong.values()) or 0 <= thought < BAR * 0.92
            assert clip.doubtful == (thought < BAR and not shows)
        spoilt = [clip for clip in found if clip.bare and clip.kind in ("perturbed", "mistyped")]
        picked = sum(clip.kind == "designer" and not clip.bare for clip in found)
        assert 0.8 * 2 * picked <= len(spoilt) <= 2 * picked  # two of each, but what cannot be made worse
        for clip in spoilt:
            assert id(clip.camera) not in every
            assert clip.opinion < BAR or None in clip.words
        for_test = clips_of(replace(scene, split="test"), np.random.default_rng(2))
        assert not any(clip.bare for clip in for_test)


def test_no_picture_shows_what_was_asked_for_or_a_wall_behind_the_camera(scenes: list[Scene]) -> None:
    grid = next(grid for scene in scenes for grid in scene.grids if picks(grid.cameras, 1))
    good = grid.cameras[picks(grid.cameras, 1)[0]].measures
    for name, value in (("clearance", 0.1), ("size_error", 0.3), ("view", 0.2)):
        spoilt = good | {name: value}
        assert any(bool(f) for f in flaws(spoilt).values())
        assert not any(bool(f) for f in flaws(spoilt, seen=True).values())
    assert any(bool(f) for f in flaws(good | {"head_cut": 0.5}, seen=True).values())


def test_half_of_the_negatives_are_proposals_as_they_come(scenes: list[Scene]) -> None:
    for scene in scenes:
        for seed in range(3):
            for clip in clips_of(scene, np.random.default_rng(seed)):
                own = [c for grid in scene.grids for c in grid.cameras if c is clip.camera]
                assert len(own) == (clip.kind in ("designer", "passed-over")), clip.kind
    kinds = [clip.kind for scene in scenes for n in range(40) for clip in drawn_of(scene, n)]
    assert 0.2 < kinds.count("passed-over") / kinds.count("designer") < 0.6


def test_a_camera_that_hardly_moves_is_told() -> None:
    track = _track()
    still = replace(
        track,
        position=np.repeat(track.position[:1], len(track.position), 0),
        look_at=np.repeat(track.look_at[:1], len(track.look_at), 0),
        rotation=np.repeat(track.rotation[:1], len(track.rotation), 0),
        focal=np.repeat(track.focal[:1], len(track.focal)),
    )
    assert not moves(still)
    along = np.linspace(0, 1, len(track.focal))
    assert not moves(replace(still, position=still.position + along[:, None] * (0.01, 0, 0)))
    assert moves(replace(still, position=still.position + np.sin(np.pi * along)[:, None] * (0.5, 0, 0)))
    assert moves(replace(still, rotation=still.rotation + along[:, None] * (0, 0, 0.1)))
    turned = still.rotation + np.where(along > 0.5, 2 * np.pi, 0.0)[:, None] * (0, 0, 1)
    assert not moves(replace(still, rotation=turned))  # the same way round
    assert moves(replace(still, focal=still.focal * (1 + 0.2 * along)))


def _asked(clip: Clip) -> tuple[str, str, str]:
    return clip.camera.movement, clip.camera.scale, clip.camera.angle


def test_what_does_not_get_worse_is_no_negative(scenes: list[Scene], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("vdsl.pipeline.clips.perturbation", lambda strength, rng: lambda track: track)
    monkeypatch.setattr("vdsl.pipeline.clips.mistyped", lambda track, rng: track)
    monkeypatch.setattr("vdsl.pipeline.clips._PASSED_OVER", 0.0)
    assert [clip for scene in scenes for clip in drawn_of(scene, 0)] == []


def test_hints_of_a_mirrored_take_are_mirrored() -> None:
    track = _track()
    track = replace(track, rotation=track.rotation + np.linspace(0, 1, 40)[:, None] * (0.1, 0.2, 0.3))
    swap = np.array([1.0, -1.0, 1.0])
    other = replace(
        track,
        position=track.position * swap,
        look_at=track.look_at * swap,
        rotation=track.rotation * np.array([-1.0, 1.0, -1.0]),
    )
    camera = CameraProposal(**dict.fromkeys((f.name for f in fields(CameraProposal)), None))  # type: ignore[arg-type]
    measures = {name: bound for _, name, bound, _ in (*LEAST, *MOST)} | {
        "jerk": 4.0,
        "headroom_error": 0.5,
        "company_cut": 0.0,
        "floor_gap": 0.0,
        "gesture_lost": 0.0,
    }
    measures |= {"interest": 1.0, "size_drift": 0.0, "angular_speed": 9.0}
    measures |= {"legible": 0.8, "heads": 1.0, "hands_shown": 1.0, "together": 0.0}
    here, there = hints_of([replace(camera, track=t, measures=measures) for t in (track, other)])
    assert here["jerk"] == 2.0
    assert here["good_headroom"] == pytest.approx(np.log(0.05), abs=1e-3)
    assert here["good_headroom"] < here["good_thirds"] < 0
    assert [k for k, v in here.items() if k.startswith("fault_") and v] == ["fault_headroom_error"]
    assert here["right_panning"] == pytest.approx(track.rotation[0, 2] - track.rotation[-1, 2], abs=1e-3)
    for name, value in here.items():
        sign = -1 if name.startswith(MIRRORED) else 1
        assert there[name] == pytest.approx(sign * value, abs=1e-4), name


def test_frame_hints_say_where_the_subject_is_and_are_mirrored_with_it() -> None:
    track, count = _track(), 40
    ahead = track.position + 4.0 * camera_axes(track.rotation)[:, 2]
    at = np.array([0, 13, 39])

    def subject(turn: float, swap: float) -> Subject:
        up = {"crown": 0.9, "eyes": 0.75, "chin": 0.65, "waist": 0.0, "feet": -0.9}
        points = {name: (ahead + np.array((0.3, 0.1, z))) * (1, swap, 1) for name, z in up.items()}
        face = np.tile((np.cos(turn), swap * np.sin(turn), 0.0), (count, 1))
        return Subject("anna", "person", 1.8, ahead, np.zeros(count), points, face)

    other = replace(
        track,
        position=track.position * (1, -1, 1),
        look_at=track.look_at * (1, -1, 1),
        rotation=track.rotation * (-1, 1, -1),
    )
    camera = CameraProposal(**dict.fromkeys((f.name for f in fields(CameraProposal)), None))  # type: ignore[arg-type]
    (here,) = frame_hints_of([replace(camera, track=track)], subject(0.4, 1.0), at)
    (there,) = frame_hints_of([replace(camera, track=other)], subject(0.4, -1.0), at)
    for name, values in here.items():
        sign = -1 if name.startswith(MIRRORED) else 1
        np.testing.assert_allclose(there[name], np.multiply(values, sign), atol=2e-3, err_msg=name)
    assert (np.array(here["crown"]) > np.array(here["feet"])).all()
    behind = replace(track, rotation=track.rotation + np.array((0, 0, np.pi)))
    (unseen,) = frame_hints_of([replace(camera, track=behind)], subject(0.4, 1.0), at)
    assert np.isnan(unseen["right_eyes"]).all()
    both = frame_hints_of([replace(camera, track=t) for t in (track, behind)], subject(0.4, 1.0), at)
    for one, alone in zip(both, (here, unseen), strict=True):
        assert one.keys() == alone.keys()
        for name, values in alone.items():
            np.testing.assert_array_equal(one[name], values, err_msg=name)
