"""Actions from text to clips; every action of the library on every posture, by short and tall people."""

from __future__ import annotations

import numpy as np
import pytest
from motion.library import clips, definitions
from motion.scenes import FPS, angular_steps, at, joint, person, thing

from runtime.motion.perform import perform
from runtime.motion.types import Actor, SceneMotion, Task
from vdsl.lang.codes import CODES
from vdsl.lang.definitions.action import ActionDef, read_action
from vdsl.lang.diagnostics import Report
from vdsl.lang.parse import parse_definition
from vdsl.lang.source import Source
from vdsl.library import Catalog
from vdsl.pipeline.script import check_source
from vdsl.stage.actions import build_clip

WANTED = (
    "walk",
    "run",
    "sit",
    "stand-up",
    "wave",
    "talk",
    "greet",
    "pick-up",
    "put-down",
    "pour",
    "drink",
    "give",
    "point",
    "look",
    "nod",
    "shake-head",
    "think",
    "laugh",
    "listen",
    "lean",
    "type",
    "phone",
    "call",
    "open",
    "shrug",
    "cheer",
    "turn",
)


def read(text: str) -> tuple[ActionDef | None, Report]:
    report = Report()
    name = text.split()[1]
    definition = parse_definition(Source("test.vds", text), "action", name, report)
    assert definition is not None
    return read_action(definition, report), report


def codes(report: Report) -> list[str]:
    return [d.code for d in report.diagnostics]


# --- the text ---------------------------------------------------------------------------------


def test_an_action_reads_into_keys_and_moves() -> None:
    action, report = read(
        """action salute {
            target optional character
            faces target
            duration 2s
            gaze target, from 0%, to 90%
            at 25% { arm right swing 60deg, bend 120deg; head nod -5deg }
            at 1.5s { arm right rest }
            reach left hip, from 10%, at 30%, until 80%, back 100%, out 2cm
            beat head turn 4deg, times 2, from 20%, to 60%
            variant big { amplitude 150%; tempo 50% }
            variant left { mirror }
        }"""
    )
    assert codes(report) == []
    assert action is not None
    assert (action.target, action.target_kinds, action.second) == ("optional", ("character",), "none")
    assert [v.name for v in action.variants] == ["plain", "big", "left"]
    plain, big, left = action.variants
    value = {(k.channel, round(k.time, 3)): k.value for k in plain.part.keys}
    assert value[("arm_right.swing", 0.25)] == pytest.approx(np.radians(60))
    assert value[("arm_right.weight", 0.25)] == 1.0
    assert value[("arm_right.weight", 0.75)] == 0.0
    assert big.duration == pytest.approx(4.0)
    bigger = {(k.channel, round(k.time, 3)): k.value for k in big.part.keys}
    assert bigger[("head.nod", 0.25)] == pytest.approx(1.5 * np.radians(-5))
    assert {k.channel.split(".")[0] for k in left.part.keys} == {"arm_left", "head"}
    assert next(m for m in left.part.moves if m.kind == "reach").words[0] == "right"
    clip = build_clip(action)
    reach = clip.variants[0].timeline.reaches[0]
    assert (reach.start, reach.arrive, reach.leave, reach.end) == pytest.approx((0.1, 0.3, 0.8, 1.0))
    assert reach.offset == pytest.approx((0.0, 0.02, 0.0))


def test_an_action_says_how_one_goes_what_it_needs_and_how_it_ends() -> None:
    action, report = read(
        """action stumble {
            group going
            feeling afraid
            posture kneeling, in 1.2s, back
            apart 45cm
            travel crawl
            gait lift 8cm, lean 10deg, facing back
            example "anna stumble to jug", with jug glass
            duration 2s
            reach right partner shoulder, from 10%, at 30%, until 60%, back 100%, shake 3cm, times 4
            step left, ahead 30cm, turn 10deg, from 10%, to 30%
            jump 20cm, ahead 50cm, on right, from 40%, to 60%
            drive target 80%, from 30%, to 60%
            variant limping { mirror; gait limp 40% }
        }"""
    )
    assert codes(report) == []
    assert action is not None
    assert (action.group, action.feeling, action.posture, action.rises) == (
        "going",
        "afraid",
        "kneeling",
        True,
    )
    assert (action.apart, action.posture_time, action.travel) == (0.45, 1.2, "crawl")
    assert action.example == "anna stumble to jug"
    assert action.props == ("jug", "glass")
    clip = build_clip(action)
    plain, limping = clip.variants
    assert (plain.gait.lift, plain.gait.facing, plain.gait.limp) == (0.08, "back", 0.0)
    assert (limping.gait.lift, limping.gait.limp) == (0.08, 0.4)
    assert plain.timeline.reaches[0].to == "partner.shoulder"
    assert plain.timeline.reaches[0].shake == pytest.approx(0.03)
    (step,), (mirrored,) = plain.timeline.steps, limping.timeline.steps
    assert (step.foot, mirrored.foot, mirrored.turn) == ("left", "right", -step.turn)
    assert plain.timeline.jumps[0].feet == "right"
    assert plain.timeline.drives[0].openness == pytest.approx(0.8)


