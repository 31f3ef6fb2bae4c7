"""Patterns of materials over a shaded picture, in place: pixel by pixel, or on the host sixteen at a time.

Both evaluate the same :func:`.pattern.pattern`; the second with vectors for places (see ``gather`` on those).
Noise is looked up one place at a time, and where it changes slowly along the sixteen only at some of them.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .gather import EVEN, V, fv
from .geometry import f1, f2, greater, i1, rays, triangle, u32s, u64s, vec3
from .paint import RUN, SHADE, SHEET, scaled
from .pattern import GRAINED, Alone, pattern, value_noise
from .spans import qv, uv

SLOPE = 0.45  # by how much an sRGB value changes with the light, both as shares
SCRATCH = 3  # vectors a worker writes to reach single lanes, or their bits
ALL = (1 << RUN) - 1
SOME = sum(1 << material for material in GRAINED)
COARSE = 0.12  # of a feature of noise: as far as it is taken to be straight
EVEN_BITS = 0x4B400000  # of EVEN as a float32: a whole number added to it appears below these


@ti.func
def noise_along(
    x,
    y,
    lattice: ti.template(),
    number: ti.template(),
    wide: ti.template(),
    word: ti.template(),
    at,
    first,
    last,
):
    """:func:`.pattern.value_noise` at sixteen places along a line; right in the lanes first..last."""
    wide[at], wide[at + 1] = x, y
    here = at * RUN
    apart, span = 1, last - first
    change = ti.abs(number[here + last] - number[here + first])
    change += ti.abs(number[here + RUN + last] - number[here + RUN + first])
    if span > 1 and change < COARSE:
        apart = span
    elif span == RUN - 1:
        if change < 3 * COARSE:
            apart = 5
        elif change < 5 * COARSE:
            apart = 3
    k = here + first
    while k <= here + last:
        number[k + 2 * RUN] = value_noise(number[k], number[k + RUN], lattice)
        k += apart
    out = wide[at + 2]
    if apart > 1:
        share = (laned() - ti.cast(first, ti.f32)) * (1.0 / ti.cast(apart, ti.f32))
        k = here + 2 * RUN + first
        out = share * 0.0 + number[k]
        while k < here + 2 * RUN + last:
            out += (number[k + apart] - number[k]) * ti.min(ti.max(share, 0.0), 1.0)
            share -= 1.0
            k += apart
    return out


@ti.func
def hashed_along(
    a,
    b,
    lattice: ti.template(),
    number: ti.template(),
    wide: ti.template(),
    word: ti.template(),
    at,
    first,
    last,
):
    """:func:`.pattern.hashed` of sixteen pairs of whole numbers."""
    wide[at] = a + EVEN
    wide[at + 1] = a * 0.0 + b + EVEN
    even = ti.u32(EVEN_BITS)
    h = (word[at] - even) * ti.u32(0x9E3779B1) + (word[at + 1] - even) * ti.u32(0x85EBCA77)
    h ^= h >> ti.u32(16)
    h *= ti.u32(0x7FEB352D)
    h ^= h >> ti.u32(15)
    word[at] = (h >> ti.u32(9)) | ti.u32(0x3F800000)
    return wide[at] - 1.0


class Along:
    """Patterns at sixteen places at a time."""

    noise = staticmethod(noise_along)
    hashed = staticmethod(hashed_along)


@ti.func
def laned():
    lanes = V(0.0)
    for k in ti.static(range(RUN)):
        lanes[k] = float(k)
    return lanes


@ti.func
def surface(sheet: ti.template(), t, eye, first, step, x, scale):
    """How a triangle of the set lies under a row of pixels.

    Returns its normal, 1/z as near + x * turn, and a pixel's width on it at ``x``, metres.
    """
    row = 2 * t * SHEET
    plane = vec3(sheet[row + 12], sheet[row + 13], sheet[row + 14])
    inverse = 1.0 / (sheet[row + 15] - plane.dot(eye))
    near, turn = plane.dot(first) * inverse, plane.dot(step) * inverse
    # a pixel's width on the surface at 1 m, tamed at grazing angles
    ray = first + step * ti.cast(x, ti.f32)
    cosine = ti.abs(plane.dot(ray)) / ray.norm()
    slant = 1.0 / (greater(ti.sqrt(cosine), 0.15) * scale)
    return plane, near, turn, slant / (near + ti.cast(x, ti.f32) * turn)


@ti.func
def scaled_all(c, q):
    """:func:`.paint.scaled` of sixteen colours, by ``q`` 256ths."""
    full, byte = c * ti.u32(0) + ti.u32(255), ti.u32(255)
    r = (c & byte) * q >> ti.u32(8)
    g = (c >> ti.u32(8) & byte) * q >> ti.u32(8)
    b = (c >> ti.u32(16) & byte) * q >> ti.u32(8)
    r = ti.select(r > byte, full, r)
    g = ti.select(g > byte, full, g)
    b = ti.select(b > byte, full, b)
    luma = (r * ti.u32(5) + g * ti.u32(9) + b * ti.u32(2)) >> ti.u32(4)
    return r | (g << ti.u32(8)) | (b << ti.u32(16)) | (luma << ti.u32(24))


@ti.kernel
def grain_rows(
    view: f2,
    sheet: f1,
    static_faces: ti.i32,
    lattice: f1,
    vis: u64s,
    solid: i1,
    level: i1,
    picture: u32s,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Put the patterns of the set on a shaded picture, in place."""
    for slot in range(slots):
        line = crew.task(slot, views * height, queue, host)
        if line < views * height:
            n = line // height
            eye, first, step = rays(view, n, line % height)
            runs = (width + RUN - 1) // RUN
            for run in range(runs):
                whole = solid[line * runs + run]
                if whole >= 0 and level[line * runs + run] >= SHADE:
                    limit = ti.min(run * RUN + RUN, width)
                    x = run * RUN
                    while x < limit:
                        at = line * width + x
                        t = whole - 1 if whole > 0 else triangle(vis, at)
                        stop = limit if whole > 0 else x + 1
                        while stop < limit and triangle(vis, at + stop - x) == t:
                            stop += 1
                        if 0 <= t < static_faces:
                            material = ti.bit_cast(sheet[2 * t * SHEET + 11], ti.i32) & 255
                            if (SOME >> material) & 1 == 1:
                                plane, near, turn, blur = surface(sheet, t, eye, first, step, x, view[n, 13])
                                for j in range(x, stop):
                                    along = ti.cast(j, ti.f32)
                                    z = 1.0 / (near + along * turn)
                                    p = eye + (first + step * along) * z
                                    factor = pattern(material, p.x, p.y, p.z, plane, blur, Alone, (lattice,))
                                    i = line * width + j
                                    picture[i] = scaled(picture[i], 1.0 + (factor - 1.0) * SLOPE)
                        x = stop


