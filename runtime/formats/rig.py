"""Skeletons of other programs, and which of their bones are which of our joints.

Bones are found by name first (the common ways to name them) and, where names say nothing, by structure: the
two chains that end lowest are legs, the two that reach furthest out are arms, what lies between them is the
spine. All positions are Z up; where people face is found from their feet, or from which side is called left.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Without these nobody can be moved.
NEEDED = ("hips", "thigh_l", "shin_l", "foot_l", "thigh_r", "shin_r", "foot_r",
          "upperarm_l", "forearm_l", "hand_l", "upperarm_r", "forearm_r", "hand_r")  # fmt: skip

#: Names of sided bones, without side and number, run together; the first that is there counts.
_SIDED = {
    "thigh": ("upleg", "upperleg", "thigh", "legupper", "femur", "hip", "hipjoint"),
    "shin": ("lowerleg", "lowleg", "calf", "shin", "leglower", "knee", "leg", "tibia"),
    "foot": ("foot", "ankle"),
    "toe": ("toebase", "toe", "toes", "ball"),
    "clavicle": ("clavicle", "collar", "shoulder", "collarbone"),
    "upperarm": ("upperarm", "uparm", "armupper", "arm", "humerus", "shoulder"),
    "forearm": ("forearm", "lowerarm", "lowarm", "armlower", "elbow", "radius"),
    "hand": ("hand", "wrist"),
}
_CENTRE = {
    "hips": ("hips", "pelvis", "hip", "root", "hiproot"),
    "neck": ("neck",),
    "head": ("head",),
}
_FINGERS = ("thumb", "index", "middle", "ring", "pinky", "little", "finger", "palm")
_NOISE = re.compile(
    r"^(?:.*[:|])|^(?:def|org|mch|bip\d*|b|bn|bone|jnt|j|rig|valvebiped)[-_. ](?=\w)", re.IGNORECASE
)


@dataclass(frozen=True, eq=False)
class Rig:
    """Bones, parents first, in a pose that serves as rest.

    parents: -1 for roots; position: float64 [B, 3], Z up; ends: [B, 3], where a bone without children ends
    (its own position where that is not known)
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    position: Array
    ends: Array

    @property
    def children(self) -> list[list[int]]:
        out: list[list[int]] = [[] for _ in self.names]
        for i, parent in enumerate(self.parents):
            if parent >= 0:
                out[parent].append(i)
        return out

    def chain(self, bone: int) -> list[int]:
        """The bone and all those above it, from the root down."""
        out = [bone]
        while self.parents[out[-1]] >= 0:
            out.append(self.parents[out[-1]])
        return out[::-1]


@dataclass(frozen=True, eq=False)
class Match:
    """Bones by our joints' names, and world_from_rig [3, 3]: the turn about Z that has them face +X."""

    bones: dict[str, int]
    facing: Array


def match(rig: Rig) -> Match | None:
    """Our joints among the bones; None where they are no person's."""
    found = _by_name(rig)
    if found is None:
        found = _by_structure(rig)
    if found is None:
        return None
    forward = _forward(rig, found)
    c, s = forward[0], forward[1]
    facing = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    side = (rig.position[found["thigh_l"]] - rig.position[found["thigh_r"]]) @ facing[1]
    arms = (rig.position[found["hand_l"]] - rig.position[found["hand_r"]]) @ facing[1]
    if side + arms < 0:  # left and right by their feet, whatever they are called
        swap = {"l": "r", "r": "l"}
        found = {n if n[-2:-1] != "_" else f"{n[:-1]}{swap[n[-1]]}": b for n, b in found.items()}
    return Match(found, facing)


# --- names ----------------------------------------------------------------------------


def plain(name: str) -> tuple[str, str]:
    """A bone's name run together without side and number, and its side: ``l``, ``r`` or ``""``."""
    text = name
    while (shorter := _NOISE.sub("", text, count=1)) != text:
        text = shorter
    text = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)
    words = [w for w in re.split(r"[^A-Za-z]+", text) if w]
    side = ""
    kept = []
    for word in words:
        low = word.lower()
        if low in ("l", "left", "lft"):
            side = "l"
        elif low in ("r", "right", "rgt"):
            side = "r"
        elif low not in ("joint", "jnt", "bone", "skeleton", "bind", "def"):
            kept.append(low)
    joined = "".join(kept)
    if not side:
        for word, short in (("left", "l"), ("right", "r")):
            if joined.startswith(word) or joined.endswith(word):
                side, joined = short, joined.replace(word, "", 1)
    return joined, side


