"""The lens: depth of field, worked out on the inked picture before its stair-steps are smoothed.

The circle of confusion of a thin lens is linear in 1/z, which the visibility buffer holds. What lies behind
the plane of focus and what lies before it are two layers in linear light, each a pyramid of halved pictures;
a pixel is blurred on the level on which its circle is a few cells wide, so a wide blur costs no more than a
narrow one.

- Behind: a mean over the circle, of those cells alone that lie behind too and whose own circles reach it;
  so nothing sharp leaks into a blurred background, and nothing blurred runs over what stands before it.
- Before: every cell is spread over its own circle and lies over the rest by its share; what it stands before
  shows through its border, filled in from around it.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from .geometry import f1, f2, lesser, nearness, u32s, u64s, vec3
from .paint import decode, encode

LEVELS = 4  # halvings of the two layers
FILLS = 7  # halvings of what is filled in behind a blurred foreground
TILE = 16  # pixels; a cell of the coarsest level
CELL = 5  # numbers in a cell: red, green, blue times weight, weight, radius
SHARP, SOFT = 0.5, 1.6  # pixels: up to the one a radius counts as sharp, from the other on as blurred
MOST = 80.0  # pixels: widest radius
WHOLE = 0.9  # share of a foreground from which on it covers all
STEPS = 32  # steps a cell of the table of areas
SPAN = 16  # cells; no circle reaches farther
#: Numbers of a tile in the survey: how wide circles before the focus reach it on each level; how many tiles
#: away the nearest is that a blurred foreground reaches, and the nearest with a blurred background (0 to 3).
NEAR_BY, FAR_BY = LEVELS, LEVELS + 1
SURVEY = LEVELS + 2

#: Between these radii (pixels) a level hands over to the next coarser one.
HAND_OVER = ((4.0, 5.5), (9.0, 12.0), (20.0, 27.0), (1e6, 2e6))

vec4 = ti.types.vector(4, ti.f32)


@ti.func
def ramp(low, high, x):
    """0 below ``low``, 1 above ``high``, even in between."""
    return ti.min(ti.max((x - low) / (high - low), 0.0), 1.0)


@ti.func
def radius_at(lens: ti.template(), n, w):
    """Radius in pixels of the circle of confusion of what is at 1/z = w; negative behind the focus."""
    return ti.min(ti.max(lens[n, 0] * (lens[n, 1] * w - 1.0), -ti.static(MOST)), ti.static(MOST))


@ti.func
def cell4(a: ti.template(), at):
    return vec4(a[at], a[at + 1], a[at + 2], a[at + 3])


@ti.func
def put4(a: ti.template(), at, v):
    for k in ti.static(range(4)):
        a[at + k] = v[k]


@ti.func
def cells_of(radius, scale):
    """A circle's radius in cells ``scale`` pixels wide, less what halving and drawing between cells blur."""
    own = 0.55 if scale < 3.0 else 1.0
    return ti.max(ti.sqrt(ti.max((radius / scale) ** 2 - own, 0.0)), 0.5)


@ti.func
def chord(radius, dy):
    """How many cells to either side a circle covers, ``dy`` rows off its middle."""
    return ti.cast(ti.sqrt(ti.max((radius + 0.5) ** 2 - ti.cast(dy * dy, ti.f32), 0.0)), ti.i32)


@ti.func
def column(a: ti.template(), upper, lower, share, columns, x):
    """Four numbers of the first level between two rows of cells, at column ``x`` or the last there is."""
    at = ti.min(ti.max(x, 0), columns - 1) * 4
    above = cell4(a, upper + at)
    return above + (cell4(a, lower + at) - above) * share


@ti.func
def between(a: ti.template(), begin, stride, columns, rows, x, y):
    """A level at a point given in its cells, between the four cells around it."""
    fx = ti.min(ti.max(x - 0.5, 0.0), ti.cast(columns - 1, ti.f32))
    fy = ti.min(ti.max(y - 0.5, 0.0), ti.cast(rows - 1, ti.f32))
    x0, y0 = ti.cast(fx, ti.i32), ti.cast(fy, ti.i32)
    x1, y1 = ti.min(x0 + 1, columns - 1), ti.min(y0 + 1, rows - 1)
    tx, ty = fx - ti.cast(x0, ti.f32), fy - ti.cast(y0, ti.f32)
    upper, lower = begin + y0 * columns * stride, begin + y1 * columns * stride
    top = cell4(a, upper + x0 * stride) * (1.0 - tx) + cell4(a, upper + x1 * stride) * tx
    bottom = cell4(a, lower + x0 * stride) * (1.0 - tx) + cell4(a, lower + x1 * stride) * tx
    return top * (1.0 - ty) + bottom * ty


