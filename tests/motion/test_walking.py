"""Walking, running, turning: feet stay where they are planted, the way ends where it should."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.motion.perform import perform
from runtime.motion.types import SceneMotion, Task

from .scenes import FPS, angular_steps, joint, person, random_path, skeleton, sole_points, travelling


def walk(height: float, seed: int, how: str, steps: int = 3, heading: float | None = None) -> SceneMotion:
    path = random_path(np.random.default_rng(seed), steps)
    task = Task(travelling(how), path=path, arrive_heading=heading)
    return perform({"a": person(height)}, {"a": task}, {}, FPS, seed)


def slides(motion: SceneMotion, height: float) -> tuple[float, float]:
    """The largest slide of a sole point that is on the floor in two frames running, and the deepest dip."""
    body = skeleton(height, 8.0 if height < 1.4 else 32.0)
    worst, deepest = 0.0, 0.0
    for side in "lr":
        points = sole_points(motion, "a", body, side)
        low = points[..., 2] < 0.001
        both = low[:-1] & low[1:]
        moved = np.linalg.norm(np.diff(points[..., :2], axis=0), axis=-1)
        worst = max(worst, float((moved * both).max()))
        deepest = min(deepest, float(points[..., 2].min()))
    return worst, deepest


@settings(max_examples=25, deadline=None, derandomize=True)
@given(seed=st.integers(0, 10_000), height=st.sampled_from([1.2, 1.55, 1.7, 1.95]), steps=st.integers(1, 4))
def test_planted_feet_do_not_slide_or_sink(seed: int, height: float, steps: int) -> None:
    slide, dip = slides(walk(height, seed, "walk", steps), height)
    assert slide < 0.002
    assert dip > -0.004


@pytest.mark.parametrize("seed", range(4))
def test_running_feet_do_not_slide_either(seed: int) -> None:
    motion = walk(1.7, seed, "run")
    slide, dip = slides(motion, 1.7)
    assert slide < 0.003
    assert dip > -0.004


def test_running_has_flight_and_walking_has_none() -> None:
    def lowest(how: str) -> float:
        path = np.array([[0.0, 0.0], [6.0, 0.0]])
        motion = perform({"a": person()}, {"a": Task(travelling(how), path=path)}, {}, FPS, 0)
        soles = np.concatenate([sole_points(motion, "a", skeleton(), s)[..., 2] for s in "lr"], axis=1)
        return float(soles.min(axis=1).max())

    assert lowest("run") > 0.02
    assert lowest("walk") < 0.004


@settings(max_examples=15, deadline=None, derandomize=True)
@given(seed=st.integers(0, 10_000), heading=st.floats(-3.1, 3.1))
def test_arrives_on_the_spot_with_the_asked_heading(seed: int, heading: float) -> None:
    path = random_path(np.random.default_rng(seed), 3)
    task = Task(travelling(), path=path, arrive_heading=heading)
    motion = perform({"a": person()}, {"a": task}, {}, FPS, seed)
    end = motion.end_actors["a"]
    assert np.allclose(end.position[:2], path[-1], atol=1e-6)
    assert abs(np.angle(np.exp(1j * (end.heading - heading)))) < 1e-4
    feet = 0.5 * (joint(motion, "a", "foot_l") + joint(motion, "a", "foot_r"))[-1, :2]
    assert np.linalg.norm(feet - path[-1]) < 0.03
    facing = motion.world_from_joint["a"][-1, 0, :2, 0]
    assert abs(np.angle(np.exp(1j * (np.arctan2(facing[1], facing[0]) - heading)))) < 0.2


def test_a_longer_way_takes_longer_and_haste_shortens_it() -> None:
    def frames(length: float, speed: float, how: str = "walk") -> int:
        path = np.array([[0.0, 0.0], [length, 0.0]])
        task = Task(travelling(how), path=path, speed=speed)
        return perform({"a": person()}, {"a": task}, {}, FPS, 0).frames

    assert frames(2, 1) < frames(4, 1) < frames(8, 1)
    assert frames(4, 1.5) < frames(4, 1)
    assert frames(4, 1, "run") < frames(4, 1)
    assert 1.0 < 6.0 / ((frames(10, 1) - frames(4, 1)) / FPS) < 1.6  # an ordinary pace, m/s


def test_turning_round_is_done_in_steps() -> None:
    motion = perform({"a": person()}, {"a": Task(travelling(), arrive_heading=np.pi)}, {}, FPS, 0)
    assert motion.end_actors["a"].heading == pytest.approx(np.pi)
    left = joint(motion, "a", "foot_l")
    assert left[:, 2].max() > left[0, 2] + 0.01
    assert slides(motion, 1.7)[0] < 0.002


@pytest.mark.parametrize("how", ["walk", "run"])
@pytest.mark.parametrize("height", [1.2, 1.7, 1.95])
def test_motion_is_smooth(how: str, height: float) -> None:
    motion = walk(height, 3, how)
    limit = 0.6 if how == "walk" else 0.85
    steps = angular_steps(motion, "a")
    assert steps.max() < limit
    hips = joint(motion, "a", "hips")
    jerk = np.abs(np.diff(hips, 2, axis=0)).max() * FPS * FPS
    assert jerk < (14 if how == "walk" else 30)  # m/s²


@pytest.mark.parametrize("how", ["walk", "run"])
def test_knees_bend_forward_and_elbows_back(how: str) -> None:
    task = Task(travelling(how), path=np.array([[0, 0], [5.0, 0]]))
    motion = perform({"a": person()}, {"a": task}, {}, FPS, 1)
    for s in "lr":
        hip, knee, ankle = (joint(motion, "a", f"{n}_{s}") for n in ("thigh", "shin", "foot"))
        line = hip + (ankle - hip) * 0.5
        assert ((knee - line)[:, 0] > -0.005).all()
        shoulder, elbow, wrist = (joint(motion, "a", f"{n}_{s}") for n in ("upperarm", "forearm", "hand"))
        bend = np.cross(elbow - shoulder, wrist - elbow)
        assert (bend[:, 1] < 0.004).all()  # flexes forward: about -Y while heading +X


def test_nobody_walks_in_step() -> None:
    way = np.array([[0.0, 0.0], [5.0, 0.0]])
    tasks = {n: Task(travelling(), path=way + np.array([0, k])) for k, n in enumerate(("a", "b"))}
    actors = {"a": person(), "b": person(y=1.0)}
    motion = perform(actors, tasks, {}, FPS, 0)
    lead = [joint(motion, n, "foot_l")[:, 0] - joint(motion, n, "foot_r")[:, 0] for n in ("a", "b")]
    assert np.abs(lead[0] - lead[1]).max() > 0.15


def test_the_same_seed_gives_the_same_motion_and_another_another() -> None:
    one, two, other = (walk(1.7, s, "walk") for s in (5, 5, 6))
    assert np.array_equal(one.world_from_joint["a"], two.world_from_joint["a"])
    assert one.frames != other.frames or not np.allclose(
        one.world_from_joint["a"], other.world_from_joint["a"]
    )
