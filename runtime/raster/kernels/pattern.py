"""Procedural materials, evaluated in the world.

Each gives a factor for the base colour around 1. Joints and grains are filtered by the width of a
pixel on the surface and fade out before they could shimmer. Indices are those of
:data:`runtime.mesh.MATERIALS`; 10 and 11 vary so slowly that the shading looks them up every few
pixels (:func:`broad_pattern`), 7 and 8 are no surfaces to light at all.

The others go over the shaded picture (:mod:`.grain`), in its sRGB bytes: a pattern is so faint that the
film's curve is straight along it. What a material is made of besides arithmetic, numbers by chance and
noise, is looked up first, in loops over where, then put together (:mod:`.materials`): a look-up of sixteen
places is long, Taichi puts a copy of it wherever it is called from, and a copy for each place of each
material took a fifth of the time of a start.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from .geometry import vec3
from .materials import NOISES, SEAMED, TONES, finish, joint, noise_at, seams_at, tone_at

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
def noise_alone(x, y, lattice: ti.template()):
    return value_noise(x, y, lattice)


@ti.func
def hashed_alone(a, b, lattice: ti.template()):
    return hashed(ti.cast(a, ti.i32), ti.cast(b, ti.i32))


class Alone:
    """Patterns at one place at a time. ``hashed`` takes whole numbers as float32."""

    noise = staticmethod(noise_alone)
    hashed = staticmethod(hashed_alone)


@ti.func
def pattern(material, px, py, pz, n, blur, kind: ti.template(), source: ti.template()):
    """Factor of a material at world places, of a face with normal ``n``; 1 if it is none of GRAINED.

    blur: a pixel's width, metres; kind: how things are looked up, at one place (:class:`Alone`) or at
    sixteen; source: what from
    """
    u, v = px, py
    upright = ti.abs(n.z) < 0.7
    if upright:
        v = pz
        if ti.abs(n.x) > ti.abs(n.y):
            u = py
    nothing = u * 0.0
    first, second = nothing, nothing  # numbers by chance
    tones = 0
    for k, count in ti.static(TONES):
        if material == k:
            tones = count
    if material == 1 and upright:
        tones = 0
    for slot in range(tones):
        a, b = u, v
        for k, _ in ti.static(TONES):
            if material == k:
                a, b = tone_at(k, slot, u, v, upright, first)
        found = kind.hashed(a, b, *source)
        if slot == 0:
            first = found
        else:
            second = found
    noise, noise_1, noise_2, noise_3 = nothing, nothing, nothing, nothing
    noises = 0
    for k, count in ti.static(NOISES):
        if material == k:
            noises = count
    for slot in range(noises):
        x, y, seen = u, v, 1.0
        for k, _ in ti.static(NOISES):
            if material == k:
                x, y, seen = noise_at(k, slot, px, py, pz, u, v, upright, blur, noise)
        if seen > 0.0:
            found = kind.noise(x, y, *source)
            if slot == 0:
                noise = found
            elif slot == 1:
                noise_1 = found
            elif slot == 2:
                noise_2 = found
            else:
                noise_3 = found
    seam, seam_too = nothing, nothing  # joints across and along
    x, y = u, v
    wide, blur_x, wide_too, blur_y = 0.0, 0.0, 0.0, 0.0
    for k in ti.static(SEAMED):
        if material == k:
            x, wide, blur_x, y, wide_too, blur_y = seams_at(k, u, v, upright, blur, first)
    if wide > 0.0:
        seam, seam_too = joint(x, wide, blur_x), joint(y, wide_too, blur_y)
    out = nothing + 1.0
    for k in ti.static(GRAINED):
        if material == k:
            out = finish(
                k,
                (px, py, pz, u, v),
                upright,
                blur,
                (first, second),
                (seam, seam_too),
                (noise, noise_1, noise_2, noise_3),
            )
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
