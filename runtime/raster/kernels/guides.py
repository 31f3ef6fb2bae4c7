"""What a visibility buffer shows, cell by cell: who is where in the picture, and how near everything is."""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

import taichi as ti

from ..types import FAR, GUIDES, NEAREST, OTHERS, SUBJECT
from .geometry import f1, i1, i2, nearness, triangle, u8s, u64s

COUNT = len(GUIDES)
FACE = 2  # of ``head``: the front of one


@ti.kernel
def gather_guides(
    vis: u64s,
    info: i2,
    owner: i1,
    head: u8s,
    role: u8s,
    objects: ti.i32,
    views: ti.i32,
    width: ti.i32,
    height: ti.i32,
    cells: ti.i32,
    out: u8s,
):
    """Shares of the cells' pixels as 0..255, and their mean 1/z on a scale of logarithms from 1 to 255.

    role: of each of the ``objects`` in each view, one after the other; head: of each triangle
    """
    scale = 254.0 / ti.log(FAR / NEAREST)
    for k in range(views * cells * cells):
        n = k // (cells * cells)
        row = (k // cells) % cells
        column = k % cells
        top, bottom = row * height // cells, (row + 1) * height // cells
        left, right = column * width // cells, (column + 1) * width // cells
        subject, top_of_it, face, others, nothing = 0, 0, 0, 0, 0
        near = 0.0
        for y in range(top, bottom):
            for x in range(left, right):
                at = (n * height + y) * width + x
                t = triangle(vis, at)
                if t < 0:
                    nothing += 1
                else:
                    near += nearness(vis, at)
                    who = ti.cast(role[n * objects + owner[info[t, 0]]], ti.i32)
                    if who == SUBJECT:
                        subject += 1
                        part = ti.cast(head[t], ti.i32)
                        if part > 0:
                            top_of_it += 1
                        if part == FACE:
                            face += 1
                    elif who == OTHERS:
                        others += 1
        pixels = ti.max((bottom - top) * (right - left), 1)
        share = 255.0 / ti.cast(pixels, ti.f32)
        counts = ti.Vector([subject, top_of_it, face, others, nothing])
        for c in ti.static(range(5)):
            out[COUNT * k + c] = ti.cast(ti.cast(counts[c], ti.f32) * share + 0.5, ti.u8)
        far = ti.cast(pixels, ti.f32) / ti.max(near, 1e-9)
        code = 255.0 - scale * ti.log(ti.min(ti.max(far, NEAREST), FAR) / NEAREST)
        out[COUNT * k + 5] = ti.cast(code + 0.5, ti.u8) if near > 0 else ti.cast(0, ti.u8)


@ti.kernel
def probe(
    vis: u64s,
    info: i2,
    owner: i1,
    role: u8s,
    objects: ti.i32,
    pixels: i1,
    each: ti.i32,
    count: ti.i32,
    near: f1,
    seen: u8s,
):
    """1/z of what ``count`` pixels of all buffers show, ``each`` of every view, and the role of what that is;
    0 where nothing is, and where the pixel is less than 0."""
    for k in range(count):
        near[k] = 0.0
        seen[k] = ti.cast(0, ti.u8)
        at = pixels[k]
        if at >= 0:
            t = triangle(vis, at)
            if t >= 0:
                near[k] = nearness(vis, at)
                seen[k] = role[k // each * objects + owner[info[t, 0]]]
