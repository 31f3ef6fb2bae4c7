"""Where between two pixels an edge passes: told by the triangles that are seen in them.

A pixel is of one triangle, so an edge of a picture, and the ink along it, lies between two pixels, up to half
a pixel off, and leaps from one to the next where the camera turns slowly. But where a ray leaves a triangle
is known exactly, so the pixels around an edge can be moved to where it is (geometric anti-aliasing; Persson
2011 keeps the distances while drawing). Along rows for edges that are rather upright, along columns for the
others.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .borders import FOLD
from .geometry import (
    f2,
    f3,
    greater,
    i1,
    i2,
    item3,
    lesser,
    nearness,
    part3,
    rays,
    row3,
    triangle,
    u32s,
    u64s,
    vec3,
)
from .ink import level as level_with
from .paint import INK, RUN, SMOOTH

NEVER = 2.0  # further than any neighbour
OUTLINE, BEND = 2, 1
FAR = 12  # triangles after which an end is no longer looked for
REACH = 3  # pixels from which an edge is asked for
UNKNOWN, OUTLINED, STEPS = 127, 128, 124  # of :func:`coded`
FAINT = 12  # steps of luma that nobody sees
BESIDE = 0.1  # share of the depth by which two surfaces that meet may be apart in neighbouring pixels
MOST = 0.95  # of a pixel that may come from others


@ti.func
def corners(t, m, eye, vertices: ti.template(), position: ti.template(), faces: ti.template(), counts):
    """The corners of a triangle as seen from the eye. counts: triangles, vertices of the set"""
    a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
    p, q, r = vec3(0), vec3(0), vec3(0)
    if t < counts[0]:
        p, q, r = row3(vertices, a), row3(vertices, b), row3(vertices, c)
    else:
        p = item3(position, m, a - counts[1])
        q = item3(position, m, b - counts[1])
        r = item3(position, m, c - counts[1])
    return p - eye, q - eye, r - eye


@ti.func
def crossed(change, before, facing):
    """How many steps from a ray to the edge of a triangle, if they lead out of it there.

    change, before: products of a step and of the ray with the normal of the plane through eye and edge;
    facing: determinant of the triangle's corners
    """
    steps = NEVER
    if change * facing < 0:
        steps = greater(-before / change, 0.0)
    return steps


@ti.func
def left_at(p, q, r, ray, step):
    """How many steps from a ray a triangle is left, over which edge, the normal of the plane through eye and
    that edge, and the triangle's facing. Corners less corners: small where it matters, for small triangles
    far away."""
    normal, over_q, over_r = p.cross(q - p), q.cross(r - q), r.cross(p - r)
    facing = normal.dot(r)
    edge = 0
    out = crossed(step.dot(normal), ray.dot(normal), facing)
    other = crossed(step.dot(over_q), ray.dot(over_q), facing)
    if other < out:
        out, edge, normal = other, 1, over_q
    other = crossed(step.dot(over_r), ray.dot(over_r), facing)
    if other < out:
        out, edge, normal = other, 2, over_r
    return out, edge, normal, facing


@ti.func
def ended_at(
    t,
    far,
    m,
    eye,
    ray,
    step,
    beside,
    vertices: ti.template(),
    position: ti.template(),
    faces: ti.template(),
    joined: ti.template(),
    counts,
):
    """How many steps from a ray through triangle ``t`` its surface is left, and whether the edge over which
    it is lies rather across these steps than those to the side, ``beside``.

    Over edges it goes on to the next triangle, unless that one is turned away or there is none; ``far``
    triangles at most.
    """
    out, edge, facing, at = 0.0, 0, 0.0, t
    normal = vec3(0)
    for k in range(far + 1):
        following = t
        if k > 0:
            following = joined[at, edge]
        if following < 0 or out >= 1.0:
            break
        p, q, r = corners(following, m, eye, vertices, position, faces, counts)
        steps, side, plane, turn = left_at(p, q, r, ray, step)
        if k == 0:
            facing = turn
        elif turn * facing <= 0:
            break
        out, edge, at, normal = greater(out, steps), side, following, plane
    return out, ti.abs(step.dot(normal)) >= ti.abs(beside.dot(normal))


@ti.func
def run_into(
    t,
    u,
    m,
    eye,
    ray,
    step,
    beside,
    vertices: ti.template(),
    position: ti.template(),
    faces: ti.template(),
    counts,
):
    """After how many steps from a ray triangle ``t`` goes below triangle ``u``, which is seen a step away.

    NEVER if it does not, or does so rather along these steps than across them. Their planes are asked: within
    a step what they belong to bends little.
    """
    apart = vec3(0)  # times a ray: 1/z of the first less that of the second
    for turn in range(2):
        p, q, r = corners(t if turn == 0 else u, m, eye, vertices, position, faces, counts)
        plane = (q - p).cross(r - p)
        apart += plane / plane.dot(p) * (1.0 if turn == 0 else -1.0)
    before, change = apart.dot(ray), apart.dot(step)
    out = NEVER
    if before > 0 and before + change < 0 and ti.abs(change) >= ti.abs(apart.dot(beside)):
        out = -before / change
    return out


@ti.func
def border(behind, at, to, beyond, edge: ti.template(), vis: ti.template()):
    """OUTLINE where a surface ends between two pixels, BEND where it bends, else 0.

    behind, beyond: the pixels next to them on the line
    """
    e, f = edge[at], edge[to]
    out = 0
    if triangle(vis, at) != triangle(vis, to):
        if ((e ^ f) >> 16) != 0:
            out = OUTLINE
        else:
            w, v = nearness(vis, at), nearness(vis, to)
            ends = 2.0 * w - nearness(vis, behind) - v > FOLD * w * w and w > v
            if ends or (2.0 * v - nearness(vis, beyond) - w > FOLD * v * v and v > w):
                out = OUTLINE
            elif not level_with(e, f):
                out = BEND
    return out


@ti.func
def passing(
    at,
    to,
    kind,
    m,
    eye,
    ray,
    step,
    beside,
    vis: ti.template(),
    vertices: ti.template(),
    position: ti.template(),
    faces: ti.template(),
    joined: ti.template(),
    counts,
):
    """How far from the middle between two pixels their edge passes, towards the second: -0.5..0.5 pixels.

    NEVER where that is not known. kind: OUTLINE or BEND; ray: of the first pixel, step: to that of the second
    """
    out = NEVER
    t, u = triangle(vis, at), triangle(vis, to)
    far = FAR if kind == OUTLINE else 0
    here, there = NEVER, NEVER
    here_across, there_across = False, False
    # it is that of the nearer one, if it ends there at all; asked for in one place, as it is much code
    w, v = nearness(vis, at), nearness(vis, to)
    first = w >= v
    for turn in range(2):
        own = first if turn == 0 else not first
        asked = t if own else u
        if asked >= 0 and (turn == 0 or kind == BEND or ti.min(here, there) >= 1.0):
            begin, way = ray, step
            if not own:
                begin, way = ray + step, step * -1.0
            steps, across = ended_at(
                asked, far, m, eye, begin, way, beside, vertices, position, faces, joined, counts
            )
            if own:
                here, here_across = steps, across
            else:
                there, there_across = steps, across
    met = NEVER
    if 0 <= ti.min(t, u) < counts[0] and ti.abs(w - v) < BESIDE * ti.max(w, v):
        # within a body they are too small to tell, and far apart they do not meet
        met = run_into(t, u, m, eye, ray, step, beside, vertices, position, faces, counts)
    if kind == BEND and here < 1.0 and there < 1.0:
        if here_across or there_across:  # between them is what rounds the edge off
            out = 0.5 * (here - there)
    elif here < 1.0 and (first or there >= 1.0):
        if met < here:
            out = met - 0.5  # where it ends is behind the other
        elif here_across:
            out = here - 0.5
    elif there < 1.0 and 1.0 - there < met <= 1.0:
        out = met - 0.5
    elif there < 1.0 and there_across:
        out = 0.5 - there
    elif here >= 1.0 and there >= 1.0 and met <= 1.0:
        out = met - 0.5  # nothing ends: they run into each other
    return out


@ti.func
def told_apart(a, b, c, d, picture: ti.template()):
    """Whether four pixels in a line differ enough in luma for an edge among them to be seen."""
    p, q = ti.cast(picture[a] >> 24, ti.i32), ti.cast(picture[b] >> 24, ti.i32)
    r, s = ti.cast(picture[c] >> 24, ti.i32), ti.cast(picture[d] >> 24, ti.i32)
    return greater(greater(p, q), greater(r, s)) - lesser(lesser(p, q), lesser(r, s)) > FAINT


@ti.func
def coded(kind, s):
    """A border and how far off it passes in eight bits; never 0."""
    out = UNKNOWN
    if s < NEVER:
        out = ti.cast((s + 0.5) * STEPS + 0.5, ti.i32) + 1
    return out | (OUTLINED if kind == OUTLINE else 0)


@ti.func
def kind_of(code):
    return 0 if code == 0 else (OUTLINE if code & OUTLINED else BEND)


@ti.func
def wanted(k, b, y, blocks, height, level: ti.template()):
    """Whether block ``k``, the ``b``-th of row ``y``, or one within REACH of it is still to be smoothed."""
    out = level[k] >= SMOOTH
    if not out:
        for j in range(ti.max(y - REACH, 0), ti.min(y + REACH + 1, height)):
            row = k + (j - y) * blocks
            out = out or level[row] >= SMOOTH
            out = out or (b > 0 and level[row - 1] >= SMOOTH)
            out = out or (b < blocks - 1 and level[row + 1] >= SMOOTH)
    return out


@ti.kernel
def find_edges(
    view: f2,
    moment: i1,
    vertices: f2,
    position: f3,
    faces: i2,
    joined: i2,
    static_faces: ti.i32,
    static_vertices: ti.i32,
    vis: u64s,
    edge: u32s,
    picture: u32s,
    marks: i1,
    level: i1,
    told: ti.i32,
    kinds: i1,
    found: i1,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Where edges pass between each pixel and the one on its right, from bit 8 on the one below; 0 for none.

    marks, level: of blocks, pixels at which something ends, and what is left to do; told: whether ``kinds``
    says of blocks with lines where surfaces end (``borders.find_borders``); joined: as ``adjacency.beside``
    """
    for slot in range(slots):
        line = crew.task(slot, views * height, queue, host)
        if line < views * height:
            n, y = line // height, line % height
            m = moment[n]
            eye, first, step = rays(view, n, y)
            down = part3(view, n, 6) * (-1.0 / view[n, 13])
            counts = ti.Vector([static_faces, static_vertices])
            blocks = (width + RUN - 1) // RUN
            for b in range(blocks):
                k = line * blocks + b
                if not wanted(k, b, y, blocks, height, level):
                    continue
                begin = line * width + b * RUN
                count = ti.min(RUN, width - b * RUN)
                for i in range(count):
                    found[begin + i] = 0
                # marked is every pixel beside another triangle, where lines were drawn and no more was copied
                bits = (1 << count) - 1
                if level[k] >= SMOOTH:
                    bits &= marks[k]
                known = told == 1 and level[k] >= INK
                if known:
                    either = kinds[2 * k] | kinds[2 * k + 1]
                    bits &= either | either >> RUN
                while bits != 0:
                    i = 31 - ti.math.clz(bits)
                    bits ^= 1 << i
                    x, at = b * RUN + i, begin + i
                    code = 0
                    ray = first + step * ti.cast(x, ti.f32)
                    for below in range(2):
                        stride, before, after, along, aside = 1, x, width - 1 - x, step, down
                        if below == 1:
                            stride, before, after, along, aside = width, y, height - 1 - y, down, step
                        to = at + stride
                        behind = at - stride if before > 0 else at
                        beyond = to + stride if after > 1 else to
                        kind = 0
                        if known:
                            word = kinds[2 * k + below] >> i
                            kind = OUTLINE if word & 1 else (BEND if word >> RUN & 1 else 0)
                        elif after > 0:
                            kind = border(behind, at, to, beyond, edge, vis)
                        if kind != 0:
                            s = NEVER
                            if told_apart(behind, at, to, beyond, picture):
                                s = passing(
                                    at,
                                    to,
                                    kind,
                                    m,
                                    eye,
                                    ray,
                                    along,
                                    aside,
                                    vis,
                                    vertices,
                                    position,
                                    faces,
                                    joined,
                                    counts,
                                )
                            code |= coded(kind, s) << (8 * below)
                    found[at] = code


