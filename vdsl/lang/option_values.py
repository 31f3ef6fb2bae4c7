"""Values of options into numbers and words: one reader for each kind of value.

A reader returns None where the value is not of its kind, which is then in the report.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from . import ast, words
from .diagnostics import Report, listing, nearest

SHORTEST_LENS, LONGEST_LENS = 8.0, 400.0
LONGEST_SHOT = 120.0
WIDEST_APERTURE, SMALLEST_APERTURE = 0.7, 64.0
_F_NUMBER = re.compile(r"f?(\d+(?:\.\d+)?)")


def read_lens(value: ast.Value, fps: tuple[int, int], report: Report) -> tuple[float, float] | None:
    """``50mm`` or ``35..85mm`` as shortest and longest focal length, mm."""
    ends = (value.low, value.high) if isinstance(value, ast.Range) else (value, value)
    unit = ends[1].unit if isinstance(ends[1], ast.Number) else None
    if isinstance(value, ast.Range) and unit is None:
        _needs_unit(value, "mm", "a focal length", report)
        return None
    found: list[float] = []
    for end in ends:
        if not isinstance(end, ast.Number):
            report_no_value(value, "a focal length", "lens 50mm", report)
            return None
        if (end.unit or unit) is None:
            _needs_unit(end, "mm", "a focal length", report)
            return None
        if (end.unit or unit) != "mm":
            report.error(
                "VDS053",
                end.span,
                label="a lens is measured in mm",
                fix=f"{end.value:g}mm",
                help=f"write {end.value:g}mm",
            )
            return None
        if not SHORTEST_LENS <= end.value <= LONGEST_LENS:
            report.error(
                "VDS054",
                end.span,
                label=f"no lens has {end.value:g}mm",
                help=f"focal lengths go from {SHORTEST_LENS:g}mm to {LONGEST_LENS:g}mm",
            )
            return None
        found.append(end.value)
    if found[0] > found[1]:
        report.error(
            "VDS054",
            value.span,
            label="this range runs backwards",
            fix=f"{found[1]:g}..{found[0]:g}mm",
            help=f"write {found[1]:g}..{found[0]:g}mm",
        )
        return None
    return found[0], found[1]


def read_ease(value: ast.Value, fps: tuple[int, int], report: Report) -> tuple[float, ...] | None:
    """A word, ``a|b`` or ``*`` as the easings that may be used."""
    if isinstance(value, ast.Star):
        return tuple(sorted(set(words.EASES.values())))
    found: list[float] = []
    for item in value.items if isinstance(value, ast.Choice) else (value,):
        word = choose(item, words.EASES, "ease", report)
        if word is None:
            return None
        if words.EASES[word] not in found:
            found.append(words.EASES[word])
    return tuple(found)


def read_duration(value: ast.Value, fps: tuple[int, int], report: Report) -> float | None:
    """``4s`` or ``96f`` in seconds, no longer than a shot may last."""
    seconds = read_time(value, fps, report)
    if seconds is None:
        return None
    if not 0 < seconds <= LONGEST_SHOT:
        report.error(
            "VDS054",
            value.span,
            label=f"a shot cannot last {seconds:g}s",
            help=f"more than 0s, at most {LONGEST_SHOT:g}s",
        )
        return None
    return seconds


def read_time(value: ast.Value, fps: tuple[int, int], report: Report) -> float | None:
    """``4s`` or ``12f`` in seconds."""
    if not isinstance(value, ast.Number):
        report_no_value(value, "a time", "4s", report)
        return None
    if value.unit is None:
        _needs_unit(value, "s", "a time", report)
        return None
    if value.unit == "f":
        return value.value * fps[1] / fps[0]
    if value.unit != "s":
        report.error(
            "VDS053", value.span, label="a time is measured in s or f (frames)", help="as in 4s or 96f"
        )
        return None
    return value.value


def read_roll(value: ast.Value, fps: tuple[int, int], report: Report) -> float | None:
    """``12deg`` in radians."""
    if not isinstance(value, ast.Number):
        report_no_value(value, "an angle", "roll 12deg", report)
        return None
    if value.unit is None and value.value != 0:
        _needs_unit(value, "deg", "an angle", report)
        return None
    if value.unit not in ("deg", None):
        report.error(
            "VDS053",
            value.span,
            label="an angle is measured in deg",
            help=f"write {value.value:g}deg",
            fix=f"{value.value:g}deg",
        )
        return None
    if abs(value.value) > 90:
        report.error("VDS054", value.span, label="no camera rolls this far", help="at most 90deg either way")
        return None
    return math.radians(value.value)


def read_aperture(value: ast.Value, fps: tuple[int, int], report: Report) -> float | None:
    """``1.8``, ``f1.8`` or ``off`` as an f-number, 0 where everything is sharp."""
    if isinstance(value, ast.Name) and words.fold(value.text) in ("off", "none"):
        return 0.0
    said = _F_NUMBER.fullmatch(value.span.text.casefold()) if isinstance(value, ast.Name) else None
    if isinstance(value, ast.Number) and value.unit is not None:
        fix = f"{value.value:g}"
        report.error(
            "VDS053", value.span, label="an aperture is a bare f-number", help=f"write {fix}", fix=fix
        )
        return None
    if not isinstance(value, ast.Number) and said is None:
        report.error(
            "VDS055",
            value.span,
            label="an f-number is wanted here",
            help="as in `aperture 1.8`: the smaller, the less is sharp; `aperture off` keeps all sharp",
        )
        return None
    number = value.value if isinstance(value, ast.Number) else float(said[1] if said else 0)
    if WIDEST_APERTURE <= number <= SMALLEST_APERTURE:
        return number
    fix = "off" if number == 0 else f"{WIDEST_APERTURE if number < 1 else SMALLEST_APERTURE:g}"
    report.error(
        "VDS054",
        value.span,
        label=f"no lens stands at f/{number:g}",
        help=f"f-numbers go from {WIDEST_APERTURE:g} to {SMALLEST_APERTURE:g}; `off` keeps all sharp",
        suggestion=fix,
        fix=fix,
    )
    return None


def read_name(value: ast.Value, fps: tuple[int, int], report: Report) -> ast.Name | None:
    """A name, as one word."""
    if isinstance(value, ast.Name):
        return value
    fix = "-".join(value.value.split()) if isinstance(value, ast.Text) else None
    report.error("VDS055", value.span, label="a name is wanted here", help="as in `name opening`", fix=fix)
    return None


def read_text(value: ast.Value, fps: tuple[int, int], report: Report) -> str | None:
    """A text in quotes."""
    if isinstance(value, ast.Text):
        return value.value
    fix = f'"{value.span.text}"' if isinstance(value, ast.Name) else None
    report.error(
        "VDS055",
        value.span,
        label="a text in quotes is wanted here",
        help=f"write {fix}" if fix else 'as in say "Hello."',
        fix=fix,
    )
    return None


def count_reader(most: int, example: str) -> Callable[[ast.Value, tuple[int, int], Report], int | None]:
    """A reader of whole numbers from 1 to ``most``."""

    def read(value: ast.Value, fps: tuple[int, int], report: Report) -> int | None:
        return read_count(value, most, example, report)

    return read


def read_count(value: ast.Value, most: int, example: str, report: Report, least: int = 1) -> int | None:
    """A whole number without a unit, from ``least`` to ``most``."""
    if not isinstance(value, ast.Number):
        report_no_value(value, "a whole number", example, report)
        return None
    if value.unit is not None or value.value != int(value.value):
        report.error(
            "VDS055",
            value.span,
            label="a whole number without a unit is wanted here",
            help=f"as in `{example}`",
        )
        return None
    if not least <= value.value <= most:
        report.error(
            "VDS054", value.span, label=f"{value.value:g} is out of range", help=f"from {least} to {most}"
        )
        return None
    return int(value.value)


def read_speed(value: ast.Value, fps: tuple[int, int], report: Report) -> float | None:
    """A word, ``1.3`` or ``130%`` as a factor."""
    if isinstance(value, ast.Number):
        factor = value.value / 100 if value.unit == "%" else value.value
        if value.unit not in (None, "%"):
            report.error(
                "VDS053",
                value.span,
                label="a speed is a word or a bare factor",
                help="as in `speed brisk` or `speed 1.3`",
            )
            return None
        if not 0.25 <= factor <= 4:
            report.error(
                "VDS054",
                value.span,
                label=f"a speed of {factor:g} is out of range",
                help="from 0.25 to 4; 1 is as the action is",
            )
            return None
        return factor
    word = choose(value, words.SPEEDS, "speed", report)
    return None if word is None else words.SPEEDS[word]


def read_style(value: ast.Value, fps: tuple[int, int], report: Report) -> str | None:
    """The name of a style."""
    return choose(value, dict.fromkeys(words.STYLES), "style", report)


def choose(
    value: ast.Value,
    choices: dict[str, object] | dict[str, float] | dict[str, None],
    what: str,
    report: Report,
) -> str | None:
    """One of some words."""
    word = words.fold(value.text) if isinstance(value, ast.Name) else None
    if word in choices:
        return word
    meant = nearest(word, choices) if word else None
    report.error(
        "VDS056",
        value.span,
        label=f"`{value.span.text}` is no {what}",
        help=f"{what} may be {listing(choices)}",
        suggestion=meant,
        fix=meant,
    )
    return None


def _needs_unit(value: ast.Number | ast.Range, unit: str, what: str, report: Report) -> None:
    fix = f"{value.span.text}{unit}"
    report.error("VDS020", value.span, label=f"{what} needs a unit", help=f"write {fix}", fix=fix)


def report_no_value(value: ast.Value, what: str, example: str, report: Report) -> None:
    """Something else stands where ``what`` is wanted."""
    report.error("VDS055", value.span, label=f"{what} is wanted here", help=f"as in `{example}`")
