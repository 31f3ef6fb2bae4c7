"""A person's pose over all frames: torso by angles, limbs by inverse kinematics, face by small turns.

Called in the order of the class: :meth:`Figure.torso`, :meth:`Figure.head`, :meth:`Figure.legs`,
:meth:`Figure.arms`, :meth:`Figure.hands`, :meth:`Figure.face`. Left and right are axis 0 of limb arrays.
Angles are radians, positions metres in the world.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, JOINTS, PARENTS, Skeleton

from .hands import MIRROR, Hands
from .ik import bind_frame, bone_rotation, two_bone
from .rotations import (
    blend,
    cross,
    dot,
    norm,
    quaternion,
    rot_x,
    rot_y,
    rot_z,
    rot_zy,
    rot_zyx,
    rotation,
    rotation_vector,
    steady,
    turned,
    unit,
    wrap,
)

Array = NDArray[np.float64]
SIDES = ("l", "r")


def _joints(*names: str) -> list[int]:
    """Joints of the left side, then of the right."""
    return [JOINT[f"{name}_{s}"] for s in SIDES for name in names]


#: Limbs of both sides, left first, and which way they flex in the bind pose.
_THIGHS, _SHINS, _FEET = _joints("thigh"), _joints("shin"), _joints("foot")
_UPPERARMS, _FOREARMS, _HANDS = _joints("upperarm"), _joints("forearm"), _joints("hand")
_BACK, _FRONT = np.array([-1.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0])
#: Joints that are posed together, each of them by its parent.
_KNUCKLES, _MIDDLES, _INDEXTIPS = (
    _joints("fingers", "thumb"),
    _joints("fingertips", "index"),
    _joints("indextip"),
)
_FACE = [JOINT["jaw"], JOINT["lip"], *_joints("eye", "lid", "underlid", "brow", "mouth")]
_BROWS = _joints("browin")


@dataclass(frozen=True, eq=False)
class ArmPose:
    """Both arms by angles, each [2, T]; see :mod:`runtime.motion.channels`."""

    swing: Array
    out: Array
    twist: Array
    bend: Array
    wrist: Array
    side: Array
    turn: Array


@dataclass(frozen=True, eq=False)
class HandGoals:
    """Where palms are to be: position [2, T, 3] and weight [2, T]; rotation [2, T, 3, 3] and its weight.

    around: [2, T], 1 where the arm goes around somebody, with the elbow out
    """

    position: Array
    weight: Array
    rotation: Array
    turning: Array
    around: Array


@dataclass(frozen=True, eq=False)
class Mimic:
    """What a feeling adds to a face, each [T]: lids turned shut, radians; the others as in
    :class:`runtime.motion.feelings.Expression`."""

    lid: Array
    squint: Array
    inner: Array
    wide: Array
    sneer: Array


class Figure:
    """One person's joints over T frames."""

    def __init__(self, skeleton: Skeleton, frames: int) -> None:
        self.skeleton = skeleton
        self.frames = frames
        self.offsets = skeleton.offsets
        self.rotation = np.zeros((frames, len(JOINTS), 3, 3))
        self.position = np.zeros((frames, len(JOINTS), 3))
        bind = skeleton.bind
        self._upper = float(np.linalg.norm(bind[JOINT["forearm_l"]] - bind[JOINT["upperarm_l"]]))
        self._lower = float(np.linalg.norm(bind[JOINT["hand_l"]] - bind[JOINT["forearm_l"]]))
        self.arm_length = self._upper + self._lower
        self._thigh_frames = self._bind_frames(_THIGHS, _SHINS, _BACK)
        self._shin_frames = self._bind_frames(_SHINS, _FEET, _BACK)
        self._upperarm_frames = self._bind_frames(_UPPERARMS, _FOREARMS, _FRONT)
        self._forearm_frames = self._bind_frames(_FOREARMS, _HANDS, _FRONT)
        self.hands = Hands(skeleton)

    def _bind_frames(self, bones: list[int], ends: list[int], side: Array) -> Array:
        """[2, 1, 3, 3]: bind frames of bones of both sides."""
        bind = self.skeleton.bind
        return bind_frame(bind[ends] - bind[bones], side)[:, None]

    def turn(self, joint: str, local: Array) -> None:
        """Sets a joint by its local rotation [T, 3, 3]; its parent has to be set."""
        j = JOINT[joint]
        base = self.rotation[:, PARENTS[j]]
        self.rotation[:, j] = base @ local
        self.position[:, j] = self.position[:, PARENTS[j]] + base @ self.offsets[j]

    def _turn_all(self, joints: list[int], local: Array) -> None:
        """Sets several joints by their local rotations [T, N, 3, 3]; their parents have to be set."""
        parents = [PARENTS[j] for j in joints]
        base = self.rotation[:, parents]
        self.rotation[:, joints] = base @ local
        self.position[:, joints] = self.position[:, parents] + turned(base, self.offsets[joints])

    def _set(self, joints: list[int], position: Array, rotation: Array) -> None:
        """Sets a joint of both sides: position [2, T, 3], rotation [2, T, 3, 3]."""
        for k, j in enumerate(joints):
            self.position[:, j], self.rotation[:, j] = position[k], rotation[k]

    def _place(self, joint: str) -> Array:
        """Where a joint is by its parent [T, 3], before it is turned itself."""
        j = JOINT[joint]
        out: Array = self.position[:, PARENTS[j]] + self.rotation[:, PARENTS[j]] @ self.offsets[j]
        return out

    # -- torso and head ------------------------------------------------------------------

    def torso(
        self,
        root: Array,
        yaw: Array,
        pelvis: tuple[Array, Array, Array],
        bend: tuple[Array, Array, Array],
        shoulders: tuple[Array, Array],
    ) -> None:
        """Hips at ``root`` [T, 3]; pelvis: turn, pitch, roll [T]; bend: twist, lean, side of the whole spine
        [T]; shoulders: up and forward [2, T] of each clavicle."""
        turn, pitch, roll = pelvis
        self.rotation[:, 0] = rot_zyx(yaw + turn, pitch, roll)
        self.position[:, 0] = root
        twist, lean, side = bend
        self.turn("spine", rot_zyx(0.4 * twist, 0.5 * lean, -0.5 * side))
        self.turn("chest", rot_zyx(0.6 * twist, 0.5 * lean, -0.5 * side))
        up, forward = shoulders
        for k, s in enumerate(SIDES):
            m = 1.0 if s == "l" else -1.0
            self.turn(f"clavicle_{s}", rot_z(-m * forward[k]) @ rot_x(m * up[k]))

    def head(self, turn: Array, nod: Array, tilt: Array) -> None:
        """Neck and head share the angles [T]; tilt to the left is positive."""
        for joint, share in (("neck", 0.4), ("head", 0.6)):
            self.turn(joint, rot_zyx(share * turn, share * nod, -share * tilt))

    # -- limbs -----------------------------------------------------------------------------

    def hip_joints(self) -> Array:
        """[2, T, 3]"""
        return np.stack([self._place(f"thigh_{s}") for s in SIDES])

    def legs(
        self,
        ankle: Array,
        yaw: Array,
        pitch: Array,
        toes: Array,
        spread: Array,
        low: tuple[Array, Array] | None = None,
    ) -> None:
        """Ankles at ``ankle`` [2, T, 3]; feet turned by yaw and pitch (heel up) [2, T]; toes flex up [2, T];
        knees bulge along the feet, ``spread`` [2, T] more to the outside; with ``low``, a share [T] and
        directions weighted by it [2, T, 3], they point there instead."""
        bind = self.skeleton.bind
        root = self.hip_joints()
        thigh = float(np.linalg.norm(bind[JOINT["shin_l"]] - bind[JOINT["thigh_l"]]))
        shin = float(np.linalg.norm(bind[JOINT["foot_l"]] - bind[JOINT["shin_l"]]))
        knee_yaw = yaw + MIRROR * spread
        pole = np.stack([np.cos(knee_yaw), np.sin(knee_yaw), np.zeros_like(yaw)], axis=-1)
        pole[..., 2] += 0.25
        if low is not None:
            pole = pole * (1.0 - low[0])[:, None] + low[1]
        limb = two_bone(root, ankle, thigh, shin, pole, soft=False)
        self._set(_THIGHS, root, bone_rotation(limb.middle - root, limb.hinge, self._thigh_frames))
        self._set(_SHINS, limb.middle, bone_rotation(limb.end - limb.middle, limb.hinge, self._shin_frames))
        self._set(_FEET, limb.end, rot_zy(yaw, pitch))
        for k, s in enumerate(SIDES):
            self.turn(f"toe_{s}", rot_y(-toes[k]))

    def shoulders(self) -> Array:
        """[2, T, 3]"""
        return np.stack([self._place(f"upperarm_{s}") for s in SIDES])

    def arms(self, pose: ArmPose, goals: HandGoals, yaw: Array) -> Array:
        """Both arms by their angles, drawn to the goals by inverse kinematics; sets hands too.

        Returns the positions of the palms [2, T, 3].
        """
        root = self.shoulders()
        chest = self.rotation[:, JOINT["chest"]]
        down, forward = _arm_directions(pose)
        down, forward = (turned(chest[None], v) for v in (down, forward))
        lower = np.cos(pose.bend)[..., None] * down + np.sin(pose.bend)[..., None] * forward
        wrist_fk = root + down * self._upper + lower * self._lower
        pole_fk = -forward
        heading = rot_z(yaw)
        high = np.clip((goals.position[..., 2] - root[..., 2] + 0.09 * self.skeleton.height) / 0.25, 0.0, 1.0)
        natural = np.stack(
            [
                -0.12 - 0.18 * high + 0.4 * goals.around,
                MIRROR * (0.42 + 0.15 * high + 0.8 * goals.around),
                0.7 * goals.around - 1.0,
            ],
            axis=-1,
        )
        natural = turned(heading[None], natural)
        w = goals.weight[..., None]
        pole = unit((1 - w) * pole_fk + w * natural)
        fk_relative = self.hands.bent(pose.turn, pose.side, pose.wrist)
        offset, axis = self.hands.offset, self._forearm_frames[:, :, 0]
        goal_wrist = goals.position - turned(goals.rotation, offset)
        arc = turned(heading[None], np.stack([[[0.75, m * 0.45, 0.0]] for m in (1.0, -1.0)]))
        for turn in range(9 if goals.weight.any() else 1):
            way = goal_wrist - wrist_fk
            target = wrist_fk + w * way + (0.7 * w * (1 - w) * norm(way)[..., None]) * arc
            limb = two_bone(root, target, self._upper, self._lower, pole, fold=2.8)
            fore = bone_rotation(limb.end - limb.middle, limb.hinge, self._forearm_frames)
            relative = _wrists(fore, fk_relative, goals, axis)
            hand = fore @ relative
            wished = goals.position - turned(hand, offset)
            if turn >= 2 and (norm(limb.end - wished) * goals.weight).max() < 0.004:
                break
            goal_wrist = goal_wrist + (1.0 if turn < 3 else 0.5) * (wished - goal_wrist)  # may go to and fro
        else:  # the hand as it lies in the end is taken there
            way = (goals.position - turned(hand, offset)) - wrist_fk
            target = wrist_fk + w * way + (0.7 * w * (1 - w) * norm(way)[..., None]) * arc
            limb = two_bone(root, target, self._upper, self._lower, pole, fold=2.8)
            fore = bone_rotation(limb.end - limb.middle, limb.hinge, self._forearm_frames)
            relative = np.swapaxes(fore, -1, -2) @ hand
        swivel = dot(rotation_vector_twist(relative, axis), axis)
        upper = bone_rotation(limb.middle - root, limb.hinge, self._upperarm_frames)
        self._set(_UPPERARMS, root, upper)
        self._set(_FOREARMS, limb.middle, fore @ rotation(axis * (0.45 * swivel)[..., None]))
        self._set(_HANDS, limb.end, hand)
        palm: Array = limb.end + turned(hand, offset)
        return palm

    def fingers(self, curl: Array, point: Array, thumb: Array) -> None:
        """Fingers [2, T]: curl 0 straight .. 1 fist; point: the index stays straight; thumb curls 0..1,
        and stands off below 0."""
        first, second = -MIRROR * 1.35 * curl, -MIRROR * 1.7 * curl
        fold = np.clip((thumb - 0.77) / 0.18, 0.0, 1.0)  # a fist: the thumb lies over the fingers
        over = rotation(cross(np.array([1.0, 0.0, 0.0]), self.hands.fingers) * (1.25 * fold)[..., None])
        thumbs = (
            rot_x(-MIRROR * (0.55 * thumb + 0.35 * fold)) @ rot_z(-MIRROR * 0.35 * thumb * (1 - fold)) @ over
        )
        self._turn_all(_KNUCKLES, _in_order(rot_x(first), thumbs))
        self._turn_all(_MIDDLES, _in_order(rot_x(second), rot_x(-first * point)))
        self._turn_all(_INDEXTIPS, _in_order(rot_x(second * (1 - point))))

    # -- face ------------------------------------------------------------------------------

    def face(
        self,
        eyes: tuple[Array, Array],
        lids: Array,
        brows: tuple[Array, Array],
        mouth: Array,
        jaw: Array,
        mimic: Mimic | None = None,
    ) -> None:
        """eyes: turn, down [T]; lids [T]: 0 open .. 1 shut; brows: up [2, T] and knit [T]; mouth [T]: smile
        -1..1; jaw [T]: open 0..1, a little below 0 pressed shut; mimic: what a feeling adds"""
        turn, down = eyes
        still = np.zeros(self.frames)
        m = Mimic(*([still] * 5)) if mimic is None else mimic
        shut, knit = lids + 0.35 * np.clip(down, -0.4, 0.5), brows[1]
        about_z, about_y = [still, still], [0.30 * jaw, -0.20 * m.sneer]
        for side, up in zip((1.0, -1.0), brows[0], strict=True):
            about_z += [turn, still, still, -side * 0.06 * knit, side * 0.16 * m.wide]
            about_y += [
                down,
                0.95 * shut + m.lid,
                -0.42 * m.squint,
                -0.19 * up + 0.03 * knit,
                0.12 * jaw - 0.20 * mouth,
            ]
        self._turn_all(_FACE, np.swapaxes(rot_zy(np.stack(about_z), np.stack(about_y)), 0, 1))
        about_z, about_y = [-side * 0.05 * knit for side in (1.0, -1.0)], [-0.15 * m.inner] * 2
        self._turn_all(_BROWS, np.swapaxes(rot_zy(np.stack(about_z), np.stack(about_y)), 0, 1))

    # -- places ----------------------------------------------------------------------------

    def point(self, joint: str, offset: Array) -> Array:
        """[T, 3] of a point fixed to a joint, ``offset`` [3] in the bind frame."""
        j = JOINT[joint]
        out: Array = self.position[:, j] + self.rotation[:, j] @ offset
        return out

    def matrices(self) -> NDArray[np.float32]:
        """float32 [T, J, 4, 4] world_from_joint."""
        out = np.zeros((self.frames, len(JOINTS), 4, 4), np.float32)
        out[..., :3, :3] = self.rotation
        out[..., :3, 3] = self.position
        out[..., 3, 3] = 1.0
        return out


