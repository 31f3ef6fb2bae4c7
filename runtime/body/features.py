"""The head's and hands' pieces: skin cut into eyes' openings and lips, eyeballs, lids, brows, glasses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .anatomy import ARM_FRAME, Figure, arm
from .beards import beard_pieces
from .field import Field, Points, Values
from .hair import hair_cover, hair_pieces
from .hats import hat_line, hat_pieces, hides_hair
from .head import (
    EARS_COVERED,
    Head,
    brow_line,
    ear,
    ear_bowl,
    eye_lines,
    eye_region,
    face,
    lips,
    mouth,
    nose_region,
    on_front,
    under_jaw,
    under_nose,
    with_neck,
)
from .pieces import Piece, hemmed, parted, parted_all, shade
from .sheets import sheet, tube
from .spec import Colour
from .surface import Bend, Focus, Patch, clip, cull, cut_out, half, polygonise, simplify

_WHITE: Colour = (0.97, 0.96, 0.94)
_DARK: Colour = (0.10, 0.07, 0.07)
_LASH: Colour = (0.15, 0.10, 0.09)
#: Of what is dark between parted lips.
MOUTH: Colour = (0.25, 0.08, 0.08)
_TEETH: Colour = (0.96, 0.94, 0.90)
_ROW = 0.84  # how far to the side the upper teeth go, as a share of half of the mouth


def head_pieces(f: Figure) -> list[Piece]:
    """Everything above the collar."""
    head = Head(f)
    pieces = [*_skin(head), *_ears(head), *_eyes(head), *_brows(head), *_glasses(head)]
    return [*pieces, *_hair(head), *beard_pieces(head), *hat_pieces(head)]


def _hair(head: Head) -> list[Piece]:
    """Hair as far as the hat leaves it to be seen."""
    if hides_hair(head):
        return []
    line = hat_line(head)
    pieces = hair_pieces(head)
    if line is None:
        return pieces
    return [replace(p, patch=clip(p.patch, head.field(line), keep_outside=True)) for p in pieces]


def limb_pieces(f: Figure) -> list[Piece]:
    """The bare arms with their hands, as far as sleeves may leave them free."""
    solid = arm(f)
    h, reach = f.p.height, f.p.upper_arm + f.p.forearm + 1.1 * f.p.hand
    origin = f.joint("upperarm_l")
    long_sleeves = f.spec.top not in ("tshirt", "tank", "scrubs", "dress", "gown")
    start = (f.p.upper_arm + f.p.forearm) * 0.90 if long_sleeves else 0.22 * f.p.upper_arm
    local: Field = lambda q: solid(q @ ARM_FRAME + origin)  # noqa: E731
    patch = polygonise(local, (start, -0.065 * h, -0.06 * h), (reach, 0.065 * h, 0.06 * h), 0.0045 * h / 1.7)
    wrist = f.p.upper_arm + f.p.forearm
    focus = Focus((wrist + 0.55 * f.p.hand, 0.0, 0.0), 0.6 * f.p.hand, 2.2)
    elbow = Bend((f.p.upper_arm, 0.0, 0.0), (1.0, 0.0, 0.0), 0.054 * h, 0.060 * h, 0.010 * h)
    patch = simplify(patch, round((500 if long_sleeves else 790) * f.detail), local, (focus, elbow))
    patch = Patch(
        patch.vertices @ ARM_FRAME + origin,
        patch.faces[:, ::-1] if np.linalg.det(ARM_FRAME) < 0 else patch.faces,
    )
    piece = Piece(patch, f.spec.skin, "skin", solid, symmetry="side")
    return _gloved(f, piece) if f.spec.gloves else [piece]


def _gloved(f: Figure, piece: Piece) -> list[Piece]:
    """Hands in gloves that reach over the wrist."""
    hard = f.spec.top in ("armour", "spacesuit")
    colour = shade(f.spec.top_color, 0.85) if hard else f.spec.accent_color
    origin = f.joint("upperarm_l")
    line = f.p.upper_arm + 0.90 * f.p.forearm
    return parted(piece, lambda p: line - (p - origin) @ ARM_FRAME[0], colour, "gloves")


def _skin(head: Head) -> list[Piece]:
    f, u, o = head.figure, head.unit, head.origin
    solid = with_neck(head)
    low, high = o + np.array([-0.55, -0.04, -0.76]) * u, o + np.array([0.60, 0.48, 1.05]) * u
    patch = polygonise(solid, low, high, 0.0150 * u)
    centre = o + np.array([0.30, 0.10, 0.34]) * u
    focus = Focus((float(centre[0]), float(centre[1]), float(centre[2])), 0.24 * u, 3.6)
    patch = half(simplify(patch, round(1680 * f.detail), solid, (focus,)))
    cover = hair_cover(head)
    if cover is not None:
        patch = cull(patch, cover, 0.012 * u)
    under_hat = hat_line(head)
    if under_hat is not None:
        patch = cull(patch, head.field(under_hat), 0.05 * u)
    line = o[2] - 0.72 * u
    side, nape, back = 0.058 * f.p.height, f.level(1.04), f.joint("neck")[0] - 0.012 * f.p.height

    def shown(p: Points) -> Values:
        """Less than clothes may leave bare is hidden anyway."""
        wide = np.where(p[:, 2] < o[2] - 0.1 * u, p[:, 1] - side, -1.0)
        behind = np.where(p[:, 0] < back, nape - p[:, 2], -1.0)
        return np.maximum(np.maximum(line - p[:, 2], wide), behind)

    patch = clip(patch, shown)
    _opening, patch = cut_out(
        patch, head.field(eye_region(head)), [head.field(line) for line in eye_lines(head)]
    )
    lash = head.field(_lash_outline(head))
    piece = Piece(patch, f.spec.skin, "skin", solid, rule="face")
    piece = hemmed(piece, 0.034 * u)
    skin, rim = parted(piece, lash, _LASH, "skin")
    skin, jaw = parted(skin, head.field(under_jaw(head)), shadow_colour(f), "skin")
    jaw = replace(jaw, material="shade")
    lines = [head.field(line) for line in under_nose(head)]
    under, patch = cut_out(skin.patch, head.field(nose_region(head)), lines)
    nose, skin = replace(jaw, patch=under), replace(skin, patch=patch)
    *rest, _slit = parted_all(skin, [head.field(cut) for cut in mouth(head)], MOUTH, "skin")
    outline = [head.field(cut) for cut in lips(head)]
    looks = [look for piece in rest for look in parted_all(piece, outline, lip_colour(f), "skin")]
    return [rim, jaw, nose, *looks, *_mouth(head)]


def _mouth(head: Head) -> list[Piece]:
    """What is seen between parted lips: the upper teeth, darkness behind them."""
    m, half_ = head.mouth_z, head.mouth_half
    aside = np.linspace(0.0, 1.0, 8)[:, None]
    # a bowl: at the corners of the lips nearly as far out as these, or one would look past it from aside
    rows = m + np.linspace(-0.105, 0.050, 7) * (1.0 - 0.7 * aside**2)
    back = _behind(head, half_ * aside, rows, 0.040 - 0.033 * aside, below=2)
    side = np.linspace(0.0, _ROW, 7)[:, None]
    low = m + 0.0075 + 0.012 * (side / _ROW) ** 2  # the corner teeth are shorter
    teeth = _behind(head, half_ * side, low + np.linspace(0.0, 0.0425, 3), np.linspace(0.022, 0.036, 3))
    return [
        Piece(back, MOUTH, "skin", None, rule="mouth"),
        Piece(teeth, _TEETH, "skin", None, rule="teeth"),
    ]


def _behind(head: Head, across: Values, up: Values, depth: Values | float, below: int = 0) -> Patch:
    """A sheet at Y >= 0 over widths ``across`` at heights ``up``, ``depth`` behind the foremost skin, facing
    forward; all broadcast to [C, R]. below: behind the skin of so many rows below as well, to which an
    opening jaw brings it"""
    y, z = np.broadcast_arrays(across, up)
    points = on_front(face(head), y.reshape(-1), z.reshape(-1)).reshape(*y.shape, 3)
    front = points[..., 0].copy()
    for k in range(1, below + 1):
        points[:, k:, 0] = np.minimum(points[:, k:, 0], front[:, :-k])
    points[..., 0] -= depth
    return sheet(head.metres(points.reshape(-1, 3)).reshape(points.shape), head.metres(np.zeros((1, 3)))[0])


def _ears(head: Head) -> list[Piece]:
    if head.figure.spec.hair in EARS_COVERED or head.figure.spec.hat == "veil":
        return []
    solid, u = head.field(ear(head)), head.unit
    low, high = head.metres(np.array([-0.2, 0.22, 0.28])), head.metres(np.array([0.12, 0.48, 0.66]))
    patch = simplify(polygonise(solid, low, high, 0.0115 * u), 170, solid)
    whole = Piece(patch, head.figure.spec.skin, "skin", solid, rule="head", symmetry="side")
    ear_, bowl = parted(whole, head.field(ear_bowl(head, 0.006)), shadow_colour(head.figure), "skin")
    return [ear_, replace(bowl, material="shade")]


def _lash_outline(head: Head) -> Field:
    """A thin crescent along the upper lid."""
    thick = 0.010 + 0.008 * head.fem
    outer = eye_lines(head, grow=0.004, lift=thick)
    ez = head.eye[2]

    def field(p: Points) -> Values:
        return np.maximum.reduce([line(p) for line in outer] + [ez + 0.006 - p[:, 2]])

    return field


def shadow_colour(f: Figure) -> Colour:
    """Skin that never sees the light: darker, and warmer for the light that skin throws on skin."""
    r, g, b = f.spec.skin
    return (0.85 * r, 0.77 * g, 0.73 * b)


def lip_colour(f: Figure) -> Colour:
    """Redder than the skin, more so for women."""
    r, g, b = f.spec.skin
    t = 0.30 + 0.35 * f.fem
    target = (0.72 * (0.55 + 0.45 * r), 0.27 * (0.4 + 0.6 * g), 0.28 * (0.4 + 0.6 * b))
    return (r + (target[0] - r) * t, g + (target[1] - g) * t, b + (target[2] - b) * t)


def ball(centre: NDArray[np.float64], radius: float, polar: list[float], segments: int) -> Patch:
    """A sphere's part around +X between polar angles (radians, the first may be 0)."""
    turn = np.arange(segments) * 2 * np.pi / segments
    rings = [
        np.stack([np.full(segments, np.cos(a)), np.sin(a) * np.cos(turn), np.sin(a) * np.sin(turn)], 1)
        for a in polar
    ]
    vertices = centre + radius * np.concatenate(rings)
    faces = []
    for i in range(len(polar) - 1):
        for k in range(segments):
            a, b = i * segments + k, i * segments + (k + 1) % segments
            c, d = a + segments, b + segments
            if polar[i] > 0:
                faces.append((a, d, b))
            faces.append((a, c, d))
    return Patch(vertices, np.array(faces, np.int64))


