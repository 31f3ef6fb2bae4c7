"""The light of a set's lamps: worked out once per scene, looked up at every place that is shaded.

A volume is a header (:func:`runtime.raster.lamps.header`) and six numbers of each cell: the light that
arrives from all sides, red, green and blue, and a vector of length 0..1 towards where it comes from.
"""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from ..lamps import HEADER, LAMP
from .ambient import area_near
from .geometry import bounded, f1, vec3

BLOCKED = 3.2  # how well a surface keeps lamplight off: exp(-BLOCKED) goes through
FIXTURE = 0.1  # metres around a lamp in which nothing keeps its light off


@ti.kernel
def shine(
    lamps: f1,
    count: ti.i32,
    grid: f1,
    nx: ti.i32,
    ny: ti.i32,
    nz: ti.i32,
    density: f1,
    volume: f1,
    cells: ti.i32,
):
    """Fill the cells of ``volume``. grid: low corner 3 and cells a metre of ``density``"""
    for c in range(cells):
        sy, sz = ti.cast(volume[5], ti.i32), ti.cast(volume[6], ti.i32)
        cell = 1.0 / volume[3]
        i, j, k = c // (sy * sz), c // sz % sy, c % sz
        p = vec3(volume[0], volume[1], volume[2]) + vec3(i, j, k) * cell
        corner = vec3(grid[0], grid[1], grid[2])
        step = 1.0 / grid[3]
        light = vec3(0)
        towards = vec3(0)
        for n in range(count):
            at = n * LAMP
            way = vec3(lamps[at], lamps[at + 1], lamps[at + 2]) - p
            away = way.norm() + 1e-6
            reach = lamps[at + 3]
            if away < reach:
                way *= 1.0 / away
                facing = vec3(lamps[at + 8], lamps[at + 9], lamps[at + 10])
                flat = facing.norm()
                ahead = ti.max(-facing.dot(way), 0.0) / ti.max(flat, 1e-6)
                share = 1.0 - flat + 3.0 * flat * ahead * ahead
                near = away / reach
                fade = 1.0 - near * near
                share *= fade * fade / (away * away + lamps[at + 7])
                # through what stands between, from a little off the place itself
                thick = 0.0
                begin = ti.min(step + 0.5 * cell, 0.5 * away)
                end = away - ti.min(ti.max(FIXTURE, 1.5 * step), 0.5 * away)
                steps = ti.cast((end - begin) / step, ti.i32) + 1
                gap = (end - begin) / steps
                s = 0
                while s < steps and thick < 2.5:
                    q = p + way * (begin + (s + 0.5) * gap)
                    thick += gap * area_near(q, corner, grid[3], nx, ny, nz, density)
                    s += 1
                share *= ti.exp(-BLOCKED * thick)
                color = vec3(lamps[at + 4], lamps[at + 5], lamps[at + 6]) * share
                light += color
                towards += way * (color.x + color.y + color.z)
        sum = light.x + light.y + light.z
        towards *= 1.0 / ti.max(sum, 1e-6)
        for a in ti.static(range(3)):
            volume[HEADER + 6 * c + a] = light[a]
            volume[HEADER + 6 * c + 3 + a] = towards[a]


@ti.func
def lamplight(p, n, volume: ti.template()):
    """Light of lamps that a surface with unit normal ``n`` gets at ``p``; 0 outside of what they reach."""
    out = vec3(0)
    if volume[3] > 0:
        q = p + n * volume[7]
        x = (q.x - volume[0]) * volume[3]
        y = (q.y - volume[1]) * volume[3]
        z = (q.z - volume[2]) * volume[3]
        if 0 <= x < volume[4] - 1 and 0 <= y < volume[5] - 1 and 0 <= z < volume[6] - 1:
            i, j, k = ti.cast(x, ti.i32), ti.cast(y, ti.i32), ti.cast(z, ti.i32)
            x -= i
            y -= j
            z -= k
            ny, nz = ti.cast(volume[5], ti.i32), ti.cast(volume[6], ti.i32)
            at = HEADER + ((i * ny + j) * nz + k) * 6
            right, ahead = ny * nz * 6, nz * 6
            got = ti.Vector([0.0] * 6)
            for a in ti.static(range(6)):
                b = at + a
                low = volume[b] + (volume[b + 6] - volume[b]) * z
                far = volume[b + ahead] + (volume[b + ahead + 6] - volume[b + ahead]) * z
                low += (far - low) * y
                b += right
                high = volume[b] + (volume[b + 6] - volume[b]) * z
                far = volume[b + ahead] + (volume[b + ahead + 6] - volume[b + ahead]) * z
                high += (far - high) * y
                got[a] = low + (high - low) * x
            turned = 0.34 + 0.66 * (n.x * got[3] + n.y * got[4] + n.z * got[5])
            out = vec3(got[0], got[1], got[2]) * bounded(turned, 0.04, 1.0)
    return out
