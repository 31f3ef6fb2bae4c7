"""Motion of other programs on our joints: :func:`read_clip`.

What a bone turns by from the pose it rests in is what our joint turns by; the way of the hips is measured in
lengths of the leg, so that it fits every body. Feet are made to stand where it is played
(:mod:`runtime.motion.replay`).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from runtime.body.skeleton import JOINT, JOINTS
from runtime.motion.types import Capture

from . import limits
from .bvh import read_bvh
from .errors import ModelFileError
from .gltf import Gltf, open_gltf
from .model import upright
from .person import read_skin
from .pose import bind_turns, posed
from .rig import Match, Rig, match

Array = NDArray[np.float64]
#: Frames a second at which glTF motion is looked at.
RATE = 30.0
SHORTEST, LONGEST = 0.2, 120.0


def read_clip(
    path: Path, folder: Path, clip: str = "", cut: tuple[float, float | None] = (0.0, None),
    up: str = "", turn: float = 0.0, times: int = 1, stays: bool = False,
) -> Capture:  # fmt: skip
    """The motion of a file, or its part between two times in seconds, played ``times`` over.

    clip: a motion's name, "" for the first; stays: without leaving the spot
    """
    linear = _about_z(turn) @ upright(up != "z")
    if path.suffix.lower() == ".bvh":
        made = _bvh(path, cut, linear)
    else:
        made = _gltf(open_gltf(path, folder), clip, cut, up, turn, linear)
    if stays:
        made = _staying(made)
    return _repeated(made, times)


def _bvh(path: Path, cut: tuple[float, float | None], linear: Array) -> Capture:
    motion = read_bvh(path)
    rest = motion.rest() @ linear.T
    ends = rest.copy()
    for i, parent in enumerate(motion.parents):
        if parent >= 0 and not motion.names[i]:
            ends[parent] = rest[i]
    rig = Rig(motion.names, motion.parents, rest, ends)
    found = _matched(path, rig)
    turns, at = motion.world()
    own = _cut(path, len(turns), 1.0 / motion.seconds, cut)
    turns = linear @ turns[own] @ linear.T
    return _capture(
        rig, found, np.tile(np.eye(3), (len(rest), 1, 1)), turns, at[own] @ linear.T, 1.0 / motion.seconds
    )


def _matched(path: Path, rig: Rig) -> Match:
    found = match(rig)
    if found is None:
        raise ModelFileError(
            path, "its bones are not those of a person: hips, two legs, a spine and two arms are needed"
        )
    return found


def _cut(path: Path, frames: int, rate: float, cut: tuple[float, float | None]) -> slice:
    first = round(cut[0] * rate)
    last = frames if cut[1] is None else min(frames, round(cut[1] * rate) + 1)
    if last - first < 2 or (last - first) / rate < SHORTEST:
        raise ModelFileError(
            path,
            f"its motion has {frames / rate:.2f} s; between the times asked for there is nothing to play",
        )
    if (last - first) / rate > LONGEST:
        raise ModelFileError(path, f"its motion is longer than {LONGEST:g} s; say `from` and `to`")
    return slice(first, last)


# --- glTF -----------------------------------------------------------------------------


def _gltf(
    gltf: Gltf, clip: str, cut: tuple[float, float | None], up: str, turn: float, linear: Array
) -> Capture:
    names = gltf.file.clips()
    if not names or (clip and clip not in names):
        raise ModelFileError(
            gltf.path, f"there is no motion {clip!r} in it" if clip else "there is no motion in it"
        )
    animation = gltf.tree.animations[names.index(clip) if clip else 0]
    skinned = any(gltf.tree.nodes[i].skin is not None for i in gltf.file.things())
    if skinned:
        skin = read_skin(gltf, up, turn)
        rig, found, nodes, rest = skin.rig, skin.found, list(skin.nodes), skin.rest
    else:
        rig, nodes, rest = _moved(gltf, animation, linear)
        found = _matched(gltf.path, rig)
    end = max((float(gltf.accessor(s.input).max(initial=0.0)) for s in animation.samplers), default=0.0)
    if end > limits.SECONDS:
        raise ModelFileError(gltf.path, f"its motion is longer than {limits.SECONDS:g} s")
    own = _cut(gltf.path, int(end * RATE) + 1, RATE, cut)
    times = np.arange(own.start, own.stop) / RATE
    world = _animated(gltf, animation, times, [nodes[b] for b in found.bones.values()])
    at = np.zeros((len(times), len(nodes), 3))
    turns = np.tile(np.eye(3), (len(times), len(nodes), 1, 1))
    for bone in found.bones.values():
        matrix = world[nodes[bone]]
        size = np.maximum(np.linalg.norm(matrix[:, :3, :3], axis=1, keepdims=True), 1e-12)
        turns[:, bone] = linear @ (matrix[:, :3, :3] / size)
        at[:, bone] = matrix[:, :3, 3] @ linear.T
    return _capture(rig, found, rest, turns, at, RATE)


def _moved(gltf: Gltf, animation: object, linear: Array) -> tuple[Rig, list[int], Array]:
    """The skeleton of a file that has no skin: the nodes that move, and those below them."""
    moved = {c.target.node for c in animation.channels if c.target.node is not None}  # type: ignore[attr-defined]
    parents = gltf.parents()
    nodes = []
    for node in gltf.order():
        above = parents[node]
        if node in moved or (above in nodes and above >= 0):
            nodes.append(node)
    if not nodes or len(nodes) > limits.JOINTS:
        raise ModelFileError(gltf.path, "its motion moves no skeleton")
    index = {n: k for k, n in enumerate(nodes)}
    worlds = gltf.worlds()[nodes]
    at = worlds[:, :3, 3] @ linear.T
    size = np.maximum(np.linalg.norm(worlds[:, :3, :3], axis=1, keepdims=True), 1e-12)
    names = tuple(str(gltf.tree.nodes[n].name or "") for n in nodes)
    rig = Rig(names, tuple(index.get(parents[n], -1) for n in nodes), at, at)
    return rig, nodes, linear @ (worlds[:, :3, :3] / size)


def _animated(gltf: Gltf, animation: object, times: Array, wanted: list[int]) -> dict[int, Array]:
    """world_from_node [T, 4, 4] of the wanted nodes and all above them."""
    parents = gltf.parents()
    needed: set[int] = set()
    for node in wanted:
        while node >= 0 and node not in needed:
            needed.add(node)
            node = parents[node]
    channels: dict[tuple[int, str], Array] = {}
    for channel in animation.channels:  # type: ignore[attr-defined]
        if channel.target.node in needed and channel.target.path in ("translation", "rotation", "scale"):
            sampler = animation.samplers[channel.sampler]  # type: ignore[attr-defined]
            channels[channel.target.node, channel.target.path] = _sampled(
                gltf, sampler, times, channel.target.path
            )
    out: dict[int, Array] = {}
    for node in gltf.order():
        if node in needed:
            local = _locals(gltf, node, channels, len(times))
            out[node] = local if parents[node] < 0 else out[parents[node]] @ local
    return out


def _sampled(gltf: Gltf, sampler: object, times: Array, path: str) -> Array:
    """Values [T, 3 or 4] of one channel at the times."""
    width = 4 if path == "rotation" else 3
    keys = gltf.accessor(sampler.input)[:, 0]  # type: ignore[attr-defined]
    values = gltf.accessor(sampler.output)  # type: ignore[attr-defined]
    if sampler.interpolation == "CUBICSPLINE":  # type: ignore[attr-defined]
        values = values[1::3]
    count = min(len(keys), len(values))
    if count == 0 or values.shape[1] != width or (np.diff(keys) < 0).any():
        raise ModelFileError(gltf.path, "the keys of its motion do not belong together")
    keys, values = keys[:count], values[:count]
    if width == 4:
        flips = np.cumprod(np.where((values[1:] * values[:-1]).sum(1) < 0, -1.0, 1.0))
        values = values * np.concatenate([[1.0], flips])[:, None]
    if sampler.interpolation == "STEP":  # type: ignore[attr-defined]
        return np.asarray(values[np.clip(np.searchsorted(keys, times, side="right") - 1, 0, count - 1)])
    return np.stack([np.interp(times, keys, values[:, k]) for k in range(width)], axis=1)


def _locals(gltf: Gltf, node: int, channels: dict[tuple[int, str], Array], frames: int) -> Array:
    """parent_from_node [T, 4, 4]."""
    paths = [p for p in ("translation", "rotation", "scale") if (node, p) in channels]
    if not paths:
        return np.tile(gltf.local(node), (frames, 1, 1))
    item = gltf.tree.nodes[node]
    shift = channels.get(
        (node, "translation"), np.tile(np.array(item.translation or (0, 0, 0), float), (frames, 1))
    )
    turn = channels.get(
        (node, "rotation"), np.tile(np.array(item.rotation or (0, 0, 0, 1), float), (frames, 1))
    )
    scale = channels.get((node, "scale"), np.tile(np.array(item.scale or (1, 1, 1), float), (frames, 1)))
    x, y, z, w = (turn / np.maximum(np.linalg.norm(turn, axis=1, keepdims=True), 1e-12)).T
    out = np.zeros((frames, 4, 4))
    out[:, 0, 0], out[:, 0, 1], out[:, 0, 2] = (
        1 - 2 * (y * y + z * z),
        2 * (x * y - w * z),
        2 * (x * z + w * y),
    )
    out[:, 1, 0], out[:, 1, 1], out[:, 1, 2] = (
        2 * (x * y + w * z),
        1 - 2 * (x * x + z * z),
        2 * (y * z - w * x),
    )
    out[:, 2, 0], out[:, 2, 1], out[:, 2, 2] = (
        2 * (x * z - w * y),
        2 * (y * z + w * x),
        1 - 2 * (x * x + y * y),
    )
    out[:, :3, :3] *= scale[:, None, :]
    out[:, :3, 3] = shift
    out[:, 3, 3] = 1.0
    return out


# --- our joints -----------------------------------------------------------------------


def _capture(rig: Rig, found: Match, rest: Array, turns: Array, at: Array, rate: float) -> Capture:
    """From turns [T, B, 3, 3] and positions [T, B, 3] of the bones, Z up, to ours."""
    binding = bind_turns(rig, found)
    placed = posed(rig, binding)
    bones = found.bones
    leg = placed[bones["hips"], 2] - (placed[bones["foot_l"], 2] + placed[bones["foot_r"], 2]) / 2
    known = np.zeros(len(JOINTS), bool)
    out = np.tile(np.eye(3), (len(turns), len(JOINTS), 1, 1))
    for joint, bone in bones.items():
        known[JOINT[joint]] = True
        out[:, JOINT[joint]] = found.facing @ turns[:, bone] @ rest[bone].T @ binding[bone].T
    hips = out[:, JOINT["hips"]]
    ahead = hips[: max(1, round(0.1 * rate)), :, 0].mean(0)
    yaw = float(np.arctan2(ahead[1], ahead[0]))
    heading = _about_z(-yaw)
    root = at[:, bones["hips"]] @ (heading @ found.facing).T / max(float(leg), 1e-9)
    root = root - np.array([*root[0, :2], 0.0])
    return Capture(rate, (heading @ out).astype(np.float32), known, root)


def _staying(capture: Capture) -> Capture:
    """Without the way it goes: what is even in it is taken out."""
    share = np.linspace(0.0, 1.0, len(capture.root))[:, None]
    root = capture.root.copy()
    root[:, :2] -= share * (root[-1, :2] - root[0, :2])
    return Capture(capture.fps, capture.turns, capture.known, root)


def _repeated(capture: Capture, times: int) -> Capture:
    """Played over, each time from where and facing as the last ended."""
    if times < 2:
        return capture
    if times * len(capture.turns) / capture.fps > LONGEST:
        times = max(1, int(LONGEST * capture.fps / len(capture.turns)))
    turns, roots = [capture.turns], [capture.root]
    for _ in range(times - 1):
        first, last = turns[0][0, JOINT["hips"], :, 0], turns[-1][-1, JOINT["hips"], :, 0]
        turn = _about_z(float(np.arctan2(last[1], last[0]) - np.arctan2(first[1], first[0])))
        turns.append((turn @ capture.turns[1:]).astype(np.float32))
        way = capture.root[1:] - np.array([*capture.root[0, :2], 0.0])
        roots.append(way @ turn.T + np.array([*roots[-1][-1, :2], 0.0]))
    return Capture(capture.fps, np.concatenate(turns), capture.known, np.concatenate(roots))


def _about_z(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
