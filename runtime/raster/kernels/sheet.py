"""What is known of the triangles of a set before there is a camera, once per scene."""

# mypy: ignore-errors
# Taichi reads annotations as kernel types and parses the bodies itself.

from functools import lru_cache

import taichi as ti

from ..types import Style
from .ambient import toned
from .chart import DARK, LIT, MIXED, SHADOW_SHIFT
from .geometry import f1, f2, i2, row3, vec3
from .light import across, lifted, lit
from .paint import SHEET, pack_normal

MOST_STEPS = 200  # along a triangle, to find that out


@ti.func
def shadow_class(
    p,
    q1,
    q2,
    n,
    basis: ti.template(),
    frame: ti.template(),
    size,
    depth_map: ti.template(),
    coarse: ti.template(),
):
    """Whether the set leaves a triangle with corners p, p + q1, p + q2 and normal n in the key light,
    keeps it off all of it, or neither; looked up every few texels, MIXED where that were too many."""
    texel = 1.0 / frame[0, 2]
    steps = (
        ti.cast(ti.sqrt(ti.max(q1.norm_sqr(), q2.norm_sqr(), (q1 - q2).norm_sqr())) / (3.0 * texel), ti.i32)
        + 1
    )
    out = MIXED
    if steps < MOST_STEPS:
        off = lifted(across(basis, n), texel)
        p_l, q1_l, q2_l = across(basis, p) + off, across(basis, q1), across(basis, q2)
        least, most = 1.0, 0.0
        i = 0
        while i <= steps:
            j = 0
            while j <= steps - i:
                a, b = ti.cast(i, ti.f32) / steps, ti.cast(j, ti.f32) / steps
                light = lit(p_l + q1_l * a + q2_l * b, 0, frame, size, depth_map, coarse)
                least, most = ti.min(least, light), ti.max(most, light)
                j += 1
                if 0 < light < 1 or least < most:
                    i, j = steps, steps + 1
            i += 1
        if least == 1.0:
            out = LIT
        elif most == 0.0:
            out = DARK
    return out


@lru_cache(maxsize=8)
def fold_kernel(style: Style):
    """The kernel that fills the sheet of a set, for a style."""
    tones = style.tones
    shadows = style.shadows

    @ti.kernel
    def fold(
        vertices: f2,
        normals: f2,
        faces: i2,
        color: f2,
        info: i2,
        light: f1,
        basis: f1,
        set_frame: f2,
        set_size: ti.i32,
        set_depth: f1,
        set_coarse: f1,
        count: ti.i32,
        sheet: f1,
    ):
        """What shading needs of the first ``count`` triangles (the set), seen from the front and from behind.

        sheet, SHEET numbers a triangle and side: normal 3, light from the key, colour under the ambient
        light 3, mark of the edge buffer (bits), colour under the full key 3, material | flags | shadow <<
        SHADOW_SHIFT (bits), plane 4: unit normal, and its offset. shadow: how the set shades it, MIXED, LIT
        or DARK
        """
        for i in range(2 * count):
            t = i // 2
            p = row3(vertices, faces[t, 0])
            cross = (row3(vertices, faces[t, 1]) - p).cross(row3(vertices, faces[t, 2]) - p)
            plane = cross / ti.max(cross.norm(), 1e-20)
            n = row3(normals, faces[t, 0]) * (1.0 - 2.0 * (i % 2))
            base = row3(color, t)
            sky = vec3(light[6], light[7], light[8])
            under = vec3(light[9], light[10], light[11])
            ambient = base * (under + (sky - under) * (n.z * 0.5 + 0.5))
            direct = base * vec3(light[3], light[4], light[5])
            mark = (ti.cast(info[t, 0], ti.u32) << 16) | pack_normal(n)
            at = i * SHEET
            for a in ti.static(range(3)):
                sheet[at + a] = n[a]
                sheet[at + 4 + a] = ambient[a]
                sheet[at + 8 + a] = direct[a]
                sheet[at + 12 + a] = plane[a]
            facing = toned(n.dot(vec3(light[0], light[1], light[2])), tones)
            shadow = MIXED
            if ti.static(shadows):  # noqa: SIM102
                if facing > 0:
                    q1, q2 = row3(vertices, faces[t, 1]) - p, row3(vertices, faces[t, 2]) - p
                    shadow = shadow_class(p, q1, q2, n, basis, set_frame, set_size, set_depth, set_coarse)
            sheet[at + 3] = facing
            sheet[at + 7] = ti.bit_cast(mark, ti.f32)
            sheet[at + 11] = ti.bit_cast(info[t, 1] | (shadow << SHADOW_SHIFT), ti.f32)
            sheet[at + 15] = plane.dot(p)

    return fold