@ti.kernel
def grain_runs(
    view: f2,
    sheet: f1,
    static_faces: ti.i32,
    lattice: f1,
    vis: u64s,
    seen: qv,
    solid: i1,
    level: i1,
    picture: uv,
    number: f1,
    wide: fv,
    word: uv,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    queue: i1,
    slots: ti.i32,
    workers: ti.i32,
):
    """The same for rows of whole runs. number, wide, word: scratch [workers * SCRATCH], the same memory."""
    for slot in range(slots):
        worker = slot // (slots // workers)
        at = worker * SCRATCH
        lanes = laned()
        bits = ti.Vector([ti.i32(1 << lane) for lane in range(RUN)])
        nothing = bits * 0
        runs = width // RUN
        line = crew.task(slot, views * height, queue, True)
        if line < views * height:
            n = line // height
            eye, first, step = rays(view, n, line % height)
            for run in range(runs):
                whole = solid[line * runs + run]
                if whole >= 0 and level[line * runs + run] >= SHADE:
                    base = (line * runs + run) * RUN
                    own = ti.cast(seen[line * runs + run], ti.u32)
                    left = ALL
                    if whole == 0:
                        of_set = own - ti.u32(1) < ti.cast(static_faces, ti.u32)
                        left = ti.select(of_set, bits, nothing).sum()
                    while left != 0:
                        # the next triangle of the run, and the lanes that show it
                        x = ti.math.popcnt((left & -left) - 1)
                        t, these = whole - 1, ALL
                        if whole == 0:
                            t = triangle(vis, base + x)
                            these = ti.select(own == ti.cast(t + 1, ti.u32), bits, nothing).sum()
                        left &= ~these
                        material = 0
                        if 0 <= t < static_faces:
                            material = ti.bit_cast(sheet[2 * t * SHEET + 11], ti.i32) & 255
                        if (SOME >> material) & 1 == 1:
                            last = 31 - ti.math.clz(these)
                            plane, near, turn, blur = surface(
                                sheet, t, eye, first, step, run * RUN + x, view[n, 13]
                            )
                            # places beside the triangle are drawn to its last ones: elsewhere 1/z may be 0
                            along = ti.min(ti.max(lanes, ti.cast(x, ti.f32)), ti.cast(last, ti.f32))
                            along += ti.cast(run * RUN, ti.f32)
                            z = 1.0 / (near + along * turn)
                            px = eye.x + (first.x + step.x * along) * z
                            py = eye.y + (first.y + step.y * along) * z
                            pz = eye.z + (first.z + step.z * along) * z
                            factor = pattern(
                                material,
                                px,
                                py,
                                pz,
                                plane,
                                blur,
                                Along,
                                (lattice, number, wide, word, at, x, last),
                            )
                            wide[at] = (1.0 + (factor - 1.0) * SLOPE) * 256.0 + EVEN
                            old = picture[line * runs + run]
                            new = scaled_all(old, word[at] - ti.u32(EVEN_BITS))
                            if whole == 0:
                                new = ti.select(own == ti.cast(t + 1, ti.u32), new, old)
                            picture[line * runs + run] = new
