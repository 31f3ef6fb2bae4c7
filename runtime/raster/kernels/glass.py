"""Clear glass over a picture: tint, reflection that grows towards grazing, and outlines of small things.

A buffer of its own holds the nearest face of glass of each pixel, as the visibility buffer does; only what is
nearer than the opaque is laid over it.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from ..panes import HELD, OUTLINED, STREAKS
from . import crew
from .geometry import f1, f2, f3, i1, i2, item3, nearness, part3, row3, triangle, u32s, u64s, vec3
from .paint import INK, decode, encode

STEP = 0.015  # metres farther back: a rim before the glass behind it
i32s = ti.types.ndarray(ti.i32, ndim=1)


@ti.func
def thing_at(x, y, at, behind, width, height, vis: ti.template(), pane: ti.template(), group: ti.template()):
    """Number of the pane or thing of glass seen at a pixel, -1 where there is none; borders go on.

    at, behind: the pixel in ``pane`` and in ``vis``
    """
    out = -2
    if 0 <= x < width and 0 <= y < height:
        out = -1
        t = triangle(pane, at)
        if t >= 0 and nearness(pane, at) > nearness(vis, behind):
            out = group[t, 0]
    return out


@ti.func
def corner(f: ti.template(), t, k, still, offset, m, vertices: ti.template(), position: ti.template()):
    p = vec3(0)
    if t < still:
        p = row3(vertices, f[t, k])
    else:
        p = item3(position, m, f[t, k] - offset)
    return p


@ti.kernel
def lay(
    view: f2,
    moment: i1,
    vertices: f2,
    position: f3,
    faces: i2,
    group: i2,
    color: f2,
    still: ti.i32,
    offset: ti.i32,
    of: i1,
    box: i2,
    pane: u64s,
    vis: u64s,
    level: i32s,
    picture: u32s,
    marks: i32s,
    linear: f1,
    table: u32s,
    run: ti.i32,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    queue: i1,
    slots: ti.i32,
    host: ti.template(),
):
    """Lay the glass of views over their pictures where these are inked anew, and mark its outlines.

    faces [G, 3], the first ``still`` into ``vertices``, the others from ``offset`` on into ``position``
    of [views]: which of the pictures each is of; box [views, 4]: first column, column after the last, first
    row, row after the last in which there may be glass; marks: a bit a pixel, ``run`` pixels a number
    """
    for slot in range(slots):
        line = crew.task(slot, views * height, queue, host)
        if line < views * height:
            n, y = line // height, line % height
            if box[n, 2] <= y < box[n, 3]:
                seen = of[n] * height + y
                runs = (width + run - 1) // run
                last, along = -1, 0.0
                normal, own = vec3(0), vec3(0)
                dy = (view[n, 15] - ti.cast(y, ti.f32) - 0.5) / view[n, 13]
                right = part3(view, n, 3)
                row = part3(view, n, 6) * dy + part3(view, n, 9)
                for b in range(box[n, 0] // run, (box[n, 1] + run - 1) // run):
                    if level[seen * runs + b] >= INK:
                        for x in range(b * run, ti.min(width, b * run + run)):
                            at, under = line * width + x, seen * width + x
                            t = triangle(pane, at)
                            if t >= 0:
                                w = nearness(pane, at)
                                if w > nearness(vis, under):
                                    if t != last:
                                        last = t
                                        p0 = corner(faces, t, 0, still, offset, moment[n], vertices, position)
                                        p1 = corner(faces, t, 1, still, offset, moment[n], vertices, position)
                                        p2 = corner(faces, t, 2, still, offset, moment[n], vertices, position)
                                        normal = (p1 - p0).cross(p2 - p0).normalized(1e-12)
                                        own = row3(color, t)
                                    ray = (
                                        right * ((ti.cast(x, ti.f32) + 0.5 - view[n, 14]) / view[n, 12]) + row
                                    )
                                    grazing = 1.0 - ti.abs(normal.dot(ray)) / ray.norm()
                                    share = 0.12 + 0.55 * grazing * grazing * grazing
                                    shine = ti.min(own * 0.9 + 0.1, 1.0)
                                    if group[t, 1] & STREAKS:
                                        share += 0.16
                                        # bands of reflection fixed in the world
                                        p = part3(view, n, 0) + ray / w
                                        along = (p.x + p.y + p.z * 0.9) * 0.55
                                        along -= ti.floor(along)
                                        if along < 0.16 or 0.24 < along < 0.30:
                                            share += 0.25
                                            shine = shine * 0.4 + 0.6
                                    share = ti.min(share, 0.85)
                                    behind = decode(picture[under], linear)
                                    # what goes through is tinted, the more the deeper the colour of the glass
                                    deep = ti.max(own.max(), 1e-3)
                                    through = behind * (0.45 + 0.55 * own / deep)
                                    light = through * (1.0 - share) + shine * share
                                    if group[t, 1] & OUTLINED:
                                        ends = False
                                        for k in ti.static(range(4)):
                                            i, j = ti.static(((-1, 0), (1, 0), (0, -1), (0, 1))[k])
                                            by = i + j * width
                                            q = thing_at(
                                                x + i,
                                                y + j,
                                                at + by,
                                                under + by,
                                                width,
                                                height,
                                                vis,
                                                pane,
                                                group,
                                            )
                                            if q != -2:
                                                farther = w - nearness(pane, at + by) > STEP * w * w
                                                ends = ends or q != group[t, 0] or farther
                                        if ends:
                                            light *= 1.0 - (0.75 if group[t, 1] & HELD else 0.45)
                                            marks[seen * runs + b] = marks[seen * runs + b] | 1 << (
                                                x - b * run
                                            )
                                    picture[under] = encode(light, table)