def _eyes(head: Head) -> list[Piece]:
    """Left eyeball in rings of pupil, iris and white with a glint, and the lid that closes over it."""
    f, r = head.figure, head.eye_radius * head.unit
    centre = head.metres(head.eye[None])[0]
    iris = float(np.arcsin(0.050 / head.eye_radius))
    pupil = 0.50 * iris
    seen: Field = lambda p: np.linalg.norm(p - centre, axis=1) - r  # noqa: E731

    def ring(angles: list[float], colour: Colour) -> Piece:
        patch = ball(centre, r, angles, 18)
        return Piece(patch, colour, "eye", seen, rule="eye_l", symmetry="side")

    pieces = [
        ring([0.0, pupil], _DARK),
        ring([pupil, 0.82 * iris], f.spec.eye_color),
        ring([0.82 * iris, iris], shade(f.spec.eye_color, 0.45)),
        ring([iris, 0.75, 1.05, 1.5], _WHITE),
    ]
    tilt = np.array([0.93, -0.12, 0.26])
    glint = ball(np.zeros(3), r * 1.012, [0.0, 0.085], 8)
    axis = tilt / np.linalg.norm(tilt)
    across = np.cross((0.0, 0.0, 1.0), axis)
    across /= np.linalg.norm(across)
    basis = np.stack([axis, across, np.cross(axis, across)])
    spot = Patch(glint.vertices @ basis + centre, glint.faces)
    pieces.append(Piece(spot, (1.0, 1.0, 1.0), "eye", seen, rule="eye_l", symmetry="side"))
    return pieces + _lid(head, centre, r * 1.045, seen)


