"""Colours and normals as they are packed, and what all passes over the rows of a picture share.

Pictures in between are sRGB bytes, red lowest, with the luma in the fourth. ``edge`` buffers keep, per
pixel, the surface in the high half and the normal (octahedral, 8 + 8 bits) in the low half;
NOTHING is the backdrop.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from ...materials import MATERIALS
from ..film import FILM_RANGE, FILM_SIZE
from .geometry import bounded, vec3

NOTHING = 0xFFFF0000
RUN = 16  # pixels; rows are worked through in aligned runs of them
#: Levels of a run: what is the first thing that is left to do in it (:mod:`.reuse`).
SHADE, INK, SMOOTH, DONE = 3, 2, 1, 0
#: Materials whose colours go by the place they are seen at, or by nothing at all.
GLASS, GLOW = MATERIALS.index("glass"), MATERIALS.index("glow")
SHEET = 16  # numbers kept for each side of a triangle of the set


@ti.func
def pack_normal(n):
    """Octahedral encoding in 8 + 8 bits (Cigolle et al. 2014)."""
    s = 1.0 / ti.max(ti.abs(n.x) + ti.abs(n.y) + ti.abs(n.z), 1e-12)
    x = n.x * s
    y = n.y * s
    if n.z < 0:
        ox = (1.0 - ti.abs(y)) * (1.0 if x >= 0 else -1.0)
        y = (1.0 - ti.abs(x)) * (1.0 if y >= 0 else -1.0)
        x = ox
    qx = ti.cast((x * 0.5 + 0.5) * 254.0 + 0.5, ti.u32)
    qy = ti.cast((y * 0.5 + 0.5) * 254.0 + 0.5, ti.u32)
    return (qx << 8) | qy


@ti.func
def unpack_normal(bits):
    """A packed normal, of whatever length comes of it."""
    x = ti.cast((bits >> 8) & 0xFF, ti.f32) * (2.0 / 254.0) - 1.0
    y = ti.cast(bits & 0xFF, ti.f32) * (2.0 / 254.0) - 1.0
    z = 1.0 - ti.abs(x) - ti.abs(y)
    if z < 0:
        ox = (1.0 - ti.abs(y)) * (1.0 if x >= 0 else -1.0)
        y = (1.0 - ti.abs(x)) * (1.0 if y >= 0 else -1.0)
        x = ox
    return vec3(x, y, z)


@ti.func
def encode(light, table: ti.template()):
    """Linear 0..1 to packed 8-bit sRGB and luma, through the table of 4096."""
    r = ti.cast(ti.min(ti.max(light.x, 0.0), 1.0) * 4095.0 + 0.5, ti.i32)
    g = ti.cast(ti.min(ti.max(light.y, 0.0), 1.0) * 4095.0 + 0.5, ti.i32)
    b = ti.cast(ti.min(ti.max(light.z, 0.0), 1.0) * 4095.0 + 0.5, ti.i32)
    r8, g8, b8 = table[r], table[g], table[b]
    return r8 | (g8 << 8) | (b8 << 16) | (((r8 * 5 + g8 * 9 + b8 * 2) >> 4) << 24)


@ti.func
def exposed(light, film: ti.template()):
    """Scene light to sRGB in 256ths of a step, halves added for rounding: red, green, blue."""
    limit = ti.static(FILM_RANGE)
    scale = ti.static((FILM_SIZE - 1) / FILM_RANGE)
    return ti.Vector(
        [
            ti.cast(film[ti.cast(bounded(light.x, 0.0, limit) * scale + 0.5, ti.i32)], ti.i32),
            ti.cast(film[ti.cast(bounded(light.y, 0.0, limit) * scale + 0.5, ti.i32)], ti.i32),
            ti.cast(film[ti.cast(bounded(light.z, 0.0, limit) * scale + 0.5, ti.i32)], ti.i32),
        ]
    )


@ti.func
def packed(paint):
    """Colours of :func:`exposed` to packed 8-bit sRGB and luma."""
    c = paint >> 8
    luma = (c.x * 5 + c.y * 9 + c.z * 2) >> 4
    return ti.cast(c.x | (c.y << 8) | (c.z << 16) | (luma << 24), ti.u32)


@ti.func
def developed(light, film: ti.template()):
    """Scene light to packed 8-bit sRGB and luma, through the film's table."""
    return packed(exposed(light, film))


@ti.func
def backdrop(ray, horizon, zenith, film: ti.template()):
    """The sky in the direction of a ray, as :func:`exposed` gives it."""
    up = ray.z / ray.norm()
    return exposed(horizon + (zenith - horizon) * ti.min(ti.max(up * 1.6, 0.0), 1.0), film)


@ti.func
def paired(begin, end, steps):
    """What :func:`spread` and :func:`ramp` begin with and add: colours two in a word, 8.8 bits each."""
    luma = (begin.x * 5 + begin.y * 9 + begin.z * 2) >> 4
    outer = ti.cast(begin.x | (begin.z << 16), ti.u32)
    inner = ti.cast(begin.y | (luma << 16), ti.u32)
    outer_step = 0
    inner_step = 0
    if steps > 1:
        luma_end = (end.x * 5 + end.y * 9 + end.z * 2) >> 4
        share = 1.0 / ti.cast(steps, ti.f32)
        outer_step = part_of(end.x - begin.x, share) + (part_of(end.z - begin.z, share) << 16)
        inner_step = part_of(end.y - begin.y, share) + (part_of(luma_end - luma, share) << 16)
    return outer, inner, ti.cast(outer_step, ti.u32), ti.cast(inner_step, ti.u32)


@ti.func
def spread(begin, end, steps, mark, at, count, picture: ti.template(), edge: ti.template()):
    """Fill ``count`` pixels with colours evenly between two (of :func:`exposed`), ``steps`` pixels apart."""
    outer, inner, outer_step, inner_step = paired(begin, end, steps)
    for i in range(at, at + count):
        picture[i] = ((outer >> 8) & ti.u32(0x00FF00FF)) | (inner & ti.u32(0xFF00FF00))
        edge[i] = mark
        outer += outer_step
        inner += inner_step


@ti.func
def ramp(begin, end, steps, at, count, picture: ti.template()):
    """The same without marks."""
    outer, inner, outer_step, inner_step = paired(begin, end, steps)
    for i in range(at, at + count):
        picture[i] = ((outer >> 8) & ti.u32(0x00FF00FF)) | (inner & ti.u32(0xFF00FF00))
        outer += outer_step
        inner += inner_step


@ti.func
def part_of(whole, share):
    return ti.cast(ti.cast(whole, ti.f32) * share, ti.i32)


@ti.func
def scaled(c, factor):
    """A packed colour, brighter or darker."""
    q = ti.cast(factor * 256.0 + 0.5, ti.u32)
    r = ti.min((c & 255) * q >> 8, ti.u32(255))
    g = ti.min((c >> 8 & 255) * q >> 8, ti.u32(255))
    b = ti.min((c >> 16 & 255) * q >> 8, ti.u32(255))
    return r | (g << 8) | (b << 16) | (((r * 5 + g * 9 + b * 2) >> 4) << 24)


@ti.func
def decode(c, table: ti.template()):
    return vec3(
        table[ti.cast(c & 0xFF, ti.i32)],
        table[ti.cast((c >> 8) & 0xFF, ti.i32)],
        table[ti.cast((c >> 16) & 0xFF, ti.i32)],
    )
