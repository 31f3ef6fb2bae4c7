"""Low postures, jumps, steps, stairs, people who touch, poses that stay: measured as the product promises."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from runtime.body.skeleton import JOINT
from runtime.motion.perform import perform
from runtime.motion.timeline import FootMove, Jump, Timeline
from runtime.motion.types import ActionClip, Actor, ActorState, SceneMotion, Task, Variant
from runtime.world import Stairs
from vdsl.lang.definitions.action import read_action
from vdsl.lang.diagnostics import Report
from vdsl.lang.parse import parse_definition
from vdsl.lang.source import Source
from vdsl.stage.actions import build_clip

from .checks import measure, violations
from .scenes import FPS, angular_steps, at, joint, person, skeleton, travelling

POSTURES = ("crouching", "kneeling", "one-knee", "floor", "lying", "fours", "prone", "plank")
WAY = np.array([[0.0, 0.0], [2.5, 0.0]])


def settling(posture: str, back: bool = False) -> ActionClip:
    return ActionClip("settle", (Variant("plain", 0.6, Timeline()),), posture=posture, rises=back)


def clip(text: str) -> ActionClip:
    report = Report()
    definition = parse_definition(Source("test.vds", text), "action", text.split()[1], report)
    assert definition is not None
    action = read_action(definition, report)
    assert action is not None
    assert not report.diagnostics
    return build_clip(action)


def sound(motion: SceneMotion, who: str, height: float) -> list[str]:
    return violations(measure(motion, who, skeleton(height, 8.0 if height < 1.4 else 32.0), FPS))


@pytest.mark.parametrize("height", [1.2, 1.93])
@pytest.mark.parametrize("posture", POSTURES)
def test_postures_are_taken_kept_and_left(posture: str, height: float) -> None:
    down = perform({"a": person(height)}, {"a": Task(settling(posture))}, {}, FPS, 0)
    assert down.end_actors["a"].posture == posture
    assert sound(down, "a", height) == []
    assert angular_steps(down, "a").max() < 0.9
    low = Actor(person(height).skeleton, down.end_actors["a"])
    idle = perform({"a": low}, {}, {}, FPS, 1)
    assert np.abs(joint(idle, "a", "hips")[0] - joint(down, "a", "hips")[-1]).max() < 0.03
    assert np.ptp(joint(idle, "a", "neck"), axis=0).max() > 0.0005  # breathing
    away = perform({"a": low}, {"a": Task(travelling(), path=WAY)}, {}, FPS, 2)
    assert away.end_actors["a"].posture == "standing"
    assert np.allclose(away.end_actors["a"].position[:2], WAY[-1])
    left = sound(away, "a", height)
    assert [v for v in left if "hand" not in v or posture != "prone"] == []  # hands come under the chest


def test_somebody_lying_gets_up_at_once_and_is_where_they_were() -> None:
    motion = perform({"a": person()}, {"a": Task(settling("lying", back=True))}, {}, FPS, 0)
    assert motion.end_actors["a"].posture == "standing"
    assert np.allclose(motion.end_actors["a"].position[:2], (0.0, 0.0), atol=1e-6)


def test_a_bed_is_lain_on_and_left() -> None:
    bed = at(1.0, 0.0, 0.5, bed=((1.0, 0.0, 0.5), np.pi / 2))
    start = {"a": person(1.7, 0.1, 0.0, 0.0)}
    motion = perform(start, {"a": Task(settling("lying"), target=bed)}, {}, FPS, 0)
    head, hips = joint(motion, "a", "head")[-1], joint(motion, "a", "hips")[-1]
    assert head[1] - hips[1] > 0.5  # the head lies where the bed says
    assert 0.5 < hips[2] < 0.7
    assert min(joint(motion, "a", f"foot_{s}")[-1, 2] for s in "lr") > 0.5
    lying = {"a": Actor(start["a"].skeleton, motion.end_actors["a"])}
    up = perform(
        lying, {"a": Task(travelling(), path=np.array([[1.0, 0.0], [0.0, 0.1], [-2.0, 0.5]]))}, {}, FPS, 1
    )
    assert up.end_actors["a"].posture == "standing"
    assert np.allclose(up.end_actors["a"].position[:2], (-2.0, 0.5))
    assert joint(up, "a", "foot_l")[-1, 2] < 0.15


def test_a_jump_leaves_the_floor_and_lands_where_it_is_asked() -> None:
    jump = Jump("both", 0.4, 0.65, height=0.3, ahead=0.6, turn=np.pi / 2)
    leap = ActionClip("jump", (Variant("plain", 2.0, Timeline(jumps=(jump,))),))
    motion = perform({"a": person()}, {"a": Task(leap)}, {}, FPS, 0)
    soles = np.stack([joint(motion, "a", f"foot_{s}")[:, 2] for s in "lr"])
    assert soles.min(axis=0).max() > 0.3
    assert np.allclose(motion.end_actors["a"].position[:2], (0.6, 0.0), atol=1e-6)
    assert motion.end_actors["a"].heading == pytest.approx(np.pi / 2)
    assert sound(motion, "a", 1.7) == []


def test_steps_carry_the_body_along() -> None:
    steps = (FootMove("left", 0.1, 0.3, ahead=0.4), FootMove("right", 0.4, 0.6, ahead=0.4))
    walk = ActionClip("steps", (Variant("plain", 2.0, Timeline(steps=steps)),))
    motion = perform({"a": person()}, {"a": Task(walk)}, {}, FPS, 0)
    assert np.allclose(motion.end_actors["a"].position[:2], (0.4, 0.0), atol=1e-6)
    assert sound(motion, "a", 1.7) == []


@pytest.mark.parametrize("height", [1.2, 1.93])
def test_stairs_are_climbed_tread_by_tread(height: float) -> None:
    flight = Stairs((1.0, 0.0, 0.0), (3.24, 0.0, 1.53), 1.0, 9, (1.0, 0.0))
    path = np.array([[0.0, 0.0, 0.0], [0.9, 0.0, 0.0], [3.3, 0.0, 1.53], [4.2, 0.0, 1.53]])
    up = Task(travelling(), path=path, stairs=(flight,))
    motion = perform({"a": person(height)}, {"a": up}, {}, FPS, 0)
    end = motion.end_actors["a"]
    treads = np.unique(np.round(motion.touches["a"].ground[motion.touches["a"].planted] / flight.rise, 3))
    assert np.allclose(treads, np.round(treads), atol=0.15)
    assert len(np.unique(np.round(treads))) >= 8
    low = Actor(person(height).skeleton, end)
    down = perform({"a": low}, {"a": replace(up, path=path[::-1])}, {}, FPS, 1)
    assert down.end_actors["a"].position[2] == pytest.approx(0.0)
    assert sound(down, "a", height) == []
    assert end.position[2] == pytest.approx(path[-1, 2])
    hips = joint(motion, "a", "hips")[:, 2]
    assert hips[-1] - hips[0] == pytest.approx(path[-1, 2], abs=0.03)
    assert np.abs(np.diff(hips)).max() < 0.06
    assert sound(motion, "a", height) == []


@pytest.mark.parametrize(
    "gait",
    [
        "lift 9cm, crouch 12cm, lean 20deg, toes 50%",
        "limp 80%",
        "facing back",
        "facing left",
        "stiff 100%, bounce 3cm",
    ],
)
def test_feet_stay_planted_in_every_gait(gait: str) -> None:
    go = clip(f"action go {{\n target optional place\n gait {gait}\n}}")
    motion = perform({"a": person()}, {"a": Task(go, path=WAY)}, {}, FPS, 0)
    assert np.allclose(motion.end_actors["a"].position[:2], WAY[-1])
    assert sound(motion, "a", 1.7) == []


@pytest.mark.parametrize("travel", ["skip", "crawl"])
def test_skipping_and_crawling_get_there(travel: str) -> None:
    go = clip(f"action go {{\n target optional place\n travel {travel}\n}}")
    motion = perform({"a": person()}, {"a": Task(go, path=WAY)}, {}, FPS, 0)
    assert np.linalg.norm(np.array(motion.end_actors["a"].position[:2]) - WAY[-1]) < 0.05
    assert motion.end_actors["a"].posture == ("fours" if travel == "crawl" else "standing")
    assert sound(motion, "a", 1.7) == []


@pytest.mark.parametrize(("one", "other"), [(1.93, 1.55), (1.55, 1.93), (1.7, 1.7)])
def test_two_people_hold_each_other_and_step_apart(one: float, other: float) -> None:
    hug = clip(
        """action hug {
            target required character
            faces target
            apart 38cm
            duration 3s
            reach left partner waist, from 5%, at 35%, until 75%, back 100%
            reach right partner shoulder, from 5%, at 35%, until 75%, back 100%
            partner { reach left partner shoulder, from 8%, at 38%, until 75%, back 100% }
        }"""
    )
    actors = {"a": person(one), "b": person(other, 1.4, 0.1, 2.9)}
    motion = perform(actors, {"a": Task(hug, target=at(1.4, 0.1, 0.93 * other, character="b"))}, {}, FPS, 0)
    apart = np.linalg.norm(motion.position["a"] - motion.position["b"], axis=1)
    assert apart.min() < 0.5
    assert apart[-1] > 0.6
    touched = [motion.touches[n].hands.max() for n in "ab"]
    assert min(touched) > 0.99
    for name, height in (("a", one), ("b", other)):
        assert [v for v in sound(motion, name, height) if "hand" in v or "slides" in v] == []


def test_hands_clasp_at_one_point_and_shake_together() -> None:
    shake = clip(
        """action shake {
            target required character
            apart 75cm
            duration 2s
            reach right clasp, from 5%, at 30%, until 80%, back 100%, shake 4cm, times 3
            partner { reach right clasp, from 5%, at 30%, until 80%, back 100%, shake 4cm, times 3 }
        }"""
    )
    actors = {"a": person(1.8), "b": person(1.6, 0.9, 0.0, np.pi)}
    motion = perform(actors, {"a": Task(shake, target=at(0.9, 0.0, 1.5, character="b"))}, {}, FPS, 0)
    a, b = (motion.touches[n] for n in "ab")
    held = (a.hands[1] > 0.99) & (b.hands[1] > 0.99)
    assert held.sum() > 10
    assert np.linalg.norm(a.palms[1] - b.palms[1], axis=1)[held].max() < 0.02
    assert np.ptp(a.palms[1][held, 2]) > 0.05


def test_a_pose_that_is_held_goes_on_until_one_goes() -> None:
    lean = clip("action lean { duration 1s\n at 60% { body lean 30deg }\n hold }")
    first = perform({"a": person()}, {"a": Task(lean)}, {}, FPS, 0)
    leaning = {"a": Actor(person().skeleton, first.end_actors["a"])}
    for task in ({}, {"a": Task(clip("action nod { duration 1s\n at 50% { head nod 10deg } }"))}):
        idle = perform(leaning, task, {}, FPS, 1)
        assert np.abs(joint(idle, "a", "neck")[[0, -1], 0] - joint(first, "a", "neck")[-1, 0]).max() < 0.06
    gone = perform(leaning, {"a": Task(travelling(), path=WAY)}, {}, FPS, 2)
    assert gone.end_actors["a"].kept is None
    assert abs(joint(gone, "a", "neck")[-1, 0] - joint(gone, "a", "hips")[-1, 0]) < 0.06


@pytest.mark.parametrize("manner", ["drunk", "sadly", "stealthily", "briskly", "proudly", "nervously"])
def test_manners_change_how_one_walks_but_not_where_feet_stand(manner: str) -> None:
    plain = perform({"a": person()}, {"a": Task(travelling(), path=WAY)}, {}, FPS, 0)
    done = perform({"a": person()}, {"a": Task(travelling(), path=WAY, manner=manner)}, {}, FPS, 0)
    assert sound(done, "a", 1.7) == []
    assert np.allclose(done.end_actors["a"].position[:2], WAY[-1])
    head = [joint(m, "a", "head")[m.frames // 2, 2] for m in (plain, done)]
    leans = [(joint(m, "a", "neck") - joint(m, "a", "hips"))[m.frames // 2, 0] for m in (plain, done)]
    assert abs(done.frames - plain.frames) > 4 or abs(head[0] - head[1]) > 0.02 or leans[1] < leans[0] - 0.02


def test_a_drunk_swerves_and_a_sad_wave_is_small() -> None:
    path = np.array([[0.0, 0.0], [5.0, 0.0]])
    drunk = perform({"a": person()}, {"a": Task(travelling(), path=path, manner="drunk")}, {}, FPS, 0)
    assert 0.03 < np.abs(drunk.position["a"][:, 1]).max() < 0.3
    wave = clip("action wave { duration 2s\n at 40% { arm right swing 60deg, out 60deg, bend 90deg } }")
    high = [
        joint(perform({"a": person()}, {"a": Task(wave, manner=m)}, {}, FPS, 0), "a", "hand_r")[:, 2].max()
        for m in ("", "sadly")
    ]
    assert high[1] < high[0] - 0.1


def test_gaze_rests_on_its_target_from_every_posture() -> None:
    look = clip("action look { target optional place\n travel none\n duration 2.5s\n gaze target }")
    for posture in ("standing", "kneeling", "floor", "lying"):
        state = ActorState((0.0, 0.0, 0.0), 0.0, posture)
        actor = replace(person(), state=state)
        point = at(1.6, 0.7, 1.4) if posture != "lying" else at(0.4, 0.9, 1.3)
        motion = perform({"a": actor}, {"a": Task(look, target=point)}, {}, FPS, 0)
        assert motion.touches["a"].gaze.max() > 0.98
        assert [v for v in sound(motion, "a", 1.7) if "eyes" in v] == [], posture


def test_one_leans_over_the_feet_on_the_way_to_the_floor() -> None:
    down = perform({"a": person()}, {"a": Task(settling("floor"))}, {}, FPS, 0)
    hips, neck = joint(down, "a", "hips"), joint(down, "a", "neck")
    middle = int(np.argmin(np.abs(hips[:, 2] - 0.5 * (hips[0, 2] + hips[-1, 2]))))
    assert neck[middle, 0] - hips[middle, 0] > 0.12


def test_a_head_turned_on_a_bowed_trunk_stays_upright() -> None:
    bowed = clip("action peer { duration 2s; at 50% { body lean 35deg; head turn 65deg }; hold }")
    motion = perform({"a": person()}, {"a": Task(bowed)}, {}, FPS, 0)
    head = motion.world_from_joint["a"][-1, JOINT["head"], :3, :3].astype(float)
    assert abs(np.degrees(np.arctan2(head[1, 0], head[0, 0]))) > 45.0  # it is turned
    assert abs(np.degrees(np.arcsin(head[2, 1]))) < 12.0  # both eyes as high


def test_who_crawls_around_a_bend_keeps_hands_planted() -> None:
    bend = np.array([[0.0, 0.0], [0.8, 0.0], [1.0, 0.7], [0.6, 1.3], [-0.2, 1.4]])
    crawl = replace(travelling("crawl"), posture="fours")
    for height in (1.52, 1.93):
        motion = perform({"a": person(height)}, {"a": Task(crawl, path=bend)}, {}, FPS, 0)
        assert [v for v in sound(motion, "a", height) if "hand" in v] == []


def test_written_travel_leads_to_the_target() -> None:
    assert clip("action near { target required place; travel walk; duration 1s }").goes
    assert not clip("action far { target required place; duration 1s }").goes
    assert not clip("action here { target required place; travel none; duration 1s }").goes
