"""From the pose a skeleton rests in to our bind pose: facing +X, legs straight down, arms 45° out.

What a bone has to turn by to get there is all that is needed, both to take a skin along and to take a motion
over: a bone that is turned by D in the world moves our joint by D after undoing that turn.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .rig import Match, Rig

Array = NDArray[np.float64]
_DOWN = np.array([0.0, 0.0, -1.0])
_S = 0.5**0.5


def bind_turns(rig: Rig, found: Match) -> Array:
    """float64 [B, 3, 3]: how each bone turns from the rig's rest, facing as it does, to our bind pose."""
    bones, turn = found.bones, np.tile(found.facing, (len(rig.names), 1, 1))
    at = rig.position @ found.facing.T
    ends = rig.ends @ found.facing.T
    own: dict[int, Array] = {}
    for side, m in (("l", 1.0), ("r", -1.0)):
        out = np.array([0.0, m * _S, -_S])
        for bone, end, way in (
            ("thigh", "shin", _DOWN),
            ("shin", "foot", _DOWN),
            ("upperarm", "forearm", out),
            ("forearm", "hand", out),
        ):
            a, b = bones[f"{bone}_{side}"], bones[f"{end}_{side}"]
            own[a] = between(at[b] - at[a], way)
        hand, foot = bones[f"hand_{side}"], bones[f"foot_{side}"]
        own[hand] = own[bones[f"forearm_{side}"]]
        toe = bones.get(f"toe_{side}")
        ahead = ((at[toe] if toe is not None else ends[foot]) - at[foot])[:2]
        yaw = float(np.arctan2(ahead[1], ahead[0])) if np.linalg.norm(ahead) > 1e-6 else 0.0
        own[foot] = _about_z(-np.clip(yaw, -0.8, 0.8))
    own[bones["hips"]] = np.eye(3)
    for joint in ("spine", "chest", "neck", "head", "clavicle_l", "clavicle_r"):
        if joint in bones:
            own[bones[joint]] = np.eye(3)
    current: list[Array] = []
    for i, parent in enumerate(rig.parents):
        inherited = current[parent] if parent >= 0 else np.eye(3)
        current.append(own.get(i, inherited))
        turn[i] = current[i] @ found.facing
    return turn


def posed(rig: Rig, turns: Array) -> Array:
    """float64 [B, 3]: where the bones are after the turns, lengths kept; roots turn about the origin."""
    at = np.zeros_like(rig.position)
    for i, parent in enumerate(rig.parents):
        if parent < 0:
            at[i] = turns[i] @ rig.position[i]
        else:
            at[i] = at[parent] + turns[parent] @ (rig.position[i] - rig.position[parent])
    return at


def between(a: Array, b: Array) -> Array:
    """[3, 3]: the least turn from direction ``a`` to direction ``b``."""
    u, v = a / max(float(np.linalg.norm(a)), 1e-12), b / max(float(np.linalg.norm(b)), 1e-12)
    axis, cosine = np.cross(u, v), float(u @ v)
    if cosine < -0.9999:  # opposite: about any axis across
        side = np.cross(u, [1.0, 0.0, 0.0] if abs(u[0]) < 0.9 else [0.0, 1.0, 0.0])
        side = side / np.linalg.norm(side)
        return np.asarray(2.0 * np.outer(side, side) - np.eye(3))
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.asarray(np.eye(3) + k + k @ k / (1.0 + cosine))


def _about_z(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
