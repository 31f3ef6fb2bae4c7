"""Who holds what, line by line: so that nobody drinks from empty hands unnoticed.

Follows what actions take, put and pass on. Only warns: how a line is acted is the engine's to decide.
"""

from __future__ import annotations

from .catalog import CatalogLike
from .definitions.types import DefinitionBase
from .diagnostics import Report
from .ir import Beat, Target

Thing = tuple[str, ...]


class Hands:
    """The hands of everyone in one scene; empty when it opens, but for what people are placed with."""

    def __init__(self, catalog: CatalogLike, report: Report) -> None:
        self._catalog = catalog
        self._report = report
        self._held: dict[str, list[Thing]] = {}

    def act(self, beat: Beat) -> None:
        """Follow one beat, and warn where it needs something that is not in a hand."""
        definition = self._catalog.get("action", beat.action)
        if definition is None:
            return
        held = self._held.setdefault(beat.character, [])
        if beat.brought is not None and beat.brought.path not in held:
            held.append(beat.brought.path)
        needs: str = getattr(definition, "needs", "none")
        self._need(beat, needs)
        taken: Target | None = getattr(beat, needs, None) if needs in ("target", "second") else None
        if taken is not None and taken.kind == "object" and taken.path not in held:
            for other in self._held.values():
                _drop(other, taken.path)
            held.append(taken.path)
        moves = _moves(definition)
        if "take" in moves and beat.target is not None and beat.target.kind == "object":
            for other in self._held.values():
                _drop(other, beat.target.path)
            held.append(beat.target.path)
        if moves & {"put", "pass", "throw"}:
            gone = self._meant(beat, held)
            if gone is not None:
                held.remove(gone)
                if moves & {"pass", "throw"} and beat.second is not None and beat.second.kind == "character":
                    self._held.setdefault(beat.second.path[0], []).append(gone)

    def give(self, who: str, thing: Thing) -> None:
        """Put a thing into a hand before anything happens."""
        self._held.setdefault(who, []).append(thing)

    def holder(self, thing: Thing) -> str | None:
        """Who has a thing in a hand."""
        return next((who for who, held in self._held.items() if thing in held), None)

    def held_by(self, who: str) -> tuple[Thing, ...]:
        """What somebody has in their hands."""
        return tuple(self._held.get(who, ()))

    def _meant(self, beat: Beat, held: list[Thing]) -> Thing | None:
        """What leaves the hand: the target if it is held, else what was taken last."""
        if beat.target is not None and beat.target.path in held:
            return beat.target.path
        return held[-1] if held else None

    def _need(self, beat: Beat, needs: str) -> None:
        wanted: Target | None = {"target": beat.target, "second": beat.second}.get(needs)
        held = self._held.get(beat.character, [])
        if needs == "none" or held or (wanted is not None and wanted.kind == "object"):
            return  # what is named, and in no hand yet, is taken up first
        what = "anything"
        self._report.warn(
            "VDS080",
            beat.span,
            label=f"{beat.character} does not hold {what} here",
            help=f"a line like `({beat.character} pick up NAME)` before this puts it in a hand",
        )


def _moves(definition: DefinitionBase) -> set[str]:
    """Kinds of moves of an action's plain variant."""
    variants = getattr(definition, "variants", ())
    return {move.kind for move in variants[0].part.moves} if variants else set()


def _drop(held: list[Thing], thing: Thing) -> None:
    if thing in held:
        held.remove(thing)