@pytest.mark.parametrize(
    ("body", "code"),
    [
        ("duration 2s\n wink 3", "VDS033"),
        ("duration 2s\n at 40% { tail wag 20deg }", "VDS033"),
        ("duration 2s\n at 40% { arm right swong 20deg }", "VDS026"),
        ("duration 2s\n at 40% { arm right swing 20 }", "VDS020"),
        ("duration 2s\n at 40 { head nod 5deg }", "VDS142"),
        ("duration 2s\n at 2.5s { head nod 5deg }", "VDS143"),
        ("at 40% { head nod 5deg }", "VDS141"),
        ("duration 2s\n reach right mouth, from 50%, at 20%", "VDS144"),
        ("duration 2s\n reach right nose, from 50%", "VDS026"),
        ("duration 2s\n gaze target, form 50%", "VDS030"),
        ("duration 2s\n variant big { amplitude 120%; size 3 }", "VDS033"),
        ("duration 2s\n target maybe", "VDS026"),
        ("duration 2s\n posture upside-down", "VDS026"),
        ("duration 2s\n gait wobble 3cm", "VDS026"),
        ("duration 2s\n group music-hall", "VDS026"),
        ("duration 2s\n feeling bored", "VDS026"),
        ("duration 2s\n step both, ahead 30cm", "VDS026"),
        ("duration 2s\n reach right partner nose", "VDS026"),
    ],
)
def test_mistakes_are_reported_with_a_code_that_is_explained(body: str, code: str) -> None:
    _, report = read(f"action try {{\n {body}\n}}")
    assert code in codes(report)
    assert set(codes(report)) <= set(CODES)


# --- the library ------------------------------------------------------------------------------


def test_the_library_has_the_actions_and_several_ways_to_do_each() -> None:
    assert set(WANTED) <= set(clips())
    for name, clip in clips().items():
        assert len(clip.variants) >= 3, name
        assert len({v.name for v in clip.variants}) == len(clip.variants), name


def act(name: str, variant: str, height: float, posture: str, seed: int = 0) -> tuple[SceneMotion, Task]:
    definition, clip = definitions()[name], clips()[name]
    state = {"posture": "sitting", "seat": (0.0, 0.0, 0.45)} if posture == "sitting" else {}
    actors: dict[str, Actor] = {"a": person(height, **state), "b": person(1.75, 1.0, 0.2, 3.0)}
    props = {7: thing(0.45, -0.1, 0.74), 8: thing(0.42, 0.15, 0.74, 0.1)}
    target = None
    if definition.target != "none":
        cup, place = at(0.45, -0.1, 0.79, object=7), at(0.45, -0.25, 0.78)
        kinds = definition.target_kinds
        target = cup if "object" in kinds else place if "place" in kinds else at(1.0, 0.2, 1.3, character="b")
        if clip.seat == "down":
            target = at(-0.6, 0.2, 0.45, facing=0.4, seat=(-0.6, 0.2, 0.45))
    second = at(1.0, 0.2, 1.3, character="b") if "character" in definition.second_kinds else None
    if clip.needs == "second":
        second = at(0.42, 0.15, 0.84, object=8)
    path = np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 1.0]]) if name in ("walk", "run") else None
    task = Task(clip, variant, path=path, target=target, second=second)
    return perform(actors, {"a": task}, props, FPS, seed), task


@pytest.mark.parametrize("name", WANTED)
@pytest.mark.parametrize(("height", "posture"), [(1.52, "standing"), (1.95, "sitting")])
def test_every_action_is_sound(name: str, height: float, posture: str) -> None:
    for variant in clips()[name].variants:
        motion, task = act(name, variant.name, height, posture)
        world = motion.world_from_joint["a"]
        assert np.isfinite(world).all()
        linear = world[..., :3, :3].astype(np.float64)
        assert np.allclose(linear @ np.swapaxes(linear, -1, -2), np.eye(3), atol=1e-4)
        assert motion.frames >= 12
        steps = angular_steps(motion, "a")
        assert steps.max() < 1.0, (variant.name, np.unravel_index(steps.argmax(), steps.shape))
        hips = joint(motion, "a", "hips")
        assert np.linalg.norm(np.diff(hips, axis=0), axis=1).max() < 0.25
        for s in "lr":
            assert joint(motion, "a", f"foot_{s}")[:, 2].min() > 0.02 * height
        expected = "sitting" if task.clip.seat == "down" else posture
        if task.clip.seat == "up" or name in ("walk", "run"):
            expected = "standing"
        assert motion.end_actors["a"].posture == expected


