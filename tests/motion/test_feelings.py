"""Feelings on faces and bodies: each different from the others, on everybody, and while talking too."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray

from runtime.body.build import make_body
from runtime.body.proportions import make_skeleton
from runtime.body.skeleton import JOINT, skinning_matrices
from runtime.body.spec import BodySpec
from runtime.motion.feelings import FEELINGS
from runtime.motion.perform import perform
from runtime.motion.timeline import Talk, Timeline
from runtime.motion.types import ActionClip, Actor, ActorState, SceneMotion, Task, Variant

FACES = {
    "child": BodySpec(height=1.2, age=7.0, femininity=1.0, hair="ponytail"),
    "woman": BodySpec(height=1.68, femininity=1.0, hair="bob"),
    "bearded": BodySpec(height=1.8, femininity=0.0, facial_hair="beard"),
}


def felt(spec: BodySpec, word: str, clip: ActionClip | None = None) -> SceneMotion:
    """One second of somebody who feels so."""
    actor = Actor(make_skeleton(spec), ActorState((0.0, 0.0, 0.0), 0.0))
    tasks = {} if clip is None else {"anna": Task(clip, duration=2.0)}
    return perform({"anna": actor}, tasks, {}, 12.0, 3, 2.0, feelings={"anna": word})


def face(spec: BodySpec, motion: SceneMotion, frame: int = 12) -> NDArray[np.float64]:
    """The face's vertices against the head, metres."""
    body = make_body(spec)
    mesh = body.mesh
    world = motion.world_from_joint["anna"][frame : frame + 1].astype(float)
    matrices = skinning_matrices(body.skeleton, world)[0].astype(float)
    head = body.skeleton.bind[JOINT["head"]]
    of_face = (mesh.vertices[:, 2] > head[2] - 0.04) & (mesh.vertices[:, 0] > 0.04)
    points = np.concatenate([mesh.vertices[of_face], np.ones((of_face.sum(), 1))], axis=1)
    each = np.einsum("vkab,vb->vka", matrices[body.joints[of_face]], points)
    posed = np.einsum("vka,vk->va", each, body.weights[of_face].astype(float))
    frame_of_head = matrices[JOINT["head"]]
    return np.asarray((posed - frame_of_head[:, 3]) @ frame_of_head[:, :3])


@pytest.mark.parametrize("who", sorted(FACES))
def test_every_feeling_is_a_face_of_its_own(who: str) -> None:
    spec = FACES[who]
    faces = {word: face(spec, felt(spec, word)) for word in FEELINGS}
    for a, b in itertools.combinations(FEELINGS, 2):
        apart = np.linalg.norm(faces[a] - faces[b], axis=1)
        assert apart.max() > 0.018 * spec.height / 7.0, (a, b)  # a fiftieth of the head
        assert (apart > 0.001).sum() > 40, (a, b)


def turn_of(motion: SceneMotion, joint: str, parent: str) -> NDArray[np.float64]:
    """Turn about Y of a joint against its parent, [T]: positive lowers what is in front."""
    world = motion.world_from_joint["anna"][..., :3, :3].astype(float)
    local = np.swapaxes(world[:, JOINT[parent]], -1, -2) @ world[:, JOINT[joint]]
    return np.asarray(np.arctan2(local[:, 0, 2], local[:, 0, 0]))


def test_features_go_the_way_they_should() -> None:
    spec = FACES["woman"]
    motions = {word: felt(spec, word) for word in FEELINGS}

    def mean(word: str, joint: str, parent: str = "head") -> float:
        return float(turn_of(motions[word], joint, parent).mean())

    assert mean("happy", "mouth_l") < -0.1 < 0.1 < mean("sad", "mouth_l")
    assert mean("angry", "brow_l") > 0.03
    assert mean("surprised", "brow_l") < -0.1
    assert mean("sad", "browin_l", "brow_l") < -0.08 < 0.08 < mean("angry", "browin_l", "brow_l")
    assert mean("surprised", "jaw") > 0.15
    assert mean("disgusted", "lip") < -0.1
    assert mean("happy", "underlid_l") < -0.2
    assert mean("afraid", "lid_l") < mean("neutral", "lid_l") < mean("sad", "lid_l")


def test_feelings_show_in_the_bearing() -> None:
    spec = FACES["bearded"]
    motions = {word: felt(spec, word).world_from_joint["anna"] for word in ("neutral", "sad", "afraid")}
    nod = {w: turn_of(felt(spec, w), "head", "chest").mean() for w in motions}
    assert nod["sad"] > nod["neutral"] + 0.05
    high = {
        w: (m[:, JOINT["upperarm_l"], 2, 3] - m[:, JOINT["chest"], 2, 3]).mean() for w, m in motions.items()
    }
    assert high["afraid"] > high["neutral"] + 0.01


def test_talking_goes_on_under_every_feeling() -> None:
    spec = FACES["woman"]
    talk = ActionClip("say", (Variant("plain", 1.6, Timeline(talks=(Talk(0.0, 1.0),))),))
    for word in FEELINGS:
        jaw = turn_of(felt(spec, word, talk), "jaw", "head")
        assert np.ptp(jaw) > 0.05, word


def test_an_action_brings_its_own_feeling_and_the_lines_wins() -> None:
    spec = FACES["woman"]
    sob = ActionClip("sob", (Variant("plain", 1.6, Timeline()),), feeling="sad")
    actor = {"anna": Actor(make_skeleton(spec), ActorState((0.0, 0.0, 0.0), 0.0))}
    own = perform(actor, {"anna": Task(sob)}, {}, 12.0, 3, 2.0)
    lines = perform(actor, {"anna": Task(sob)}, {}, 12.0, 3, 2.0, feelings={"anna": "happy"})
    middle = own.frames // 2
    assert turn_of(own, "mouth_l", "head")[middle] > 0.08
    assert turn_of(lines, "mouth_l", "head")[middle] < -0.08


def test_a_manner_shows_on_the_face_unless_the_line_feels_otherwise() -> None:
    spec = FACES["woman"]
    clip = ActionClip("stay", (Variant("plain", 2.0, Timeline()),), "none", feeling="happy")

    def shown(manner: str, word: str = "") -> NDArray[np.float64]:
        actor = Actor(make_skeleton(spec), ActorState((0.0, 0.0, 0.0), 0.0))
        tasks = {"anna": Task(clip, duration=2.0, manner=manner)}
        feelings = {"anna": word} if word else {}
        return face(spec, perform({"anna": actor}, tasks, {}, 12.0, 3, 2.0, feelings=feelings))

    angrily = shown("angrily")
    assert np.linalg.norm(angrily - shown(""), axis=1).max() > 0.002  # not as the action has it
    assert np.linalg.norm(angrily - shown("angrily", "sad"), axis=1).max() > 0.002
    assert np.allclose(angrily, shown("angrily", "angry"), atol=1e-4)
