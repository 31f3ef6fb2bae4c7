"""A planned person over all frames: the layers of motion, laid over each other, as a posed figure.

Order of layers: standing and sitting, gait, idling (breath, weight, wandering), clip keys, gaze, then
contact by inverse kinematics. :class:`Performer` is called stage by stage because some stages need what
other people do in the one before.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT

from .carriage import Low, Style
from .channels import Channels
from .contacts import Contacts, HandTracks, Layer
from .curves import below, delayed, plateau, ramp, smooth, wander
from .face import GazePull, Look, beyond_eyes, blinks, eye_angles, felt, look, mimic, speech
from .feet import ankle_positions
from .figure import ArmPose, Figure, HandGoals
from .gait import level_thigh, sit_clearance
from .hands import MIRROR
from .plan import Plan
from .replay import play
from .rotations import norm, rot_zy, turned, unwrapped, wrap
from .types import Touches

Array = NDArray[np.float64]


class Performer:
    """One person over T frames at times ``t`` [T]."""

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

    # -- what others may ask before any pose is made ---------------------------------------

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

    # -- layers ------------------------------------------------------------------------------

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

    # -- torso ----------------------------------------------------------------------------

    def gaze(self, pulls: list[GazePull]) -> None:
        """Sets where to look, before the torso is posed."""
        ahead = delayed(self.yaw, -0.35 * self.fps)
        curve = (ahead - self.yaw) * 0.8
        walk = GazePull(curve, np.full(self.frames, 0.06), np.ones(self.frames), 0.75)
        self.look: Look = look([walk, *pulls], self.frames, self.fps)

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

    # -- arms -----------------------------------------------------------------------------

    def talk(self) -> None:
        """Prepares speech; before :meth:`torso`."""
        talks = [(k, w.start, w.duration) for w in self.plan.windows for k in w.timeline.talks]
        self.speech = speech(talks, self.t, self.fps, self.rng)

    def arm_pose(self, carry: Array) -> ArmPose:
        """Both arms by angles: hanging, swinging with the gait, carrying (``carry`` [2, T]), then keys."""
        c = self.channels
        stride = np.clip(self.lead / (0.42 * self.height), -1.6, 1.6) * self.style.arms
        opposite = np.stack([-stride, stride])
        lag = delayed(opposite.T, 0.06 * self.fps).T
        run = self.run
        sit = self.sitting
        swing = (
            -0.03
            + self.arm_noise
            + opposite * (0.36 + 0.15 * run)
            - 0.15 * run
            + 0.18 * sit
            + 0.85 * self.bent
            + self.low.swing
            + 1.4 * self.low.balance
            + self.style.fling
        )
        out = 0.17 + 0.05 * run + 0.5 * self.arm_noise[::-1] + 0.05 * sit + 0.02 * self.breath
        bend = self.rest + 0.20 * np.maximum(lag, -0.4) * (1 - run) + run * (1.45 + 0.25 * lag) + 0.75 * sit
        bend = bend + self.style.bend
        twist = 0.14 + 0.2 * run + 0.2 * sit + 0.0 * swing
        hang: dict[str, Array] = {
            "swing": swing + c.pair("arm", "swing+"), "out": out, "bend": bend, "twist": twist,
            "wrist": 0.12 + 0.1 * lag, "side": np.zeros_like(swing), "turn": np.full_like(swing, 0.35),
        }  # fmt: skip
        held: dict[str, Array | float] = {
            "swing": 0.18 + 0.25 * opposite * 0.36, "out": 0.16, "bend": 1.42, "twist": 0.18,
            "wrist": 0.0, "side": 0.0, "turn": 0.0,
        }  # fmt: skip
        weight = c.pair("arm", "weight")
        values = {}
        for axis, value in hang.items():
            base = value + carry * (held[axis] - value)
            extra = c.pair("arm", axis + "+") if axis != "swing" else 0.0
            values[axis] = base + weight * (c.pair("arm", axis) - base) + extra
        values["bend"] = np.clip(values["bend"], 0.03, 2.5)
        return ArmPose(**values)

    def resting(self, posed: Array, carry: Array) -> list[Layer]:
        """Where hands are in a low posture, where keys (``posed`` [2, T]) do not say and nothing is in them:
        planted on the floor, or on the knees."""
        if not self.low.any:
            return []
        free = (1 - posed) * (1 - carry)
        layers = []
        if self.low.knees.any():
            layers += [
                Layer(k, self.low.knees * free[k], "knee", np.zeros(3), (0.3, -0.5, 1.2)) for k in (0, 1)
            ]
        if self.low.palms.any():
            palms = self.plan.route.palms(self.t)
            for k in (0, 1):
                up = self.low.palms_up + palms.lift[k]
                place = np.concatenate([palms.place[k, :, :2], up[:, None]], axis=1)
                layers.append(Layer(k, self.low.palms * free[k], place, np.zeros(3), (0.0, 0.0, 1.5)))
        return layers

    def stand(self) -> None:
        """Poses the torso as it is before hands ask anything of it."""
        self.torso(*(np.zeros(self.frames) for _ in range(4)))

    def reach_body(self, tracks: HandTracks) -> None:
        """Poses the torso so that hands can get where they are to go: leans, crouches, then twists; after
        :meth:`stand`."""
        lean, twist, drop, forward = (np.zeros(self.frames) for _ in range(4))
        if not tracks.reaching:
            return
        down_to = tracks.position(self.figure)[..., 2] - self.ground
        crouch = np.clip((0.40 - down_to / self.height) / 0.2, 0.0, 0.85) * tracks.pull
        crouch = smooth(crouch.max(axis=0), 0.1 * self.fps) * (1 - self.sitting) * (1 - self.low.share)
        for _ in range(4):
            gap = self._shortage(tracks)
            if gap.max() < 4e-3:
                return
            shoulders = self.figure.shoulders()
            d = tracks.position(self.figure) - shoulders
            heading = np.stack([np.cos(self.yaw), np.sin(self.yaw)], axis=1)
            flat = np.einsum("ktc,tc->kt", d[..., :2], heading)
            length = np.maximum(norm(d), 1e-6)
            ahead = (gap * np.clip(flat / length, 0.0, 1.0)).max(axis=0)
            down = (gap * np.clip(-d[..., 2] / length, 0.0, 1.0)).max(axis=0)
            reach = max(1, round(0.1 * self.fps))
            ahead, down = -below(-ahead, reach), -below(-down, reach)
            lower = np.minimum(down * crouch, np.maximum(0.32 * self.height - drop, 0.0))
            hips = 0.30 * self.height  # from there to the shoulders
            lean = np.minimum(lean + (1.1 * ahead + 1.0 * (down - lower)) / hips, 1.1 - 0.7 * tracks.close)
            drop = drop + lower
            room = 0.09 * self.height * (1 - self.sitting) * (1 - self.low.share) * (1 - tracks.close)
            forward = np.minimum(forward + 0.6 * ahead, room)
            side = (gap[0] - gap[1]) * -0.5
            twist = np.clip(twist + smooth(side, 0.1 * self.fps), -0.45, 0.45)
            self.torso(lean, twist, drop, forward)

    def _shortage(self, tracks: HandTracks) -> Array:
        """[2, T]: how far each hand's place is out of the arm's reach, by the reach's weight."""
        rotation = tracks.rotation(self.figure.hands)
        wrist = tracks.position(self.figure) - turned(rotation, self.figure.hands.offset)
        d = norm(wrist - self.figure.shoulders())
        return np.asarray(np.maximum(d - 0.925 * self.figure.arm_length, 0.0) * tracks.pull)

    def arms(self, contacts: Contacts) -> Array:
        """Poses arms and hands; returns the palms [2, T, 3]."""
        tracks = contacts.tracks
        pose = self.arm_pose(tracks.carry)
        rotation = tracks.rotation(self.figure.hands)
        goals = HandGoals(
            tracks.position(self.figure), tracks.weight, rotation, tracks.turning, tracks.around
        )
        palms = self.figure.arms(pose, goals, self.yaw)
        self.tracks, self.goals, self.palms = tracks, goals.position, palms
        self.goal_rotation = rotation
        c = self.channels
        weight = c.pair("fingers", "weight")
        relaxed = 0.30 + 0.04 * self.arm_noise / 0.02 * 0.3 + 0.35 * self.run
        relaxed = relaxed + self.plan.manner.fists * (1.0 - relaxed)
        curl = relaxed + tracks.grip * (0.62 - relaxed)
        curl = curl + weight * (c.pair("fingers", "curl") - curl) + c.pair("fingers", "curl+")
        point = weight * c.pair("fingers", "point")
        thumb = np.clip(0.35 + 0.6 * curl, 0.0, 1.0)
        thumb = thumb - (0.8 + thumb) * np.clip(weight * c.pair("fingers", "thumb"), 0.0, 1.0)
        self.figure.fingers(np.clip(curl, 0.0, 1.0), np.clip(point, 0, 1), thumb)
        self._replay()
        return self.palms

    def _replay(self) -> None:
        """Lays captured motion over the pose."""
        self.replayed = []
        for replay in self.plan.replays:
            own, standing = play(replay, self.figure, self.feet, self.t)
            self.replayed.append((own, standing))
            hands = self.figure.hands.offset
            for k, side in enumerate(("l", "r")):
                self.palms[k, own] = self.figure.point(f"hand_{side}", hands[k, 0])[own]

    def touches(self, frames: int) -> Touches:
        """What hands, feet and eyes are on, over the first ``frames``."""
        c, feet = self.channels, self.feet
        moved = sum(np.abs(c.pair("foot", axis)) for axis in ("forward", "out", "lift"))
        hanging = self.sitting * self._dangle() > 0.005
        planted = (feet.air <= 0) & (moved < 0.004) & (feet.lift < 1e-4) & ~hanging
        for own, standing in self.replayed:
            planted[:, own] = standing
        hands = self.tracks.weight
        if self.low.palms.any():  # palms on their way to another place of the floor
            hands = np.where(self.plan.route.palms(self.t).air > 0, 0.0, hands)
        return Touches(
            planted[:, :frames],
            feet.ground[:, :frames],
            hands[:, :frames],
            self.goals[:, :frames],
            self.palms[:, :frames],
            self.look.fixed[:frames],
            self.look.point[:frames],
        )

    def _gaze_from(self) -> tuple[Array, Array]:
        """The head's rotation [T, 3, 3] and the point between the eyes [T, 3]."""
        fig, bind = self.figure, self.skeleton.bind
        eye = bind[JOINT["eye_l"]] - bind[JOINT["head"]]
        return fig.rotation[:, JOINT["head"]], fig.point("head", np.array([eye[0], 0.0, eye[2]]))

    def face(self) -> None:
        """Eyes, lids, brows, mouth and jaw."""
        c, talk, feeling = self.channels, self.speech, self.feeling
        up = c.pair("brow", "up") + 0.5 * talk.brow + feeling["brow"]
        knit = np.clip(c.pair("brow", "knit").max(axis=0) + feeling["knit"], 0.0, 1.2)
        lids = np.maximum(np.maximum(blinks(self.t, self.rng), c["lids.close"]), feeling["lid"])
        smile = np.clip(c["mouth.smile"] + feeling["smile"], -1.1, 1.1)
        turn, down = eye_angles(self.look, rot_zy(self.yaw, self.low.looks), *self._gaze_from())
        self.figure.face(
            (turn + c["eyes.turn"], down + c["eyes.down"]),
            np.clip(lids, 0, 1), (up, knit), smile,
            np.clip(talk.jaw * (1.0 - 0.5 * feeling["jaw"]) + c["jaw.open"] + feeling["jaw"], -0.2, 1),
            mimic(feeling, c["mouth.smile"], talk.jaw),
        )  # fmt: skip


def relative_gaze(eye: Array, yaw: Array, tilt: Array, point: Array) -> tuple[Array, Array]:
    """Turn to the left and down [T] from ``eye`` [T, 3] to ``point`` [(T,) 3], against a trunk that faces
    ``yaw`` and is tipped forward by ``tilt``."""
    d = point - eye
    if tilt.any():
        d = turned(np.swapaxes(rot_zy(yaw, tilt), -1, -2), d)
        yaw = np.zeros_like(yaw)
    turn = wrap(np.arctan2(d[..., 1], d[..., 0]) - yaw)
    return unwrapped(turn), np.arctan2(-d[..., 2], np.hypot(d[..., 0], d[..., 1]))


def fade(t: Array, start: float, end: float, lead: float = 0.35) -> Array:
    """A gaze's weight: quickly there, quickly gone."""
    return ramp(t, start, start + lead) * (1.0 - ramp(t, end - 0.5 * lead, end + 0.5 * lead))
