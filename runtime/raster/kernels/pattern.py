"""Procedural materials, evaluated in the world.

Each gives a factor for the base colour around 1. Joints and grains are filtered by the width of a
pixel on the surface and fade out before they could shimmer.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from .geometry import vec3


@ti.func
def hashed(a, b):
    """A number 0..1 for a pair of integers (a finaliser after lowbias32, Wellons 2018)."""
    h = ti.cast(a, ti.u32) * ti.u32(0x9E3779B1) + ti.cast(b, ti.u32) * ti.u32(0x85EBCA77)
    h ^= h >> 16
    h *= ti.u32(0x7FEB352D)
    h ^= h >> 15
    return ti.cast(h >> 8, ti.f32) / 16777216.0


@ti.func
def value_noise(x, y):
    """Smooth noise 0..1 with features about 1 wide."""
    fx, fy = ti.floor(x), ti.floor(y)
    i, j = ti.cast(fx, ti.i32), ti.cast(fy, ti.i32)
    tx, ty = x - fx, y - fy
    tx = tx * tx * (3 - 2 * tx)
    ty = ty * ty * (3 - 2 * ty)
    a = hashed(i, j) * (1 - tx) + hashed(i + 1, j) * tx
    b = hashed(i, j + 1) * (1 - tx) + hashed(i + 1, j + 1) * tx
    return a * (1 - ty) + b * ty


@ti.func
def joint(x, width, blur):
    """Coverage 0..1 of a joint ``width`` wide centred on whole numbers (all in periods of x)."""
    d = ti.abs(x - ti.floor(x + 0.5))
    soft = ti.max(blur, 1e-4)
    cover = ti.min(ti.max((0.5 * width - d) / soft + 0.5, 0.0), 1.0)
    # thinner than a pixel: paler instead of broken; and gone before the period is a few pixels
    return cover * ti.min(1.0, width / soft) * ti.min(ti.max(1.4 - 4.0 * blur, 0.0), 1.0)


@ti.func
def fade(blur, period):
    """1 where a period is many pixels, 0 where it is few."""
    return ti.min(ti.max(1.5 - 4.0 * blur / period, 0.0), 1.0)


@ti.func
def pattern(material, p, n, blur):
    """Factor of a material at world point ``p``, face normal ``n``; blur: a pixel's width, metres."""
    out = 1.0
    upright = ti.abs(n.z) < 0.7
    u, v = p.x, p.y
    if upright:
        v = p.z
        if ti.abs(n.x) > ti.abs(n.y):
            u = p.y
    if material == 1:  # wood
        if upright:
            strong = 0.10 * fade(blur, 0.03)
            if strong > 0:
                out = 1.0 + (value_noise(u * 34.0, v * 2.2) - 0.5) * strong
        else:
            row = v * (1.0 / 0.13)
            line = ti.floor(row)
            along = u * (1.0 / 1.3) + hashed(ti.cast(line, ti.i32), 7)
            tone = hashed(ti.cast(line, ti.i32), ti.cast(ti.floor(along), ti.i32))
            out = 1.0 + (tone - 0.5) * 0.13 * fade(blur, 0.13)
            strong = 0.07 * fade(blur, 0.022)
            if strong > 0:
                out += (value_noise(u * 2.4 + 13.0 * line, v * 46.0) - 0.5) * strong
            gap = ti.max(
                joint(row, 0.004 / 0.13, blur * (1.0 / 0.13)), joint(along, 0.004 / 1.3, blur * (1.0 / 1.3))
            )
            out *= 1.0 - 0.3 * gap
    elif material == 2:  # tile
        size = 0.15 if upright else 0.3
        inverse = 1.0 / 0.15 if upright else 1.0 / 0.3
        x, y = u * inverse, v * inverse
        tone = hashed(ti.cast(ti.floor(x), ti.i32), ti.cast(ti.floor(y), ti.i32))
        out = 1.0 + (tone - 0.5) * 0.05 * fade(blur, size)
        line = 0.005 * inverse
        gap = ti.max(joint(x, line, blur * inverse), joint(y, line, blur * inverse))
        out *= 1.0 - 0.24 * gap
    elif material == 3:  # brick
        y = v / 0.075
        line = ti.floor(y)
        x = u / 0.24 + 0.5 * (line - 2.0 * ti.floor(line * 0.5))
        tone = hashed(ti.cast(ti.floor(x), ti.i32), ti.cast(line, ti.i32))
        out = 1.0 + (tone - 0.5) * 0.2 * fade(blur, 0.12)
        gap = ti.max(joint(x, 0.012 / 0.24, blur / 0.24), joint(y, 0.012 / 0.075, blur / 0.075))
        out *= 1.0 + 0.28 * gap
    elif material == 4:  # grass
        broad = value_noise(p.x * 1.1, p.y * 1.1)
        tuft = value_noise(p.x * 11.0, p.y * 11.0 + p.z * 7.0)
        patch = ti.min(ti.max((broad - 0.42) * 6.0, 0.0), 1.0)
        blade = ti.min(ti.max((tuft - 0.62) * 7.0, 0.0), 1.0)
        out = 0.95 + 0.09 * patch - 0.13 * blade * fade(blur, 0.12)
    elif material == 5:  # asphalt
        out = 1.0 + (value_noise(u * 0.7, v * 0.7) - 0.5) * 0.08
        strong = 0.16 * fade(blur, 0.02)
        if strong > 0:
            out += (value_noise(u * 55.0, v * 55.0) - 0.5) * strong
    elif material == 6:  # cloth
        strong = 0.05 * fade(blur, 0.006)
        if strong > 0:
            out = 1.0 - strong * (joint(u / 0.006, 0.4, blur / 0.006) + joint(v / 0.006, 0.4, blur / 0.006))
    elif material == 9:  # carpet
        strong = 0.16 * fade(blur, 0.014)
        if strong > 0:
            out = 1.0 + (value_noise(u * 80.0, v * 80.0) - 0.5) * strong
        out *= 1.0 + (value_noise(u * 3.0, v * 3.0) - 0.5) * 0.05
    return out


@ti.func
def broad_pattern(material, p, n):
    """The part of a pattern that is broader than any stretch of pixels; sampled sparsely."""
    out = 1.0
    if material >= 10:
        u, v = p.x, p.y
        if ti.abs(n.z) < 0.7:
            v = p.z
            if ti.abs(n.x) > ti.abs(n.y):
                u = p.y
        if material == 10:  # concrete
            out = 1.0 + (value_noise(u * 1.3, v * 1.3) - 0.5) * 0.12
        else:  # plaster
            out = 1.0 + (value_noise(u * 1.7, v * 1.7) - 0.5) * 0.035
    return out


@ti.func
def glazed(base, ray, p):
    """Glass: pale, with slanting bands of reflection fixed in the world."""
    band = (p.x + p.y) * 0.8 + p.z * 1.1
    t = band - ti.floor(band)
    streak = 0.10 if (t < 0.16 or 0.24 < t < 0.30) else 0.0
    return base * 1.5 + vec3(0.10, 0.12, 0.13) + 2.0 * streak
