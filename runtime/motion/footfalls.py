"""Footfalls of a way: when which foot leaves the floor and lands, in walking, running and skipping."""

from __future__ import annotations

Fall = tuple[int, float, float, float]


def paced(total: float, period: float, swing_share: float, limp: float) -> list[Fall]:
    """Footfalls (foot after foot, lift, land, next lift) that fill the time of a way."""
    active = total - 0.06
    count = max(2, round(active / period - swing_share) + 1)
    period = active / (count - 1 + swing_share)
    swing = swing_share * period
    falls = []
    for k in range(count):
        late = 0.28 * limp * period * (k % 2) * (k < count - 1)
        lift = 0.03 + k * period + late
        land = 0.03 + k * period + swing
        falls.append((k % 2, lift, land, 0.03 + (k + 2) * period))
    return falls


def skipped(total: float, period: float) -> list[Fall]:
    """Footfalls of skipping: each foot steps and hops once, then the other."""
    count = max(2, round((total - 0.1) / period))
    period = (total - 0.1) / count
    falls: list[Fall] = []
    lands = [0.05 + (k + 1) * period for k in range(count)]
    before: dict[int, float] = {0: 0.0, 1: 0.0}
    for k, land in enumerate(lands):
        foot, hop = (k // 2) % 2, k % 2 == 1
        lift = land - 0.55 * period if hop else max(before[foot], land - 2.2 * period)
        falls.append((foot, max(lift, 0.02), land, land + (0.45 if not hop else 0.6) * period))
        before[foot] = land + 0.35 * period
    last = {f for f, *_ in falls[-2:]}
    if len(last) == 1:  # the other foot closes up
        other = 1 - falls[-1][0]
        falls.append((other, max(before[other], total - 0.4), total - 0.02, total + 0.3))
    return falls
