"""Header lines: frame rate, picture size, seed, rig, style, aperture, takes and proposals."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from . import ast, words
from .diagnostics import Report, listing, nearest
from .option_values import read_aperture, read_count
from .options import MOST_PROPOSALS, MOST_TAKES

#: Frame rates that are written rounded and meant exactly.
EXACT_FPS = {
    23.976: (24000, 1001),
    23.98: (24000, 1001),
    29.97: (30000, 1001),
    47.952: (48000, 1001),
    59.94: (60000, 1001),
}
SMALLEST_SIDE, LARGEST_SIDE = 16, 7680
LARGEST_SEED = 2**63 - 1


@dataclass
class Settings:
    """What header lines (or the command line) say; None where nothing was said."""

    fps: tuple[int, int] | None = None
    size: tuple[int, int] | None = None
    aspect: float | None = None
    seed: int | None = None
    rig: str | None = None
    style: str | None = None
    takes: int | None = None
    proposals: int | None = None
    aperture: float | None = None

    def complete(self, others: Settings) -> None:
        """Take from others what was not said here; a picture's size and shape go together."""
        shaped = self.size is not None or self.aspect is not None
        for name, value in vars(others).items():
            if getattr(self, name) is None and not (shaped and name in ("size", "aspect")):
                setattr(self, name, value)

    def final_size(self) -> tuple[int, int]:
        """The picture's even width and height; ``aspect`` changes the height."""
        width, height = self.size or (1280, 720)
        if self.aspect is not None:
            height = max(SMALLEST_SIDE, 2 * round(width / self.aspect / 2))
        return width, height


def read_header(line: ast.Header, settings: Settings, report: Report) -> None:
    """Take one header line into the settings."""
    name = line.keyword.text
    if getattr(settings, name) is not None:
        report.error("VDS035", line.span, label=f"`{name}` is said twice", help="remove one of the two")
        return
    value = line.values[0]
    if name == "fps":
        settings.fps = _fps(line, report)
    elif name == "size":
        settings.size = _size(line, report)
    elif name == "aspect":
        settings.aspect = _aspect(line, report)
    elif name == "seed":
        settings.seed = read_count(value, LARGEST_SEED, "seed 7", report, least=0)
    elif name == "takes":
        settings.takes = read_count(value, MOST_TAKES, "takes 5", report)
    elif name == "proposals":
        settings.proposals = read_count(value, MOST_PROPOSALS, "proposals 80", report)
    elif name == "aperture":
        settings.aperture = read_aperture(value, (24, 1), report)
    else:
        _word(line, settings, words.RIGS if name == "rig" else words.STYLES, report)


def _word(line: ast.Header, settings: Settings, choices: tuple[str, ...], report: Report) -> None:
    name, value = line.keyword.text, line.values[0]
    if isinstance(value, ast.Name) and value.text in choices:
        setattr(settings, name, value.text)
        return
    meant = nearest(value.text, choices) if isinstance(value, ast.Name) else None
    report.error(
        "VDS036",
        value.span,
        label=f"`{value.span.text}` is no {name}",
        help=f"{name} may be {listing(choices)}",
        suggestion=meant,
        fix=meant,
    )


def _plain(line: ast.Header, count: int, example: str, report: Report) -> list[float] | None:
    """The line's numbers, which have no units."""
    numbers: list[float] = []
    for value in line.values:
        if not isinstance(value, ast.Number) or value.unit is not None:
            report.error(
                "VDS036", value.span, label="a bare number is wanted here", help=f"as in `{example}`"
            )
            return None
        numbers.append(value.value)
    if len(numbers) != count:
        report.error("VDS036", line.span, label="this header reads otherwise", help=f"as in `{example}`")
        return None
    return numbers


def _fps(line: ast.Header, report: Report) -> tuple[int, int] | None:
    numbers = _plain(line, len(line.values), "fps 24", report)
    if numbers is None:
        return None
    span = line.values[0].span.to(line.values[-1].span)
    known = EXACT_FPS.get(numbers[0]) if len(numbers) == 1 else None
    if known:
        return known
    whole = all(n == int(n) and n > 0 for n in numbers)
    rate = Fraction(int(numbers[0]), int(numbers[1]) if len(numbers) == 2 else 1) if whole else None
    if rate is None or not 1 <= rate <= 120:
        report.error(
            "VDS036",
            span,
            label="no film runs at this rate",
            help="fps 24, 25, 30, 23.976, 29.97, or any whole rate to 120",
        )
        return None
    return rate.numerator, rate.denominator


def _size(line: ast.Header, report: Report) -> tuple[int, int] | None:
    numbers = _plain(line, 2, "size 1280x720", report)
    if numbers is None:
        return None
    width, height = (int(n) for n in numbers)
    span = line.values[0].span
    if not all(SMALLEST_SIDE <= side <= LARGEST_SIDE for side in (width, height)):
        report.error(
            "VDS036",
            span,
            label="this size is out of range",
            help=f"sides go from {SMALLEST_SIDE} to {LARGEST_SIDE}",
        )
        return None
    if width % 2 or height % 2:
        even = f"{width + width % 2}x{height + height % 2}"
        report.error(
            "VDS037",
            span,
            label="video needs an even width and height",
            help=f"write {even}",
            suggestion=even,
            fix=even,
        )
        return None
    return width, height


def _aspect(line: ast.Header, report: Report) -> float | None:
    numbers = _plain(line, len(line.values), "aspect 2.39", report)
    if numbers is None:
        return None
    ratio = numbers[0] / numbers[1] if len(numbers) == 2 and numbers[1] else numbers[0]
    if not 0.2 <= ratio <= 5:
        report.error(
            "VDS036",
            line.values[0].span,
            label="this aspect is out of range",
            help="from 0.2 to 5, as in 1.85, 2.39 or 16:9",
        )
        return None
    return ratio
