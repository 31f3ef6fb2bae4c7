"""Hatching: the tones of a shaded picture as strokes of ink on white paper.

Strokes are slices of the world, and of people as they were modelled, so that they stay on what they
are drawn on. Their spacing on the picture stays between one and two times SPACING: as one comes
nearer, strokes grow in between; nothing jumps.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .geometry import bounded, f1, f2, f3, i1, i2, item3, nearness, part3, row3, triangle, u32s, u64s, vec3
from .paint import RUN, SHADE
from .pattern import value_noise

SPACING, CLOSEST = 0.0085, 3.2  # of the picture's height; pixels, at least
FIRST, SECOND = (0.61, 0.45, 0.65), (-0.52, 0.66, 0.55)  # across the strokes of the two layers
#: From one knot to the next of the spline that strokes are seen through: pixels, at most; of their spacing.
SOFT, SOFTER = 1.25, 0.2
LIGHTEST = (0.1, 0.26)  # darkness at which strokes begin, and have all of their ink
DEEPER = 0.4  # how much lighter a set has to be to stay white where it is as gloomy as can be
OPENER = 0.4  # and how much of their ink people lose there, so that they stand out
LEAST = 0.03  # ink that is seen
SET = 0.7  # of their ink that strokes of a set have: black is for people
NARROW = 1.6  # times the way between strokes: what has less room begins to lose them, up to a quarter less
FLAT = 0.4  # ink that is there instead, about as much as strokes have in the middle
HALO = 0.0085  # of the picture's height around people, where the set behind them has no strokes
#: Metres between strokes from which on, by and by, people have a wash of grey instead, which is read at a
#: glance where strokes are not; and how dark their shadows are in it.
AFAR, SHADOW = (0.008, 0.015), 0.3
UNDER, OVER = 0.5, 0.75  # near by: share of the wash, and of the ink of the strokes over it
SKY, BRIGHT = 0.9, 165.0  # how dark strokes make a sky, and the luma from which on it stays white


@ti.func
def eased(x, low, high):
    t = bounded((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


@ti.func
def pressed(dark, spacing):
    """Half the width of a stroke, pixels."""
    return spacing * (0.07 + 0.12 * bounded(dark, 0.0, 1.0))


@ti.func
def passed(x):
    """How much of a pixel lies before an edge ``x`` knots from its middle, by the quadratic B-spline: seen
    through a box, strokes flicker as they go along the pixels."""
    t = ti.min(ti.abs(x), 1.5)
    rest = 1.5 - t
    out = ti.select(t < 0.5, 0.5 + t * (0.75 - t * t * (1.0 / 3.0)), 1.0 - rest * rest * rest * (1.0 / 6.0))
    return ti.select(x < 0.0, 1.0 - out, out)


@ti.func
def strokes(place, along, grow, spacing, half, lattice: ti.template()):
    """Coverage 0..1 of parallel strokes.

    place: across them, along: along them, metres; grow: metres across them a pixel; spacing, half: pixels
    between strokes and half the width of one
    """
    wanted = 1.0 / ti.max(grow * spacing, 1e-9)  # strokes a metre
    bits = ti.bit_cast(wanted, ti.i32)
    octave = ti.bit_cast(bits & 0x7F800000, ti.f32)  # the power of two below it
    finer = wanted / octave - 1.0
    at = (
        place * 2.0 * octave + (value_noise(along * octave * 0.4, place * octave * 0.3, lattice) - 0.5) * 0.45
    )
    apart = 1.0 / (2.0 * octave * grow)  # pixels from one line to the next
    knots = 1.0 / ti.min(SOFT, SOFTER * spacing)
    seen = 0.0
    for k in range(2):  # the nearest even line, and the nearest of those that grow between these
        grown = 1.0 if k == 0 else eased(finer, 0.25, 1.0)
        if grown > 0.0:
            other = ti.cast(k, ti.f32)
            line = 2.0 * ti.floor((at - other) * 0.5 + 0.5) + other
            away = ti.abs(at - line) * apart
            # a hand presses, and lifts the pen now and then
            press = value_noise(along * octave * 0.22, line * 7.31, lattice)
            width = half * (0.55 + 0.75 * press) * grown
            covered = passed((width - away) * knots) - passed((-width - away) * knots)
            seen += covered * eased(press, 0.10, 0.2)
    return ti.min(seen, 1.0)


@ti.func
def inked(ink):
    """The colour of paper under so much ink, 0..1: luma, blue, green, red."""
    shade = 1.0 - 0.93 * ink
    r8 = ti.cast(250.0 * shade + 0.5, ti.u32)
    g8 = ti.cast(249.0 * shade + 0.5, ti.u32)
    b8 = ti.cast(247.0 * shade + 0.5, ti.u32)
    return r8 | (g8 << 8) | (b8 << 16) | (((r8 * 5 + g8 * 9 + b8 * 2) >> 4) << 24)


def looks_around(height: int) -> int:
    """How many pixels away what is drawn in a pixel may go by, in pictures so high."""
    return int(max(NARROW * max(SPACING * height, CLOSEST), HALO * height)) + 2


@ti.func
def extent(i, place, size, step, room, edge: ti.template()):
    """Over how many pixels in a row the surface goes on that is seen in one of them, up to ``room``.

    place: of the pixel in its row of ``size``; step: from pixel to pixel of it in memory
    """
    s = edge[i] >> 16
    half = (room + 1) // 2
    out = room
    if (
        place < half
        or place >= size - half
        or edge[i - half * step] >> 16 != s
        or edge[i + half * step] >> 16 != s
    ):
        out = 1
        for way in range(2):
            k, most = 1, ti.select(way == 0, place, size - 1 - place)
            one = ti.select(way == 0, -step, step)
            while k <= most and out < room and edge[i + k * one] >> 16 == s:
                k += 1
                out += 1
    return out


@ti.func
def alone_here(line, y, run, runs, height, reach, solid: ti.template()):
    """Whether nobody is within ``reach`` of a run of pixels, as one triangle of the set fills each around."""
    out = True
    for j in range(-2, 3):
        v = y + j * ((reach + 1) // 2)
        if 0 <= v < height:
            for r in range(ti.max(run - 1, 0), ti.min(run + 2, runs)):
                out = out and solid[(line - y + v) * runs + r] != 0
    return out


@ti.func
def haloed(i, x, y, width, height, reach, vis: ti.template(), own: ti.template()):
    """How near a place of the set is to somebody's outline before it, 0..1.

    i, x, y: its pixel; reach: pixels, looked for in eight ways, and half as far, for what is narrow
    """
    here = nearness(vis, i)
    found = 0
    for k in range(18):
        if found > 1:
            break
        far = ti.select(k < 9, reach, (reach + 1) // 2)
        dx, dy = far * (k % 3 - 1), far * (k // 3 % 3 - 1)
        u, v = x + dx, y + dy
        if 0 <= u < width and 0 <= v < height:
            j = i + dy * width + dx
            t = triangle(vis, j)
            if t >= 0 and nearness(vis, j) > here and own[t, 1] >= 0:
                found += 1
    return ti.min(0.5 * ti.cast(found, ti.f32), 1.0)


@ti.kernel
def hatch_rows(
    view: f2,
    moment: i1,
    vertices: f2,
    rest: f2,
    position: f3,
    faces: i2,
    static_faces: ti.i32,
    static_vertices: ti.i32,
    own: f2,
    level: ti.f32,
    gloom: ti.f32,
    lattice: f1,
    vis: u64s,
    edge: u32s,
    solid: i1,
    todo: i1,
    picture: u32s,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Turn a shaded picture into strokes, in place.

    own [F, 3]: how light each triangle is in all of the light, 1 for white, the ink of its colour in strokes,
        less than 0 of what belongs to the set, and the same in a wash;
    edge: surfaces in its upper half; solid: the triangle + 1 of the set that fills each RUN alone, or not 0;
    level: luma that stays white; gloom: how far from the light of day the set is, 0..1; todo: levels of runs
    """
    for slot in range(slots):
        line = crew.task(slot, views * height, queue, host)
        if line < views * height:
            n = line // height
            m = moment[n]
            eye = part3(view, n, 0)
            step = part3(view, n, 3) / view[n, 12]
            down = -part3(view, n, 6) / view[n, 13]
            first = (
                part3(view, n, 9) + down * (line % height + 0.5 - view[n, 15]) + step * (0.5 - view[n, 14])
            )
            spacing = ti.max(SPACING * height, CLOSEST)
            apart = spacing * step.norm()  # metres between strokes a metre away
            room = ti.cast(NARROW * spacing + 0.5, ti.i32)
            reach = ti.max(ti.cast(HALO * height + 0.5, ti.i32), 2)
            y, runs = line % height, (width + RUN - 1) // RUN
            nobody = False  # near the run at hand
            last = -2
            plane, ga, gb = vec3(0), vec3(0), vec3(0)
            offset, xa, xb = 1.0, 0.0, 0.0
            for x in range(width):
                i = line * width + x
                t = triangle(vis, i)
                if todo[line * runs + x // RUN] < SHADE:
                    continue
                if x % RUN == 0:
                    nobody = alone_here(line, y, x // RUN, runs, height, reach, solid)
                tone = ti.cast(picture[i] >> 24, ti.f32)
                ray = first + step * ti.cast(x, ti.f32)
                if t < 0:
                    # the sky at night: strokes on a sphere that is the same from everywhere
                    dark = SKY * (BRIGHT - tone) / 255.0
                    ink = 0.0
                    if dark > LIGHTEST[0]:
                        far = 1.0 / ray.norm()
                        wa, wb = vec3(FIRST), vec3(SECOND)
                        ra, rb = wa.dot(ray), wb.dot(ray)
                        turn, drop = ray.dot(step) * far * far, ray.dot(down) * far * far
                        across = ti.Vector([wa.dot(step) - ra * turn, wa.dot(down) - ra * drop]).norm() * far
                        half = pressed(dark, spacing)
                        ink = strokes(ra * far, rb * far, across, spacing, half, lattice)
                        ink *= SET * eased(dark, LIGHTEST[0], LIGHTEST[1])
                    picture[i] = inked(ink)
                else:
                    tone /= level
                    dark, wash, afar = 0.0, 0.0, 0.0
                    moves = own[t, 1] >= 0
                    if not moves:
                        # sets are quiet
                        dark = 0.85 * (1.0 - tone / (1.0 + DEEPER * gloom)) - 0.05
                    else:
                        # people: shadows whatever the colour, and what is dark itself, over a wash
                        dark = (0.62 * (1.0 - tone / own[t, 0]) + own[t, 1]) * (1.0 - OPENER * gloom)
                        wash = own[t, 2]
                        afar = eased(apart / nearness(vis, i), AFAR[0], AFAR[1])
                    if dark <= LIGHTEST[0] and not moves:
                        picture[i] = inked(0.0)
                        continue
                    ink = 0.0
                    flat = 0.0  # share of a flat grey, where there is no room for strokes
                    if not moves:
                        wide = extent(i, x, width, 1, room, edge)
                        if wide > 1:
                            wide = ti.min(wide, extent(i, y, height, width, room, edge))
                        flat = bounded(4.0 * (1.0 - ti.cast(wide, ti.f32) / ti.cast(room, ti.f32)), 0.0, 1.0)
                    if dark > LIGHTEST[0] and afar < 1.0 and flat < 1.0:
                        if t != last:
                            last = t
                            a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
                            p, q1, q2 = vec3(0), vec3(0), vec3(0)
                            if t < static_faces:
                                p = row3(vertices, a)
                                q1, q2 = row3(vertices, b) - p, row3(vertices, c) - p
                            else:
                                a, b, c = a - static_vertices, b - static_vertices, c - static_vertices
                                p = item3(position, m, a)
                                q1, q2 = item3(position, m, b) - p, item3(position, m, c) - p
                            cross = q1.cross(q2)
                            inverse = 1.0 / ti.max(cross.norm_sqr(), 1e-20)
                            plane = cross * ti.sqrt(inverse)
                            offset = plane.dot(p - eye)
                            r, e1, e2 = p, q1, q2
                            if t >= static_faces:
                                r = row3(rest, a)
                                e1, e2 = row3(rest, b) - r, row3(rest, c) - r
                            # places across the strokes are linear over the triangle
                            g1, g2 = q2.cross(cross) * inverse, cross.cross(q1) * inverse
                            wa, wb = vec3(FIRST), vec3(SECOND)
                            ga, gb = g1 * wa.dot(e1) + g2 * wa.dot(e2), g1 * wb.dot(e1) + g2 * wb.dot(e2)
                            xa, xb = wa.dot(r) + ga.dot(eye - p), wb.dot(r) + gb.dot(eye - p)
                        facing = plane.dot(ray)
                        z = offset / facing
                        ra, rb = ga.dot(ray), gb.dot(ray)
                        tx, ty = plane.dot(step) / facing, plane.dot(down) / facing
                        place_a, place_b = xa + z * ra, xb + z * rb
                        across_a = ti.Vector([ga.dot(step) - ra * tx, ga.dot(down) - ra * ty]).norm()
                        half = pressed(dark, spacing)
                        ink = strokes(place_a, place_b, across_a * ti.abs(z), spacing, half, lattice)
                        ink *= eased(dark, LIGHTEST[0], LIGHTEST[1])
                        if dark > 0.46:
                            across_b = ti.Vector(
                                [gb.dot(step) - rb * tx, gb.dot(down) - rb * ty]
                            ).norm() * ti.abs(z)
                            other = strokes(place_b, place_a, across_b, spacing, half, lattice)
                            ink = ti.max(ink, other * eased(dark, 0.46, 0.58))
                            ink = ti.max(ink, eased(dark, 0.6, 0.76))
                    ink += (FLAT * eased(dark, LIGHTEST[0], LIGHTEST[1]) - ink) * flat
                    if not moves:
                        ink *= SET
                        if ink > LEAST and not nobody:
                            ink *= 1.0 - haloed(i, x, y, width, height, reach, vis, own)
                    else:
                        shadow = SHADOW * eased(dark - own[t, 1], LIGHTEST[0], LIGHTEST[1])
                        wash *= afar + (1.0 - afar) * UNDER
                        ink *= OVER
                        ink = wash + (1.0 - wash) * (ink + (shadow - ink) * afar)
                    picture[i] = inked(ink)
