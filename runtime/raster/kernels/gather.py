"""Which triangles each view sees, as they are on the screen: sixteen triangles at a time, on the host.

Taichi never turns a loop that stores into vector instructions; explicit vectors it does, where the compile
option is set (``device.vectorised``), on memory aligned to 64 bytes. Under that option only plain arithmetic,
comparisons and selections of vectors compile, so everything else here is written in numbers.

Same arithmetic as ``geometry.cut``, operation by operation: same corners to the last bit.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .geometry import (
    CLOSE,
    NEAR,
    bounded,
    cut,
    f1,
    f2,
    f3,
    greater,
    i1,
    i2,
    item3,
    lesser,
    part3,
    row3,
    to_pixel,
    vec3,
)

LANES = 16  # 1 << LANE_BITS
LANE_BITS = 4
CORNERS = 9  # numbers of a triangle: three corners, x y z
#: Numbers kept with a triangle on the screen: triangle + 1, first row, row after the last. The first is
#: negative where the corners have the numbers of a plane (``geometry.plane_of``) in place of their 1/z.
TAGS = 3
BUNDLE = 32  # triangles on the screen, one after another, whose rows are kept together
GROUPS = 4  # of LANES triangles in a cluster, at most
EVERY, TAKEN, OTHERS = 0, 1, 2  # which of the moving clusters a view draws
WHOLE, ACROSS = 1.0, 2.0  # states of a lane: well in front of the near plane, or near it or across
EVEN = 12582912.0  # 1.5 * 2^23: adding and taking it off rounds to whole numbers

V = ti.types.vector(LANES, ti.f32)
I = ti.types.vector(LANES, ti.i32)  # noqa: E741
fv = ti.types.ndarray(dtype=ti.types.vector(LANES, ti.f32), ndim=1)
iv = ti.types.ndarray(dtype=ti.types.vector(LANES, ti.i32), ndim=1)


@ti.kernel
def arrange(
    faces: i2,
    clusters: i2,
    wanted: i2,
    first: ti.i32,
    count: ti.i32,
    offset: ti.i32,
    moments: ti.i32,
    position: f3,
    out: f1,
):
    """Corners of the triangles of those of ``count`` clusters from ``first`` on that are wanted, sixteen of a
    kind side by side.

    wanted: [M, count], 1 or 0
    position [M, V, 3], of vertices counted from ``offset`` on; out: [M, count, GROUPS, CORNERS, LANES]
    """
    for i in range(moments * count):
        m = i // count
        c = first + i % count
        base = i * (GROUPS * CORNERS * LANES)
        for k in range(clusters[c, 1] * wanted[m, i % count]):
            t = clusters[c, 0] + k
            at = base + (k // LANES) * (CORNERS * LANES) + k % LANES
            for j in ti.static(range(3)):
                v = faces[t, j] - offset
                for a in ti.static(range(3)):
                    out[at + (3 * j + a) * LANES] = position[m, v, a]


@ti.func
def least3(a, b, c):
    d = ti.select(a < b, a, b)
    return ti.select(d < c, d, c)


@ti.func
def most3(a, b, c):
    d = ti.select(a > b, a, b)
    return ti.select(d > c, d, c)


@ti.func
def turned(block: ti.template(), at, e0, e1, e2, a0, a1, a2):
    """One camera coordinate of sixteen points."""
    return a0 * (block[at] - e0) + a1 * (block[at + 1] - e1) + a2 * (block[at + 2] - e2)


@ti.kernel
def gather(
    view: f2,
    moment: i1,
    hidden: i2,
    clusters: i2,
    sphere: f2,
    moving_sphere: f3,
    moving_first: ti.i32,
    rests: i1,
    taken: i1,
    part: i2,
    which: i1,
    still: fv,
    moving: fv,
    work: fv,
    lane: f1,
    corner: f1,
    tag: i1,
    clipped: i1,
    counts: i2,
    most: ti.i32,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """The triangles of each view that may cover the centre of a pixel, as they are on the screen.

    clusters [C, 4]: first triangle, count, cull, wall; rests [moving clusters]: 1 for those that are in all
    moments as in the first one, where alone they are; taken: 1 for those of them that are in empty sets
    part [views, 2]: from which cluster to which is drawn; which [views]: of the moving ones EVERY, those that
    are TAKEN, or the OTHERS
    still, moving: their corners (:func:`arrange`)
    work [views * 10]: scratch, ``lane`` its memory; corner [views, 2 F, CORNERS], tag [views, 2 F, TAGS]:
    what is found; clipped [views, F]: triangles near the near plane or across it; counts [views, 2]: how many
    of both
    """
    for slot in range(slots):
        n = crew.task(slot, views, queue, host)
        if n < views:
            e0, e1, e2 = view[n, 0], view[n, 1], view[n, 2]
            r0, r1, r2 = view[n, 3], view[n, 4], view[n, 5]
            u0, u1, u2 = view[n, 6], view[n, 7], view[n, 8]
            g0, g1, g2 = view[n, 9], view[n, 10], view[n, 11]
            scale_x, scale_y, half_x, half_y = view[n, 12], view[n, 13], view[n, 14], view[n, 15]
            # the pyramid of the view: slopes of its sides, and what a radius counts against them
            side_x, side_y = half_x / scale_x, half_y / scale_y
            grow_x, grow_y = ti.sqrt(1 + side_x * side_x), ti.sqrt(1 + side_y * side_y)
            limit_x, limit_y = ti.cast(width, ti.f32) - 0.5, ti.cast(height, ti.f32) - 0.5
            movers = clusters.shape[0] - moving_first
            found, crossing = 0, 0
            for c in range(part[n, 0], part[n, 1]):
                b0, b1, b2, radius = 0.0, 0.0, 0.0, 0.0
                moves, drawn = c >= moving_first, True
                m = moment[n]
                if moves:
                    k = c - moving_first
                    drawn = which[n] == EVERY or (taken[k] != 0) == (which[n] == TAKEN)
                    if rests[k] != 0:
                        m = 0
                    b0, b1 = moving_sphere[m, k, 0], moving_sphere[m, k, 1]
                    b2, radius = moving_sphere[m, k, 2], moving_sphere[m, k, 3]
                else:
                    b0, b1, b2, radius = sphere[c, 0], sphere[c, 1], sphere[c, 2], sphere[c, 3]
                b0 -= e0
                b1 -= e1
                b2 -= e2
                z = g0 * b0 + g1 * b1 + g2 * b2
                shown = (
                    drawn
                    and z > NEAR - radius
                    and ti.abs(r0 * b0 + r1 * b1 + r2 * b2) - z * side_x < radius * grow_x
                    and ti.abs(u0 * b0 + u1 * b1 + u2 * b2) - z * side_y < radius * grow_y
                )
                if shown and clusters[c, 3] >= 0:
                    shown = hidden[n, clusters[c, 3]] == 0
                if shown:
                    first, count = clusters[c, 0], clusters[c, 1]
                    for g in range((count + LANES - 1) // LANES):
                        ax, ay, az = V(0.0), V(0.0), V(0.0)
                        bx, by, bz = V(0.0), V(0.0), V(0.0)
                        cx, cy, cz = V(0.0), V(0.0), V(0.0)
                        if moves:
                            at = ((m * movers + c - moving_first) * GROUPS + g) * CORNERS
                            ax = turned(moving, at, e0, e1, e2, r0, r1, r2)
                            ay = turned(moving, at, e0, e1, e2, u0, u1, u2)
                            az = turned(moving, at, e0, e1, e2, g0, g1, g2)
                            bx = turned(moving, at + 3, e0, e1, e2, r0, r1, r2)
                            by = turned(moving, at + 3, e0, e1, e2, u0, u1, u2)
                            bz = turned(moving, at + 3, e0, e1, e2, g0, g1, g2)
                            cx = turned(moving, at + 6, e0, e1, e2, r0, r1, r2)
                            cy = turned(moving, at + 6, e0, e1, e2, u0, u1, u2)
                            cz = turned(moving, at + 6, e0, e1, e2, g0, g1, g2)
                        else:
                            at = (c * GROUPS + g) * CORNERS
                            ax = turned(still, at, e0, e1, e2, r0, r1, r2)
                            ay = turned(still, at, e0, e1, e2, u0, u1, u2)
                            az = turned(still, at, e0, e1, e2, g0, g1, g2)
                            bx = turned(still, at + 3, e0, e1, e2, r0, r1, r2)
                            by = turned(still, at + 3, e0, e1, e2, u0, u1, u2)
                            bz = turned(still, at + 3, e0, e1, e2, g0, g1, g2)
                            cx = turned(still, at + 6, e0, e1, e2, r0, r1, r2)
                            cy = turned(still, at + 6, e0, e1, e2, u0, u1, u2)
                            cz = turned(still, at + 6, e0, e1, e2, g0, g1, g2)
                        # as geometry.facing
                        px, py, pz = bx - ax, by - ay, bz - az
                        qx, qy, qz = cx - ax, cy - ay, cz - az
                        front = ax * (py * qz - pz * qy) + ay * (pz * qx - px * qz) + az * (px * qy - py * qx)
                        if clusters[c, 2] == 0:
                            front = ti.select(front < 0.0, 0.0 - front, front)
                        nearest, farthest = least3(az, bz, cz), most3(az, bz, cz)
                        whole = nearest > CLOSE
                        aw, bw, cw = 1.0 / az, 1.0 / bz, 1.0 / cz
                        ax = half_x + scale_x * ax * aw
                        bx = half_x + scale_x * bx * bw
                        cx = half_x + scale_x * cx * cw
                        ay = half_y - scale_y * ay * aw
                        by = half_y - scale_y * by * bw
                        cy = half_y - scale_y * cy * cw
                        left, right = least3(ax, bx, cx), most3(ax, bx, cx)
                        top, bottom = least3(ay, by, cy), most3(ay, by, cy)
                        state = ti.select(right > 0.5, V(WHOLE), V(0.0))
                        state = ti.select(bottom > 0.5, state, V(0.0))
                        state = ti.select(left <= limit_x, state, V(0.0))
                        state = ti.select(top <= limit_y, state, V(0.0))
                        # many lie between pixel centres
                        column, line = (right + EVEN) - EVEN, (bottom + EVEN) - EVEN
                        thin = ti.select(left > column - 0.5, column + 0.5, left - 1.0)
                        state = ti.select(right <= thin, V(0.0), state)
                        thin = ti.select(top > line - 0.5, line + 0.5, top - 1.0)
                        state = ti.select(bottom <= thin, V(0.0), state)
                        state = ti.select(whole, state, V(ACROSS))
                        state = ti.select(farthest > NEAR, state, V(0.0))
                        state = ti.select(front > 0.0, state, V(0.0))
                        put = n * (CORNERS + 1)
                        work[put] = ax
                        work[put + 1] = ay
                        work[put + 2] = aw
                        work[put + 3] = bx
                        work[put + 4] = by
                        work[put + 5] = bw
                        work[put + 6] = cx
                        work[put + 7] = cy
                        work[put + 8] = cw
                        work[put + 9] = state
                        for k in range(ti.min(LANES, count - g * LANES)):
                            what = lane[(put + 9) * LANES + k]
                            if what == WHOLE:
                                to = (n * 2 * most + found) * CORNERS
                                for j in range(CORNERS):
                                    corner[to + j] = lane[(put + j) * LANES + k]
                                tall = ti.cast(height, ti.f32)
                                y0, y1, y2 = corner[to + 1], corner[to + 4], corner[to + 7]
                                over, under = lesser(lesser(y0, y1), y2), greater(greater(y0, y1), y2)
                                to = (n * 2 * most + found) * TAGS
                                tag[to] = first + g * LANES + k + 1
                                tag[to + 1] = ti.cast(bounded(to_pixel(over), 0.0, tall), ti.i32)
                                tag[to + 2] = ti.cast(bounded(to_pixel(under), 0.0, tall), ti.i32)
                                found += 1
                            elif what == ACROSS:
                                clipped[n * most + crossing] = first + g * LANES + k
                                crossing += 1
            counts[n, 0] = found
            counts[n, 1] = crossing


@ti.kernel
def clip(
    view: f2,
    moment: i1,
    vertices: f2,
    position: f3,
    faces: i2,
    info: i2,
    static_faces: ti.i32,
    static_vertices: ti.i32,
    clipped: i1,
    corner: f1,
    tag: i1,
    counts: i2,
    extent: i1,
    most: ti.i32,
    views: ti.i32,
    height: ti.i32,
    banded: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Cut the triangles near the near plane that :func:`gather` found; add what is left to its findings.

    extent: [views, bundles of a view, 2], first row and row after the last of each BUNDLE of findings;
        all rows unless ``banded``, as then every band looks at all of them
    """
    for slot in range(slots):
        n = crew.task(slot, views, queue, host)
        if n < views:
            eye = part3(view, n, 0)
            right = part3(view, n, 3)
            up = part3(view, n, 6)
            forward = part3(view, n, 9)
            m = moment[n]
            found = counts[n, 0]
            for i in range(counts[n, 1]):
                t = clipped[n * most + i]
                p0, p1, p2 = vec3(0), vec3(0), vec3(0)
                if t >= static_faces:
                    p0 = item3(position, m, faces[t, 0] - static_vertices) - eye
                    p1 = item3(position, m, faces[t, 1] - static_vertices) - eye
                    p2 = item3(position, m, faces[t, 2] - static_vertices) - eye
                else:
                    p0 = row3(vertices, faces[t, 0]) - eye
                    p1 = row3(vertices, faces[t, 1]) - eye
                    p2 = row3(vertices, faces[t, 2]) - eye
                pieces, sa, sb, sc, sd, planar, plane = cut(
                    (info[t, 1] >> 10) & 1 != 0,
                    ti.Vector([view[n, 12], view[n, 13]]),
                    ti.Vector([view[n, 14], view[n, 15]]),
                    vec3(right.dot(p0), up.dot(p0), forward.dot(p0)),
                    vec3(right.dot(p1), up.dot(p1), forward.dot(p1)),
                    vec3(right.dot(p2), up.dot(p2), forward.dot(p2)),
                )
                for j in range(pieces):
                    if j == 1:
                        sb, sc = sc, sd
                    to = (n * 2 * most + found) * CORNERS
                    for a in ti.static(range(3)):
                        corner[to + a] = sa[a]
                        corner[to + 3 + a] = sb[a]
                        corner[to + 6 + a] = sc[a]
                    if planar:
                        for a in ti.static(range(3)):
                            corner[to + 3 * a + 2] = plane[a]
                    top = to_pixel(lesser(lesser(sa.y, sb.y), sc.y))
                    bottom = to_pixel(greater(greater(sa.y, sb.y), sc.y))
                    tall = ti.cast(height, ti.f32)
                    to = (n * 2 * most + found) * TAGS
                    tag[to] = -(t + 1) if planar else t + 1
                    tag[to + 1] = ti.cast(bounded(top, 0.0, tall), ti.i32)
                    tag[to + 2] = ti.cast(bounded(bottom, 0.0, tall), ti.i32)
                    found += 1
            counts[n, 0] = found
            bundles = (2 * most + BUNDLE - 1) // BUNDLE
            for i in range((found + BUNDLE - 1) // BUNDLE):
                first, last = 0, height
                if banded != 0:
                    first, last = height, 0
                    for k in range(i * BUNDLE, ti.min(found, i * BUNDLE + BUNDLE)):
                        first = ti.min(first, tag[(n * 2 * most + k) * TAGS + 1])
                        last = ti.max(last, tag[(n * 2 * most + k) * TAGS + 2])
                extent[(n * bundles + i) * 2] = first
                extent[(n * bundles + i) * 2 + 1] = last
