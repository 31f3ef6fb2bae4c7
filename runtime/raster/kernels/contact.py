"""Contact: how closely what moves stands over the floor and over the tops of furniture.

A grid of cells lies over the floor; in each moment two layers of it are filled, one for the floor and one for
what stands on it.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from . import crew
from .geometry import f1, f2, f3, i1, i2, item3, vec3

LOWEST, HIGHEST = 0.25, 1.6  # metres over the floor between which furniture ends above
UPWARD = 0.9  # how far up what things stand on faces
NOWHERE = -1e9  # the top of what is not there
REACH = (0.4, 0.25)  # metres over the floor, or over furniture, from which on a thing leaves no shadow
BLURS = (3, 2)  # times; what stands on furniture is smaller
UNIT, MOST = 512.0, 500.0  # whole numbers of each surface a cell; the most of a vertex, far beyond black


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


@ti.func
def cell_below(p, highest, floor: ti.template(), columns, rows):
    """The same of what is not too high to count; -1 for the rest, which nobody need look for."""
    cell = -1
    if p.z < highest:
        cell = floor_cell(p, floor, columns, rows)
    return cell


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


@ti.func
def left_by(
    p,
    cell,
    v,
    layer: ti.template(),
    area: ti.template(),
    solid: ti.template(),
    floor: ti.template(),
    tops: ti.template(),
):
    """What a vertex at ``p`` leaves in its cell of the floor (layer 0) or of furniture, a whole number; -1
    where it is too far away for any."""
    over = above_floor(p.z, floor) if ti.static(layer == 0) else p.z - tops[cell]
    reach = ti.static(REACH[layer])
    out = -1
    if over < reach and ti.static((-1e9, -0.1)[layer]) < over:
        share = 1.0 - ti.max(over, 0.0) / reach
        amount = (area[v] if ti.static(layer == 0) else solid[v]) * share * share
        out = ti.cast(ti.min(amount * (floor[2] * floor[2]), MOST) * UNIT + 0.5, ti.i32)
    return out


@ti.kernel
def touch(
    position: f3,
    area: f1,
    solid: f1,
    runs: i2,
    moments: ti.i32,
    floor: f1,
    tops: f1,
    highest: ti.f32,
    columns: ti.i32,
    rows: ti.i32,
    resting: i1,
    still: ti.i32,
    spare: i1,
    counted: i1,
    stained: i2,
    ground: f1,
    queue: i1,
    slots: ti.i32,
    stretch: ti.i32,
    host: ti.template(),
):
    """How closely moving things stand over each cell of the floor, and of what is on it, blurred:
    ground [M, 2, rows, columns], the floor and the tops of furniture.

    area: surface each skinned vertex stands for, square metres; solid: the same without what is flat
    runs [R, 2]: first vertex and the one after the last of things, or parts of them
    floor: corner x, y, cells a metre, then the heights of the floors, rising; tops: of :func:`find_tops`;
    highest: over which nothing counts
    resting [2, rows, columns]: what is there in all moments, in whole numbers, so that it does not matter
    what is counted first; still: the moment of ``ground`` that has it already, as all others have but for the
    cells in ``stained`` [M, 2 * 4], which is renewed; -1 where ``resting`` is all 0 and what there is in the
    one moment is to go to ``counted`` too, as whole numbers
    spare: scratch of 5 * rows * columns for every ``stretch`` slots, all 0 before and after
    """
    for slot in range(slots):
        m = crew.task(slot, moments, queue, host)
        if m < moments:
            cells = rows * columns
            own, begin = slot // stretch * (5 * cells), 2 * m * cells
            blurred, total = own + 2 * cells, own + 3 * cells
            if still >= 0:
                for layer in range(2):
                    for y in range(stained[m, 4 * layer + 2], stained[m, 4 * layer + 3]):
                        for x in range(stained[m, 4 * layer], stained[m, 4 * layer + 1]):
                            at = layer * cells + y * columns + x
                            ground[begin + at] = ground[2 * still * cells + at]
            around = ti.Matrix([[0, 0, 0, 0], [0, 0, 0, 0]])
            for run in range(runs.shape[0]):
                box = ti.Matrix([[columns, -1, rows, -1], [columns, -1, rows, -1]])
                for v in range(runs[run, 0], runs[run, 1]):
                    p = item3(position, m, v)
                    cell = cell_below(p, highest, floor, columns, rows)
                    if cell >= 0:
                        for layer in ti.static(range(2)):
                            amount = left_by(p, cell, v, layer, area, solid, floor, tops)
                            if amount >= 0:
                                x, y, at = cell % columns, cell // columns, own + layer * cells + cell
                                # written out: one thread has the moment, and += would be an atomic addition
                                spare[at] = spare[at] + amount
                                box[layer, 0] = ti.min(box[layer, 0], x)
                                box[layer, 1] = ti.max(box[layer, 1], x)
                                box[layer, 2] = ti.min(box[layer, 2], y)
                                box[layer, 3] = ti.max(box[layer, 3], y)
                for layer in ti.static(range(2)):
                    if box[layer, 1] >= 0:
                        base = own + layer * cells
                        left, right = box[layer, 0], box[layer, 1] + 1
                        low, high = box[layer, 2], box[layer, 3] + 1
                        for _ in range(ti.static(BLURS[layer])):
                            left, right = ti.max(left - 1, 0), ti.min(right + 1, columns)
                            low, high = ti.max(low - 1, 0), ti.min(high + 1, rows)
                            for y in range(low, high):
                                for x in range(left, right):
                                    at = base + y * columns + x
                                    a = spare[at - 1] if x > left else 0
                                    b = spare[at + 1] if x < right - 1 else 0
                                    spare[blurred + y * columns + x] = a + spare[at] + b
                            for y in range(low, high):
                                for x in range(left, right):
                                    at = blurred + y * columns + x
                                    a = spare[at - columns] if y > low else 0
                                    b = spare[at + columns] if y < high - 1 else 0
                                    spare[base + y * columns + x] = a + spare[at] + b
                        for y in range(low, high):
                            for x in range(left, right):
                                at = layer * cells + y * columns + x
                                spare[total + at] = spare[total + at] + spare[own + at]
                                spare[own + at] = 0
                                spare[blurred + y * columns + x] = 0
                        first = around[layer, 1] == 0
                        around[layer, 0] = left if first else ti.min(around[layer, 0], left)
                        around[layer, 1] = ti.max(around[layer, 1], right)
                        around[layer, 2] = low if first else ti.min(around[layer, 2], low)
                        around[layer, 3] = ti.max(around[layer, 3], high)
            if still < 0:
                for i in range(2 * cells):
                    counted[i] = spare[total + i]
                    unit = ti.static(scale(0)) if i < cells else ti.static(scale(1))
                    ground[i] = ti.cast(counted[i], ti.f32) * unit
            for layer in ti.static(range(2)):
                for k in ti.static(range(4)):
                    stained[m, 4 * layer + k] = around[layer, k]
                for y in range(around[layer, 2], around[layer, 3]):
                    for x in range(around[layer, 0], around[layer, 1]):
                        at = layer * cells + y * columns + x
                        count = resting[at] + spare[total + at]
                        ground[begin + at] = ti.cast(count, ti.f32) * ti.static(scale(layer))
                        spare[total + at] = 0


@ti.kernel
def touch_atomic(
    position: f3,
    area: f1,
    solid: f1,
    listed: i1,
    count: ti.i32,
    moments: ti.i32,
    floor: f1,
    tops: f1,
    highest: ti.f32,
    columns: ti.i32,
    rows: ti.i32,
    resting: i1,
    spare: i1,
    counted: i1,
    ground: f1,
):
    """The same as :func:`touch`, a thread a vertex and then a cell, for machines of many threads.

    All that is blurred is whole numbers that are added up, so it comes to the same whether things are blurred
    one by one or together.

    listed: the ``count`` vertices of the runs; spare: scratch as large as ``counted``
    """
    for i in range(moments * 2 * rows * columns):
        counted[i] = 0
    for i in range(moments * count):
        m, v = i // count, listed[i % count]
        p = item3(position, m, v)
        cell = cell_below(p, highest, floor, columns, rows)
        if cell >= 0:
            for layer in ti.static(range(2)):
                amount = left_by(p, cell, v, layer, area, solid, floor, tops)
                if amount > 0:
                    ti.atomic_add(counted[(2 * m + layer) * rows * columns + cell], amount)
    for i in range(moments * 2 * rows * columns):
        spare[i] = spread(counted, i, columns, rows, 0)
    for i in range(moments * 2 * rows * columns):
        counted[i] = spread(spare, i, columns, rows, 1)
    for i in range(moments * 2 * rows * columns):
        spare[i] = spread(counted, i, columns, rows, 2)
    for i in range(moments * 2 * rows * columns):
        cells = rows * columns
        counted[i] = spare[i] + resting[i % (2 * cells)]
        unit = ti.static(scale(0)) if i // cells % 2 == 0 else ti.static(scale(1))
        ground[i] = ti.cast(counted[i], ti.f32) * unit


@ti.func
def spread(counts: ti.template(), i, columns, rows, time: ti.template()):
    """The sum of the cells around one, itself included, or itself if its layer is not blurred so often."""
    out = counts[i]
    x, y, layer = i % columns, i // columns % rows, i // (columns * rows) % 2
    if time < (ti.static(BLURS[0]) if layer == 0 else ti.static(BLURS[1])):
        out = 0
        for down in range(ti.max(y - 1, 0), ti.min(y + 2, rows)):
            for along in range(ti.max(x - 1, 0), ti.min(x + 2, columns)):
                out += counts[i + (down - y) * columns + along - x]
    return out


def scale(layer: int) -> float:
    """What one of the whole numbers counts that are summed up, blurred."""
    return 1.0 / (UNIT * 9.0 ** BLURS[layer])


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