def _arm_directions(pose: ArmPose) -> tuple[Array, Array]:
    """In the chest's frame: where the upper arm points, and where a bent forearm would, each [2, T, 3].

    The upper arm swings from hanging about the axis square to (swing, out), then twists about itself.
    """
    angle = np.hypot(pose.swing, pose.out)
    safe = np.maximum(angle, 1e-9)
    cf = np.where(angle < 1e-6, 1.0, pose.swing / safe)
    co = np.where(angle < 1e-6, 0.0, pose.out / safe)
    s, c = np.sin(angle), np.cos(angle)
    down = np.stack([s * cf, s * co, -c], axis=-1)
    forward = np.stack([cf * c * cf + co * co, cf * c * co - co * cf, cf * s], axis=-1)
    twist = pose.twist[..., None]
    forward = np.cos(twist) * forward + np.sin(twist) * cross(down, forward)
    flip = np.ones((2, 1, 3))
    flip[1, 0, 1] = -1.0
    return down * flip, forward * flip


def _in_order(*locals: Array) -> Array:
    """Local rotations [2, T, 3, 3] of some joints in the order of :func:`_joints`: [T, N, 3, 3]."""
    return np.swapaxes(np.concatenate([np.stack(side) for side in zip(*locals, strict=True)]), 0, 1)