#: Turn about Y, radians, that closes an upper lid; and one that draws the lower lid over the iris.
LID_CLOSED, UNDERLID_CLOSED = 1.0, -0.55


def _lid(head: Head, centre: NDArray[np.float64], radius: float, seen: Field) -> list[Piece]:
    """Shells in front of the eyeball, out of sight behind the skin until they are turned."""
    upper, lash = _shell(centre, radius, (-0.42, 0.75), 0.10, -LID_CLOSED)
    lower, line = _shell(centre, radius, (-0.85, -0.12), 0.0, -UNDERLID_CLOSED)
    skin = head.figure.spec.skin
    looks = (
        (upper, shade(skin, 0.90), "lid_l"),
        (lash, _LASH, "lid_l"),
        (lower, shade(skin, 0.94), "underlid_l"),
        (line, shade(skin, 0.62), "underlid_l"),
    )
    return [Piece(patch, colour, "skin", seen, rule=rule, symmetry="side") for patch, colour, rule in looks]


def _shell(
    centre: NDArray[np.float64], radius: float, pitches: tuple[float, float], droop: float, turn: float
) -> tuple[Patch, Patch]:
    """Part of a ball between two pitches, turned about Y; and its border strip next to the pupil."""
    side, up = np.linspace(-1.06, 1.06, 11), np.linspace(*pitches, 5)
    yaw, pitch = np.meshgrid(side, up, indexing="ij")
    pitch = pitch + droop * (yaw / 1.06) ** 2 * (pitch < 0)
    points = np.stack([np.cos(yaw) * np.cos(pitch), np.sin(yaw), np.cos(yaw) * np.sin(pitch)], -1).reshape(
        -1, 3
    )
    c, s = np.cos(turn), np.sin(turn)
    turned = np.stack(
        [points[:, 0] * c + points[:, 2] * s, points[:, 1], -points[:, 0] * s + points[:, 2] * c], 1
    )
    rows, columns = len(side), len(up)
    a = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1)
    faces = np.concatenate(
        [np.stack([a, a + columns, a + columns + 1], 1), np.stack([a, a + columns + 1, a + 1], 1)]
    )
    column = faces % columns
    border = column.max(1) <= 1 if turn < 0 else column.min(1) >= columns - 2
    vertices = centre + radius * turned
    return Patch(vertices, faces[~border]), Patch(vertices, faces[border])


