"""Light by time of day: friendly, with a direction, never mud.

Indoors the key comes in from the side the windows are on, high enough to reach over the wall;
outdoors it is the sun over the street. A set whose `light` is that of lamps looks the same at any
hour, only lower at night. Radiances are linear, backdrops sRGB.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from runtime.materials import MATERIALS, NIGHT_GLASS
from runtime.world import Light

from ..lang.definitions.set import SetDef

Colour = tuple[float, float, float]


@dataclass(frozen=True)
class _Hour:
    """elevation, azimuth: of the key, degrees; backdrop: horizon and zenith
    glass, glass_share: what window panes show, and how much of it
    lamps: how far what glows is turned up; by day, and in the open, it does not show
    windows: how much the sun lightens what it falls on through a window
    """

    elevation: float
    azimuth: float
    sun: Colour
    sky: Colour
    ground: Colour
    backdrop: tuple[Colour, Colour]
    glass: Colour
    glass_share: float
    lamps: float = 0.0
    windows: float = 0.0


_OUTDOORS = {
    "dawn": _Hour(20, 70, (1.36, 1.06, 0.70), (0.58, 0.69, 0.88), (0.48, 0.48, 0.52),
                  ((0.985, 0.915, 0.80), (0.64, 0.79, 0.91)), (1.0, 0.90, 0.80), 0.75, 0.35),
    "day": _Hour(50, 240, (1.20, 1.13, 0.99), (0.68, 0.76, 0.86), (0.56, 0.54, 0.50),
                 ((0.90, 0.945, 0.965), (0.60, 0.79, 0.93)), (0.90, 0.95, 0.97), 0.0),
    "dusk": _Hour(20, 205, (1.50, 0.98, 0.54), (0.50, 0.60, 0.84), (0.42, 0.43, 0.52),
                  ((0.975, 0.88, 0.76), (0.56, 0.69, 0.83)), (0.99, 0.78, 0.58), 0.8, 0.6),
    "night": _Hour(56, 215, (0.66, 0.69, 0.82), (0.42, 0.47, 0.62), (0.30, 0.32, 0.41),
                   ((0.40, 0.46, 0.60), (0.18, 0.23, 0.38)), (0.24, 0.30, 0.46), 0.8, 1.0),
}  # fmt: skip

#: Indoors walls throw much of the light back: more fill, less key. At night the lamps are on. The key of
#: late hours is warm and its fill cool, so that floor, walls and people keep their own colours.
_INDOORS = {
    "dawn": _Hour(46, 70, (0.84, 0.70, 0.46), (0.97, 1.00, 1.07), (0.93, 0.90, 0.88),
                  ((0.94, 0.93, 0.92), (0.94, 0.93, 0.92)), (1.0, 0.92, 0.82), 0.7, 0.35, 0.7),
    "day": _Hour(46, 235, (0.70, 0.66, 0.56), (1.12, 1.11, 1.10), (1.04, 1.00, 0.94),
                 ((0.93, 0.93, 0.92), (0.93, 0.93, 0.92)), (0.90, 0.95, 0.97), 0.0, 0.0, 0.8),
    "dusk": _Hour(42, 200, (1.02, 0.73, 0.36), (0.74, 0.82, 0.97), (0.78, 0.75, 0.75),
                  ((0.90, 0.88, 0.88), (0.90, 0.88, 0.88)), (0.98, 0.80, 0.62), 0.7, 0.7, 0.8),
    "night": _Hour(64, 215, (1.56, 1.14, 0.62), (0.52, 0.58, 0.74), (0.52, 0.50, 0.54),
                   ((0.34, 0.36, 0.45), (0.34, 0.36, 0.45)), (0.25, 0.32, 0.47), 0.92, 1.0),
}  # fmt: skip


#: Places where the hour does not matter: underground, in a ship, by a fire. Never below what a face needs.
_LAMPS = {
    "lamps": _Hour(60, 235, (0.62, 0.58, 0.50), (1.02, 1.01, 0.98), (0.92, 0.89, 0.84),
                   ((0.86, 0.86, 0.84), (0.86, 0.86, 0.84)), (0.90, 0.95, 0.97), 0.0, 0.4),
    "cool": _Hour(58, 235, (0.52, 0.64, 0.76), (0.80, 0.92, 1.04), (0.62, 0.70, 0.82),
                  ((0.20, 0.25, 0.36), (0.12, 0.16, 0.26)), (0.24, 0.30, 0.46), 0.0, 0.8),
    "warm": _Hour(46, 250, (1.16, 0.84, 0.49), (0.86, 0.85, 0.89), (0.81, 0.73, 0.67),
                  ((0.42, 0.36, 0.34), (0.34, 0.30, 0.31)), (1.0, 0.90, 0.80), 0.4, 0.9),
    "dim": _Hour(62, 225, (0.58, 0.57, 0.54), (0.66, 0.69, 0.73), (0.54, 0.55, 0.57),
                 ((0.46, 0.48, 0.52), (0.40, 0.42, 0.47)), (0.80, 0.86, 0.90), 0.5, 0.9),
}  # fmt: skip
#: How far lamps are turned down at night.
_LOWERED = 0.86
#: How far key and fill step back before lamps that are turned all the way up.
_BACK, _BACK_OUTSIDE = (0.45, 0.26), (0.5, 0.28)
#: Lamps enough to light a place by themselves, as ``shining`` counts them.
_ENOUGH = 0.025
_BOUNCE: Colour = (0.16, 0.09, 0.02)

#: A lit window seen from the street at night.
LAMPLIGHT: Colour = (0.93, 0.80, 0.55)


def _hour(time: str, outdoor: bool, light: str) -> _Hour:
    if light in _LAMPS:
        lamps = _LAMPS[light]
        return (
            lamps
            if time != "night"
            else replace(
                lamps,
                sun=_times(lamps.sun, _LOWERED),
                sky=_times(lamps.sky, _LOWERED),
                ground=_times(lamps.ground, _LOWERED),
            )
        )
    hours = _OUTDOORS if outdoor else _INDOORS
    return hours.get(time, hours["day"])


def _times(radiance: Colour, share: float) -> Colour:
    r, g, b = radiance
    return r * share, g * share, b * share


def _plus(one: Colour, other: Colour) -> Colour:
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]


def make_light(definition: SetDef, time: str, room: tuple[str, ...] = ()) -> Light:
    """The light of a set, seen from one of its rooms (or all of it)."""
    hour = _hour(time, definition.outdoor, definition.light)
    azimuth, elevation = math.radians(hour.azimuth), math.radians(hour.elevation)
    if not definition.outdoor:
        found = window_azimuth(definition, room)
        azimuth = azimuth if found is None else found
    sun = (
        math.cos(azimuth) * math.cos(elevation),
        math.sin(azimuth) * math.cos(elevation),
        math.sin(elevation),
    )
    return Light(sun, hour.sun, hour.sky, hour.ground, hour.backdrop, hour.lamps, hour.windows)


def by_lamplight(light: Light, outdoor: bool, shining: float) -> Light:
    """The light of a set that has lamps, as far as they are turned up: the rest steps back before them, and
    what walls throw back of them is warm. shining: their light one metre away for each square metre of floor,
    so that a place with a screen or a candle alone does not go dark."""
    share = light.lamps * min(shining / _ENOUGH, 1.0)
    key, fill = (1.0 - back * share for back in (_BACK_OUTSIDE if outdoor else _BACK))
    bounce = (0.0, 0.0, 0.0) if outdoor else _times(_BOUNCE, share)
    return replace(
        light,
        sun_color=_times(light.sun_color, key),
        sky=_plus(_times(light.sky, fill), bounce),
        ground=_plus(_times(light.ground, fill), bounce),
    )


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


def glass_tint(time: str, outdoor: bool, light: str = "daylight") -> tuple[Colour, float, int]:
    """The colour window panes take at a time of day, how much of it (0..1), and the number of the material
    they are drawn as: at night glass is dark, save where somebody is at home behind it (:data:`LAMPLIGHT`);
    in a ship, whose light is cool, there is no hour."""
    if light == "cool":
        return (0.0, 0.0, 0.0), 0.0, MATERIALS.index("glass")
    hour = _hour(time, outdoor, "daylight")
    return hour.glass, hour.glass_share, NIGHT_GLASS if time == "night" else MATERIALS.index("glass")
