"""Curves over time: eases, keys, envelopes, filters. All vectorised over frames."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def ease(u: Array) -> Array:
    """Minimum-jerk ease of 0..1 (Flash & Hogan 1985): 10u³ - 15u⁴ + 6u⁵, held outside."""
    u = np.clip(u, 0.0, 1.0)
    return u * u * u * (10.0 + u * (6.0 * u - 15.0))


def ramp(t: Array, start: float, end: float) -> Array:
    """Eases from 0 at ``start`` to 1 at ``end``."""
    return ease((t - start) / max(end - start, 1e-6))


def plateau(t: Array, start: float, arrive: float, leave: float, end: float) -> Array:
    """0, eases to 1 at ``arrive``, stays until ``leave``, eases back to 0 at ``end``."""
    return ramp(t, start, arrive) * (1.0 - ramp(t, leave, end))


def keyed(times: tuple[float, ...], values: tuple[float, ...], t: Array) -> Array:
    """Monotone cubic Hermite through keys (Fritsch & Carlson 1980): C1, no overshoot, rests at
    extremes and holds, passes through the keys between without stopping."""
    x, y = np.asarray(times, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if len(x) == 1:
        return np.full(t.shape, y[0])
    h = np.maximum(np.diff(x), 1e-9)
    d = np.diff(y) / h
    slope = np.zeros_like(y)
    if len(x) > 2:
        same = d[:-1] * d[1:] > 0
        w1, w2 = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
        safe = np.where(same, d[:-1] * d[1:], 1.0)
        slope[1:-1] = np.where(same, (w1 + w2) * safe / (w1 * d[1:] + w2 * d[:-1] + (~same)), 0.0)
    t = np.clip(t, x[0], x[-1])
    i = np.clip(np.searchsorted(x, t, side="right") - 1, 0, len(h) - 1)
    u = (t - x[i]) / h[i]
    u2, u3 = u * u, u * u * u
    return (
        (2 * u3 - 3 * u2 + 1) * y[i]
        + (u3 - 2 * u2 + u) * h[i] * slope[i]
        + (3 * u2 - 2 * u3) * y[i + 1]
        + (u3 - u2) * h[i] * slope[i + 1]
    )


def convolve(x: Array, kernel: Array, centre: int) -> Array:
    """Filters along axis 0; ends are held; ``centre`` is the kernel's sample at lag 0."""
    if x.ndim > 1:
        columns = x.reshape(len(x), -1).T
        return np.stack([convolve(c, kernel, centre) for c in columns], axis=1).reshape(x.shape)
    before, frames = len(kernel) - 1 - centre, len(x)
    padded = np.empty(frames + len(kernel) - 1)
    padded[:before], padded[before : before + frames], padded[before + frames :] = x[0], x, x[-1]
    out: Array = np.convolve(padded, kernel, mode="valid")
    return out


def smooth(x: Array, sigma: float) -> Array:
    """Gaussian along axis 0, ``sigma`` in frames."""
    if sigma < 0.3 or len(x) < 2:
        return x
    reach = int(np.ceil(3 * sigma))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    return convolve(x, kernel / kernel.sum(), reach)


def delayed(x: Array, frames: float) -> Array:
    """Later by ``frames`` (linear between samples), along axis 0."""
    at = np.clip(np.arange(len(x)) - frames, 0, len(x) - 1)
    low = np.floor(at).astype(np.int64)
    share = (at - low).reshape(-1, *([1] * (x.ndim - 1)))
    out: Array = x[low] * (1 - share) + x[np.minimum(low + 1, len(x) - 1)] * share
    return out


def below(limit: Array, reach: int) -> Array:
    """A smooth curve [T] nowhere above ``limit``: the minimum over a window, then a mean over it."""
    if reach < 1:
        return limit
    padded = np.concatenate([np.repeat(limit[:1], 2 * reach), limit, np.repeat(limit[-1:], 2 * reach)])
    low = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1).min(axis=-1)
    kernel = np.hanning(2 * reach + 3)[1:-1]
    out: Array = np.convolve(low, kernel / kernel.sum(), mode="valid")
    return out


def springy(x: Array, fps: float, rate: float, damping: float, anticipation: float = 0.0) -> Array:
    """Follow-through: a damped spring of ``rate`` Hz drawn along behind ``x``, minus its mean delay.

    Overshoots a little where ``damping`` < 1; with ``anticipation`` it draws back before it goes.
    """
    w = 2 * np.pi * rate
    wd = w * np.sqrt(max(1 - damping * damping, 1e-4))
    length = max(3, int(np.ceil(fps * 4.0 / (damping * w))))
    s = (np.arange(length) + 0.5) / fps
    kernel = np.exp(-damping * w * s) * np.sin(wd * s)
    kernel /= kernel.sum()
    lag = round(2 * damping / w * fps)
    if anticipation > 0:
        lead = max(2, round(0.22 * fps))
        early = np.hanning(lead + 2)[1:-1]
        full = np.concatenate([-anticipation * early / early.sum(), (1 + anticipation) * kernel])
        return convolve(x, full, lead + lag)
    return convolve(x, kernel, min(lag, length - 1))


def wander(t: Array, rng: np.random.Generator, period: float) -> Array:
    """Seeded smooth noise of about unit size: five sines around ``period`` seconds."""
    rates = (2 * np.pi / period) * (0.55 + 0.25 * np.arange(5) + 0.12 * rng.random(5))
    phases = rng.random(5) * 2 * np.pi
    weights = 1.0 / (1.0 + 0.5 * np.arange(5))
    waves = np.sin(t[:, None] * rates + phases) @ weights
    out: Array = waves / np.sqrt(0.5 * np.sum(weights**2))
    return out
