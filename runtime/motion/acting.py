"""A planned person over all frames, with arms, hands and face, as a posed figure.

Arms hang and swing by angles, play their keys, then go where hands have to be by inverse kinematics.
:class:`Performer` is called stage by stage because some stages need what other people do in the one before.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .contacts import Contacts, HandTracks, Layer
from .curves import below, delayed, smooth
from .face import blinks, eye_angles, mimic
from .figure import ArmPose, HandGoals
from .replay import play
from .rotations import norm, rot_zy, turned
from .trunk import Trunk
from .types import Touches

Array = NDArray[np.float64]


class Performer(Trunk):
    """One person over T frames at times ``t`` [T]."""

    # -- arms -----------------------------------------------------------------------------

    def arm_pose(self, tracks: HandTracks) -> ArmPose:
        """Both arms by angles: hanging, swinging with the gait, carrying, then keys."""
        c, carry = self.channels, tracks.carry
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
            "swing": 0.18 - 0.15 * tracks.hang + 0.25 * opposite * 0.36, "out": 0.16 + 0.06 * tracks.hang,
            "bend": tracks.bend, "twist": 0.18,
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
        pose = self.arm_pose(tracks)
        rotation = tracks.rotation(self.figure.hands)
        goals = HandGoals(
            tracks.position(self.figure), tracks.weight, rotation, tracks.turning, tracks.around
        )
        palms = self.figure.arms(pose, goals, self.yaw)
        if tracks.one_goes_with_the_other:
            goals = replace(goals, position=tracks.position(self.figure, palms))
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
