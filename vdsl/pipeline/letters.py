"""Whether what a script says can be written on pictures with the typefaces of this machine.

Assumes a checked storyboard. Guarantees one warning at most, at the first place that could not be written.
"""

from __future__ import annotations

from collections.abc import Iterator

from ..emit.typefaces import lacking
from ..emit.words import line_words
from ..lang import Report, Span
from ..lang.ir import Storyboard

_MOST_TOLD = 12


def warn_of_letters(storyboard: Storyboard, report: Report) -> None:
    """Tell of letters that no typeface here shows: on sheets and in burn-ins they come out as boxes."""
    lost, first = "", None
    for text, span in _written(storyboard):
        found = lacking(text)
        if found and first is None:
            first = span
        lost += "".join(c for c in found if c not in lost)
    if first is None:
        return
    told = " ".join(lost[:_MOST_TOLD]) + (" …" if len(lost) > _MOST_TOLD else "")
    report.warn(
        "VDS330",
        first,
        label=f"no typeface on this machine has {told}",
        help="install one that does; on Debian `apt install fonts-wqy-microhei` brings Chinese, Japanese and "
        "Korean, `fonts-noto-core` most other scripts",
    )


def _written(storyboard: Storyboard) -> Iterator[tuple[str, Span]]:
    """Every text that goes on a sheet or a strip, with its place."""
    for line in storyboard.lines:
        scene = storyboard.scenes[line.scene].name
        yield f"{storyboard.title} {line_words(line, scene)} {scene}", line.span
        for shot in line.shots:
            yield f"{shot.say or ''} {shot.note or ''} {shot.id}", shot.span
