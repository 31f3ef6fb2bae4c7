"""Candidates that are shot: their tracks, and what was drawn for each."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ..cinema.moves import FLOOR_CLEARANCE, RACK, SIGN, Draw, families, family, of_camera
from ..cinema.subject import Subject
from ..cinema.takes import within
from ..cinema.track import CameraTrack, camera_axes, project

Array = NDArray[np.float64]

_TURNED = np.radians(3.0)  # of a tilt that has left where it was
_LEVEL = frozenset(("pan", "dolly"))  # movements to the side
_WELL = 0.1  # of the frame from its borders, within which eyes are well in it


@dataclass(frozen=True, eq=False)
class Shooting:
    """P candidates of one story, shot.

    order: [P] which of the given rows each is; movements, scales, angles: words, P each
    key: frame the framing is of; draw: what was drawn, all [P], second:
    the same for the second of two movements at once; lifted: radians off the asked angle to
    stay above the floor; relative: azimuth from the subject's heading, radians
    floor: height of the subject's floor, above which cameras stay; view: as in the shot
    """

    rig: str
    track: CameraTrack
    order: NDArray[np.int64]
    movements: tuple[str, ...]
    scales: tuple[str, ...]
    angles: tuple[str, ...]
    key: NDArray[np.int64]
    draw: Draw
    second: Draw
    lifted: Array
    relative: Array
    height: Array
    floor: float = 0.0
    view: str = ""

    @property
    def strata(self) -> NDArray[np.int64]:
        """λ and end of each candidate as one small number, for variety."""
        lam = np.unique(self.draw.lam, return_inverse=True)[1]
        return np.asarray(2 * lam + self.draw.key)

    def only(self, rows: NDArray[np.int64]) -> Shooting:
        """Some of the candidates (rows in rising order)."""
        if len(rows) == len(self.movements):
            return self
        t = self.track
        return Shooting(
            self.rig,
            t.only(rows),
            self.order[rows],
            tuple(self.movements[p] for p in rows),
            tuple(self.scales[p] for p in rows),
            tuple(self.angles[p] for p in rows),
            self.key[rows],
            Draw(*(getattr(self.draw, f.name)[rows] for f in fields(Draw))),
            Draw(*(getattr(self.second, f.name)[rows] for f in fields(Draw))),
            self.lifted[rows],
            self.relative[rows],
            self.height[rows],
            self.floor,
            self.view,
        )

    def window(self, at: NDArray[np.int64], subject: Subject) -> NDArray[np.bool_]:
        """bool [P, F]: sampled frames at which the subject is meant to be in the picture.

        A camera that turns or goes onto its subject, or off it, is meant to show it at one end. Where it is
        well in the frame at the other end of a pan or dolly as well, as somebody who goes along with it,
        nobody who watches can tell which: then all frames count that it is well in. One that goes up or down
        is known by where the head is.
        """
        out = self._meant(at / max(subject.frames - 1, 1), at)
        level = np.array([bool(families(m) & _LEVEL) for m in self.movements], bool)
        rows = np.flatnonzero(level & ~out.all(axis=1))
        if self.rig == "cinema" and len(rows):
            t = self.track
            axes = camera_axes(t.rotation[np.ix_(rows, at)])
            eyes = subject.landmarks["eyes"][None, at, None]
            camera, focal = t.position[np.ix_(rows, at)], t.focal[np.ix_(rows, at)]
            there = within(*project(eyes, camera, axes, focal, t.sensor), _WELL)[..., 0]
            out[rows] |= there & (there[:, :1] & there[:, -1:])
        return out

    def _meant(self, time: Array, at: NDArray[np.int64]) -> NDArray[np.bool_]:
        """The same by the movements alone; time: of the frames ``at``, 0..1."""
        out = np.ones((len(self.movements), len(at)), bool)
        for p, movement in enumerate(self.movements):
            kinds = families(movement)
            if kinds & {"whip-pan"}:
                out[p] = time >= 0.5
            elif kinds & {"tilt", "pan"}:
                on, kept = self.draw.on[p], self.draw.kept[p] or self.second.kept[p]
                if kept and "pan" in kinds:
                    continue
                out[p] = time >= 0.75 if on else time <= 0.25
                if kept:  # it leaves the face for the body when it turns, and is not to wait for that
                    pitch = self.track.rotation[p, at, 1]
                    out[p] &= np.abs(pitch - pitch[-1 if on else 0]) < _TURNED
                out[p, -1 if on else 0] = True
            elif kinds & {"dolly", "pedestal"} and self.draw.travel[p] > 0 and self.draw.before[p] != 0.5:
                out[p] = time >= 0.4 if self.draw.before[p] == 1.0 else time <= 0.6
        return out

    def params(self, p: int, roll: float) -> dict[str, float | str]:
        """The drawn variables of one candidate, as docs/cinema.md lists them."""
        movement = of_camera(self.movements[p])
        d, kind = self.draw, family(movement)
        out: dict[str, float | str] = {
            "r": float(d.r[p]),
            "theta": float(d.theta[p]),
            "phi": float(d.phi[p]),
            "azimuth": float(self.relative[p]),
            "focal": float(d.focal[p]),
            "lambda": float(d.lam[p]),
            "roll": roll,
            "floor_clearance": FLOOR_CLEARANCE,
            "reference": "end" if d.key[p] else "start",
        }
        if self.rig == "paper":
            out["reference_height"] = float(self.height[p])
        else:
            out |= {f"offset_{a}": float(d.offset[p, k]) for k, a in enumerate("xyz")}
        first, _, too = movement.partition("+")
        out |= _moved(first, d, p, "")
        if too:
            out |= {"lambda_2": float(self.second.lam[p])} | _moved(too, self.second, p, "_2")
        if kind in ("dolly", "pedestal"):
            for word, t in (("start", 0), ("end", -1)):
                out |= {f"{word}_{a}": float(self.track.position[p, t, k]) for k, a in enumerate("xyz")}
        if RACK in self.movements[p].split("+"):
            out["lambda_focus"] = float(self.second.lam[p])
        low = float(self.track.position[p, :, 2].min()) - self.floor
        if self.lifted[p] > 1e-9 or low <= FLOOR_CLEARANCE + 1e-9:
            out["lifted"] = float(self.lifted[p])
        return out


def _moved(movement: str, d: Draw, p: int, suffix: str) -> dict[str, float | str]:
    """What was drawn for one movement."""
    kind = family(movement)
    out: dict[str, float | str] = {}
    if kind in ("push", "pull", "zoom", "dolly-zoom"):
        out["mu"] = float(d.mu[p])
    if kind in ("push", "pull", "zoom") and d.rise[p]:
        out["rise"] = float(d.rise[p])
    if kind in ("tilt", "pan", "arc", "crane", "roll", "whip-pan"):
        out["turn"] = float(SIGN[movement] * d.turn[p])
    if kind in ("tilt", "pan", "roll"):
        out["ending"] = "on" if d.on[p] else "off"
    return {name + suffix: value for name, value in out.items()}


def joined(parts: list[Shooting]) -> Shooting:
    """Several as one."""

    def cat(name: str) -> NDArray[np.float64]:
        return np.concatenate([getattr(p, name) for p in parts])

    track = CameraTrack(
        np.concatenate([p.track.position for p in parts]),
        np.concatenate([p.track.rotation for p in parts]),
        np.concatenate([p.track.focal for p in parts]),
        np.concatenate([p.track.look_at for p in parts]),
        parts[0].track.sensor,
    )
    draw = Draw(*(np.concatenate([getattr(p.draw, f.name) for p in parts]) for f in fields(Draw)))
    second = Draw(*(np.concatenate([getattr(p.second, f.name) for p in parts]) for f in fields(Draw)))
    return Shooting(
        parts[0].rig,
        track,
        cat("order").astype(np.int64),
        tuple(w for p in parts for w in p.movements),
        tuple(w for p in parts for w in p.scales),
        tuple(w for p in parts for w in p.angles),
        cat("key").astype(np.int64),
        draw,
        second,
        cat("lifted"),
        cat("relative"),
        cat("height"),
    )
