"""Options of story and camera lines: ``lens 50mm, ease slow-in, 4s, say "…"``.

Each option has one reader; an option no line knows is an error at its place.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from runtime.motion.feelings import FEELINGS

from . import ast, words
from .diagnostics import Report, listing, nearest

SHORTEST_LENS, LONGEST_LENS = 8.0, 400.0
LONGEST_SHOT = 120.0
MOST_PROPOSALS = 2000
MOST_TAKES = 40


@dataclass
class ShotOptions:
    """What options said; None where nothing was. Units as in :class:`vdsl.lang.ir.Shot`."""

    lens: tuple[float, float] | None = None
    ease: tuple[float, ...] | None = None
    duration: float | None = None
    roll: float | None = None
    focus: ast.Name | None = None
    say: str | None = None
    note: str | None = None
    proposals: int | None = None
    takes: int | None = None
    speed: float | None = None
    style: str | None = None
    feelings: list[tuple[ast.Name | None, str]] = field(default_factory=list)


def read_options(options: tuple[ast.Option, ...], fps: tuple[int, int], report: Report) -> ShotOptions:
    """All options of one line."""
    found = ShotOptions()
    seen: dict[str, ast.Option] = {}
    for option in options:
        name = words.fold(option.name.text)
        if name == "feeling":
            _feeling(option, found, report)
            continue
        reader = _READERS.get(name)
        if reader is None:
            _unknown(option, report)
            continue
        if name in seen:
            report.error(
                "VDS051",
                option.span,
                label=f"`{name}` is said twice on this line",
                notes=[(seen[name].span, "first here")],
            )
            continue
        seen[name] = option
        if len(option.values) != 1:
            _wrong_count(option, name, report)
            continue
        value = reader(option.values[0], fps, report)
        if value is not None:
            setattr(found, name, value)
    return found


def _feeling(option: ast.Option, found: ShotOptions, report: Report) -> None:
    """``feeling angry`` of whoever acts first, ``feeling ben afraid`` of somebody else; once for each."""
    values = option.values
    if not 1 <= len(values) <= 2:
        span = option.name.span if not values else values[2].span
        report.error(
            "VDS052",
            span,
            label="`feeling` takes a word, or a name and a word",
            help="as in `feeling angry` or `feeling ben afraid`",
        )
        return
    who = values[0] if len(values) == 2 else None
    if who is not None and not isinstance(who, ast.Name):
        _no_value(who, "a name", "feeling ben afraid", report)
        return
    word = _choose(values[-1], dict.fromkeys(FEELINGS), "feeling", report)
    if word is None:
        return
    if any((who and who.text) == (name and name.text) for name, _ in found.feelings):
        whose = f"the feeling of {who.text}" if who is not None else "`feeling`"
        report.error("VDS051", option.span, label=f"{whose} is said twice on this line")
        return
    found.feelings.append((who, word))


def _unknown(option: ast.Option, report: Report) -> None:
    name = option.name.text
    folded = words.fold(name)
    if folded in words.CAMERA_WORDS:
        report.error(
            "VDS050",
            option.name.span,
            label=f"`{name}` is a word of the camera, not an option",
            help="camera words stand in parentheses after the slash: `/ (static close-up eye-level)`",
        )
        return
    known = (*_READERS, "feeling")
    meant = nearest(name, known)
    report.error(
        "VDS050",
        option.name.span,
        label=f"there is no option `{name}`",
        help=f"options are {listing(known, 20, last='and')}; a time alone is the duration",
        suggestion=meant,
        fix=meant,
    )


def _wrong_count(option: ast.Option, name: str, report: Report) -> None:
    example = _EXAMPLES[name]
    if not option.values:
        report.error("VDS052", option.name.span, label=f"`{name}` needs a value", help=f"as in `{example}`")
        return
    extra = option.values[1]
    report.error("VDS052", extra.span, label=f"`{name}` takes one value", help=_repair(extra, example))


def _repair(extra: ast.Value, example: str) -> str:
    """How a second value was probably meant."""
    if isinstance(extra, ast.Number) and extra.value < 0:
        return "a range has two dots, as in `lens 35..85mm`"
    if isinstance(extra, ast.Number) or (isinstance(extra, ast.Name) and words.fold(extra.text) in _READERS):
        return f"put a comma before `{extra.span.text}`"
    return f"as in `{example}`"


# -- one reader an option ------------------------------------------------------------------


def _lens(value: ast.Value, fps: tuple[int, int], report: Report) -> tuple[float, float] | None:
    ends = (value.low, value.high) if isinstance(value, ast.Range) else (value, value)
    unit = ends[1].unit if isinstance(ends[1], ast.Number) else None
    if isinstance(value, ast.Range) and unit is None:
        _needs_unit(value, "mm", "a focal length", report)
        return None
    found: list[float] = []
    for end in ends:
        if not isinstance(end, ast.Number):
            _no_value(value, "a focal length", "lens 50mm", report)
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


def _ease(value: ast.Value, fps: tuple[int, int], report: Report) -> tuple[float, ...] | None:
    if isinstance(value, ast.Star):
        return tuple(sorted(set(words.EASES.values())))
    found: list[float] = []
    for item in value.items if isinstance(value, ast.Choice) else (value,):
        word = _choose(item, words.EASES, "ease", report)
        if word is None:
            return None
        if words.EASES[word] not in found:
            found.append(words.EASES[word])
    return tuple(found)


def _duration(value: ast.Value, fps: tuple[int, int], report: Report) -> float | None:
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
        _no_value(value, "a time", "4s", report)
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


def _roll(value: ast.Value, fps: tuple[int, int], report: Report) -> float | None:
    if not isinstance(value, ast.Number):
        _no_value(value, "an angle", "roll 12deg", report)
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


def _focus(value: ast.Value, fps: tuple[int, int], report: Report) -> ast.Name | None:
    if isinstance(value, ast.Name):
        return value
    _no_value(value, "a name", "focus anna", report)
    return None


def _text(value: ast.Value, fps: tuple[int, int], report: Report) -> str | None:
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


def _count(most: int, example: str) -> Callable[[ast.Value, tuple[int, int], Report], int | None]:
    def read(value: ast.Value, fps: tuple[int, int], report: Report) -> int | None:
        return read_count(value, most, example, report)

    return read


def read_count(value: ast.Value, most: int, example: str, report: Report, least: int = 1) -> int | None:
    """A whole number without a unit, from ``least`` to ``most``."""
    if not isinstance(value, ast.Number):
        _no_value(value, "a whole number", example, report)
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


def _speed(value: ast.Value, fps: tuple[int, int], report: Report) -> float | None:
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
    word = _choose(value, words.SPEEDS, "speed", report)
    return None if word is None else words.SPEEDS[word]


def _style(value: ast.Value, fps: tuple[int, int], report: Report) -> str | None:
    return _choose(value, dict.fromkeys(words.STYLES), "style", report)


def _choose(
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


def _no_value(value: ast.Value, what: str, example: str, report: Report) -> None:
    report.error("VDS055", value.span, label=f"{what} is wanted here", help=f"as in `{example}`")


_READERS: dict[str, Callable[[ast.Value, tuple[int, int], Report], object]] = {
    "lens": _lens,
    "ease": _ease,
    "duration": _duration,
    "roll": _roll,
    "focus": _focus,
    "say": _text,
    "note": _text,
    "proposals": _count(MOST_PROPOSALS, "proposals 80"),
    "takes": _count(MOST_TAKES, "takes 5"),
    "speed": _speed,
    "style": _style,
}
_EXAMPLES = {
    "lens": "lens 50mm", "ease": "ease slow-in", "duration": "4s", "roll": "roll 12deg",
    "focus": "focus anna",
    "say": 'say "Hello."', "note": 'note "late light"', "proposals": "proposals 80", "takes": "takes 5",
    "speed": "speed brisk", "style": "style ink",
}  # fmt: skip