def _by_name(rig: Rig) -> dict[str, int] | None:
    named: dict[tuple[str, str], int] = {}
    for i, name in enumerate(rig.names):
        named.setdefault(plain(name), i)
    found: dict[str, int] = {}
    for joint, options in _SIDED.items():
        for side in "lr":
            for option in options:
                if (option, side) in named and named[option, side] not in found.values():
                    found[f"{joint}_{side}"] = named[option, side]
                    break
    for joint, options in _CENTRE.items():
        for option in options:
            if (option, "") in named:
                found[joint] = named[option, ""]
                break
    for side in "lr":  # a shoulder without an arm is the arm
        if f"upperarm_{side}" not in found and f"clavicle_{side}" in found:
            found[f"upperarm_{side}"] = found.pop(f"clavicle_{side}")
        toe = found.get(f"toe_{side}")
        if toe is not None and found.get(f"foot_{side}") not in rig.chain(toe):
            del found[f"toe_{side}"]
    hips = _hips(rig, found)
    if hips is not None:
        found["hips"] = hips
    if not all(joint in found and found[joint] >= 0 for joint in NEEDED) or not _in_order(rig, found):
        return None
    return _with_spine(rig, found)


def _hips(rig: Rig, found: dict[str, int]) -> int | None:
    """The bone that legs and arms hang on, near the legs: the one of that name only where it is there."""
    limbs = [found.get(f"{joint}_{side}") for joint in ("thigh", "upperarm") for side in "lr"]
    known = [bone for bone in limbs if bone is not None]
    feet = [found.get(f"foot_{side}") for side in "lr"]
    if len(known) < 4 or None in feet:
        return found.get("hips")
    middle = (rig.position[known[0]] + rig.position[known[1]]) / 2
    leg = float(np.linalg.norm(rig.position[known[0]] - rig.position[feet[0]]))
    named = found.get("hips", -1)
    for bone in (named, _common(rig, known), _common(rig, known[:2])):
        above = bone >= 0 and all(bone in rig.chain(limb)[:-1] for limb in known[:2])
        if above and np.linalg.norm(rig.position[bone] - middle) < 0.4 * leg:
            return bone
    return None


def _in_order(rig: Rig, found: dict[str, int]) -> bool:
    """Whether limbs hang together as they should."""
    for side in "lr":
        for limb in (("thigh", "shin", "foot"), ("upperarm", "forearm", "hand")):
            bones = [found[f"{joint}_{side}"] for joint in limb]
            chain = rig.chain(bones[-1])
            if len(set(bones)) < 3 or not all(b in chain for b in bones):
                return False
            if not chain.index(bones[0]) < chain.index(bones[1]) < chain.index(bones[2]):
                return False
    return True


# --- structure ------------------------------------------------------------------------


def _by_structure(rig: Rig) -> dict[str, int] | None:
    children = rig.children
    leaves = [i for i in range(len(rig.names)) if not children[i]]
    if len(leaves) < 4:
        return None
    z = rig.position[:, 2]
    size = float(np.ptp(rig.position, axis=0).max())
    low = sorted(leaves, key=lambda i: z[i])
    feet = _two_apart(rig, low, 0.03 * size)
    if feet is None:
        return None
    hips = _common(rig, feet)
    if hips < 0:
        return None
    above = [i for i in leaves if hips in rig.chain(i) and z[i] > z[hips]]
    centre = rig.position[hips, :2]
    wide = sorted(above, key=lambda i: -float(np.linalg.norm(rig.position[i, :2] - centre)))
    hands = _two_apart(rig, wide, 0.08 * size)
    if hands is None:
        return None
    chest = _common(rig, hands)
    found = {"hips": hips}
    sides = _sides(rig, feet, hands)
    for side, foot in zip("lr", sides[0], strict=True):
        chain = rig.chain(foot)[rig.chain(foot).index(hips) + 1 :]
        if len(chain) < 3:
            return None
        limb = _leg(rig, chain)
        found |= {
            f"{joint}_{side}": bone
            for joint, bone in zip(("thigh", "shin", "foot", "toe"), limb, strict=False)
        }
    for side, hand in zip("lr", sides[1], strict=True):
        chain = rig.chain(hand)[rig.chain(hand).index(chest) + 1 :]
        fingers = next((k for k, b in enumerate(chain) if len(children[b]) > 1), None)
        if fingers is not None:
            chain = chain[: fingers + 1]
        if len(chain) < 3:
            return None
        limb = chain[:3] if len(chain) == 3 else chain[-4:] if fingers is not None else chain[:4]
        if len(limb) == 4:
            found[f"clavicle_{side}"] = limb[0]
        found |= {f"{j}_{side}": b for j, b in zip(("upperarm", "forearm", "hand"), limb[-3:], strict=True)}
    return _with_spine(rig, found) if _in_order(rig, found) else None


