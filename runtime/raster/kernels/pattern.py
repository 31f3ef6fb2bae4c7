"""Procedural materials, evaluated in the world.

Each gives a factor for the base colour around 1. Joints and grains are filtered by the width of a
pixel on the surface and fade out before they could shimmer. Indices are those of
:data:`runtime.mesh.MATERIALS`; 10 and 11 vary so slowly that the shading looks them up every few
pixels (:func:`broad_pattern`), 7 and 8 are no surfaces to light at all.

The others go over the shaded picture (:mod:`.grain`), in its sRGB bytes: a pattern is so faint that the
film's curve is straight along it.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from .geometry import bounded, greater, lesser, vec3

SIDE = 128  # of the lattice of the noise
GRAINED = (1, 2, 3, 4, 5, 6, 9, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22)  # drawn pixel by pixel


def noise_lattice() -> NDArray[np.float32]:
    """Numbers 0..1 at the whole places of the noise, float32 [SIDE * SIDE]; always the same."""
    return np.random.Generator(np.random.PCG64(5)).random(SIDE * SIDE, np.float32)


@ti.func
def hashed(a, b):
    """A number 0..1 for a pair of integers (a finaliser after lowbias32, Wellons 2018)."""
    h = ti.cast(a, ti.u32) * ti.u32(0x9E3779B1) + ti.cast(b, ti.u32) * ti.u32(0x85EBCA77)
    h ^= h >> 16
    h *= ti.u32(0x7FEB352D)
    h ^= h >> 15
    return ti.cast(h >> 8, ti.f32) / 16777216.0


@ti.func
def value_noise(x, y, lattice: ti.template()):
    """Smooth noise 0..1 with features about 1 wide, the same again after SIDE of them."""
    fx, fy = ti.floor(x), ti.floor(y)
    i, j = ti.cast(fx, ti.i32), ti.cast(fy, ti.i32)
    tx, ty = x - fx, y - fy
    tx = tx * tx * (3 - 2 * tx)
    ty = ty * ty * (3 - 2 * ty)
    left, right = i & (SIDE - 1), (i + 1) & (SIDE - 1)
    low, high = (j & (SIDE - 1)) * SIDE, ((j + 1) & (SIDE - 1)) * SIDE
    a = lattice[low + left] + (lattice[low + right] - lattice[low + left]) * tx
    b = lattice[high + left] + (lattice[high + right] - lattice[high + left]) * tx
    return a + (b - a) * ty


@ti.func
def noise_at(x, y, lattice: ti.template()):
    return value_noise(x, y, lattice)


@ti.func
def hashed_at(a, b, lattice: ti.template()):
    return hashed(ti.cast(a, ti.i32), ti.cast(b, ti.i32))


class Alone:
    """Patterns at one place at a time. ``hashed`` takes whole numbers as float32."""

    noise = staticmethod(noise_at)
    hashed = staticmethod(hashed_at)


@ti.func
def positive(x):
    return greater(x, 0.0 - x)


@ti.func
def joint(x, width, blur):
    """Coverage 0..1 of a joint ``width`` wide centred on whole numbers (all in periods of x)."""
    d = positive(x - ti.floor(x + 0.5))
    sharp = 1.0 / greater(blur, 1e-4)
    cover = bounded((0.5 * width - d) * sharp + 0.5, 0.0, 1.0)
    # thinner than a pixel: paler instead of broken; and gone before the period is a few pixels
    return cover * (lesser(1.0, width * sharp) * bounded(1.4 - 4.0 * blur, 0.0, 1.0))


@ti.func
def fade(blur, period):
    """1 where a period is many pixels, 0 where it is few."""
    return bounded(1.5 - 4.0 * blur / period, 0.0, 1.0)


@ti.func
def contour(h, level, width, blur):
    """Coverage 0..1 of the line on which a noise ``h`` has a ``level``; width, blur: in units of h."""
    soft = greater(blur, 0.3 * width)
    cover = bounded((0.5 * width - positive(h - level)) / soft + 0.5, 0.0, 1.0)
    return cover * lesser(1.0, width / soft)


@ti.func
def bonded(u, v, length, height, gap, blur, varied, dark, kind: ti.template(), source: ti.template()):
    """Courses of blocks ``length`` by ``height`` metres, each course shifted: tones, and darker joints."""
    row = v / height
    line = ti.floor(row)
    along = u / length + kind.hashed(line, 11.0, *source)
    tone = kind.hashed(line, ti.floor(along), *source)
    seam = greater(joint(row, gap / height, blur / height), joint(along, gap / length, blur / length))
    return (1.0 + (tone - 0.5) * varied * fade(blur, height)) * (1.0 - dark * seam)


@ti.func
def pattern(material: ti.template(), px, py, pz, n, blur, kind: ti.template(), source: ti.template()):
    """Factor of one of GRAINED at world places, of a face with normal ``n``; blur: a pixel's width, metres.

    kind: how noise is looked up, at one place (:class:`Alone`) or at sixteen; source: what from
    """
    u, v = px, py
    upright = ti.abs(n.z) < 0.7
    if upright:
        v = pz
        if ti.abs(n.x) > ti.abs(n.y):
            u = py
    out = u * 0.0 + 1.0
    if ti.static(material >= 12):
        out = ground_pattern(material, px, py, pz, u, v, upright, blur, kind, source)
    elif ti.static(material == 1):  # wood
        if upright:
            strong = 0.10 * fade(blur, 0.03)
            if strong > 0:
                out = 1.0 + (kind.noise(u * 34.0, v * 2.2, *source) - 0.5) * strong
        else:
            row = v * (1.0 / 0.13)
            line = ti.floor(row)
            along = u * (1.0 / 1.3) + kind.hashed(line, 7.0, *source)
            tone = kind.hashed(line, ti.floor(along), *source)
            out = 1.0 + (tone - 0.5) * 0.13 * fade(blur, 0.13)
            strong = 0.07 * fade(blur, 0.022)
            if strong > 0:
                out += (kind.noise(u * 2.4 + 13.0 * line, v * 46.0, *source) - 0.5) * strong
            gap = greater(
                joint(row, 0.004 / 0.13, blur * (1.0 / 0.13)), joint(along, 0.004 / 1.3, blur * (1.0 / 1.3))
            )
            out *= 1.0 - 0.3 * gap
    elif ti.static(material == 2):  # tile
        size = 0.15 if upright else 0.3
        inverse = 1.0 / 0.15 if upright else 1.0 / 0.3
        x, y = u * inverse, v * inverse
        tone = kind.hashed(ti.floor(x), ti.floor(y), *source)
        out = 1.0 + (tone - 0.5) * 0.05 * fade(blur, size)
        line = 0.005 * inverse
        gap = greater(joint(x, line, blur * inverse), joint(y, line, blur * inverse))
        out *= 1.0 - 0.24 * gap
    elif ti.static(material == 3):  # brick
        y = v / 0.075
        line = ti.floor(y)
        x = u / 0.24 + 0.5 * (line - 2.0 * ti.floor(line * 0.5))
        tone = kind.hashed(ti.floor(x), line, *source)
        out = 1.0 + (tone - 0.5) * 0.2 * fade(blur, 0.12)
        gap = greater(joint(x, 0.012 / 0.24, blur / 0.24), joint(y, 0.012 / 0.075, blur / 0.075))
        out *= 1.0 + 0.28 * gap
    elif ti.static(material == 4):  # grass
        broad = kind.noise(px * 1.1, py * 1.1, *source)
        tuft = kind.noise(px * 11.0, py * 11.0 + pz * 7.0, *source)
        patch = bounded((broad - 0.42) * 6.0, 0.0, 1.0)
        blade = bounded((tuft - 0.62) * 7.0, 0.0, 1.0)
        out = 0.95 + 0.09 * patch - 0.13 * blade * fade(blur, 0.12)
    elif ti.static(material == 5):  # asphalt
        out = 1.0 + (kind.noise(u * 0.7, v * 0.7, *source) - 0.5) * 0.08
        strong = 0.16 * fade(blur, 0.02)
        if strong > 0:
            out += (kind.noise(u * 55.0, v * 55.0, *source) - 0.5) * strong
    elif ti.static(material == 6):  # cloth
        strong = 0.05 * fade(blur, 0.006)
        if strong > 0:
            out = 1.0 - strong * (joint(u / 0.006, 0.4, blur / 0.006) + joint(v / 0.006, 0.4, blur / 0.006))
    elif ti.static(material == 9):  # carpet
        strong = 0.16 * fade(blur, 0.014)
        if strong > 0:
            out = 1.0 + (kind.noise(u * 80.0, v * 80.0, *source) - 0.5) * strong
        out *= 1.0 + (kind.noise(u * 3.0, v * 3.0, *source) - 0.5) * 0.05
    return out


@ti.func
def ground_pattern(
    material: ti.template(), px, py, pz, u, v, upright, blur, kind: ti.template(), source: ti.template()
):
    """The materials of landscapes, old walls and machines, on the plane (u, v) through the places."""
    out = u * 0.0 + 1.0
    if ti.static(material == 12):  # water: broken strokes of light on slow swells
        swell = kind.noise(px * 0.32 + 5.0, py * 0.75, *source)
        wave = (
            kind.noise(px * 0.85, py * 2.3, *source) * 0.7
            + kind.noise(px * 2.3 + 9.0, py * 5.0, *source) * 0.3
        )
        light = contour(wave, 0.56, 0.075, blur * 2.6) + 0.6 * contour(wave, 0.34, 0.05, blur * 2.6)
        some = bounded((kind.noise(px * 0.55 + 3.0, py * 1.3, *source) - 0.3) * 3.0, 0.0, 1.0)
        out = 0.97 + (swell - 0.5) * 0.16 + 0.3 * light * some * fade(blur, 0.35)
    elif ti.static(material == 13):  # sand: ripples the wind made, and grains
        drift = kind.noise(u * 0.45, v * 0.45, *source)
        bent = v * 2.6 + 1.6 * kind.noise(u * 0.8, v * 0.5, *source) + 0.35 * u
        crest = positive(bent - ti.floor(bent) - 0.5) * 2.0
        out = 1.0 + (drift - 0.5) * 0.09 + (crest - 0.5) * 0.12 * fade(blur, 0.38)
        strong = 0.12 * fade(blur, 0.02)
        if strong > 0:
            out += (kind.noise(u * 60.0, v * 60.0, *source) - 0.5) * strong
    elif ti.static(material == 14):  # stone: hewn blocks in a wall, flags on a floor
        if upright:
            out = bonded(u, v, 0.62, 0.31, 0.016, blur, 0.18, 0.28, kind, source)
        else:
            out = bonded(u, v, 0.8, 0.55, 0.014, blur, 0.16, 0.28, kind, source)
        strong = 0.07 * fade(blur, 0.1)
        if strong > 0:
            out += (kind.noise(u * 12.0, v * 12.0, *source) - 0.5) * strong
    elif ti.static(material == 15):  # metal: broad slanting sheens, brushed along u
        sheen = (px + py) * 0.55 + pz * 0.8
        sheen = positive(sheen - ti.floor(sheen) - 0.5) * 2.0
        sheen = sheen * sheen * (3 - 2 * sheen)
        out = 0.99 + (sheen - 0.46) * 0.13
        strong = 0.07 * fade(blur, 0.02)
        if strong > 0:
            out += (kind.noise(u * 3.0, v * 70.0, *source) - 0.5) * strong
    elif ti.static(material == 16):  # leaves: light and dark clumps, the same whichever way a face looks
        x, y = px + 0.45 * pz, py - 0.6 * pz
        clump = (
            kind.noise(x * 4.2, y * 4.2, *source) * 0.6 + kind.noise(x * 10.0 + 3.0, y * 10.0, *source) * 0.4
        )
        bright = bounded((clump - 0.55) * 9.0, 0.0, 1.0)
        dark = bounded((0.44 - clump) * 9.0, 0.0, 1.0)
        out = 1.0 + (0.12 * bright - 0.13 * dark) * fade(blur, 0.2)
    elif ti.static(material == 17):  # snow: soft drifts
        out = 1.0 + (kind.noise(u * 0.6, v * 0.6, *source) - 0.5) * 0.07
        out += (kind.noise(u * 2.7, v * 2.7, *source) - 0.5) * 0.045 * fade(blur, 0.3)
    elif ti.static(material == 18):  # earth: trodden patches and pebbles
        broad = kind.noise(u * 0.9, v * 0.9, *source)
        x, y = u * 6.4 + v * 4.8, v * 6.4 - u * 4.8
        stones = kind.noise(x, y, *source) * 0.6 + kind.noise(u * 9.0, v * 9.0, *source) * 0.4
        pebble = bounded((stones - 0.6) * 9.0, 0.0, 1.0)
        out = 1.0 + (broad - 0.5) * 0.16 + (0.025 - 0.13 * pebble) * fade(blur, 0.12)
        strong = 0.1 * fade(blur, 0.03)
        if strong > 0:
            out += (kind.noise(u * 34.0, v * 34.0, *source) - 0.5) * strong
    elif ti.static(material == 19):  # marble: veins that run aslant over large slabs
        x, y = u * 0.83 + v * 0.56, v * 0.83 - u * 0.56
        warp = kind.noise(x * 1.1, y * 1.1, *source)
        vein = (
            kind.noise(x * 0.5 + 0.5 * warp, y * 2.6 + 1.2 * warp, *source) * 0.8
            + kind.noise(x * 4.0, y * 5.0, *source) * 0.2
        )
        strong = contour(vein, 0.5, 0.04, blur * 2.2) + 0.6 * contour(vein, 0.7, 0.04, blur * 2.2)
        out = 1.02 + (warp - 0.5) * 0.11 - 0.2 * strong * fade(blur, 0.3)
        seam = greater(joint(u / 0.8, 0.01, blur / 0.8), joint(v / 0.8, 0.01, blur / 0.8))
        out *= 1.0 - 0.2 * seam
    elif ti.static(material == 20):  # cobble: small rounded stones in courses
        row = v / 0.16
        line = ti.floor(row)
        along = u / 0.19 + kind.hashed(line, 3.0, *source)
        tone = kind.hashed(line, ti.floor(along), *source)
        x, y = along - ti.floor(along) - 0.5, row - line - 0.5
        edge = greater(positive(x), positive(y)) + 0.35 * (x * x + y * y)
        soft = greater(blur / 0.16, 0.08)
        seam = bounded((edge - 0.5) / soft + 0.5, 0.0, 1.0)
        out = 1.05 + ((tone - 0.5) * 0.17 - 0.26 * seam) * fade(blur, 0.17)
    elif ti.static(material == 21):  # parquet: squares of four strips, every other one across
        side = 1.0 / 0.36
        i, j = ti.floor(u * side), ti.floor(v * side)
        turned = i + j - 2.0 * ti.floor((i + j) * 0.5)
        strip = ti.select(turned > 0.5, u, v) * side * 4.0
        tone = kind.hashed(ti.floor(strip), i * 57.0 + j * 131.0, *source)
        seam = greater(
            joint(strip, 0.045, blur * side * 4.0),
            greater(joint(u * side, 0.012, blur * side), joint(v * side, 0.012, blur * side)),
        )
        out = (1.015 + (tone - 0.5) * 0.13 * fade(blur, 0.12) + (turned - 0.5) * 0.05) * (1.0 - 0.22 * seam)
    else:  # plate: sheets of metal with seams between them
        x, y = u * (1.0 / 1.2), v * (1.0 / 0.8)
        tone = kind.hashed(ti.floor(x), ti.floor(y), *source)
        seam = greater(joint(x, 0.016 / 1.2, blur / 1.2), joint(y, 0.016 / 0.8, blur / 0.8))
        out = (1.0 + (tone - 0.5) * 0.07 * fade(blur, 0.8)) * (1.0 - 0.26 * seam)
        sheen = (px - py) * 0.4 + pz * 0.6
        out += (positive(sheen - ti.floor(sheen) - 0.5) - 0.25) * 0.16
    return out


@ti.func
def broad_pattern(material, p, n, lattice: ti.template()):
    """The part of a pattern that is broader than any stretch of pixels; sampled sparsely."""
    out = 1.0
    if material == 10 or material == 11:
        u, v = p.x, p.y
        if ti.abs(n.z) < 0.7:
            v = p.z
            if ti.abs(n.x) > ti.abs(n.y):
                u = p.y
        if material == 10:  # concrete
            out = 1.0 + (value_noise(u * 1.3, v * 1.3, lattice) - 0.5) * 0.12
        else:  # plaster
            out = 1.0 + (value_noise(u * 1.7, v * 1.7, lattice) - 0.5) * 0.035
    return out


@ti.func
def glazed(base, ray, p):
    """Glass: pale, with slanting bands of reflection fixed in the world."""
    band = (p.x + p.y) * 0.8 + p.z * 1.1
    t = band - ti.floor(band)
    streak = 0.10 if (t < 0.16 or 0.24 < t < 0.30) else 0.0
    return base * 1.5 + vec3(0.10, 0.12, 0.13) + 2.0 * streak
