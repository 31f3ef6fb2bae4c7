"""Implicit surfaces: signed distances (about; negative inside) of simple solids and how they join.

A :data:`Field` maps points float64 [N, 3] to float64 [N]. Distances are true near the surface to within
a factor that the polygoniser allows for; gradients are smooth where the solids are joined smoothly.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Points = NDArray[np.float64]
Values = NDArray[np.float64]
Field = Callable[[Points], Values]

_SAMPLES = 96


def ellipsoid(centre: ArrayLike, radii: ArrayLike, axes: ArrayLike | None = None) -> Field:
    """An ellipsoid; ``axes`` [3, 3] has its unit axes as rows (the world's where None)."""
    c, r = np.asarray(centre, float), np.broadcast_to(np.asarray(radii, float), (3,))
    frame = None if axes is None else np.asarray(axes, float)
    middle = c if frame is None else frame @ c

    def field(p: Points) -> Values:
        inside, steep = np.full(len(p), 1e-18), np.full(len(p), 1e-18)
        for k in range(3):
            d = (p[:, k] if frame is None else p @ frame[k]) - middle[k]
            q = d * (1.0 / r[k])
            q *= q
            inside += q
            q *= 1.0 / r[k] ** 2
            steep += q
        length = np.sqrt(inside)
        return np.asarray(length * (length - 1.0) / np.sqrt(steep))

    return field


def round_cone(a: ArrayLike, b: ArrayLike, ra: float, rb: float, flat: ArrayLike | None = None) -> Field:
    """The solid between spheres of radii ``ra`` at ``a`` and ``rb`` at ``b``.

    ``flat``: a vector (direction and factor as its length) along which space is stretched first, which
    flattens the cross-section.
    """
    pa, pb = np.asarray(a, float), np.asarray(b, float)
    stretch = np.zeros(3) if flat is None else np.asarray(flat, float)
    factor = float(np.linalg.norm(stretch))
    unit = stretch / factor if factor else stretch
    axis = pb - pa
    if factor:
        axis = axis + float(axis @ unit) * (factor - 1.0) * unit
    length2 = float(axis @ axis)
    slope = (rb - ra) / np.sqrt(length2)
    scale = 1.0 / (np.sqrt(1.0 + slope * slope) * max(factor, 1.0))

    def field(p: Points) -> Values:
        d = [p[:, k] - pa[k] for k in range(3)]
        if factor:
            wider = sum(d[k] * unit[k] for k in range(3)) * (factor - 1.0)
            d = [d[k] + wider * unit[k] for k in range(3)]
        t = sum(d[k] * (axis[k] / length2) for k in range(3))
        t = np.clip(t, 0.0, 1.0)
        away = sum((d[k] - t * axis[k]) ** 2 for k in range(3))
        return np.asarray((np.sqrt(away) - (ra + (rb - ra) * t)) * scale)

    return field


def monotone(x: ArrayLike, y: ArrayLike) -> Callable[[Values], NDArray[np.float64]]:
    """A smooth curve through points that rises and falls only where they do (Fritsch and Carlson's).

    x: [K], rising; y: [K] or [K, C]. What is asked for outside of x gets the end's value.
    """
    x, y = np.asarray(x, float), np.asarray(y, float)
    columns = y.reshape(len(x), -1)
    step = np.diff(x)[:, None]
    rise = np.diff(columns, axis=0) / step
    slope = np.repeat(rise[:1], len(x), axis=0)
    if len(x) > 2:
        before, after = step[:-1] + 2 * step[1:], 2 * step[:-1] + step[1:]
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = (before + after) / (before / rise[:-1] + after / rise[1:])
        slope[1:-1] = np.where(rise[:-1] * rise[1:] > 0, mean, 0.0)
        slope[0] = _end_slope(step[0], step[1], rise[0], rise[1])
        slope[-1] = _end_slope(step[-1], step[-2], rise[-1], rise[-2])

    def curve(at: Values) -> NDArray[np.float64]:
        at = np.clip(np.asarray(at, float), x[0], x[-1])
        k = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(x) - 2)
        t = ((at - x[k]) / step[k, 0])[:, None]
        low = columns[k] + t * t * (3 - 2 * t) * (columns[k + 1] - columns[k])
        bent = t * (1 - t) * step[k] * ((1 - t) * slope[k] - t * slope[k + 1])
        return np.asarray((low + bent).reshape(at.shape + y.shape[1:]))

    return curve


def _end_slope(near: Values, next_: Values, rise: Values, further: Values) -> Values:
    """Slope at an end of a monotone curve, by the parabola through the last three points where that fits."""
    slope = ((2 * near + next_) * rise - near * further) / (near + next_)
    slope = np.where(slope * rise <= 0, 0.0, slope)
    return np.where((rise * further <= 0) & (np.abs(slope) > 3 * np.abs(rise)), 3 * rise, slope)


