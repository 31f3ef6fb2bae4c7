"""Geometry: bounds, and triangles into the visibility buffer.

The visibility buffer holds, per pixel, ``depth key << 32 | triangle + 1`` and keeps the largest: the
key is the bit pattern of 1/z, which is linear over the picture and orders like the number it is.
A pixel belongs to a triangle when its centre is inside, left and top edges included. Edges are
walked from their upper end, so triangles that share one agree on it to the last bit.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

NEAR = 0.03  # metres
#: Metres; of a triangle that comes nearer, the depth is that of its plane (:func:`plane_of`). Near the plane
#: of the eye corners may lie 100,000 pixels beside the picture, where rounding moves them by a hundredth of
#: one, and depths between such corners of a long and narrow one by metres.
CLOSE = 0.5
FAINTEST = 1e-6  # 1/z, of what is a thousand kilometres away
STRIPS = 8  # interleaved rows a triangle is shared by
vec3 = ti.types.vector(3, ti.f32)

f1 = ti.types.ndarray(ti.f32, ndim=1)
f2 = ti.types.ndarray(ti.f32, ndim=2)
f3 = ti.types.ndarray(ti.f32, ndim=3)
f4 = ti.types.ndarray(ti.f32, ndim=4)
i1 = ti.types.ndarray(ti.i32, ndim=1)
i2 = ti.types.ndarray(ti.i32, ndim=2)
u8s = ti.types.ndarray(ti.u8, ndim=1)
u16s = ti.types.ndarray(ti.u16, ndim=1)
u32s = ti.types.ndarray(ti.u32, ndim=1)
u64s = ti.types.ndarray(ti.u64, ndim=1)


@ti.func
def triangle(vis: ti.template(), at):
    """The triangle at a pixel of a visibility buffer, -1 for none."""
    return ti.cast(ti.cast(vis[at], ti.u32), ti.i32) - 1


@ti.func
def nearness(vis: ti.template(), at):
    """1/z of a pixel of a visibility buffer, 0 where nothing is."""
    return ti.bit_cast(ti.cast(vis[at] >> 32, ti.u32), ti.f32)


@ti.func
def row3(a: ti.template(), i):
    return vec3(a[i, 0], a[i, 1], a[i, 2])


@ti.func
def item3(a: ti.template(), m, i):
    return vec3(a[m, i, 0], a[m, i, 1], a[m, i, 2])


@ti.func
def part3(a: ti.template(), i, k):
    return vec3(a[i, k], a[i, k + 1], a[i, k + 2])


@ti.func
def rays(view: ti.template(), n, y):
    """The eye of a view, the ray through pixel 0 of row ``y``, and what each pixel adds to it."""
    step = part3(view, n, 3) / view[n, 12]
    first = (
        part3(view, n, 9)
        + part3(view, n, 6) * ((view[n, 15] - (y + 0.5)) / view[n, 13])
        + step * (0.5 - view[n, 14])
    )
    return part3(view, n, 0), first, step


@ti.kernel
def bound(
    faces: i2,
    clusters: i2,
    wanted: i2,
    first: ti.i32,
    static_vertices: ti.i32,
    moments: ti.i32,
    position: f3,
    sphere: f3,
):
    """Bounding spheres of the moving clusters (from ``first`` on), of each moment those that are wanted.

    wanted: [M, moving clusters], 1 or 0
    """
    count = clusters.shape[0] - first
    for i in range(moments * count):
        m = i // count
        c = i % count
        low = vec3(1e30)
        high = vec3(-1e30)
        begin = clusters[first + c, 0]
        for t in range(begin, begin + clusters[first + c, 1] * wanted[m, c]):
            for k in ti.static(range(3)):
                p = item3(position, m, faces[t, k] - static_vertices)
                low = ti.min(low, p)
                high = ti.max(high, p)
        centre = (low + high) * 0.5
        for a in ti.static(range(3)):
            sphere[m, c, a] = centre[a]
        sphere[m, c, 3] = (high - low).norm() * 0.5


@ti.func
def bounded(x, least, most):
    """``x`` kept between two bounds; two instructions, where ti.min and ti.max also mind NaN."""
    y = ti.select(x < least, least, x)
    return ti.select(y > most, most, y)


@ti.func
def lesser(x, y):
    """The smaller one; for numbers, never NaN, as in :func:`bounded`."""
    return ti.select(x < y, x, y)


@ti.func
def greater(x, y):
    return ti.select(x > y, x, y)


@ti.func
def to_pixel(v):
    """First pixel whose centre is not before ``v``."""
    return ti.ceil(v - 0.5)


@ti.func
def fill(
    vis: ti.template(), exact: ti.template(), base, width, y_from, y_to, y_step, low, a, b, c, planar, plane
):
    """Walk the spans of one screen triangle; corners are (x, y, 1/z), ``low`` the low word of the key.

    planar, plane: as :func:`cut` has them
    """
    top = to_pixel(lesser(lesser(a.y, b.y), c.y))
    bottom = to_pixel(greater(greater(a.y, b.y), c.y))
    left = to_pixel(lesser(lesser(a.x, b.x), c.x))
    right = to_pixel(greater(greater(a.x, b.x), c.x))
    limit = ti.cast(width, ti.f32)
    # many triangles lie between pixel centres
    if top < bottom and left < right and right > 0 and left < limit and bottom > y_from and top < y_to:
        y0 = ti.cast(greater(top, ti.cast(y_from, ti.f32)), ti.i32)
        y1 = ti.cast(lesser(bottom, ti.cast(y_to, ti.f32)), ti.i32)
        if a.y > b.y:
            a, b = b, a
        if b.y > c.y:
            b, c = c, b
        if a.y > b.y:
            a, b = b, a
        if ti.static(not exact):
            y0 += (y_from - y0 % y_step + y_step) % y_step
        ab = b - a
        ac = c - a
        bc = c - b
        det = ab.x * ac.y - ac.x * ab.y
        if det != 0:
            inverse = 1.0 / det
            slope_x = (ab.z * ac.y - ac.z * ab.y) * inverse
            slope_y = (ac.z * ab.x - ab.z * ac.x) * inverse
            least = lesser(lesser(a.z, b.z), c.z)
            most = greater(greater(a.z, b.z), c.z)
            known = a
            if planar:
                slope_x, slope_y = plane.x, plane.y
                known = vec3(0.0, 0.0, plane.z)
                least, most = FAINTEST, 1.0 / NEAR
            long = ac.x / ac.y
            upper = ab.x / ab.y if ab.y > 0 else 0.0
            lower = bc.x / bc.y if bc.y > 0 else 0.0
            y = y0
            while y < y1:
                centre = ti.cast(y, ti.f32) + 0.5
                xa = a.x + (centre - a.y) * long
                xb = a.x + (centre - a.y) * upper
                if centre >= b.y:
                    xb = b.x + (centre - b.y) * lower
                x0 = ti.cast(bounded(to_pixel(lesser(xa, xb)), 0.0, limit), ti.i32)
                x1 = ti.cast(bounded(to_pixel(greater(xa, xb)), 0.0, limit), ti.i32)
                row = known.z + (centre - known.y) * slope_y + (0.5 - known.x) * slope_x
                start = base + y * width
                for x in range(x0, x1):
                    w = bounded(row + ti.cast(x, ti.f32) * slope_x, least, most)
                    key = (ti.cast(ti.bit_cast(w, ti.u32), ti.u64) << 32) | low
                    if ti.static(exact):
                        if key > vis[start + x]:
                            vis[start + x] = key
                    else:
                        ti.atomic_max(vis[start + x], key)
                y += y_step


@ti.func
def plane_of(normal, offset, scale, half):
    """1/z of a plane over the screen: what a pixel to the right and one down add, and at its corner.

    normal: in camera coordinates, of any length; offset: its product with a point of the plane
    """
    x, y = normal.x / (scale.x * offset), -normal.y / (scale.y * offset)
    return vec3(x, y, normal.z / offset - x * half.x - y * half.y)


@ti.func
def fits(plane, s):
    """Whether a plane has about the 1/z of a corner on the screen: seen edge on, it is left to rounding."""
    return ti.abs(plane.x * s.x + plane.y * s.y + plane.z - s.z) < 0.05 * s.z


@ti.func
def cut(cull, scale, half, p0, p1, p2):
    """Cull, clip at the near plane and project one triangle given in camera coordinates.

    Returns how many triangles are left (0..2), a fan of four corners on the screen, whether their depth is
    that of a plane, and that (:func:`plane_of`). Right, up, forward is a left-handed frame: a positive
    determinant faces the camera.
    """
    pieces, planar = 0, False
    sa, sb, sc, sd, plane = vec3(0), vec3(0), vec3(0), vec3(0), vec3(0)
    normal = (p1 - p0).cross(p2 - p0)
    facing = p0.dot(normal)  # of the corners alone, rounding would hide small ones
    if facing > 0 or (facing < 0 and not cull):
        inside = ti.cast(p0.z > NEAR, ti.i32) + ti.cast(p1.z > NEAR, ti.i32) + ti.cast(p2.z > NEAR, ti.i32)
        if inside > 0:
            a, b, c, d = p0, p1, p2, p2
            pieces = 1
            if inside == 1:
                # a becomes the corner in front
                if p1.z > NEAR:
                    a, b, c = p1, p2, p0
                elif p2.z > NEAR:
                    a, b, c = p2, p0, p1
                b, c = a + (b - a) * ((a.z - NEAR) / (a.z - b.z)), a + (c - a) * ((a.z - NEAR) / (a.z - c.z))
                b.z = NEAR
                c.z = NEAR
            elif inside == 2:
                # a becomes the corner behind, and is cut off
                if p1.z <= NEAR:
                    a, b, c = p1, p2, p0
                elif p2.z <= NEAR:
                    a, b, c = p2, p0, p1
                d = c + (a - c) * ((c.z - NEAR) / (c.z - a.z))
                a = b + (a - b) * ((b.z - NEAR) / (b.z - a.z))
                a.z = NEAR
                d.z = NEAR
                pieces = 2
            sa = screen(a, scale, half)
            sb = screen(b, scale, half)
            sc = screen(c, scale, half)
            sd = screen(d, scale, half)
            if lesser(lesser(p0.z, p1.z), p2.z) <= CLOSE:
                plane = plane_of(normal, facing, scale, half)
                planar = fits(plane, sa) and fits(plane, sb) and fits(plane, sc) and fits(plane, sd)
    return pieces, sa, sb, sc, sd, planar, plane


@ti.func
def screen(p, scale, half):
    w = 1.0 / p.z
    return vec3(half.x + scale.x * p.x * w, half.y - scale.y * p.y * w, w)


@ti.kernel
def clear(vis: u64s, count: ti.i32):
    for i in range(count):
        vis[i] = ti.u64(0)


@ti.kernel
def raster_atomic(
    view: f2,
    moment: i1,
    hidden: i2,
    vertices: f2,
    position: f3,
    faces: i2,
    info: i2,
    static_faces: ti.i32,
    static_vertices: ti.i32,
    vis: u64s,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
):
    """Fill cleared visibility buffers, STRIPS threads a triangle and view, for machines of many threads.

    info [F, 3]: anything, flags << 8, wall
    """
    for i in range(views * faces.shape[0] * STRIPS):
        strip = i % STRIPS
        t = (i // STRIPS) % faces.shape[0]
        n = i // (STRIPS * faces.shape[0])
        shown = True
        if info[t, 2] >= 0:
            shown = hidden[n, info[t, 2]] == 0
        if shown:
            eye = part3(view, n, 0)
            right = part3(view, n, 3)
            up = part3(view, n, 6)
            forward = part3(view, n, 9)
            m = moment[n]
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
                fill(
                    vis,
                    False,
                    n * height * width,
                    width,
                    strip,
                    height,
                    STRIPS,
                    ti.cast(t + 1, ti.u64),
                    sa,
                    sb,
                    sc,
                    planar,
                    plane,
                )