def _wrists(fore: Array, fk: Array, goals: HandGoals, axis: Array) -> Array:
    """Rotations of hands against forearms [2, T, 3, 3]: as by angles, or drawn to the goals within limits."""
    if not goals.turning.any():
        return fk
    goal = np.swapaxes(fore, -1, -2) @ goals.rotation
    return _within_limits(blend(fk, goal, goals.turning), axis)


def rotation_vector_twist(matrix: Array, axis: Array) -> Array:
    """The part of each rotation about the unit ``axis``, as a rotation vector."""
    q = quaternion(matrix)
    along = dot(q[..., 1:], axis)
    out: Array = axis * np.asarray(wrap(2.0 * np.arctan2(along, q[..., 0])))[..., None]
    return out


def _within_limits(relative: Array, axis: Array) -> Array:
    """Wrist rotations eased into what a wrist can do: 1.75 rad of turn, 1.3 rad of bend."""
    twist = steady(rotation_vector_twist(relative, axis))
    swing = rotation_vector(relative @ np.swapaxes(rotation(twist), -1, -2))
    return rotation(_soft_limit(swing, 1.3)) @ rotation(_soft_limit(twist, 1.75))


def _soft_limit(vector: Array, limit: float) -> Array:
    length = norm(vector)[..., None]
    knee = 0.75 * limit
    over = np.maximum(length - knee, 0.0)
    room = limit - knee
    eased = np.where(length > knee, knee + room * np.tanh(over / room), length)
    return vector * (eased / np.maximum(length, 1e-9))
