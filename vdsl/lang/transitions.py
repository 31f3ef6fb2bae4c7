"""Transitions: what stands between two story lines, into how the second joins the first."""

from __future__ import annotations

from . import ast
from .diagnostics import Report
from .ir import Transition
from .option_values import read_time

DEFAULT_SECONDS = {"cut": 0.0, "dissolve": 0.5, "fade-out": 1.0, "fade-in": 1.0, "wipe": 0.5}
LONGEST_TRANSITION = 10.0


class Joins:
    """Takes transition lines as they come, and gives each story line its own."""

    def __init__(self, report: Report) -> None:
        self.report = report
        self._next: Transition | None = None
        self._last: ast.TransitionLine | None = None

    def take(self, line: ast.TransitionLine, fps: tuple[int, int], begun: bool) -> None:
        """A transition line; ``begun`` where a story line stands before it."""
        kind = line.kind.text
        seconds = self._seconds(line, fps)
        if not begun and kind != "fade-in":
            self.report.error(
                "VDS078",
                line.span,
                label=f"there is nothing before this to {kind} from",
                help="a film may begin with a fade-in",
            )
            return
        if self._next is None:
            self._next, self._last = Transition(kind, seconds), line
        elif self._next.kind == "fade-out" and kind == "fade-in":
            self._next = Transition(kind, seconds, self._next.duration)
        else:
            assert self._last is not None
            self.report.error(
                "VDS078",
                line.span,
                label="two lines join in one way",
                help="only a fade-out may be followed by a fade-in",
                notes=[(self._last.span, "the other transition")],
            )

    def _seconds(self, line: ast.TransitionLine, fps: tuple[int, int]) -> float:
        kind = line.kind.text
        if line.duration is None:
            return DEFAULT_SECONDS[kind]
        seconds = read_time(line.duration, fps, self.report)
        if seconds is None:
            return DEFAULT_SECONDS[kind]
        if kind == "cut":
            self.report.error(
                "VDS078",
                line.duration.span,
                label="a cut takes no time",
                help="leave it out, or write dissolve",
            )
        elif not 0 < seconds <= LONGEST_TRANSITION:
            self.report.error(
                "VDS054",
                line.duration.span,
                label=f"{seconds:g}s is out of range",
                help=f"more than 0s, at most {LONGEST_TRANSITION:g}s",
            )
        return seconds

    def give(self) -> Transition:
        """How the story line that comes now joins the one before it."""
        found, self._next, self._last = self._next, None, None
        return found or Transition("cut", 0.0)

    def ending(self) -> Transition | None:
        """What is left after the last line: a fade-out, or a mistake."""
        if self._next is None or self._last is None:
            return None
        if self._next.kind == "fade-out":
            return self._next
        self.report.error(
            "VDS078",
            self._last.span,
            label="nothing follows that this could lead to",
            help="a film may end with a fade-out",
        )
        return None