@ti.func
def weights(code):
    """What a pixel gets of the one before it and of the one after it, to be moved as far as an edge is.

    The quadratic B-spline: wherever the edge passes, it blurs alike. What lies between two pixels' colours
    blurs by the more the further they are moved, and a line would pulse as it goes along the pixels.
    """
    s = ti.cast((code & UNKNOWN) - 1, ti.f32) * (1.0 / STEPS)
    return 0.5 * s * s, 0.5 * (1.0 - s) * (1.0 - s)


@ti.func
def moved(at, stride, bits, before, after, reach, found: ti.template()):
    """What a pixel gets of the one before it on a line and of the one after it, and whether edges are known.

    stride: from one to the next; bits: where edges across the line are in ``found``; before, after: how many
    pixels there are; reach: how many pixels from an edge are moved with it, so that lines keep their width
    """
    from_before, from_after = 0.0, 0.0
    known = False
    if before > 1 and after > 1:
        left, right = found[at - stride] >> bits & 255, found[at] >> bits & 255
        # what is thin and bends beside its outline moves with that, also where that is a pixel or two further
        further = 0
        for away in range(1, reach + 1):
            if ti.max(kind_of(left), kind_of(right)) < OUTLINE and before > away and after > away:
                p, q = found[at - (away + 1) * stride] >> bits & 255, found[at + away * stride] >> bits & 255
                if ti.max(kind_of(p), kind_of(q)) > ti.max(kind_of(left), kind_of(right)):
                    left, right, further = p, q, away
        most = ti.max(kind_of(left), kind_of(right))
        # where something ends on both sides, only what comes over the border counts
        alone = further < reach and kind_of(left) != kind_of(right)
        if most != 0 and kind_of(left) == most and left & UNKNOWN != UNKNOWN:
            known = True
            near, far = weights(left)
            from_before = near
            if alone:
                from_after = far
        if most != 0 and kind_of(right) == most and right & UNKNOWN != UNKNOWN:
            known = True
            far, near = weights(right)
            from_after = greater(from_after, near)
            if alone:
                from_before = greater(from_before, far)
    return from_before, from_after, known


@ti.func
def scaled_down(a, b, c, d):
    """What all four shares are multiplied by, so that enough of the pixel itself is left."""
    return lesser(1.0, MOST / greater(a + b + c + d, 1e-6))
