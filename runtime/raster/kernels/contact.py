"""Contact: how closely what moves stands over the floor and over the tops of furniture.

A grid of cells lies over the floor; in each moment two layers of it are filled, one for the floor and one for
what stands on it.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .geometry import f1, f2, f3, i1, i2, vec3

LOWEST, HIGHEST = 0.25, 1.6  # metres over the floor between which furniture ends above
UPWARD = 0.9  # how far up what things stand on faces
NOWHERE = -1e9  # the top of what is not there


@ti.func
def above_floor(z, floor: ti.template()):
    """Height over the highest floor that is not above it."""
    under = floor[3]
    for k in range(4, floor.shape[0]):
        if floor[k] <= z + 0.05:
            under = floor[k]
    return z - under


@ti.func
def floor_cell(p, floor: ti.template(), columns, rows):
    """The cell of the floor's grid over or under a place; -1 beside it."""
    x = ti.cast(ti.floor((p.x - floor[0]) * floor[2]), ti.i32)
    y = ti.cast(ti.floor((p.y - floor[1]) * floor[2]), ti.i32)
    return y * columns + x if 0 <= x < columns and 0 <= y < rows else -1


@ti.kernel
def find_tops(vertices: f2, faces: i2, count: ti.i32, floor: f1, columns: ti.i32, rows: ti.i32, tops: f1):
    """Where the furniture of a set ends above, into ``tops`` [rows, columns]: in each cell of the floor's
    grid the greatest height of what faces up between LOWEST and HIGHEST over the floor; as it is without.

    count: triangles of the set
    """
    ti.loop_config(serialize=True)
    for t in range(count):
        a = vec3(vertices[faces[t, 0], 0], vertices[faces[t, 0], 1], vertices[faces[t, 0], 2])
        b = vec3(vertices[faces[t, 1], 0], vertices[faces[t, 1], 1], vertices[faces[t, 1], 2]) - a
        c = vec3(vertices[faces[t, 2], 0], vertices[faces[t, 2], 1], vertices[faces[t, 2], 2]) - a
        cross = b.cross(c)
        high = above_floor(a.z, floor)
        if cross.z > UPWARD * cross.norm() and LOWEST < high < HIGHEST:
            corner = vec3(floor[0], floor[1], 0.0)
            p, q, r = (a - corner) * floor[2], b * floor[2], c * floor[2]
            left = ti.cast(ti.floor(p.x + ti.min(0.0, q.x, r.x)), ti.i32)
            right = ti.cast(ti.floor(p.x + ti.max(0.0, q.x, r.x)), ti.i32)
            low = ti.cast(ti.floor(p.y + ti.min(0.0, q.y, r.y)), ti.i32)
            top = ti.cast(ti.floor(p.y + ti.max(0.0, q.y, r.y)), ti.i32)
            inverse = 1.0 / (q.x * r.y - q.y * r.x)
            for y in range(ti.max(low, 0), ti.min(top + 1, rows)):
                for x in range(ti.max(left, 0), ti.min(right + 1, columns)):
                    dx, dy = ti.cast(x, ti.f32) + 0.5 - p.x, ti.cast(y, ti.f32) + 0.5 - p.y
                    u = (dx * r.y - dy * r.x) * inverse
                    v = (dy * q.x - dx * q.y) * inverse
                    if u >= 0 and v >= 0 and u + v <= 1:
                        at = y * columns + x
                        tops[at] = ti.max(tops[at], a.z + u * b.z + v * c.z)


@ti.kernel
def touch(
    position: f3,
    area: f1,
    solid: f1,
    moments: ti.i32,
    floor: f1,
    tops: f1,
    columns: ti.i32,
    rows: ti.i32,
    spare: f1,
    ground: f1,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """How closely moving things stand over each cell of the floor, and of what is on it, blurred:
    ground [M, 2, rows, columns], the floor and the tops of furniture.

    area: surface each skinned vertex stands for, square metres; solid: the same without what is flat
    floor: corner x, y, cells a metre, then the heights of the floors, rising; tops: of :func:`find_tops`
    """
    for slot in range(slots):
        m = crew.task(slot, moments, queue, host)
        if m < moments:
            cells = rows * columns
            for i in range(2 * cells):
                ground[2 * m * cells + i] = 0.0
            low, high = ti.Vector([columns, rows, columns, rows]), ti.Vector([-1, -1, -1, -1])
            for v in range(area.shape[0]):
                p = vec3(position[m, v, 0], position[m, v, 1], position[m, v, 2])
                cell = floor_cell(p, floor, columns, rows)
                if cell >= 0:
                    for layer in ti.static(range(2)):
                        over = above_floor(p.z, floor) if ti.static(layer == 0) else p.z - tops[cell]
                        reach = ti.static((0.4, 0.25)[layer])
                        if over < reach and ti.static((-1e9, -0.1)[layer]) < over:
                            share = 1.0 - ti.max(over, 0.0) / reach
                            own = area[v] if ti.static(layer == 0) else solid[v]
                            at_cell = (2 * m + layer) * cells + cell
                            # written out: one thread has the moment, and += would be an atomic addition
                            ground[at_cell] = ground[at_cell] + own * share * share * floor[2] * floor[2]
                            at = ti.Vector([cell % columns, cell // columns])
                            for a in ti.static(range(2)):
                                low[2 * layer + a] = ti.min(low[2 * layer + a], at[a])
                                high[2 * layer + a] = ti.max(high[2 * layer + a], at[a])
            for layer in range(2):
                base = (2 * m + layer) * cells
                left, right, bottom, top = low[0], high[0], low[1], high[1]
                if layer == 1:
                    left, right, bottom, top = low[2], high[2], low[3], high[3]
                if right >= 0:
                    left, right = ti.max(left - 8, 0), ti.min(right + 9, columns)
                    bottom, top = ti.max(bottom - 8, 0), ti.min(top + 9, rows)
                    for _ in range(3 - layer):  # what stands on furniture is smaller
                        for y in range(bottom, top):
                            for x in range(left, right):
                                at = base + y * columns + x
                                a = ground[at - 1] if x > left else 0.0
                                b = ground[at + 1] if x < right - 1 else 0.0
                                spare[at - base + m * cells] = (a + ground[at] + b) / 3.0
                        for y in range(bottom, top):
                            for x in range(left, right):
                                at = m * cells + y * columns + x
                                a = spare[at - columns] if y > bottom else 0.0
                                b = spare[at + columns] if y < top - 1 else 0.0
                                ground[base + y * columns + x] = (a + spare[at] + b) / 3.0


@ti.func
def standing_near(p, layer, floor: ti.template(), columns, rows, ground: ti.template()):
    """Bilinear sample of what stands on the floor, or on furniture; layer: which of ``ground``."""
    x = (p.x - floor[0]) * floor[2] - 0.5
    y = (p.y - floor[1]) * floor[2] - 0.5
    out = 0.0
    if 0 <= x < columns - 1 and 0 <= y < rows - 1:
        i, j = ti.cast(x, ti.i32), ti.cast(y, ti.i32)
        x -= i
        y -= j
        at = layer * rows * columns + j * columns + i
        a = ground[at] + (ground[at + 1] - ground[at]) * x
        b = ground[at + columns] + (ground[at + columns + 1] - ground[at + columns]) * x
        out = a + (b - a) * y
    return out
