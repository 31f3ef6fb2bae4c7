"""Actions: from the entries of a definition to :class:`ActionDef`.

Assumes a parsed definition. Guarantees that a mistake is reported at its place and left out. What a
person does in the time of an action is read by :mod:`.timeline`.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from runtime.motion.feelings import FEELINGS
from runtime.motion.words import POSTURES

from .. import ast
from ..diagnostics import Report
from ..source import Span
from .reader import Reader, unknown_entry
from .timeline import MOVES, Part, mirrored, read_part, scaled
from .types import DefinitionBase

TARGET_KINDS = ("place", "object", "character")
SETTINGS = ("target", "second", "duration", "travel", "stride", "cadence", "gait", "sit", "posture", "needs",
            "faces", "turn", "apart", "against", "along", "mutual", "hold", "feeling", "group", "example",
            "also", "partner", "variant", "brings", "someone", "alone")  # fmt: skip
CHANGES = ("amplitude", "tempo", "mirror", "duration", "stride", "cadence", "gait", "instead", "partner")
TRAVELS = ("none", "walk", "run", "skip", "crawl")
#: Which drawer of the library an action lies in.
GROUPS = ("going", "posture", "gesture", "hand", "social", "emotion", "sport", "work", "music", "talk")
#: What may be said of a gait, with the kind of value and what it is until said.
GAIT: dict[str, tuple[str, float]] = {
    "lift": ("length", 0.0), "bounce": ("length", 0.0), "sway": ("angle", 0.0), "lean": ("angle", 0.0),
    "crouch": ("length", 0.0), "arms": ("number", 1.0), "width": ("number", 1.0), "limp": ("number", 0.0),
    "toes": ("number", 0.0), "stiff": ("number", 0.0),
}  # fmt: skip


@dataclass(frozen=True)
class GaitDef:
    """What is particular about a way of walking: values by the names of :data:`GAIT`.

    facing: where the face looks on the way: ahead, back, left or right
    """

    values: tuple[tuple[str, float], ...] = ()
    facing: str = "ahead"


@dataclass(frozen=True)
class VariantDef:
    """One way to do an action; tempo is worked into ``duration``, amplitude and mirror into the parts."""

    name: str
    duration: float
    part: Part
    partner: Part
    stride: float
    cadence: float
    gait: GaitDef


@dataclass(frozen=True)
class ActionDef(DefinitionBase):
    """An action.

    target, second: none, optional or required; target_kinds, second_kinds: of place, object, character
    travel: how one gets there first, one of :data:`TRAVELS`
    sit: down, up or keep; needs: target, second, any or none has to be in a hand
    faces: target, second or none; turn: radians to turn by without a target; along: also while walking
    posture: one of :data:`POSTURES` to take first, "" to stay as one is; posture_time: seconds for it, 0 for
        as long as it takes; rises: stands up again at the end
    apart: metres between two people, 0 for talking distance; feeling: what shows on the face, "" for nothing
    against: metres from what the back is against to the feet, 0 where it is against nothing
    mutual: of two who both do it each does it to the other, where nobody is named
    needs_hand: left or right, "" for either; group: one of :data:`GROUPS`, "" where it is not said
    example: a line that shows it, as in the language, anna acting and ben the other; props: names of the
        props it needs
    goes: whether the way of travelling is written, so that one goes to the target whatever is done there
    also: other words for it; otherwise: what it is done to where that is not said, the first
        of these that the scene has
    anything: a name that the scene has not is taken for what it is done with there: `cook dinner`
    brings: the prop that whoever does it has about them and takes out where the line names nothing to do it
        with, "" for none; unless_held: not where anything is in a hand already
    someone: the action that it is where it is done to somebody, "" for none: `push ben`; alone: where it is
        done to nobody and nothing: `stop`
    """

    target: str
    target_kinds: tuple[str, ...]
    second: str
    second_kinds: tuple[str, ...]
    travel: str
    sit: str
    needs: str
    faces: str
    turn: float
    along: bool
    variants: tuple[VariantDef, ...]
    posture: str = ""
    posture_time: float = 0.0
    rises: bool = False
    apart: float = 0.0
    against: float = 0.0
    mutual: bool = False
    feeling: str = ""
    group: str = ""
    example: str = ""
    props: tuple[str, ...] = ()
    needs_hand: str = ""
    goes: bool = False
    also: tuple[str, ...] = ()
    otherwise: tuple[str, ...] = ()
    anything: bool = False
    brings: str = ""
    unless_held: bool = False
    someone: str = ""
    alone: str = ""
    others_at: tuple[tuple[str, Span], ...] = field(default=(), compare=False, repr=False)
    brings_at: Span | None = field(default=None, compare=False, repr=False)


def read_action(definition: ast.Definition, report: Report) -> ActionDef | None:
    """An action's definition, checked; None where nothing of it can be used."""
    if definition.parameters:
        report.error(
            "VDS140", definition.parameters[0].span, label="an action takes no parameters",
            help="write variants: `variant big { amplitude 130% }`",
        )  # fmt: skip
    settings: dict[str, Reader] = {}
    variants: list[Reader] = []
    for entry in definition.body:
        head = entry.head.text
        reader = Reader(entry, {}, report)
        if head == "variant":
            variants.append(reader)
        elif head in SETTINGS:
            settings[head] = reader
        elif head not in MOVES:
            unknown_entry(entry, (*SETTINGS, *MOVES), "an action", report)
    duration = settings["duration"].value_seconds(0, 2.0) if "duration" in settings else 0.0
    moves = tuple(e for e in definition.body if e.head.text in MOVES)
    if moves and "duration" not in settings:
        report.error("VDS141", definition.name.span, label="an action that does something needs a `duration`",
                     help="such as `duration 2.4s`")  # fmt: skip
        duration = 2.0
    part = read_part(moves, duration, report)
    part = replace(part, hold="hold" in settings)
    partner = _partner(settings.get("partner"), duration, report)
    stride, cadence = _share(settings.get("stride")), _share(settings.get("cadence"))
    plain = VariantDef("plain", duration, part, partner, stride, cadence, _gait(settings.get("gait")))
    all_variants = [plain, *(_variant(r, plain, moves, report) for r in variants)]
    action = _settings(definition, settings, tuple(all_variants))
    for reader in (*settings.values(), *variants):
        reader.done()
    if action.brings_at is not None and action.needs not in ("target", "second"):
        help = "`needs target` or `needs second` says what it is for"
        report.error("VDS145", action.brings_at, label="this action needs nothing in a hand", help=help)
    return action


