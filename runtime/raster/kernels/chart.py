"""Charts: where the set leaves its own large triangles in the key light, once per scene.

A triangle that is partly in shadow is divided along two of its edges into cells; each is LIT or DARK all
over, or MIXED. Between two places in cells of one kind, side by side, no shadow has to be looked up.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from .geometry import bounded, f1, f2, i1, i2, row3, u8s, vec3
from .light import across, lifted, lit
from .paint import SHEET

MIXED, LIT, DARK = 0, 1, 2  # how the set shades a place
SHADOW_SHIFT = 16  # of a whole triangle: it sits above the flags of a sheet
CELL = 0.1  # metres along an edge of a triangle, where that is fewer than MOST_CELLS
MOST_CELLS = 64  # along an edge
MOST_ALONG = 16  # cells that are looked at between two places
PLOT = 8  # numbers kept of each triangle: see :func:`plots`


def plots(vertices: NDArray[np.floating], faces: NDArray[np.int32]) -> tuple[NDArray, NDArray, NDArray]:
    """How triangles are divided into cells.

    Returns PLOT numbers of each, float32 [F * PLOT]: gradient of the place along the first edge 3 and its
    offset, the same along the second one, in cells; where its cells begin, int32 [F + 1]; and how many there
    are along an edge, int32 [F].
    """
    p = np.asarray(vertices, np.float64)[faces]
    q1, q2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    longest = np.sqrt(np.maximum((q1**2).sum(1), (q2**2).sum(1)))
    side = np.clip(np.ceil(longest / CELL), 1, MOST_CELLS).astype(np.int32)
    cross = np.cross(q1, q2)
    inverse = side / np.maximum((cross**2).sum(1), 1e-20)
    out = np.zeros((len(faces), PLOT), np.float32)
    for k, gradient in enumerate((np.cross(q2, cross), np.cross(cross, q1))):
        gradient = gradient * inverse[:, None]
        out[:, 4 * k : 4 * k + 3] = gradient
        out[:, 4 * k + 3] = -(gradient * p[:, 0]).sum(1)
    begin = np.zeros(len(faces) + 1, np.int32)
    np.cumsum(side.astype(np.int64) ** 2, out=begin[1:])
    return out.reshape(-1), begin, side


@ti.kernel
def survey(
    vertices: f2,
    normals: f2,
    faces: i2,
    light: f1,
    basis: f1,
    frame: f2,
    size: ti.i32,
    depth_map: f1,
    coarse: f1,
    sheet: f1,
    begin: i1,
    side: i1,
    count: ti.i32,
    chart: u8s,
):
    """The kind of each cell of the first ``count`` triangles, asked every three texels."""
    for t in range(count):
        front = ti.bit_cast(sheet[2 * t * SHEET + 11], ti.i32) >> SHADOW_SHIFT
        back = ti.bit_cast(sheet[(2 * t + 1) * SHEET + 11], ti.i32) >> SHADOW_SHIFT
        n = row3(normals, faces[t, 0])
        behind = n.dot(vec3(light[0], light[1], light[2])) < 0
        if side[t] > 1 and (back if behind else front) == MIXED:
            texel = 1.0 / frame[0, 2]
            if behind:
                n = -n
            off = lifted(across(basis, n), texel)
            p = row3(vertices, faces[t, 0])
            q1, q2 = row3(vertices, faces[t, 1]) - p, row3(vertices, faces[t, 2]) - p
            share = 1.0 / ti.cast(side[t], ti.f32)
            p, q1, q2 = across(basis, p) + off, across(basis, q1) * share, across(basis, q2) * share
            steps = ti.cast(ti.sqrt(ti.max(q1.norm_sqr(), q2.norm_sqr())) / (3.0 * texel), ti.i32) + 1
            for j in range(side[t]):
                for i in range(side[t] - j):
                    kind = 3
                    a = 0
                    while a <= steps:
                        b = 0
                        while b <= steps:
                            x = ti.cast(i, ti.f32) + ti.cast(a, ti.f32) / steps
                            y = ti.cast(j, ti.f32) + ti.cast(b, ti.f32) / steps
                            if x + y <= side[t] + 1e-3:
                                got = lit(p + q1 * x + q2 * y, 0, frame, size, depth_map, coarse)
                                here = LIT if got == 1.0 else (DARK if got == 0.0 else MIXED)
                                kind = here if kind == 3 else (kind if kind == here else MIXED)
                                if kind == MIXED:
                                    a, b = steps, steps
                            b += 1
                        a += 1
                    chart[begin[t] + j * side[t] + i] = ti.cast(kind & 3, ti.u8)


@ti.func
def cell_at(t, p, plot: ti.template(), side):
    """Along which cells of its triangle a place lies."""
    at = t * PLOT
    x = plot[at] * p.x + plot[at + 1] * p.y + plot[at + 2] * p.z + plot[at + 3]
    y = plot[at + 4] * p.x + plot[at + 5] * p.y + plot[at + 6] * p.z + plot[at + 7]
    most = ti.cast(side, ti.f32) - 1.0
    return ti.Vector([ti.cast(bounded(x, 0.0, most), ti.i32), ti.cast(bounded(y, 0.0, most), ti.i32)])


@ti.func
def kind_along(
    t, begin_at, end_at, cell, cell_end, plot: ti.template(), begin: ti.template(), side, chart: ti.template()
):
    """The kind of all cells of a triangle between two places in ``cell`` and ``cell_end``, as far as that can
    be said from a few of them; MIXED where they differ."""
    kind = ti.cast(chart[begin[t] + cell[1] * side + cell[0]], ti.i32)
    if kind != ti.cast(chart[begin[t] + cell_end[1] * side + cell_end[0]], ti.i32):
        kind = MIXED
    if kind != MIXED:
        away = ti.max(ti.abs(cell_end[0] - cell[0]), ti.abs(cell_end[1] - cell[1]))
        first = kind
        if away > MOST_ALONG:
            kind = MIXED
        for k in range(1, ti.min(away, MOST_ALONG)):
            part = ti.cast(k, ti.f32) / ti.cast(away, ti.f32)
            here = cell_at(t, begin_at + (end_at - begin_at) * part, plot, side)
            if ti.cast(chart[begin[t] + here[1] * side + here[0]], ti.i32) != first:
                kind = MIXED
    return kind
