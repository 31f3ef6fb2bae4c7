"""Options of story and camera lines: ``lens 50mm, ease slow-in, 4s, say "…"``.

Each option has one reader; an option no line knows is an error at its place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from runtime.motion.feelings import FEELINGS

from . import ast, words
from .diagnostics import Report, listing, nearest
from .option_values import (
    choose,
    count_reader,
    read_aperture,
    read_duration,
    read_ease,
    read_lens,
    read_name,
    read_roll,
    read_speed,
    read_style,
    read_text,
    report_no_value,
)

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
    focus_to: ast.Name | None = None
    aperture: float | None = None
    say: str | None = None
    note: str | None = None
    name: ast.Name | None = None
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
        if reader is None and name != "focus":
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
        if name == "focus":
            _focus(option, found, report)
            continue
        if len(option.values) != 1:
            _wrong_count(option, name, report)
            continue
        assert reader is not None
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
        report_no_value(who, "a name", "feeling ben afraid", report)
        return
    word = choose(values[-1], dict.fromkeys(FEELINGS), "feeling", report)
    if word is None:
        return
    if any((who and who.text) == (name and name.text) for name, _ in found.feelings):
        whose = f"the feeling of {who.text}" if who is not None else "`feeling`"
        report.error("VDS051", option.span, label=f"{whose} is said twice on this line")
        return
    found.feelings.append((who, word))


def _focus(option: ast.Option, found: ShotOptions, report: Report) -> None:
    """``focus anna``, or ``focus anna to ben`` of a rack-focus; ``from`` may stand before."""
    values = list(option.values)
    if len(values) > 1 and _is_word(values[0], "from"):
        del values[0]
    if not values:
        _wrong_count(option, "focus", report)
        return
    racks = len(values) == 3 and _is_word(values[1], "to")
    if len(values) > 1 and not racks:
        report.error(
            "VDS052",
            values[1].span,
            label="`focus` takes one name, or two with `to` between",
            help="as in `focus anna`, or `focus anna to ben` of a rack-focus",
        )
    names = [values[0], values[2] if racks else values[1]] if len(values) > 1 else values
    for value in names:
        if not isinstance(value, ast.Name):
            report_no_value(value, "a name", _EXAMPLES["focus"], report)
            return
    found.focus, found.focus_to = [*(name for name in names if isinstance(name, ast.Name)), None][:2]


def _is_word(value: ast.Value, word: str) -> bool:
    return isinstance(value, ast.Name) and words.fold(value.text) == word


def _in_parentheses(option: ast.Option) -> str:
    """A camera that has the word an option has been taken for; a view with whose it is."""
    if words.CAMERA_WORDS[words.fold(option.name.text)].slot != "view":
        return "/ (static close-up eye-level)"
    names = [value.text for value in option.values if isinstance(value, ast.Name)]
    return f"/ ({' '.join([option.name.text, *names[:1]])} static medium)"


def _unknown(option: ast.Option, report: Report) -> None:
    name = option.name.text
    folded = words.fold(name)
    if folded in words.CAMERA_WORDS:
        report.error(
            "VDS050",
            option.name.span,
            label=f"`{name}` is a word of the camera, not an option",
            help=f"camera words stand in parentheses after the slash: `{_in_parentheses(option)}`",
        )
        return
    known = (*_READERS, "focus", "feeling")
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


def _is_option(value: ast.Value) -> bool:
    return isinstance(value, ast.Name) and words.fold(value.text) in (*_READERS, "focus")


def _repair(extra: ast.Value, example: str) -> str:
    """How a second value was probably meant."""
    if isinstance(extra, ast.Number) and extra.value < 0:
        return "a range has two dots, as in `lens 35..85mm`"
    if isinstance(extra, ast.Number) or _is_option(extra):
        return f"put a comma before `{extra.span.text}`"
    return f"as in `{example}`"


_READERS: dict[str, Callable[[ast.Value, tuple[int, int], Report], object]] = {
    "lens": read_lens,
    "ease": read_ease,
    "duration": read_duration,
    "roll": read_roll,
    "aperture": read_aperture,
    "say": read_text,
    "note": read_text,
    "name": read_name,
    "proposals": count_reader(MOST_PROPOSALS, "proposals 80"),
    "takes": count_reader(MOST_TAKES, "takes 5"),
    "speed": read_speed,
    "style": read_style,
}
_EXAMPLES = {
    "lens": "lens 50mm", "ease": "ease slow-in", "duration": "4s", "roll": "roll 12deg",
    "aperture": "aperture 1.8", "focus": "focus anna",
    "say": 'say "Hello."', "note": 'note "late light"', "name": "name opening",
    "proposals": "proposals 80", "takes": "takes 5",
    "speed": "speed brisk", "style": "style ink",
}  # fmt: skip
