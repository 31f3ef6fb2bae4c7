"""Plain smooth shading: light at the corners of triangles, colours in between, and nothing else.

No shadows, lines, patterns, haze or smoothing. Rows go from the visibility buffer to bytes in one pass.
Light does not depend on the camera, so faces of the set with one normal have one colour for good.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .geometry import (
    bounded,
    f1,
    f2,
    f3,
    greater,
    i1,
    i2,
    item3,
    nearness,
    part3,
    row3,
    triangle,
    u8s,
    u16s,
    u32s,
    u64s,
    vec3,
)
from .paint import GLASS, GLOW, backdrop, developed, exposed, ramp

STRETCH = 32  # pixels of a triangle between two colours that are worked out
CARD = 16  # numbers kept for each triangle of the set


@ti.func
def light_on(n, light: ti.template()):
    """Light that a surface with a normal throws back where it is white."""
    sky, under = vec3(light[6], light[7], light[8]), vec3(light[9], light[10], light[11])
    key = greater(n.dot(vec3(light[0], light[1], light[2])), 0.0)
    return under + (sky - under) * (n.z * 0.5 + 0.5) + vec3(light[3], light[4], light[5]) * key


@ti.func
def store3(out: ti.template(), at, v):
    for a in ti.static(range(3)):
        out[at + a] = v[a]


@ti.func
def load3(a: ti.template(), at):
    return vec3(a[at], a[at + 1], a[at + 2])


@ti.kernel
def fold_plain(
    vertices: f2, normals: f2, faces: i2, color: f2, info: i2, light: f1, film: u16s, count: ti.i32, card: f1
):
    """What is known of the first ``count`` triangles (the set) before there is a camera.

    card, CARD numbers each: first corner 3; gradients of the shares of the other two 3 + 3; normal of the
    plane 3 and its offset; packed colours in front and behind (bits); whether they are all there is to it
    """
    for t in range(count):
        p = row3(vertices, faces[t, 0])
        q1, q2 = row3(vertices, faces[t, 1]) - p, row3(vertices, faces[t, 2]) - p
        cross = q1.cross(q2)
        inverse = 1.0 / ti.max(cross.norm_sqr(), 1e-20)
        plane = cross * ti.sqrt(inverse)
        at = t * CARD
        store3(card, at, p)
        store3(card, at + 3, q2.cross(cross) * inverse)
        store3(card, at + 6, cross.cross(q1) * inverse)
        store3(card, at + 9, plane)
        card[at + 12] = plane.dot(p)
        base, n = row3(color, t), row3(normals, faces[t, 0])
        material = info[t, 1] & 255
        flat = (info[t, 1] >> 8) & 1
        front, back = base * light_on(n, light), base * light_on(-n, light)
        if material == GLASS:
            front = base * 1.5 + vec3(0.10, 0.12, 0.13)
        if material == GLOW:
            front = base * 2.0 + 0.2
        if material == GLASS or material == GLOW:  # noqa: SIM109
            back, flat = front, 1
        card[at + 13] = ti.bit_cast(developed(front, film), ti.f32)
        card[at + 14] = ti.bit_cast(developed(back, film), ti.f32)
        card[at + 15] = flat


@ti.kernel
def plain_rows(
    view: f2,
    moment: i1,
    normals: f2,
    position: f3,
    normal: f3,
    faces: i2,
    color: f2,
    card: f1,
    static_faces: ti.i32,
    static_vertices: ti.i32,
    light: f1,
    film: u16s,
    vis: u64s,
    picture: u32s,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Shade all views into ``picture``, packed."""
    for slot in range(slots):
        line = crew.task(slot, views * height, queue, host)
        if line < views * height:
            n = line // height
            m = moment[n]
            eye = part3(view, n, 0)
            step = part3(view, n, 3) / view[n, 12]
            first = (
                part3(view, n, 9)
                + part3(view, n, 6) * ((view[n, 15] - (line % height + 0.5)) / view[n, 13])
                + step * (0.5 - view[n, 14])
            )
            horizon, zenith = load3(light, 12), load3(light, 15)
            last = -2
            flat, behind = False, False
            whole = ti.u32(0)
            p, g1, g2 = vec3(0), vec3(0), vec3(0)
            c0, c1, c2 = vec3(0), vec3(0), vec3(0)
            x = 0
            while x < width:
                at = line * width + x
                t = triangle(vis, at)
                if t != last:
                    last = t
                    flat = False
                    if t >= static_faces:
                        a, b = faces[t, 0] - static_vertices, faces[t, 1] - static_vertices
                        c = faces[t, 2] - static_vertices
                        p = item3(position, m, a)
                        q1, q2 = item3(position, m, b) - p, item3(position, m, c) - p
                        cross = q1.cross(q2)
                        p -= eye
                        side = 1.0 if cross.dot(p) <= 0 else -1.0
                        inverse = 1.0 / greater(cross.norm_sqr(), 1e-20)
                        g1, g2 = q2.cross(cross) * inverse, cross.cross(q1) * inverse
                        base = row3(color, t)
                        c0 = base * light_on(item3(normal, m, a) * side, light)
                        c1 = base * light_on(item3(normal, m, b) * side, light) - c0
                        c2 = base * light_on(item3(normal, m, c) * side, light) - c0
                    elif t >= 0:
                        row = t * CARD
                        behind = load3(card, row + 9).dot(eye) < card[row + 12]
                        flat = card[row + 15] > 0
                        whole = ti.bit_cast(card[row + 14] if behind else card[row + 13], ti.u32)
                        if not flat:
                            p, g1, g2 = load3(card, row) - eye, load3(card, row + 3), load3(card, row + 6)
                            side = -1.0 if behind else 1.0
                            base = row3(color, t)
                            c0 = base * light_on(row3(normals, faces[t, 0]) * side, light)
                            c1 = base * light_on(row3(normals, faces[t, 1]) * side, light) - c0
                            c2 = base * light_on(row3(normals, faces[t, 2]) * side, light) - c0
                if flat:
                    i = at
                    end = (line + 1) * width
                    while i < end and triangle(vis, i) == t:
                        picture[i] = whole
                        i += 1
                    x += i - at
                else:
                    stop = x + 1
                    limit = ti.min(width, x + STRETCH)
                    while stop < limit and triangle(vis, at + stop - x) == t:
                        stop += 1
                    here, there = ti.Vector([0, 0, 0]), ti.Vector([0, 0, 0])
                    for k in range(2):
                        here = there
                        if k == 0 or stop > x + 1:
                            place = x if k == 0 else stop - 1
                            ray = first + step * ti.cast(place, ti.f32)
                            if t < 0:
                                there = backdrop(ray, horizon, zenith, film)
                            else:
                                d = ray * (1.0 / nearness(vis, at + place - x)) - p
                                b1, b2 = bounded(d.dot(g1), 0.0, 1.0), bounded(d.dot(g2), 0.0, 1.0)
                                there = exposed(c0 + c1 * b1 + c2 * b2, film)
                    ramp(here, there, stop - 1 - x, at, stop - x, picture)
                    x = stop


@ti.kernel
def pack_words(picture: u32s, final: u32s, count: ti.i32):
    """Bytes of packed colours, four pixels in three words."""
    for group in range(count // 4):
        at = 4 * group
        a, b = picture[at] & 0xFFFFFF, picture[at + 1] & 0xFFFFFF
        c, d = picture[at + 2] & 0xFFFFFF, picture[at + 3] & 0xFFFFFF
        final[3 * group] = a | (b << 24)
        final[3 * group + 1] = (b >> 8) | (c << 16)
        final[3 * group + 2] = (c >> 16) | (d << 8)


@ti.kernel
def pack_bytes(picture: u32s, final: u8s, count: ti.i32):
    """The same for any number of pixels."""
    for i in range(count):
        for a in ti.static(range(3)):
            final[3 * i + a] = ti.cast((picture[i] >> (8 * a)) & 255, ti.u8)


@ti.kernel
def ids_seen(vis: u64s, info: i2, owner: i1, out: i1, count: ti.i32):
    """Object ids of a visibility buffer, -1 where nothing is."""
    for i in range(count):
        t = triangle(vis, i)
        out[i] = owner[info[t, 0]] if t >= 0 else -1