def _settings(
    definition: ast.Definition, settings: dict[str, Reader], variants: tuple[VariantDef, ...]
) -> ActionDef:
    def word(name: str, default: str, choices: tuple[str, ...]) -> str:
        return settings[name].value_word(0, default, choices) if name in settings else default

    needs = ("none", "optional", "required")
    kinds = {n: _kinds(settings[n]) if n in settings else () for n in ("target", "second")}
    target, second = word("target", "none", needs), word("second", "none", needs)
    travel = word("travel", "walk", TRAVELS)
    turn = settings["turn"].value_angle(0) if "turn" in settings else 0.0
    for flag in {"hold", "mutual"} & {*settings}:
        settings[flag].values()
    posture, example, also = (settings.get(name) for name in ("posture", "example", "also"))
    others = () if also is None else tuple(also.value_word(i, "") for i in range(also.count))
    return ActionDef(
        definition.name.text, (), definition.span, target, kinds["target"], second, kinds["second"],
        travel, word("sit", "keep", ("down", "up", "keep")),
        word("needs", "none", ("none", "target", "second", "any")),
        word("faces", "none", ("none", "target", "second")), turn, "along" in settings, variants,
        posture=word("posture", "", POSTURES),
        posture_time=posture.seconds("in", 0.0) if posture is not None else 0.0,
        rises=posture.flag("back") if posture is not None else False,
        apart=settings["apart"].value_length(0) if "apart" in settings else 0.0,
        against=settings["against"].value_length(0) if "against" in settings else 0.0,
        mutual="mutual" in settings,
        feeling=word("feeling", "", tuple(FEELINGS)),
        group=word("group", "", GROUPS),
        example=example.value_text(0) if example is not None else "",
        props=example.words("with") if example is not None else (),
        needs_hand=settings["needs"].word("in", "", ("left", "right")) if "needs" in settings else "",
        goes="travel" in settings and travel != "none",
        also=tuple(word for word in others if word),
        otherwise=settings["target"].words("otherwise") if "target" in settings else (),
        anything=settings["target"].flag("anything") if "target" in settings else False,
        brings=settings["brings"].value_word(0, "") if "brings" in settings else "",
        brings_at=next((value.span for value in settings["brings"].entry.values), None)
        if "brings" in settings
        else None,
        unless_held=settings["brings"].word("unless", "", ("held",)) != "" if "brings" in settings else False,
        someone=settings["someone"].value_word(0, "") if "someone" in settings else "",
        alone=settings["alone"].value_word(0, "") if "alone" in settings else "",
        others_at=tuple((n, settings[n].entry.span) for n in ("someone", "alone") if n in settings),
    )  # fmt: skip


