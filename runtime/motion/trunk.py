"""Hips, trunk, head and legs of a planned person over all frames: the layers of motion, laid over each other.

Order of layers: standing and sitting, gait, idling (breath, weight, wandering), clip keys, then gaze. Feet
stay where the route has set them down; the hips are as high as the legs allow.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT

from .carriage import Low, Style
from .channels import Channels
from .curves import below, delayed, plateau, smooth, wander
from .face import GazePull, Look, beyond_eyes, felt, look, speech
from .feet import ankle_positions
from .figure import Figure
from .gait import level_thigh, sit_clearance
from .hands import MIRROR
from .plan import Plan
from .rotations import rot_zy, unwrapped

Array = NDArray[np.float64]


class Trunk:
    """One person over T frames at times ``t`` [T]: all but arms, hands and face."""

    def __init__(self, plan: Plan, t: Array, fps: float, rng: np.random.Generator) -> None:
        self.plan, self.t, self.fps, self.rng = plan, t, fps, rng
        self.skeleton = plan.actor.skeleton
        self.frames = len(t)
        self.height = self.skeleton.height
        self.root, self.yaw, self.ground = plan.route.root(t)
        self.sitting = plan.route.sitting(t)
        self.seat_height = plan.route.seat_height(t) - self.ground
        self.feet = plan.route.feet(t)
        self.low = Low(plan.route, t, self.yaw)
        self.style = Style(plan.route, plan.manner, self.feet, t, fps, rng)
        self.channels = Channels(self.frames)
        for window in plan.windows:
            self.channels.perform(
                window.timeline, window.start, window.duration, t, fps, window.hands, window.until
            )
        self.figure = Figure(self.skeleton, self.frames)
        self._speed()
        self._idle()

    # -- what others may ask before any pose is made -------------------------------------------

    def eye_point(self) -> Array:
        """[T, 3] about where this person's eyes are, from the plan alone."""
        bind = self.skeleton.bind
        eye = bind[JOINT["eye_l"]][2]
        seated = self.seat_height + sit_clearance(self.skeleton) + eye - bind[JOINT["thigh_l"]][2]
        z = self.ground + eye + self.sitting * (seated - eye)
        if not self.low.any:
            return np.concatenate([self.root, z[:, None]], axis=1)
        up = eye - bind[JOINT["thigh_l"]][2]  # of the hip joints, along the trunk
        share, tilt = self.low.share, self.low.tilt
        z = z * (1 - share) + self.low.hip + share * up * np.cos(tilt)
        ahead = share * up * np.sin(tilt)
        xy = self.root + ahead[:, None] * np.stack([np.cos(self.yaw), np.sin(self.yaw)], axis=1)
        return np.concatenate([xy, z[:, None]], axis=1)

    # -- before any pose -----------------------------------------------------------------------

    def _speed(self) -> None:
        ahead = np.stack([np.cos(self.yaw), np.sin(self.yaw)], axis=1)
        velocity = np.gradient(self.root, axis=0) * self.fps if self.frames > 1 else np.zeros_like(self.root)
        self.pace = smooth(np.sum(velocity * ahead, axis=1), 0.08 * self.fps)
        self.push = smooth(
            np.gradient(self.pace) * self.fps if self.frames > 1 else self.pace, 0.1 * self.fps
        )
        turning = np.abs(np.gradient(self.yaw) * self.fps) if self.frames > 1 else np.zeros(self.frames)
        moving = np.linalg.norm(velocity, axis=1) + 0.3 * turning
        self.still = 1.0 - smooth(np.clip(moving / 0.25, 0, 1), 0.2 * self.fps)
        self.run = smooth(self.feet.run.max(axis=0) * np.clip(self.pace / 1.5, 0, 1), 0.12 * self.fps)
        offset = self.feet.place[..., :2] - self.root
        along = np.einsum("ktc,tc->kt", offset, ahead)
        moved = (1.0 - self.still) * (1.0 - self.sitting) * (1.0 - self.low.share)
        self.lead = smooth((along[0] - along[1]) * moved, 0.05 * self.fps)  # left foot ahead of the right

    def _idle(self) -> None:
        t, rng = self.t, self.rng
        calm = self.still * (1 - self.low.share)
        restless = self.plan.manner.restless
        breath = np.sin(2 * np.pi * t / rng.uniform(3.2, 4.4) + rng.uniform(0, 6.3))
        self.feeling = felt(self.plan.feelings, t, rng)
        self.breath = breath * self.feeling["breath"]
        self.sway = 0.026 * restless * wander(t, rng, 6.5) * calm * (1 - 0.8 * self.sitting)
        self.twirl = 0.035 * restless * wander(t, rng, 7.5) * calm
        self.nodding = 0.02 * wander(t, rng, 4.0)
        self.turning = 0.045 * restless * wander(t, rng, 5.0) * calm
        self.tilting = 0.03 * wander(t, rng, 6.0)
        self.rest = np.array([0.25, 0.25])[:, None] + 0.06 * rng.standard_normal((2, 1))
        self.arm_noise = np.stack([0.02 * wander(t, rng, 4.5), 0.02 * wander(t, rng, 5.5)])

    def gaze(self, pulls: list[GazePull]) -> None:
        """Sets where to look, before the torso is posed."""
        ahead = delayed(self.yaw, -0.35 * self.fps)
        curve = (ahead - self.yaw) * 0.8
        walk = GazePull(curve, np.full(self.frames, 0.06), np.ones(self.frames), 0.75)
        self.look: Look = look([walk, *pulls], self.frames, self.fps)

    def talk(self) -> None:
        """Prepares speech; before :meth:`torso`."""
        talks = [(k, w.start, w.duration) for w in self.plan.windows for k in w.timeline.talks]
        self.speech = speech(talks, self.t, self.fps, self.rng)

    # -- trunk and head ------------------------------------------------------------------------

    def torso(self, lean: Array, twist: Array, drop: Array, forward: Array) -> None:
        """Poses hips to clavicles and the head; the arguments [T] are what reaching asks on top."""
        c, fig, bind, low, style = self.channels, self.figure, self.skeleton.bind, self.low, self.style
        ankle, toes = self._ankles()
        upright = 1 - np.clip(low.share, 0.0, 1.0)
        stride = np.clip(self.lead / (0.42 * self.height), -1.5, 1.5)
        support = smooth(self.feet.air[1] - self.feet.air[0], 0.05 * self.fps) * (1 - self.sitting)
        support = support * upright
        raised = np.clip(c.pair("foot", "lift") / 0.12, 0.0, 1.0) * (1 - self.sitting) * upright
        shift = self.sway + c["hips.shift"] + 0.018 * support * (1 - 0.5 * self.run)
        shift = shift + 0.045 * self.height * (raised[1] - raised[0])  # over the foot one stands on
        pelvis_turn = -0.13 * stride * (1 - 0.3 * self.run) + c["hips.turn"] + 0.3 * self.twirl
        roll = 0.06 * support + 1.1 * self.sway + style.roll
        moving = np.clip(self.pace / 1.2, 0, 1)
        bow = c["body.bow"] + 0.13 * self.run + 0.03 * moving
        transition = self._sit_lean()
        pitch = 0.45 * lean + bow + 0.5 * transition - 0.05 * self.sitting + 0.15 * style.lean * upright
        accelerate = np.clip(0.03 * self.push, -0.08, 0.12)
        spine_lean = (
            0.55 * lean + c["body.lean"] + 0.5 * transition + accelerate + 0.05 * self.run
            + 0.012 * self.breath + 0.03 * self.sitting + self.feeling["lean"] + 0.85 * style.lean * upright
        )  # fmt: skip
        self.bent = smooth(np.clip(pitch + spine_lean - 0.08, 0.0, 1.2), 0.06 * self.fps)
        bowed = 0.75 * (pitch + spine_lean)
        spine_twist = (
            1.9 * 0.13 * stride + c["body.twist"] + self.look.chest_twist + twist + 0.6 * self.twirl
            - 0.8 * c["hips.turn"]
        )  # fmt: skip
        spine_side = c["body.side"] + 0.9 * roll + style.side * upright
        across = np.stack([-np.sin(self.yaw), np.cos(self.yaw)], axis=1)
        ahead = np.stack([np.cos(self.yaw), np.sin(self.yaw)], axis=1)
        back = 0.24 * np.sin(np.clip(pitch, 0, 1.2)) * (1 - self.sitting)
        xy = self.root + shift[:, None] * across + (c["hips.forward"] + forward - 0.3 * back)[:, None] * ahead
        z = self._pelvis_height(xy, ankle, drop + c["hips.drop"])
        if low.any:  # the hip joints stay over the root, however the trunk lies
            above = bind[0][2] - bind[JOINT["thigh_l"]][2]
            xy = xy + (above * low.share * np.sin(low.pitch))[:, None] * ahead
        pitch, spine_lean = pitch + low.pitch, spine_lean + low.lean + low.balance
        root = np.concatenate([xy, z[:, None]], axis=1)
        up = (
            c.pair("shoulder", "up")
            + 0.018 * self.breath
            + self._raise()
            + self.feeling["shoulders"]
            + style.up
        )
        fig.torso(
            root, self.yaw, (pelvis_turn, pitch, roll), (spine_twist, spine_lean, spine_side),
            (up, c.pair("shoulder", "forward") + self.feeling["rounded"] + style.forward),
        )  # fmt: skip
        talk = self.speech
        turn = (
            self.look.head_turn - 0.5 * (spine_twist - self.look.chest_twist - twist) + self.turning
            + c["head.turn"] - 0.8 * pelvis_turn + style.loll[0]
        )  # fmt: skip
        turn = np.clip(turn, -1.3, 1.3)
        level = np.clip(bowed, -0.4, 0.55)  # the head stays upright on a bowed trunk, wherever it is turned
        self.head = (
            turn,
            self.look.head_nod - level * np.cos(turn) + self.nodding + c["head.nod"] + talk.nod
            + self.feeling["nod"] + style.nod + low.nod,
            self.tilting + c["head.tilt"] + talk.tilt - 0.5 * spine_side + self.feeling["tilt"]
            + style.loll[1] + level * np.sin(turn),
        )  # fmt: skip
        fig.head(*self.head)
        self._set_legs(ankle, toes, bind)

    def attend(self) -> None:
        """Turns the head to what the eyes alone cannot get to, now that the torso is posed."""
        if not self.look.fixed.any():
            return
        body = rot_zy(self.yaw, self.low.looks)
        more = beyond_eyes(self.look, body, *self._gaze_from(), self.fps)
        turn, nod = (
            np.clip(x + y, np.minimum(x, -limit), np.maximum(x, limit))
            for x, y, limit in zip(self.head, more, (1.35, 1.0), strict=False)
        )
        self.figure.head(turn, nod, self.head[2])

    def _raise(self) -> Array:
        """Clavicles go up with a lifted arm [2, T]."""
        c = self.channels
        weight = c.pair("arm", "weight")
        angle = np.hypot(c.pair("arm", "swing"), c.pair("arm", "out"))
        return np.asarray(0.28 * weight * np.clip(angle - 0.7, 0.0, 1.6))

    def _sit_lean(self) -> Array:
        out = np.zeros(self.frames)
        for sit in self.plan.route.sits:
            d = sit.end - sit.start
            lean = plateau(self.t, sit.start - 0.15, sit.start + 0.45 * d, sit.start + 0.5 * d, sit.end + 0.1)
            out = out + 0.78 * lean
        return out

    def _gaze_from(self) -> tuple[Array, Array]:
        """The head's rotation [T, 3, 3] and the point between the eyes [T, 3]."""
        fig, bind = self.figure, self.skeleton.bind
        eye = bind[JOINT["eye_l"]] - bind[JOINT["head"]]
        return fig.rotation[:, JOINT["head"]], fig.point("head", np.array([eye[0], 0.0, eye[2]]))

    # -- hips and legs -------------------------------------------------------------------------

    def _pelvis_height(self, xy: Array, ankle: Array, drop: Array) -> Array:
        """[T]: as high as the legs allow, never with a knee snapped straight."""
        bind = self.skeleton.bind
        hip_z = bind[JOINT["thigh_l"]][2]
        leg = hip_z - bind[JOINT["foot_l"]][2]
        above = bind[0][2] - hip_z
        stand = self.ground + hip_z - 0.0025 * self.height
        cadence = self.feet.air.sum(axis=0)
        moving = np.clip(np.abs(self.pace) / 1.0, 0, 1)
        stairs = self._stairs()
        walk_bob = moving * (1 - self.run) * (0.016 * (cadence - 0.5) - 0.012)
        run_bob = (
            self.run * self.height * (0.028 * smooth(self.feet.air.min(axis=0) * 2.2, 0.04 * self.fps) - 0.04)
        )
        wished = stand + walk_bob + run_bob - drop - self.style.drop + self.style.rise - stairs
        across = np.stack([-np.sin(self.yaw), np.cos(self.yaw)], axis=1)
        half = bind[JOINT["thigh_l"]][1]
        hips = np.stack([xy + half * across, xy - half * across])
        flat = np.linalg.norm(ankle[..., :2] - hips, axis=-1)
        reach = 0.9975 * leg
        limit = ankle[..., 2] + np.sqrt(np.maximum(reach**2 - flat**2, (0.3 * leg) ** 2))
        lowest = limit.min(axis=0)
        free = 1 - np.clip(3 * self.sitting, 0, 1)
        wished = np.minimum(wished, np.where(free > 0, lowest, wished)) * free + wished * (1 - free)
        standing = below(wished, max(1, round(0.07 * self.fps)))
        seated = self.ground + self.seat_height + sit_clearance(self.skeleton)
        s, low = self.sitting, self.low
        height = standing + s * (seated - standing)
        if low.any:
            height = height * (1 - low.share) + low.hip - low.share * drop
            above = above * (1 - low.share * (1 - np.cos(low.pitch)))
        return np.asarray(height + above)

    def _stairs(self) -> Array:
        """How much lower the hips go where one foot stands higher than the other [T]: knees have to bend."""
        apart = np.abs(self.feet.ground[0] - self.feet.ground[1])
        return smooth(0.25 * apart, 0.12 * self.fps) if apart.any() else apart

    def _ankles(self) -> tuple[Array, Array]:
        c = self.channels
        pitch = self.feet.pitch + c.pair("foot", "pitch")
        ankle, toes = ankle_positions(self.skeleton, replace(self.feet, pitch=pitch))
        ahead, out, lift = (c.pair("foot", axis) for axis in ("forward", "out", "lift"))
        cos, sin = np.cos(self.yaw), np.sin(self.yaw)
        out = MIRROR * out
        ankle[..., 0] += ahead * cos - out * sin
        ankle[..., 1] += ahead * sin + out * cos
        ankle[..., 2] += lift + self.sitting * self._dangle()
        return ankle, toes

    def _dangle(self) -> Array:
        """How far the feet hang above the floor on a seat too high for them [T]: thighs stay level."""
        hip = self.seat_height + sit_clearance(self.skeleton)
        knee = self.skeleton.bind[JOINT["shin_l"]][2]
        return np.asarray(np.maximum(hip - knee - level_thigh(self.skeleton), 0.0) * (1 - self.low.share))

    def _set_legs(self, ankle: Array, toes: Array, bind: Array) -> None:
        yaw = unwrapped(self.feet.place[..., 2])
        spread = 0.10 + 0.02 * self.sitting + self.channels["knees.spread"]
        hanging = 0.35 * np.clip(self._dangle() / 0.1, 0, 1) * self.sitting
        pitch = self.feet.pitch + self.channels.pair("foot", "pitch") + hanging
        hips = self.figure.hip_joints()
        leg = bind[JOINT["thigh_l"]][2] - bind[JOINT["foot_l"]][2]
        pull = ankle - hips
        far = np.linalg.norm(pull, axis=-1, keepdims=True)
        ankle = hips + pull * np.minimum(1.0, 0.9995 * leg / np.maximum(far, 1e-6))
        across = np.stack([-np.sin(self.yaw), np.cos(self.yaw), np.zeros(self.frames)], axis=1)
        apart = 2.2 * np.sin(self.channels["knees.spread"]) * self.low.share
        poles = self.low.poles + MIRROR[..., None] * apart[:, None] * across
        low = (self.low.share, poles) if self.low.any else None
        self.figure.legs(ankle, yaw, pitch, toes, np.broadcast_to(spread, yaw.shape), low)
