"""Light by time of day: friendly, with a direction, never mud.

Indoors the key comes in from the side the windows are on, high enough to reach over the wall;
outdoors it is the sun over the street. Radiances are linear, backdrops sRGB.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from runtime.world import Light

from ..lang.definitions.set import SetDef

Colour = tuple[float, float, float]


@dataclass(frozen=True)
class _Hour:
    """elevation: of the key in degrees, outdoors and indoors; glass: what window panes show"""

    elevation: tuple[float, float]
    azimuth: float
    sun: Colour
    sky: Colour
    ground: Colour
    horizon: Colour
    zenith: Colour
    glass: Colour
    glass_share: float


_HOURS = {
    "dawn": _Hour((24, 46), 70, (1.28, 1.0, 0.8), (0.60, 0.61, 0.70), (0.40, 0.35, 0.34),
                  (0.985, 0.90, 0.83), (0.80, 0.86, 0.94), (1.0, 0.90, 0.80), 0.75),
    "day": _Hour((52, 54), 235, (1.22, 1.17, 1.06), (0.62, 0.67, 0.73), (0.42, 0.40, 0.37),
                 (0.93, 0.95, 0.955), (0.74, 0.85, 0.93), (0.90, 0.95, 0.97), 0.0),
    "dusk": _Hour((20, 42), 200, (1.36, 0.88, 0.60), (0.52, 0.50, 0.64), (0.38, 0.31, 0.32),
                  (0.985, 0.82, 0.68), (0.62, 0.64, 0.80), (0.99, 0.78, 0.58), 0.8),
    "night": _Hour((56, 62), 215, (0.62, 0.66, 0.86), (0.36, 0.41, 0.58), (0.22, 0.23, 0.31),
                   (0.40, 0.46, 0.60), (0.20, 0.25, 0.40), (0.24, 0.30, 0.46), 0.9),
}  # fmt: skip

#: Lamps are on indoors: the night inside is warm and bright, the one in the windows is blue.
_NIGHT_INSIDE = _Hour((56, 64), 215, (1.12, 0.93, 0.66), (0.56, 0.53, 0.55), (0.40, 0.35, 0.31),
                      (0.40, 0.43, 0.53), (0.26, 0.30, 0.42), (0.24, 0.30, 0.46), 0.9)  # fmt: skip


def _hour(time: str, outdoor: bool) -> _Hour:
    return _NIGHT_INSIDE if time == "night" and not outdoor else _HOURS.get(time, _HOURS["day"])


def make_light(definition: SetDef, time: str, room: tuple[str, ...] = ()) -> Light:
    """The light of a set, seen from one of its rooms (or all of it)."""
    hour = _hour(time, definition.outdoor)
    azimuth, elevation = math.radians(hour.azimuth), math.radians(hour.elevation[0])
    if not definition.outdoor:
        elevation = math.radians(hour.elevation[1])
        found = window_azimuth(definition, room)
        azimuth = azimuth if found is None else found
    sun = (
        math.cos(azimuth) * math.cos(elevation),
        math.sin(azimuth) * math.cos(elevation),
        math.sin(elevation),
    )
    backdrop = (hour.horizon, hour.zenith) if definition.outdoor else (_inside(hour), _inside(hour))
    return Light(sun, hour.sun, hour.sky, hour.ground, backdrop)


def _inside(hour: _Hour) -> Colour:
    """Behind a room there is no sky, but the paper the picture is drawn on, a little tinted."""
    paper = (0.93, 0.925, 0.91)
    h = hour.horizon
    return (0.65 * paper[0] + 0.35 * h[0], 0.65 * paper[1] + 0.35 * h[1], 0.65 * paper[2] + 0.35 * h[2])


def window_azimuth(definition: SetDef, room: tuple[str, ...]) -> float | None:
    """Heading towards the windows of a room, weighted by their area and turned off the axis a little, so
    that no wall is lit flat; None without windows."""
    x = y = 0.0
    for candidate in definition.rooms:
        if room and candidate.name != room[0]:
            continue
        for opening in candidate.openings:
            if opening.kind == "window":
                area = opening.width * opening.height
                dx, dy = {"north": (0, 1), "south": (0, -1), "east": (1, 0), "west": (-1, 0)}[opening.wall]
                x, y = x + dx * area, y + dy * area
    if math.hypot(x, y) < 1e-6:
        return None
    heading = math.atan2(y, x)
    quarter = math.pi / 2
    off = (heading / quarter) % 1.0  # how far from an axis of the room, in quarter turns
    return heading + math.radians(27) if min(off, 1 - off) < 0.15 else heading


def glass_tint(time: str, outdoor: bool) -> tuple[Colour, float]:
    """The colour window panes take at a time of day, and how much of it (0..1)."""
    hour = _hour(time, outdoor)
    return hour.glass, hour.glass_share
