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

from .geometry import greater, item3, lesser, nearness, row3, triangle, vec3
from .ink import level

NEVER = 2.0  # further than any neighbour
FOLD = 0.03  # of 1/z squared: where a surface ends before itself
OUTLINE, BEND = 2, 1
FAR = 12  # triangles after which an end is no longer looked for
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
def crossed(a, b, facing, ray, step, beside):
    """How many steps from a ray to the edge from ``a`` to ``b`` of a triangle, if they lead out of it there.

    And whether the edge lies rather across these steps than those to the side. facing: determinant of the
    triangle's corners. What is subtracted is small where it matters, for small triangles far away.
    """
    along = b - a
    change, aside = along.dot(step.cross(a)), along.dot(beside.cross(a))
    steps = NEVER
    if change * facing < 0:
        steps = greater(-along.dot(ray.cross(a)) / change, 0.0)
    return steps, ti.abs(change) >= ti.abs(aside)


@ti.func
def left_at(p, q, r, ray, step, beside):
    """How many steps from a ray a triangle is left, whether across them as above, over which edge, and its
    facing."""
    facing = p.dot(q.cross(r))
    out, across = crossed(p, q, facing, ray, step, beside)
    edge = 0
    other, over = crossed(q, r, facing, ray, step, beside)
    if other < out:
        out, across, edge = other, over, 1
    other, over = crossed(r, p, facing, ray, step, beside)
    if other < out:
        out, across, edge = other, over, 2
    return out, across, edge, facing


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
    """How many steps from a ray through triangle ``t`` its surface is left, as :func:`left_at`.

    Over edges it goes on to the next triangle, unless that one is turned away or there is none; ``far``
    triangles at most.
    """
    p, q, r = corners(t, m, eye, vertices, position, faces, counts)
    out, across, edge, facing = left_at(p, q, r, ray, step, beside)
    at = t
    for _ in range(far):
        following = joined[at, edge]
        if following < 0 or out >= 1.0:
            break
        p, q, r = corners(following, m, eye, vertices, position, faces, counts)
        steps, over, side, turn = left_at(p, q, r, ray, step, beside)
        if turn * facing <= 0:
            break
        out, across, edge, at = greater(out, steps), over, side, following
    return out, across


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
            elif not level(e, f):
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
    if t >= 0:
        here, here_across = ended_at(
            t, far, m, eye, ray, step, beside, vertices, position, faces, joined, counts
        )
    if u >= 0:
        there, there_across = ended_at(
            u, far, m, eye, ray + step, step * -1.0, beside, vertices, position, faces, joined, counts
        )
    if kind == BEND and here < 1.0 and there < 1.0:
        if here_across or there_across:  # between them is what rounds the edge off
            out = 0.5 * (here - there)
    elif here < 1.0 and (there >= 1.0 or nearness(vis, at) >= nearness(vis, to)):
        # that of the nearer one, if it ends there at all
        if here_across:
            out = here - 0.5
    elif there < 1.0 and there_across:
        out = 0.5 - there
    return out


@ti.func
def moved(
    at,
    stride,
    before,
    after,
    m,
    eye,
    ray,
    step,
    beside,
    edge: ti.template(),
    vis: ti.template(),
    vertices: ti.template(),
    position: ti.template(),
    faces: ti.template(),
    joined: ti.template(),
    counts,
):
    """What a pixel gets of the one before it on a line and of the one after it, and whether edges are known.

    stride: from one to the next; before, after: how many there are. Around an edge all is moved with it, so
    that a line of ink keeps its width.
    """
    from_before, from_after = 0.0, 0.0
    known = False
    if before > 1 and after > 1:
        back, on = at - stride, at + stride
        far_back, far_on = back - stride, on + stride
        ends_before = border(far_back, back, at, on, edge, vis)
        ends_after = border(back, at, on, far_on, edge, vis)
        # what is thin and bends beside its outline moves with that, also where that is a pixel or two further
        further = 0
        # lines of what moves are up to two pixels wide
        reach = 2 if triangle(vis, at) >= counts[0] else 1
        for away in range(1, reach + 1):
            if ti.max(ends_before, ends_after) < OUTLINE and before > away and after > away:
                p, q = at - away * stride, at + away * stride
                p_on, q_on = p - stride, q + stride
                limit = p_on - stride if before > away + 1 else p_on
                before_that = border(limit, p_on, p, p + stride, edge, vis)
                limit = q_on + stride if after > away + 1 else q_on
                after_that = border(q - stride, q, q_on, limit, edge, vis)
                if ti.max(before_that, after_that) > ti.max(ends_before, ends_after):
                    ends_before, ends_after, further = before_that, after_that, away
        most = ti.max(ends_before, ends_after)
        for k in range(2):
            kind = ends_before if k == 0 else ends_after
            if kind != 0 and kind == most:
                steps = further if k == 1 else -1 - further
                s = passing(
                    at + steps * stride,
                    at + (steps + 1) * stride,
                    kind,
                    m,
                    eye,
                    ray + step * ti.cast(steps, ti.f32),
                    step,
                    beside,
                    vis,
                    vertices,
                    position,
                    faces,
                    joined,
                    counts,
                )
                if s < NEVER:
                    known = True
                    # where something ends on both sides, only what comes over the border counts
                    alone = further < reach and ends_before != ends_after
                    if k == 0 or alone:
                        from_before = greater(from_before, s)
                    if k == 1 or alone:
                        from_after = greater(from_after, -s)
    return from_before, from_after, known


@ti.func
def scaled_down(a, b, c, d):
    """What all four shares are multiplied by, so that enough of the pixel itself is left."""
    return lesser(1.0, MOST / greater(a + b + c + d, 1e-6))
