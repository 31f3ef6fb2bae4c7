"""Little stages to try one action, prop or person on: scripts as text, staged and performed.

Assumes names that are in the catalog. Guarantees that what an action's example names is there: small things
on a table, big ones on the floor, and ``ben`` facing ``anna``.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..lang import Report, Source
from ..lang.definitions.action import ActionDef
from ..lang.definitions.prop import PropDef
from ..library import Catalog
from ..propose.story import tell
from ..propose.types import StoryProposal
from ..stage.assemble import StagedScene
from .compile import Act, stage_acts
from .script import Checked, ScriptError, check_source

#: Who acts in examples, and who the other person is.
ACTOR, PARTNER = "anna", "ben"
CAST = ("woman(top crimson)", "man(top navy)")
#: What an example writes to have stairs up to a platform there, of that name.
STAIRS = "stairs"
#: Far more ways than any action has: every variant is wanted here.
_EVERY_WAY = 64
#: Where big things stand on the trial floor, with a table in its middle and without.
#: Metres: what is held higher than this above its foot stands on the floor, not on the table.
_TALL = 0.55
_BESIDE_TABLE = ((7.9, 6.3), (4.1, 6.3), (3.4, 8.2), (8.6, 8.2))
_BETWEEN = (5.85, 6.0)
_AROUND = ((7.5, 7.2), (4.5, 7.2), (8.6, 5.0), (3.4, 5.0))


class NoTrialError(Exception):
    """The definition cannot be tried; the message says why."""


@dataclass(frozen=True, eq=False)
class Trial:
    """An action tried: who takes part, and one performance of each variant."""

    act: Act
    people: tuple[str, ...]
    ways: tuple[StoryProposal, ...]

    @property
    def staged(self) -> StagedScene:
        return self.act.staged


def try_action(
    name: str,
    catalog: Catalog,
    cast: tuple[str, str] = CAST,
    own: Path | None = None,
) -> Trial:
    """Every variant of an action, performed from its example.

    cast: what anna and ben are; own: a script whose definitions count
    Raises :class:`NoTrialError` where the action has no example, or one that cannot be played.
    """
    definition = catalog.get("action", name)
    if not isinstance(definition, ActionDef):
        raise NoTrialError(f"there is no action `{name}`")
    text = action_script(definition, catalog, cast)
    checked = _checked(text, name, own)
    try:
        (act,) = stage_acts(checked)
    except ScriptError as error:
        raise NoTrialError(_told(name, error.report)) from error
    told = tell(act.state, act.line, act.filming, checked.report, most=_EVERY_WAY)
    if checked.report.has_errors:
        raise NoTrialError(_told(name, checked.report))
    ways = {way.variant: way for way in reversed(told.proposals)}
    people = (ACTOR, PARTNER) if PARTNER in definition.example.split() else (ACTOR,)
    return Trial(act, people, tuple(reversed(ways.values())))


def action_script(definition: ActionDef, catalog: Catalog, cast: tuple[str, str] = CAST) -> str:
    """The script an action is tried with: a bare floor, what its example needs, and the example."""
    if not definition.example:
        raise NoTrialError(f"the action `{definition.name}` has no example")
    words = definition.example.split()
    small: list[str] = []
    big: list[str] = []
    kicked = any(move.kind == "send" for move in definition.variants[0].part.moves)
    for name in definition.props:
        if name == STAIRS:
            continue
        prop = catalog.get("prop", name)
        if not isinstance(prop, PropDef):
            raise NoTrialError(f"the action `{definition.name}` is tried with `{name}`, which is no prop")
        grip = prop.shape().grip
        (small if grip is not None and grip[2] < _TALL and not kicked else big).append(name)
    both = PARTNER in words
    table = bool(small) or "table" in big
    big = [name for name in big if name != "table"]
    lines = []
    if table:
        at = "(5.3, 7.0)m" if both else "(6, 6.9)m"
        lines.append(f"        place table = table(width 1.6m), at {at} {{")
        for k, name in enumerate(small):
            along = (k - (len(small) - 1) / 2) * min(0.45, 1.3 / max(len(small), 1))
            lines.append(f"            place {name} = {name}, on top, at ({along:.2f}, -0.16)m")
        lines.append("        }")
    places = _BESIDE_TABLE if table else (_BETWEEN, *_AROUND) if kicked else _AROUND
    for name, (x, y) in zip(big, places, strict=False):
        lines.append(f"        place {name} = {name}, at ({x}, {y})m")
    if STAIRS in definition.props:
        lines.append(f"        platform {STAIRS}, at (6.6, 4.6)m, size (3, 3.4, 1.02)m, steps west")
    start = "(6, 6)m, facing 90deg" if table else "(6.2, 5.6)m, facing -40deg"
    posture = " lying" if definition.sit == "up" else ""  # there has to be something to get up from
    if both:
        start = "(5.3, 6)m, facing 0deg"
    if definition.group == "going":
        start = "(4.2, 5)m, facing 0deg"
    return "\n".join(
        (
            'storyboard "trial"',
            "set trial_floor {",
            "    time day",
            '    area floor, at (-6, -6)m, size (12, 12)m, floor plain, floor-color "#e9e5da" {',
            *lines,
            f"        spot start, at {start}",
            f"        spot other, at ({8.4 if kicked else 6.7}, 6)m, facing 180deg",
            "    }",
            "}",
            f"character {ACTOR} = {cast[0]}",
            *([f"character {PARTNER} = {cast[1]}"] if both else []),
            "scene trial = trial_floor",
            f"{ACTOR} at start" + (f" facing {PARTNER}" if both else "") + posture,
            *([f"{PARTNER} at other facing {ACTOR}"] if both else []),
            f"({definition.example}) / (static full eye-level)",
            "",
        )
    )  # fmt: skip


def floor_script(placed: str = "", cast: str = "") -> str:
    """A bare floor, 12 m by 12, with an entry placed on it, or somebody in its middle who does nothing."""
    lines = [
        'storyboard "trial"',
        "set trial_floor {",
        "    time day",
        '    area floor, at (-6, -6)m, size (12, 12)m, floor plain, floor-color "#e9e5da" {',
        f"        {placed}",
        "        spot here, at (6, 6)m, facing -90deg",
        "    }",
        "}",
        *([f"character {ACTOR} = {cast}"] if cast else []),
        "scene trial = trial_floor",
        *([f"{ACTOR} at here"] if cast else []),
        "",
        "/ (static wide eye-level)",
        "",
    ]
    return "\n".join(lines)


def stage_script(text: str, name: str, own: Path | None = None, line: int = 0) -> Act:
    """The first line of a script (or another), staged; ``own``: a script whose definitions count.

    Raises :class:`NoTrialError`.
    """
    try:
        return stage_acts(_checked(text, name, own))[line]
    except ScriptError as error:
        raise NoTrialError(_told(name, error.report)) from error


def _checked(text: str, name: str, own: Path | None) -> Checked:
    report = Report()
    try:
        return check_source(Source(name, text), report, definitions=own)
    except ScriptError as error:
        raise NoTrialError(_told(name, report)) from error


def _told(name: str, report: Report) -> str:
    first = report.errors[0]
    return f"`{name}` cannot be tried: {first.label or first.title} (in `{first.span.text}`)"