def brow_colour(f: Figure) -> Colour:
    """The hair's, dark enough to read."""
    r, g, b = f.spec.hair_color
    light = 0.3 * r + 0.6 * g + 0.1 * b
    return shade((r, g, b), 0.62 if light > 0.35 else 0.85)


def _brows(head: Head) -> list[Piece]:
    line = brow_line(head)
    t = np.linspace(0.0, 1.0, len(line))
    strong = 1.0 - 0.30 * head.fem - 0.20 * head.figure.spec.youth
    tall = 0.0235 * strong * (0.85 + 0.3 * np.sin(np.pi * np.minimum(t + 0.25, 1.0))) * (1.0 - 0.72 * t**2.2)
    sizes = np.stack([0.6 * tall + 0.004, tall], 1)
    patch = tube(head.metres(line), sizes * head.unit, np.tile([0.0, 0.0, 1.0], (len(line), 1)))
    return [Piece(patch, brow_colour(head.figure), "skin", None, rule="brow", symmetry="side")]


def _glasses(head: Head) -> list[Piece]:
    """Round frames, bridge and temples."""
    if not head.figure.spec.glasses:
        return []
    ex, ey, ez = head.eye
    turn = np.linspace(0.0, 2 * np.pi, 21)
    x = ex + 0.150 - 0.25 * np.clip(np.cos(turn), 0.0, 1.0) ** 2 * 0.16
    rim = np.stack([x, ey + 0.124 * np.cos(turn), ez - 0.012 + 0.100 * np.sin(turn)], 1)
    arm_ = np.array(
        [
            [ex + 0.11, ey + 0.124, ez + 0.02],
            [0.10, 0.315, ez + 0.03],
            [-0.03, 0.345, ez + 0.03],
            [-0.08, 0.345, ez - 0.03],
        ]
    )
    bridge = np.array(
        [
            [ex + 0.150, ey - 0.122, ez + 0.012],
            [ex + 0.170, 0.012, ez + 0.030],
            [ex + 0.170, -0.001, ez + 0.030],
        ]
    )
    pieces = []
    for line, size in ((rim, 0.0095), (arm_, 0.009), (bridge, 0.009)):
        up = (
            np.tile([1.0, 0.0, 0.0], (len(line), 1))
            if line is rim
            else np.tile([0.0, 0.0, 1.0], (len(line), 1))
        )
        patch = tube(head.metres(line), np.full((len(line), 2), size * head.unit), up, 5)
        pieces.append(Piece(patch, (0.10, 0.09, 0.10), "glasses", None, rule="head", symmetry="side"))
    return pieces