@ti.kernel
def split(
    n: ti.i32,
    lens: f2,
    vis: u64s,
    picture: u32s,
    linear: f1,
    far: f1,
    near: f1,
    tiles: f1,
    width: ti.i32,
    height: ti.i32,
):
    """The first level of both layers of view ``n``, and of each tile the widest radius behind, and the
    narrowest and the widest before."""
    across, down = (width + TILE - 1) // TILE, (height + TILE - 1) // TILE
    columns, rows = (width + 1) // 2, (height + 1) // 2
    for tile in range(across * down):
        x_from, y_from = tile % across * (TILE // 2), tile // across * (TILE // 2)
        widest_far, widest_near, narrowest = 0.0, 0.0, ti.static(MOST)
        for y in range(y_from, ti.min(y_from + TILE // 2, rows)):
            for x in range(x_from, ti.min(x_from + TILE // 2, columns)):
                behind, before = vec4(0), vec4(0)
                r_behind, r_before = 0.0, 0.0
                for j in ti.static(range(2)):
                    for i in ti.static(range(2)):
                        px, py = ti.min(2 * x + i, width - 1), ti.min(2 * y + j, height - 1)
                        at = (n * height + py) * width + px
                        r = radius_at(lens, n, nearness(vis, at))
                        share = ramp(SHARP, SOFT, ti.abs(r)) * 0.25
                        if share > 0.0:
                            c = decode(picture[at], linear) * share
                            if r < 0.0:
                                behind += vec4(c.x, c.y, c.z, share)
                                r_behind -= r * share
                                widest_far = ti.max(widest_far, -r)
                            else:
                                before += vec4(c.x, c.y, c.z, share)
                                r_before += r * share
                                widest_near = ti.max(widest_near, r)
                                narrowest = ti.min(narrowest, r)
                at = (y * columns + x) * CELL
                put4(far, at, behind)
                put4(near, at, before)
                far[at + 4] = r_behind / ti.max(behind.w, 1e-6)
                near[at + 4] = r_before / ti.max(before.w, 1e-6)
        tiles[3 * tile] = widest_far
        tiles[3 * tile + 1] = narrowest
        tiles[3 * tile + 2] = widest_near


@ti.kernel
def halve_far(
    far: f1, begin: ti.i32, columns: ti.i32, rows: ti.i32, to: ti.i32, columns_to: ti.i32, rows_to: ti.i32
):
    """The next level of the layer behind; begin, to: where the two levels start in the buffer."""
    for cell in range(columns_to * rows_to):
        total, radius = vec4(0), 0.0
        for j in ti.static(range(2)):
            for i in ti.static(range(2)):
                x = ti.min(2 * (cell % columns_to) + i, columns - 1)
                y = ti.min(2 * (cell // columns_to) + j, rows - 1)
                at = begin + (y * columns + x) * CELL
                v = cell4(far, at) * 0.25
                total += v
                radius += v.w * far[at + 4]
        at = to + cell * CELL
        put4(far, at, total)
        far[at + 4] = radius / ti.max(total.w, 1e-6)


@ti.kernel
def halve_near(
    near: f1,
    begin: ti.i32,
    columns: ti.i32,
    rows: ti.i32,
    to: ti.i32,
    columns_to: ti.i32,
    rows_to: ti.i32,
    low: ti.f32,
    high: ti.f32,
):
    """Hand on to the next level what is too wide for this one: each keeps its share."""
    for cell in range(columns_to * rows_to):
        total, radius, children = vec4(0), 0.0, 0.0
        for j in ti.static(range(2)):
            for i in ti.static(range(2)):
                x, y = 2 * (cell % columns_to) + i, 2 * (cell // columns_to) + j
                inside = x < columns and y < rows
                at = begin + (ti.min(y, rows - 1) * columns + ti.min(x, columns - 1)) * CELL
                v = cell4(near, at)
                passed = ramp(low, high, near[at + 4])
                if inside:
                    put4(near, at, v * (1.0 - passed))
                    total += v * passed
                    radius += passed * v.w * near[at + 4]
                    children += 1.0
        at = to + cell * CELL
        put4(near, at, total / children)
        near[at + 4] = radius / ti.max(total.w, 1e-6)


@ti.kernel
def reach_far(far: f1, begin: ti.i32, cells: ti.i32, level: ti.i32, reach: f1):
    """How far each cell of one level reaches, in cells, and the share that each cell it reaches gets."""
    scale = ti.cast(2 << level, ti.f32)
    for cell in range(cells):
        at = begin + cell * CELL
        if far[at + 3] > 0.0:
            r = cells_of(far[at + 4], scale)
            reach[2 * cell] = r
            reach[2 * cell + 1] = 1.0 / (r * r)


@ti.kernel
def reach_near(near: f1, begin: ti.i32, cells: ti.i32, level: ti.i32, high: ti.f32, area: f1, reach: f1):
    """As :func:`reach_far`, for the layer before.

    area: cells a circle covers, by its radius in STEPS a cell
    """
    scale = ti.cast(2 << level, ti.f32)
    for cell in range(cells):
        at = begin + cell * CELL
        if near[at + 3] > 0.0:
            r = cells_of(ti.min(near[at + 4], high), scale)
            reach[2 * cell] = r
            reach[2 * cell + 1] = 1.0 / area[ti.cast(r * STEPS + 0.5, ti.i32)]


@ti.kernel
def gather_far(
    far: f1,
    begin: ti.i32,
    columns: ti.i32,
    rows: ti.i32,
    level: ti.i32,
    low: ti.f32,
    high: ti.f32,
    reach: f1,
    away: f1,
    survey: f1,
    across: ti.i32,
    down: ti.i32,
    out: f1,
    to: ti.i32,
):
    """Means over circles on one level of the layer behind.

    low, high: radii that are looked for on this level; reach: :func:`reach_far`; away: distances of cells by
    whole steps across and down, SPAN a row; out: colour times weight, and weight; begins at ``to``
    """
    scale = ti.cast(2 << level, ti.f32)
    widest = high / scale
    side = (TILE // 2) >> level
    for tile in range(across * down):
        if survey[tile * SURVEY + FAR_BY] < 2.5:
            x_from, y_from = tile % across * side, tile // across * side
            for y in range(y_from, ti.min(y_from + side, rows)):
                for x in range(x_from, ti.min(x_from + side, columns)):
                    cell = y * columns + x
                    at = begin + cell * CELL
                    own = far[at + 3] > 0.0
                    radius = widest
                    span = 2  # beside the layer: it goes on a little, for what is drawn between cells
                    wanted = True
                    if own:
                        wanted = low <= far[at + 4] < high
                        radius = ti.min(cells_of(far[at + 4], scale), widest)
                        span = ti.cast(radius + 0.5, ti.i32)
                    else:
                        found = 0.0
                        for dy in range(ti.max(-1, -y), ti.min(1, rows - 1 - y) + 1):
                            for dx in range(ti.max(-1, -x), ti.min(1, columns - 1 - x) + 1):
                                found += far[at + (dy * columns + dx) * CELL + 3]
                        wanted = found > 0.0
                    total = vec4(0)
                    if wanted:
                        least = 1.0 / (radius * radius)
                        for dy in range(ti.max(-span, -y), ti.min(span, rows - 1 - y) + 1):
                            half = chord(ti.min(radius, 2.0) if not own else radius, dy)
                            line = ti.abs(dy) * SPAN
                            for dx in range(ti.max(-half, -x), ti.min(half, columns - 1 - x) + 1):
                                to_cell = cell + dy * columns + dx
                                tap = begin + to_cell * CELL
                                if far[tap + 3] > 0.0:
                                    r, share = reach[2 * to_cell], reach[2 * to_cell + 1]
                                    if r > radius:
                                        r, share = radius, least
                                    covered = lesser(r - away[line + ti.abs(dx)] + 0.5, 1.0)
                                    if covered > 0.0:
                                        total += cell4(far, tap) * (covered * share)
                    if total.w > 0.0:
                        total *= (1.0 if own else 0.01) / total.w
                    elif own and far[at + 4] >= high:
                        total.w = 1.0  # the next level will say it
                    put4(out, to + cell * 4, total)


@ti.kernel
def join_far(
    far: f1,
    begin: ti.i32,
    columns: ti.i32,
    rows: ti.i32,
    level: ti.i32,
    survey: f1,
    across: ti.i32,
    down: ti.i32,
    out: f1,
    at_level: ti.i32,
    above: ti.i32,
    columns_above: ti.i32,
    rows_above: ti.i32,
    low: ti.f32,
    high: ti.f32,
):
    """Where circles are too wide for a level, take the next coarser one instead, in place."""
    side = (TILE // 2) >> level
    for tile in range(across * down):
        if survey[tile * SURVEY + FAR_BY] < 1.5:
            x_from, y_from = tile % across * side, tile // across * side
            for y in range(y_from, ti.min(y_from + side, rows)):
                for x in range(x_from, ti.min(x_from + side, columns)):
                    cell = y * columns + x
                    share = ramp(low, high, far[begin + cell * CELL + 4])
                    if far[begin + cell * CELL + 3] <= 0.0:
                        share = 0.5
                    if share > 0.0:
                        fx, fy = 0.5 * ti.cast(x, ti.f32) + 0.25, 0.5 * ti.cast(y, ti.f32) + 0.25
                        wide = between(out, above, 4, columns_above, rows_above, fx, fy)
                        if wide.w > 0.0:
                            own = cell4(out, at_level + cell * 4)
                            if own.w <= 0.0:
                                share = 1.0
                            # both weigh as much as the finer one says: it knows the border
                            weight = ti.max(own.w, ti.min(wide.w, 0.01))
                            wide *= weight / wide.w
                            put4(out, at_level + cell * 4, own + (wide - own) * share)


@ti.kernel
def put_far(
    n: ti.i32,
    lens: f2,
    vis: u64s,
    picture: u32s,
    linear: f1,
    table: u32s,
    out: f1,
    tiles: f1,
    width: ti.i32,
    height: ti.i32,
):
    """Lay the blurred background into the picture of view ``n``."""
    across, down = (width + TILE - 1) // TILE, (height + TILE - 1) // TILE
    columns, rows = (width + 1) // 2, (height + 1) // 2
    for tile in range(across * down):
        if tiles[3 * tile] > SHARP:
            x_from, y_from = tile % across * TILE, tile // across * TILE
            for y in range(y_from, ti.min(y_from + TILE, height)):
                # the rows of cells above and below the pixels' middles, and how far down between them
                upper = ti.max((y - 1) // 2, 0) * columns * 4
                lower = ti.min((y + 1) // 2, rows - 1) * columns * 4
                down_by = 0.25 if y & 1 else 0.75
                left = column(out, upper, lower, down_by, columns, x_from // 2 - 1)
                here = column(out, upper, lower, down_by, columns, x_from // 2)
                for x in range(x_from // 2, ti.min(x_from // 2 + TILE // 2, columns)):
                    right = column(out, upper, lower, down_by, columns, x + 1)
                    for i in ti.static(range(2)):
                        at = (n * height + y) * width + 2 * x + i
                        if 2 * x + i < width:
                            share = ramp(SHARP, SOFT, -radius_at(lens, n, nearness(vis, at)))
                            v = here * 0.75 + (left if ti.static(i == 0) else right) * 0.25
                            if share > 0.0 and v.w > 0.0:
                                c = vec3(v.x, v.y, v.z) * (1.0 / v.w)
                                if share < 1.0:
                                    own = decode(picture[at], linear)
                                    c = own + (c - own) * share
                                picture[at] = encode(c, table)
                    left = here
                    here = right


@ti.kernel
def look_round(tiles: f1, survey: f1, across: ti.i32, down: ti.i32) -> ti.f32:
    """Of each tile the widest circles before the focus that reach it, on each level, and whether any does;
    and how far it is to a blurred background. Returns the widest circle before the focus.
    """
    most = 0.0
    for tile in range(across * down):
        ti.atomic_max(most, tiles[3 * tile + 2])
        x, y = tile % across, tile // across
        span = ti.cast(MOST / TILE, ti.i32) + 1
        found = ti.Vector([0.0] * LEVELS)
        far_by, near_by = 3.0, 3.0
        for j in range(ti.max(-span, -y), ti.min(span, down - 1 - y) + 1):
            for i in range(ti.max(-span, -x), ti.min(span, across - 1 - x) + 1):
                at = 3 * (tile + j * across + i)
                low, high = tiles[at + 1], tiles[at + 2]
                steps = ti.cast(ti.max(ti.abs(i), ti.abs(j)), ti.f32)
                away = (steps - 1.0) * TILE - 2.0
                if tiles[at] > SHARP:
                    far_by = ti.min(far_by, steps)
                if high > SHARP:
                    near_by = ti.min(near_by, ti.max(ti.ceil((away - high) / TILE), 0.0))
                    for k in ti.static(range(LEVELS)):
                        least = 0.0 if ti.static(k == 0) else HAND_OVER[k - 1][0]
                        widest = ti.min(high, HAND_OVER[k][1])
                        if high > least and low < HAND_OVER[k][1] and away < widest:
                            found[k] = ti.max(found[k], widest)
        for k in ti.static(range(LEVELS)):
            survey[tile * SURVEY + k] = found[k]
        survey[tile * SURVEY + NEAR_BY] = near_by
        survey[tile * SURVEY + FAR_BY] = far_by
    return most


@ti.kernel
def gather_near(
    near: f1,
    begin: ti.i32,
    columns: ti.i32,
    rows: ti.i32,
    level: ti.i32,
    high: ti.f32,
    reach: f1,
    away: f1,
    survey: f1,
    across: ti.i32,
    down: ti.i32,
    out: f1,
    to: ti.i32,
):
    """Every cell of one level of the layer before spread over its circle.

    high: widest radius on this level; reach: :func:`reach_near`; away: as in :func:`gather_far`
    """
    scale = ti.cast(2 << level, ti.f32)
    side = (TILE // 2) >> level
    for tile in range(across * down):
        if survey[tile * SURVEY + NEAR_BY] < 2.5:
            x_from, y_from = tile % across * side, tile // across * side
            widest = survey[tile * SURVEY + level]
            span = ti.cast(ti.min(widest, high) / scale + 0.999, ti.i32)
            for y in range(y_from, ti.min(y_from + side, rows)):
                for x in range(x_from, ti.min(x_from + side, columns)):
                    total = vec4(0)
                    if widest > 0.0:
                        for dy in range(-span, span + 1):
                            row = ti.min(ti.max(y + dy, 0), rows - 1) * columns
                            half = chord(ti.min(widest, high) / scale, dy)
                            line = ti.abs(dy) * SPAN
                            for dx in range(-half, half + 1):
                                cell = row + ti.min(ti.max(x + dx, 0), columns - 1)
                                tap = begin + cell * CELL
                                if near[tap + 3] > 0.0:
                                    distance = away[line + ti.abs(dx)]
                                    covered = lesser(reach[2 * cell] - distance + 0.5, 1.0)
                                    if covered > 0.0:
                                        total += cell4(near, tap) * (covered * reach[2 * cell + 1])
                    put4(out, to + (y * columns + x) * 4, total)


@ti.kernel
def join_near(
    columns: ti.i32,
    rows: ti.i32,
    level: ti.i32,
    survey: f1,
    across: ti.i32,
    down: ti.i32,
    out: f1,
    at_level: ti.i32,
    above: ti.i32,
    columns_above: ti.i32,
    rows_above: ti.i32,
):
    """Add the next coarser level to a level, in place."""
    side = (TILE // 2) >> level
    for tile in range(across * down):
        if survey[tile * SURVEY + NEAR_BY] < 1.5:
            x_from, y_from = tile % across * side, tile // across * side
            for y in range(y_from, ti.min(y_from + side, rows)):
                for x in range(x_from, ti.min(x_from + side, columns)):
                    at = at_level + (y * columns + x) * 4
                    fx, fy = 0.5 * ti.cast(x, ti.f32) + 0.25, 0.5 * ti.cast(y, ti.f32) + 0.25
                    wide = between(out, above, 4, columns_above, rows_above, fx, fy)
                    put4(out, at, cell4(out, at) + wide)


@ti.kernel
def open_fill(
    n: ti.i32,
    lens: f2,
    vis: u64s,
    picture: u32s,
    linear: f1,
    survey: f1,
    fill: f1,
    width: ti.i32,
    height: ti.i32,
):
    """The first level of what is not before the focus, where a blurred foreground reaches."""
    across = (width + TILE - 1) // TILE
    columns, rows = (width + 1) // 2, (height + 1) // 2
    for cell in range(columns * rows):
        x, y = cell % columns, cell // columns
        total = vec4(0)
        if survey[(2 * y // TILE * across + 2 * x // TILE) * SURVEY + NEAR_BY] < 2.5:
            for j in ti.static(range(2)):
                for i in ti.static(range(2)):
                    at = (n * height + ti.min(2 * y + j, height - 1)) * width + ti.min(2 * x + i, width - 1)
                    share = 0.25 * (1.0 - ramp(SHARP, SOFT, radius_at(lens, n, nearness(vis, at))))
                    if share > 0.0:
                        c = decode(picture[at], linear) * share
                        total += vec4(c.x, c.y, c.z, share)
        put4(fill, cell * 4, total)


@ti.kernel
def halve_fill(
    fill: f1, begin: ti.i32, columns: ti.i32, rows: ti.i32, to: ti.i32, columns_to: ti.i32, rows_to: ti.i32
):
    for cell in range(columns_to * rows_to):
        total = vec4(0)
        for j in ti.static(range(2)):
            for i in ti.static(range(2)):
                x = ti.min(2 * (cell % columns_to) + i, columns - 1)
                y = ti.min(2 * (cell // columns_to) + j, rows - 1)
                total += cell4(fill, begin + (y * columns + x) * 4)
        total *= 0.25
        put4(fill, to + cell * 4, total)


@ti.kernel
def close_fill(
    fill: f1,
    begin: ti.i32,
    columns: ti.i32,
    rows: ti.i32,
    level: ti.i32,
    tiles: f1,
    survey: f1,
    across: ti.i32,
    above: ti.i32,
    columns_above: ti.i32,
    rows_above: ti.i32,
):
    """Fill the holes of a level from the next coarser one, in place; weights become 1, or 0 with nothing.

    The first level has none where nothing is before the focus.
    """
    side = (TILE // 2) >> level  # cells of a tile; 0 where cells are larger than tiles
    for cell in range(columns * rows):
        x, y = cell % columns, cell // columns
        wanted = True
        if side > 0:
            tile = y // side * across + x // side
            wanted = survey[tile * SURVEY + NEAR_BY] < 1.5 and (level > 0 or tiles[3 * tile + 2] > SHARP)
        if wanted:
            at = begin + cell * 4
            v = cell4(fill, at)
            own = ti.min(4.0 * v.w, 1.0)  # a little of what is near counts more than much of what is not
            if v.w > 0.0:
                v *= own / v.w
            if own < 1.0:
                fx, fy = 0.5 * ti.cast(x, ti.f32) + 0.25, 0.5 * ti.cast(y, ti.f32) + 0.25
                wide = between(fill, above, 4, columns_above, rows_above, fx, fy)
                if wide.w > 0.0:
                    v += wide * ((1.0 - own) / wide.w)
                elif own > 0.0:
                    v /= own
            put4(fill, at, v)


@ti.kernel
def put_near(
    n: ti.i32,
    lens: f2,
    vis: u64s,
    picture: u32s,
    linear: f1,
    table: u32s,
    out: f1,
    fill: f1,
    survey: f1,
    width: ti.i32,
    height: ti.i32,
):
    """Lay the blurred foreground over the picture of view ``n``."""
    across, down = (width + TILE - 1) // TILE, (height + TILE - 1) // TILE
    columns, rows = (width + 1) // 2, (height + 1) // 2
    for tile in range(across * down):
        if survey[tile * SURVEY + NEAR_BY] < 0.5:
            x_from, y_from = tile % across * TILE, tile // across * TILE
            for y in range(y_from, ti.min(y_from + TILE, height)):
                upper = ti.max((y - 1) // 2, 0) * columns * 4
                lower = ti.min((y + 1) // 2, rows - 1) * columns * 4
                down_by = 0.25 if y & 1 else 0.75
                left = column(out, upper, lower, down_by, columns, x_from // 2 - 1)
                here = column(out, upper, lower, down_by, columns, x_from // 2)
                for x in range(x_from // 2, ti.min(x_from // 2 + TILE // 2, columns)):
                    right = column(out, upper, lower, down_by, columns, x + 1)
                    for i in ti.static(range(2)):
                        at = (n * height + y) * width + 2 * x + i
                        v = here * 0.75 + (left if ti.static(i == 0) else right) * 0.25
                        if 2 * x + i < width and v.w > 0.002:
                            over = vec3(v.x, v.y, v.z) * (1.0 / v.w)
                            # circles of different widths leave slight gaps within a surface
                            alpha = ti.min(v.w / ti.static(WHOLE), 1.0)
                            if alpha < 0.999:
                                c = decode(picture[at], linear)
                                share = ramp(SHARP, SOFT, radius_at(lens, n, nearness(vis, at)))
                                if share > 0.0:
                                    fx, fy = (
                                        0.5 * ti.cast(2 * x + i, ti.f32) + 0.25,
                                        0.5 * ti.cast(y, ti.f32) + 0.25,
                                    )
                                    behind = between(fill, 0, 4, columns, rows, fx, fy)
                                    ground = over
                                    if behind.w > 0.0:
                                        ground = vec3(behind.x, behind.y, behind.z) / behind.w
                                    c += (ground - c) * share
                                over = c + (over - c) * alpha
                            picture[at] = encode(over, table)
                    left = here
                    here = right