def _gait(reader: Reader | None, base: GaitDef | None = None) -> GaitDef:
    """``gait lift 10cm, sway 5deg, facing back``: on top of what the action says already."""
    base = base if base is not None else GaitDef()
    if reader is None:
        return base
    values, facing = dict(base.values), base.facing
    sides = ("ahead", "back", "left", "right")
    if reader.count:  # the first pair stands as values, the rest as options
        first = reader.value_word(0, None, (*GAIT, "facing"))
        if first == "facing":
            facing = reader.value_word(1, None, sides) or facing
        elif first:
            values[first] = getattr(reader, f"value_{GAIT[first][0]}")(1)
    for name, (kind, _) in GAIT.items():
        value = getattr(reader, kind)(name, None)
        if value is not None:
            values[name] = value
    return GaitDef(tuple(sorted(values.items())), reader.word("facing", facing, sides))


def _kinds(reader: Reader) -> tuple[str, ...]:
    """``target optional character object``: the words after the first, all three where none is said."""
    found = tuple(reader.value_word(i, "object", TARGET_KINDS) for i in range(1, reader.count))
    return found or TARGET_KINDS


def _share(reader: Reader | None) -> float:
    return 1.0 if reader is None else reader.value_number(0, 1.0)


def _partner(reader: Reader | None, duration: float, report: Report) -> Part:
    return Part() if reader is None else read_part(reader.body(), duration, report)


def _variant(reader: Reader, plain: VariantDef, base: tuple[ast.Entry, ...], report: Report) -> VariantDef:
    """``variant big { amplitude 130%; tempo 90%; … }``: changes of the plain one, and entries of its own."""
    name = reader.value_word(0)
    changes: dict[str, Reader] = {}
    moves = []
    for entry in reader.body():
        if entry.head.text in CHANGES:
            changes[entry.head.text] = Reader(entry, {}, report)
        elif entry.head.text in MOVES:
            moves.append(entry)
        else:
            unknown_entry(entry, (*CHANGES, *MOVES), "a variant", report)
    duration = changes["duration"].value_seconds(0, 2.0) if "duration" in changes else plain.duration
    kept = () if "instead" in changes else base
    part = read_part((*kept, *moves), duration, report)
    partner = _partner(changes["partner"], duration, report) if "partner" in changes else plain.partner
    amplitude, tempo = _share(changes.get("amplitude")), _share(changes.get("tempo"))
    part = replace(scaled(part, amplitude), hold=plain.part.hold)
    if "mirror" in changes:
        part = mirrored(part)
    stride = _share(changes["stride"]) if "stride" in changes else plain.stride
    cadence = _share(changes["cadence"]) if "cadence" in changes else plain.cadence
    gait = _gait(changes.get("gait"), plain.gait)
    for change in changes.values():
        change.done()
    return VariantDef(name, duration / max(tempo, 0.2), part, partner, stride, cadence, gait)
