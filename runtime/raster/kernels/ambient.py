"""Tones of the key light, and how much of the ambient light and of the key reaches a place."""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from .contact import above_floor, floor_cell, standing_near
from .geometry import bounded


@ti.func
def soft_step(x, at, steepness):
    t = bounded((x - at) * steepness + 0.5, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


@ti.func
def area_near(p, low, inverse, nx, ny, nz, values: ti.template()):
    """Trilinear sample of the occlusion volume: the light kept off, 0 outside."""
    x, y, z = (p.x - low.x) * inverse, (p.y - low.y) * inverse, (p.z - low.z) * inverse
    out = 0.0
    if 0 <= x < nx - 1 and 0 <= y < ny - 1 and 0 <= z < nz - 1:
        i, j, k = ti.cast(x, ti.i32), ti.cast(y, ti.i32), ti.cast(z, ti.i32)
        x -= i
        y -= j
        z -= k
        at = (i * ny + j) * nz + k
        a = values[at] + (values[at + 1] - values[at]) * z
        b = values[at + nz] + (values[at + nz + 1] - values[at + nz]) * z
        at += ny * nz
        c = values[at] + (values[at + 1] - values[at]) * z
        d = values[at + nz] + (values[at + nz + 1] - values[at + nz]) * z
        a += (b - a) * y
        c += (d - c) * y
        out = a + (c - a) * x
    return out


@ti.func
def toned(x, tones: ti.template()):
    """Light 0..1 in soft steps; 0 of them: as it is."""
    out = ti.max(x, 0.0)
    if ti.static(tones == 2):
        out = soft_step(x, 0.22, 12.5)
    elif ti.static(tones >= 3):
        out = 0.0
        for k in ti.static(range(tones - 1)):
            out += soft_step(x, 0.10 + 0.42 * k / (tones - 2), ti.static(1.0 / (0.06 + 0.05 * k)))
        out *= ti.static(1.0 / (tones - 1))
    return out


@ti.func
def sheltered(
    where,
    nn,
    m,
    corner,
    inverse,
    nx,
    ny,
    nz,
    values: ti.template(),
    floor: ti.template(),
    tops: ti.template(),
    columns,
    rows,
    ground: ti.template(),
    deep: ti.template(),
):
    """Share of the ambient light that reaches a point of the set; deep: how much corners count."""
    out = 1.0 - deep * area_near(where + nn * 0.24, corner, inverse, nx, ny, nz, values)
    if nn.z > 0.7:
        layer = -1
        if above_floor(where.z, floor) < 0.2:
            layer = 2 * m
        else:
            cell = floor_cell(where, floor, columns, rows)
            if cell >= 0 and ti.abs(where.z - tops[cell]) < 0.06:
                layer = 2 * m + 1
        if layer >= 0:
            near = standing_near(where, layer, floor, columns, rows, ground)
            close = 1.0 - ti.exp(-(1.6 + 0.9 * ti.cast(layer & 1, ti.f32)) * near)
            out *= 1.0 - ti.static(min(0.5 * deep, 0.8)) * close
    return out
