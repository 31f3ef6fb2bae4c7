"""The pipeline's progress as bars with rates and time left; silent where nobody looks at a terminal.

Stages take turns, so a stage's rate and time left go by the seconds spent in it, not by the clock on
the wall.
"""

from __future__ import annotations

from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, ProgressColumn, Task, TaskID, TextColumn
from rich.text import Text


class _Rate(ProgressColumn):
    """Units a second while the stage was at work."""

    def render(self, task: Task) -> Text:
        seconds = task.fields["seconds"]
        if not seconds or not task.completed:
            return Text("")
        rate = task.completed / seconds
        return Text(f"{rate:,.{0 if rate >= 10 else 1}f} {task.fields['unit']}/s", style="dim")


class _Left(ProgressColumn):
    """Work left in the stage, as minutes and seconds."""

    def render(self, task: Task) -> Text:
        if not task.fields["seconds"] or not task.completed or task.total is None:
            return Text("-:--")
        left = round((task.total - task.completed) * task.fields["seconds"] / task.completed)
        return Text(f"{left // 60}:{left % 60:02d}")


class Bars:
    """One bar a stage on a terminal, nothing in a pipe. Use as a context manager.

    transient: the bars go away at the end
    """

    def __init__(self, console: Console, transient: bool = False) -> None:
        self._progress = Progress(
            TextColumn("{task.description:<10}"),
            BarColumn(bar_width=32),
            MofNCompleteColumn(),
            _Rate(),
            _Left(),
            console=console,
            disable=not console.is_terminal,
            transient=transient,
        )
        self._tasks: dict[str, TaskID] = {}

    def __enter__(self) -> Bars:
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._progress.stop()

    def begin(self, stage: str, total: int, unit: str) -> None:
        if stage not in self._tasks:
            self._tasks[stage] = self._progress.add_task(stage, total=total, unit=unit, seconds=0.0)
            return
        task = self._task(stage)
        self._progress.update(task.id, total=(task.total or 0) + total)

    def advance(self, stage: str, amount: int, seconds: float) -> None:
        task = self._task(stage)
        self._progress.update(task.id, advance=amount, seconds=task.fields["seconds"] + seconds)

    def _task(self, stage: str) -> Task:
        return next(t for t in self._progress.tasks if t.id == self._tasks[stage])