def _two_apart(rig: Rig, order: Sequence[int], distance: float) -> tuple[int, int] | None:
    """The first two of the order that are neither near each other nor on one chain."""
    for first in order[:1]:
        for other in order[1:]:
            apart = float(np.linalg.norm(rig.position[first, :2] - rig.position[other, :2]))
            if apart > distance and len(rig.chain(_common(rig, (first, other)))) + 2 <= len(rig.chain(first)):
                return first, other
    return None


def _common(rig: Rig, bones: Sequence[int]) -> int:
    """The lowest bone above all of these; -1 where there is none."""
    chains = [rig.chain(b)[:-1] for b in bones]
    common = -1
    for level in zip(*chains, strict=False):
        if len(set(level)) > 1:
            break
        common = level[0]
    return common


def _sides(
    rig: Rig, feet: tuple[int, int], hands: tuple[int, int]
) -> tuple[tuple[int, int], tuple[int, int]]:
    """Feet and hands, left first (by name where it says, else as may be: facing settles it later)."""
    across = rig.position[feet[0]] - rig.position[feet[1]]
    if float((rig.position[hands[0]] - rig.position[hands[1]]) @ across) < 0:
        hands = hands[::-1]
    votes = sum({"l": 1, "r": -1, "": 0}[plain(rig.names[i])[1]] for i in (feet[0], hands[0]))
    return (feet[::-1], hands[::-1]) if votes < 0 else (feet, hands)


def _leg(rig: Rig, chain: list[int]) -> list[int]:
    """Thigh, shin, foot and, where there is one, toe of a chain from the hips down."""
    if len(chain) <= 4:
        return chain
    length = np.linalg.norm(np.diff(rig.position[chain], axis=0), axis=1)
    start = int(np.argmax(length[:-2]))  # the first long bone is the thigh
    return chain[start : start + 4]


def _with_spine(rig: Rig, found: dict[str, int]) -> dict[str, int]:
    """Adds spine, chest, neck and head: what lies between hips, arms and crown."""
    arms = [found.get(f"clavicle_{s}", found[f"upperarm_{s}"]) for s in "lr"]
    chest = _common(rig, arms)
    chain = rig.chain(chest) if chest >= 0 else []
    if found["hips"] in chain:
        between = chain[chain.index(found["hips"]) + 1 :]
        if between:
            found["chest"] = between[-1]
        if len(between) > 1:
            found["spine"] = between[0]
    if "head" not in found and chest >= 0:
        leaves = [i for i, below in enumerate(rig.children) if not below]
        chains = {i: set(rig.chain(i)) for i in leaves if i != chest}
        tops = [i for i, chain in chains.items() if chest in chain and not chain & set(arms)]
        if tops:
            top = max(tops, key=lambda i: float(rig.position[i, 2]))
            path = rig.chain(top)[rig.chain(top).index(chest) + 1 :]
            found["head"] = path[-1] if len(path) < 3 else path[1]
            if len(path) > 1:
                found["neck"] = path[0]
    elif "neck" not in found and "head" in found:
        above = rig.chain(found["head"])
        if chest in above and above.index(chest) + 1 < len(above) - 1:
            found["neck"] = above[above.index(chest) + 1]
    return found


def _forward(rig: Rig, found: dict[str, int]) -> Array:
    """Unit [2]: where the person faces. From the toes; else from left and right; else +Y as rest."""
    size = float(np.ptp(rig.position[:, 2])) or 1.0
    total = np.zeros(2)
    for side in "lr":
        foot = found[f"foot_{side}"]
        toe = found.get(f"toe_{side}")
        end = rig.position[toe] if toe is not None else rig.ends[foot]
        total += (end - rig.position[foot])[:2]
    if np.linalg.norm(total) > 0.03 * size:
        return np.asarray(total / np.linalg.norm(total))
    across = sum(
        ((rig.position[found[f"{j}_l"]] - rig.position[found[f"{j}_r"]])[:2] for j in ("thigh", "upperarm")),
        np.zeros(2),
    )
    if np.linalg.norm(across) > 1e-6:
        left = across / np.linalg.norm(across)
        return np.array([left[1], -left[0]])
    return np.array([0.0, -1.0])


def finger_joint(name: str) -> str | None:
    """Which joint of our hand a finger bone belongs to: ``thumb``, ``index``, ``indextip``, ``fingers`` …"""
    text, _ = plain(name)
    number = re.search(r"(\d+)(?!.*\d)", name)
    first = number is None or int(number.group(1)) in (0, 1)
    for finger in _FINGERS:
        if finger in text:
            if finger == "thumb":
                return "thumb"
            if finger == "palm":
                return "hand"
            if finger == "index":
                return "index" if first else "indextip"
            return "fingers" if first else "fingertips"
    return None