@pytest.mark.parametrize("name", ["wave", "talk", "cheer", "point", "shrug"])
def test_variants_differ(name: str) -> None:
    shapes = []
    for variant in clips()[name].variants:
        motion, _ = act(name, variant.name, 1.7, "standing")
        hands = [joint(motion, "a", f"hand_{s}") for s in "lr"]
        shapes.append(np.concatenate([h[np.linspace(0, len(h) - 1, 12).astype(int)] for h in hands]))
    apart = [np.abs(a - b).max() for i, a in enumerate(shapes) for b in shapes[:i]]
    assert min(apart) > 0.03


def test_a_wave_is_a_wave() -> None:
    motion, _ = act("wave", "plain", 1.7, "standing")
    hand, shoulder = joint(motion, "a", "hand_r"), joint(motion, "a", "upperarm_r")
    up = hand[:, 2] > shoulder[:, 2] + 0.05
    assert up.mean() > 0.35
    side = hand[up, 1] - hand[up, 1].mean()
    assert (np.diff(np.sign(side)) != 0).sum() >= 3
    assert joint(motion, "a", "hand_l")[:, 2].max() < shoulder[:, 2].min()


def test_hanging_arms_keep_clear_of_the_body() -> None:
    motion = perform({"a": person()}, {}, {}, FPS, 3, duration=4.0)
    for s, m in (("l", 1.0), ("r", -1.0)):
        hand, hip = joint(motion, "a", f"hand_{s}"), joint(motion, "a", f"thigh_{s}")
        assert (m * (hand - hip)[:, 1]).min() > 0.09
    assert angular_steps(motion, "a").max() < 0.2


def _lines(*lines: str, own: str = "") -> list[str]:
    """The actions that story lines name, by the library and definitions of the script's own."""
    head = (
        'storyboard "S"\n'
        + own
        + "character anna = woman\ncharacter ben = man\nscene s = apartment.kitchen\n"
    )
    text = head + "anna at door\nben at window\n" + "\n".join(lines) + "\n"
    checked = check_source(Source("s.vds", text))
    return [line.beats[0].action for line in checked.storyboard.lines]


def test_actions_are_said_by_other_words_and_in_the_third_person() -> None:
    found = _lines(
        "(anna walks counter)", "(anna grabs the cup)", "(anna hands cup to ben)", "(ben carries cup)",
        "(ben stands up)", "(anna yells at ben)", "(ben exits)", "(anna kisses ben)",
    )  # fmt: skip
    assert found == ["walk", "pick-up", "give", "carry", "stand-up", "shout", "leave", "kiss"]


def test_of_two_readings_the_one_with_what_it_needs_is_taken() -> None:
    """`serve ball` is to serve the ball, not the stroke `serve-ball` with nothing to strike."""
    own = "action serve-cup { target required object\n duration 1s\n at 50% { hips drop 4cm } }\n"
    assert _lines("(anna serve cup)", "(anna serve-cup cup)", own=own) == ["serve", "serve-cup"]
    assert _lines("(anna picks up the cup)", "(anna look back)") == ["pick-up", "look-back"]
    assert _lines("(anna shake hands)") == ["shake-hands"], "and not to tremble at hands"


def test_a_name_is_never_another_word_for_something_else() -> None:
    catalog = Catalog()
    names, other = set(catalog.names("action")), catalog.synonyms("action")
    said = [word for a in definitions().values() for word in a.also]
    assert len(said) == len(set(said)), "one word for two actions"
    assert not set(said) & names
    assert other == {word: name for name, a in definitions().items() for word in a.also}
    assert {"take": "pick-up", "exit": "leave", "applaud": "clap", "flee": "run"}.items() <= other.items()


def test_an_action_of_ones_own_has_other_words_too_and_goes_first() -> None:
    own = "action hop-about { also bounce grab\n duration 1s\n at 50% { hips drop 4cm } }\n"
    found = _lines("(anna bounces)", "(anna grab)", own=own)
    assert found == ["hop-about", "hop-about"]
    mine = "action grab { duration 1s\n at 50% { hips drop 4cm } }\n"
    assert _lines("(anna grabs)", own=mine) == ["grab"]