@dataclass(frozen=True)
class Knot:
    """A cross-section of a loft.

    at: distance along the axis; front, back: half extents along +v and -v; side: half extent along ±w
    v, w: where its middle lies off the axis; outer: half extent along +w where it differs from ``side``
    """

    at: float
    front: float
    back: float
    side: float
    v: float = 0.0
    w: float = 0.0
    outer: float | None = None


def loft(
    origin: ArrayLike, frame: ArrayLike, knots: Sequence[Knot], power: float = 2.0, grow: float = 0.0
) -> Field:
    """A solid of cross-sections along an axis, monotone cubic in between.

    frame: rows u (along the axis), v and w, orthonormal; power: 2 for ellipses, more for squarer ones;
    grow: thickness added all round. The ends are flat.
    """
    axes = np.asarray(frame, float)
    start = axes @ np.asarray(origin, float)
    at = np.array([k.at for k in knots])
    columns = np.array(
        [[k.front, k.back, k.side, k.side if k.outer is None else k.outer, k.v, k.w] for k in knots], float
    )
    columns[:, :4] += grow
    grid = np.linspace(at[0], at[-1], _SAMPLES)
    table = monotone(at, columns)(grid)
    table[:, :4] = np.maximum(table[:, :4], 1e-4)
    scale = (_SAMPLES - 1) / (at[-1] - at[0])
    slope = np.abs(np.gradient(table[:, :4], grid, axis=0)).mean(1)
    tilt = 1.0 / np.sqrt(1.0 + np.minimum(slope, 2.0) ** 2)
    rows = np.ascontiguousarray(np.column_stack([table, table[:, :4].min(1), tilt]).T)
    steps = np.diff(rows[:6], axis=1, append=rows[:6, -1:])

    def field(p: Points) -> Values:
        u = p @ axes[0] - start[0]
        x = np.clip((u - at[0]) * scale, 0.0, _SAMPLES - 1.001)
        i = x.astype(np.intp)
        x -= i

        def row(k: int) -> Values:
            return rows[k].take(i) + steps[k].take(i) * x

        dv, dw = p @ axes[1] - start[1] - row(4), p @ axes[2] - start[2] - row(5)
        qv = np.abs(dv) / np.where(dv > 0, row(0), row(1))
        qw = np.abs(dw) / np.where(dw > 0, row(3), row(2))
        q = np.sqrt(qv * qv + qw * qw) if power == 2.0 else (qv**power + qw**power) ** (1.0 / power)
        q += 1e-6
        mean = np.where(q > 1e-3, np.sqrt(dv * dv + dw * dw) / q, rows[6].take(i))
        radial = (q - 1.0) * mean * rows[7].take(i)
        end = np.maximum(at[0] - u, u - at[-1])
        out = np.minimum(np.maximum(radial, end), 0.0)
        radial, end = np.maximum(radial, 0.0), np.maximum(end, 0.0)
        return np.asarray(out + np.sqrt(radial * radial + end * end))

    return field


def smooth_min(a: Values, b: Values, k: float) -> Values:
    """The polynomial smooth minimum: joins two solids with a fillet of about ``k`` metres."""
    if k <= 0.0:
        return np.minimum(a, b)
    h = np.maximum(k - np.abs(a - b), 0.0)
    return np.asarray(np.minimum(a, b) - h * h * h * (1.0 / (6.0 * k * k)))


def union(parts: Sequence[tuple[Field, float]]) -> Field:
    """Solids joined in order, each with its own fillet in metres."""

    def field(p: Points) -> Values:
        total = parts[0][0](p)
        for part, k in parts[1:]:
            total = smooth_min(total, part(p), k)
        return total

    return field


def carve(solid: Field, tool: Field, k: float) -> Field:
    """``solid`` without ``tool``, the edge rounded by ``k`` metres."""
    return lambda p: -smooth_min(-solid(p), tool(p), k)


def within(solid: Field, centre: ArrayLike, radius: float) -> Field:
    """The solid, which lies in a ball; outside that its distance is not asked for but bounded from below.

    Leave at least the fillet with which it is joined between its surface and the ball's.
    """
    c = np.asarray(centre, float)

    def field(p: Points) -> Values:
        out = sum((p[:, k] - c[k]) ** 2 for k in range(3))
        out = np.sqrt(out)
        near = np.flatnonzero(out < radius)
        out -= 0.5 * radius
        if len(near):
            out[near] = solid(p[near])
        return np.asarray(out)

    return field


def offset(solid: Field, by: float) -> Field:
    """The solid grown by ``by`` metres."""
    return lambda p: solid(p) - by


def mirrored(solid: Field) -> Field:
    """The solid of the left half on both sides of Y = 0."""

    def field(p: Points) -> Values:
        q = p.copy()
        q[:, 1] = np.abs(q[:, 1])
        return solid(q)

    return field


def gradient(field: Field, points: Points, step: float = 1.5e-3) -> Points:
    """Central differences of a field, [N, 3], not normalised."""
    ways = step * np.concatenate([np.eye(3), -np.eye(3)])
    ahead, behind = field((points + ways[:, None]).reshape(-1, 3)).reshape(2, 3, -1)
    return np.ascontiguousarray((ahead - behind).T) / (2.0 * step)
