"""Skinning: vertices and normals moved by blends of matrices.

On the host a blend is worked out as one vector (see ``gather``); elsewhere number by number. Which vertices a
moment needs is said by a list, and several moments may share one.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .gather import LANES, fv
from .geometry import f1, f2, f3, f4, i1, i2, row3, vec3

PARTS, PIECES = 8, 64  # of a moment's vertices; so many pieces that Taichi shares them among threads


@ti.func
def stretch(begin: ti.template(), which, part, parts):
    """From which to which place of the lists a part of one goes."""
    count = begin[which + 1] - begin[which]
    return begin[which] + count * part // parts, begin[which] + count * (part + 1) // parts


@ti.kernel
def skin_blended(
    palette: fv,
    entries: ti.i32,
    rest: f2,
    rest_normal: f2,
    joints: i2,
    weights: f2,
    vertices: i1,
    begin: i1,
    which: i1,
    moments: ti.i32,
    work: fv,
    lane: f1,
    position: f3,
    normal: f3,
    queue: i1,
    slots: ti.i32,
    workers: ti.i32,
):
    """Linear blend skinning in the first ``moments`` palettes, of vertices in lists.

    palette [M * entries]: matrices row by row, and four numbers more; vertices, begin: lists of vertices one
    after another and where each begins; which [M]: the list of a moment
    work [workers]: scratch, ``lane`` its memory; position, normal [M, V, 3]: what is found
    """
    for slot in range(slots):
        worker = slot // (slots // workers)
        task = crew.task(slot, moments * PARTS, queue, True)
        if task < moments * PARTS:
            m = task // PARTS
            first, last = stretch(begin, which[m], task % PARTS, PARTS)
            own, base = worker * LANES, m * entries
            for i in range(first, last):
                v = vertices[i]
                # four at all vertices: a matrix that counts for nothing costs less than asking
                work[worker] = (
                    palette[base + joints[v, 0]] * weights[v, 0]
                    + palette[base + joints[v, 1]] * weights[v, 1]
                    + palette[base + joints[v, 2]] * weights[v, 2]
                    + palette[base + joints[v, 3]] * weights[v, 3]
                )
                x, y, z = rest[v, 0], rest[v, 1], rest[v, 2]
                r, s, t = rest_normal[v, 0], rest_normal[v, 1], rest_normal[v, 2]
                a0, a1, a2, a3 = lane[own], lane[own + 1], lane[own + 2], lane[own + 3]
                b0, b1, b2, b3 = lane[own + 4], lane[own + 5], lane[own + 6], lane[own + 7]
                c0, c1, c2, c3 = lane[own + 8], lane[own + 9], lane[own + 10], lane[own + 11]
                position[m, v, 0] = a0 * x + a1 * y + a2 * z + a3
                position[m, v, 1] = b0 * x + b1 * y + b2 * z + b3
                position[m, v, 2] = c0 * x + c1 * y + c2 * z + c3
                p, q, w = a0 * r + a1 * s + a2 * t, b0 * r + b1 * s + b2 * t, c0 * r + c1 * s + c2 * t
                length = ti.sqrt(p * p + q * q + w * w)
                scale = 1.0 / (length if length > 1e-12 else 1e-12)
                normal[m, v, 0] = p * scale
                normal[m, v, 1] = q * scale
                normal[m, v, 2] = w * scale


@ti.kernel
def skin(
    palette: f4,
    rest: f2,
    rest_normal: f2,
    joints: i2,
    weights: f2,
    vertices: i1,
    begin: i1,
    which: i1,
    moments: ti.i32,
    position: f3,
    normal: f3,
):
    """The same by any device; palette [M, entries, 3, 4]."""
    for i in range(moments * PIECES):
        m = i // PIECES
        first, last = stretch(begin, which[m], i % PIECES, PIECES)
        for at in range(first, last):
            v = vertices[at]
            p, q = row3(rest, v), row3(rest_normal, v)
            out, turned = vec3(0), vec3(0)
            for a in ti.static(range(3)):
                blend = ti.Vector([0.0, 0.0, 0.0, 0.0])
                for k in range(4):
                    for b in ti.static(range(4)):
                        blend[b] += palette[m, joints[v, k], a, b] * weights[v, k]
                out[a] = blend[0] * p[0] + blend[1] * p[1] + blend[2] * p[2] + blend[3]
                turned[a] = blend[0] * q[0] + blend[1] * q[1] + blend[2] * q[2]
            turned /= ti.max(turned.norm(), 1e-12)
            for a in ti.static(range(3)):
                position[m, v, a] = out[a]
                normal[m, v, a] = turned[a]


@ti.kernel
def repeat(vertices: i1, begin: i1, which: i1, origin: ti.i32, moments: ti.i32, position: f3, normal: f3):
    """What rests, in moments 1 to ``moments`` - 1 as it is in moment ``origin``; lists as above."""
    for i in range((moments - 1) * PIECES):
        m = 1 + i // PIECES
        first, last = stretch(begin, which[m], i % PIECES, PIECES)
        for at in range(first, last):
            v = vertices[at]
            for a in ti.static(range(3)):
                position[m, v, a] = position[origin, v, a]
                normal[m, v, a] = normal[origin, v, a]
