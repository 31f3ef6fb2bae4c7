"""Timelines of actions: poses, reaches and looks at their times, from entries to numbers.

Assumes parsed entries. Guarantees that a mistake is reported at its place and left out; that times are
shares of the clip (0..1) in rising order; that angles are radians and lengths metres. The words are
those of the tables here; what they do is the engine's (``runtime.motion``).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

from runtime.motion.words import GAZES, HANDS, PARTNER_PLACES, REACHABLE

from .. import ast
from ..diagnostics import Report
from ..evaluate import evaluate
from .reader import Reader, unknown_entry

PALMS = ("side", "down", "up", "ahead")
LEADS = ("palm", "point")
#: Parts there are one of, and their axes with the kind of value.
CENTRE: dict[str, dict[str, str]] = {
    "body": {"lean": "angle", "side": "angle", "twist": "angle", "bow": "angle"},
    "head": {"nod": "angle", "turn": "angle", "tilt": "angle"},
    "eyes": {"turn": "angle", "down": "angle"},
    "lids": {"close": "number"},
    "hips": {"drop": "length", "shift": "length", "forward": "length", "turn": "angle"},
    "mouth": {"smile": "number"},
    "jaw": {"open": "number"},
    "knees": {"spread": "angle"},
}
#: Parts there are two of.
SIDED: dict[str, dict[str, str]] = {
    "arm": {"swing": "angle", "out": "angle", "twist": "angle", "bend": "angle", "wrist": "angle",
            "side": "angle", "turn": "angle"},
    "fingers": {"curl": "number", "point": "number", "thumb": "number"},
    "shoulder": {"up": "angle", "forward": "angle"},
    "brow": {"up": "number", "knit": "number"},
    "foot": {"forward": "length", "out": "length", "lift": "length", "pitch": "angle"},
    "hand": {"ahead": "length", "out": "length", "above": "length"},
    "wield": {"pitch": "angle", "inward": "angle", "roll": "angle", "grip": "angle"},
}  # fmt: skip
#: Poses that replace the resting one rather than add to it, and what their axes are until said.
POSED: dict[str, dict[str, float]] = {
    "arm": {"swing": 0.1, "out": 0.2, "twist": 0.2, "bend": 0.3, "wrist": 0.1, "side": 0.0, "turn": 0.3},
    "fingers": {"curl": 0.3, "point": 0.0, "thumb": 0.0},
    "wield": {"pitch": 0.0, "inward": 0.0, "roll": 0.0, "grip": 1.05},
}
LATERAL = frozenset({"body.side", "body.twist", "head.turn", "head.tilt", "eyes.turn", "hips.shift",
                     "hips.turn"})  # fmt: skip
MOVES = ("at", "beat", "reach", "take", "put", "pass", "throw", "send", "tip", "gaze", "talk", "step", "jump",
         "drive")  # fmt: skip
#: Moves in which numbers change their sign when an action is mirrored: their places.
_MIRRORED = {"step": (2,), "jump": (2, 3)}


@dataclass(frozen=True)
class Key:
    """A channel's value at a time."""

    channel: str
    time: float
    value: float


@dataclass(frozen=True)
class Move:
    """Anything with a span in time: ``kind`` is one of :data:`MOVES`, without ``at``.

    times: rising shares of the clip; one for take, put, pass, throw and send, four for reach and tip (leaves,
        is there, leaves again, is back), two for the others
    words: what it is about: channel / hand, place, palm and lead / hand / place;
        numbers: amplitude, count … by kind
    """

    kind: str
    times: tuple[float, ...]
    words: tuple[str, ...]
    numbers: tuple[float, ...] = ()


@dataclass(frozen=True)
class Part:
    """What one person does: keys and moves. hold: whether the last pose stays."""

    keys: tuple[Key, ...] = ()
    moves: tuple[Move, ...] = ()
    hold: bool = False


def read_part(entries: tuple[ast.Entry, ...], duration: float, report: Report) -> Part:
    """The keys and moves of a body."""
    keys: list[Key] = []
    moves: list[Move] = []
    for entry in entries:
        head = entry.head.text
        reader = Reader(entry, {}, report)
        if head == "at":
            keys.extend(_keys(reader, duration, report))
        elif head in MOVES:
            move = _move(reader, head, duration)
            if move is not None:
                moves.append(move)
        else:
            unknown_entry(entry, MOVES, "a timeline", report)
            continue
        reader.done()
    return Part(tuple(keys), tuple(moves))


def _time(reader: Reader, value: ast.Value | None, duration: float, default: float) -> float:
    """A share of the clip, from ``30%`` or ``0.8s``."""
    if value is None:
        return default
    seconds = isinstance(value, ast.Number) and value.unit == "s"
    if isinstance(value, ast.Number) and value.unit is None and value.value != 0:
        reader.report.error("VDS142", value.span, label="a time in an action is a share of it, or seconds",
                            help="write 30% or 0.8s")  # fmt: skip
        return default
    got = evaluate(value, {}, "seconds" if seconds else "number", reader.report)
    if not isinstance(got, float):
        return default
    share = got / duration if seconds and duration > 0 else got
    if not -1e-6 <= share <= 1.0 + 1e-6:
        reader.report.error("VDS143", value.span, label="this is outside the action's duration",
                            help=f"the action goes from 0% to 100%, {duration:g}s")  # fmt: skip
        return default
    return min(max(share, 0.0), 1.0)


def _option_time(reader: Reader, name: str, duration: float, default: float) -> float:
    values = reader.option(name)
    return _time(reader, values[0] if values else None, duration, default)


def _keys(reader: Reader, duration: float, report: Report) -> Iterator[Key]:
    """``at 30% { arm right swing 60deg, out 20deg; head nod 5deg }``"""
    time = _time(reader, reader.value(0), duration, 0.0)
    for entry in reader.body():
        pose = Reader(entry, {}, report)
        part = entry.head.text
        if part not in CENTRE and part not in SIDED:
            unknown_entry(entry, (*CENTRE, *SIDED), "a pose", report)
            continue
        place = 1 if part in SIDED else 0
        hands = _hands(pose, part) if part in SIDED else ("",)
        axes = SIDED.get(part) or CENTRE[part]
        values = _axis_values(pose, axes, place)
        for hand in hands:
            prefix = f"{part}_{hand}." if hand else f"{part}."
            if part in POSED:
                yield Key(prefix + "weight", time, 0.0 if "rest" in values else 1.0)
            elif "rest" in values:
                values = {axis: 0.0 for axis in axes}
            for axis, value in values.items():
                if axis != "rest":
                    yield Key(prefix + axis, time, value)
        pose.done()


def _hands(reader: Reader, part: str) -> tuple[str, ...]:
    words = ("left", "right", "both") if part in ("brow", "foot") else (*HANDS, "both")
    word = reader.value_word(0, None, words)
    return ("left", "right") if word in ("both", "") else (word,)


def _axis_values(reader: Reader, axes: dict[str, str], place: int) -> dict[str, float]:
    """``swing 60deg, out 20deg``: the first pair stands as values, the rest as options."""
    found: dict[str, float] = {}
    if reader.count > place:
        axis = reader.value_word(place, None, (*axes, "rest"))
        if axis == "rest":
            return {"rest": 1.0}
        if axis:
            found[axis] = reader._value_number(place + 1, None, axes[axis], "a value")
    for axis, kind in axes.items():
        value = reader._number(axis, None, kind)
        if value is not None:
            found[axis] = value
    return found


def _move(reader: Reader, kind: str, duration: float) -> Move | None:
    def when(name: str, default: float) -> float:
        return _option_time(reader, name, duration, default)

    if kind == "send":
        return Move(kind, (when("at", 0.5),), ("near",))
    if kind in ("take", "put", "pass", "throw"):
        return Move(kind, (when("at", 0.5),), (reader.value_word(0, "near", HANDS),))
    if kind == "gaze":
        to = reader.value_word(0, None, GAZES)
        times = _rising(reader, when("from", 0.0), when("to", 1.0))
        return Move(kind, times, (to,), (reader.number("head", 0.7),)) if to else None
    if kind == "talk":
        return Move(
            kind, _rising(reader, when("from", 0.0), when("to", 1.0)), (), (reader.number("loud", 1.0),)
        )
    if kind == "beat":
        return _beat(reader, _rising(reader, when("from", 0.0), when("to", 1.0)))
    if kind in ("step", "jump", "drive"):
        return _footwork(reader, kind, _rising(reader, when("from", 0.0), when("to", 1.0)))
    start = when("from", 0.0)
    arrive = when("at", min(start + 0.3, 1.0))
    leave = when("until", max(arrive, 0.7))
    times = _rising(reader, start, arrive, leave, when("back", 1.0))
    hand = reader.value_word(0, None, HANDS)
    if kind == "tip":
        return Move(kind, times, (hand,), (reader.value_angle(1),)) if hand else None
    to = reader.value_word(1, None, REACHABLE)
    if to == "partner":
        part = reader.value_word(2, None, PARTNER_PLACES)
        to = f"partner.{part}" if part else ""
    palm = reader.word("palm", "side", PALMS)
    numbers = [reader.length(n, 0.0) for n in ("ahead", "out", "above", "shake")]
    numbers += [reader.number("times", 3.0 if numbers[3] else 0.0), reader.length("along", 0.0)]
    lead = reader.word("lead", "palm", LEADS)
    return Move(kind, times, (hand, to, palm, lead), tuple(numbers)) if hand and to else None


def _footwork(reader: Reader, kind: str, times: tuple[float, ...]) -> Move | None:
    """``step left, ahead 40cm``, ``jump 30cm, ahead 1m`` and ``drive target 100%``."""
    if kind == "step":
        foot = reader.value_word(0, None, ("left", "right"))
        numbers = [reader.length("ahead", 0.0), reader.length("out", 0.0), reader.angle("turn", 0.0)]
        return Move(kind, times, (foot,), (*numbers, reader.length("lift", 0.0))) if foot else None
    if kind == "jump":
        height = reader.value_length(0, 0.0)
        feet = reader.word("on", "both", ("both", "left", "right"))
        along = [reader.length(n, 0.0) for n in ("ahead", "aside")]
        return Move(
            kind, times, (feet,), (height, *along, reader.angle("turn", 0.0), reader.length("tuck", 0.0))
        )
    to = reader.value_word(0, None, ("target", "second"))
    return Move(kind, times, (to,), (reader.value_number(1),)) if to else None


def _beat(reader: Reader, times: tuple[float, ...]) -> Move | None:
    """``beat arm right twist 25deg, times 3, from 20%, to 80%``"""
    part = reader.value_word(0, None, (*CENTRE, *SIDED))
    if not part:
        return None
    sided = part in SIDED
    hand = reader.value_word(1, None, HANDS) if sided else ""
    axes = SIDED.get(part) or CENTRE[part]
    axis = reader.value_word(2 if sided else 1, None, axes)
    if not axis or (sided and not hand):
        return None
    amplitude = reader._value_number(3 if sided else 2, None, axes[axis], "a value")
    channel = f"{part}_{hand}.{axis}" if sided else f"{part}.{axis}"
    return Move(
        "beat", times, (channel,), (amplitude, reader.number("times", 2.0), reader.number("phase", 0.0))
    )


def _rising(reader: Reader, *times: float) -> tuple[float, ...]:
    if any(b < a for a, b in pairwise(times)):
        shown = ", ".join(f"{100 * t:g}%" for t in times)
        reader.report.error("VDS144", reader.span, label="these times do not follow one another",
                            help=f"they come out as {shown}")  # fmt: skip
        return tuple(sorted(times))
    return times


def scaled(part: Part, amplitude: float) -> Part:
    """Bigger or smaller: poses away from rest, and beats, by ``amplitude``."""
    if amplitude == 1.0:
        return part
    keys = tuple(
        replace(k, value=rest + (k.value - rest) * amplitude)
        for k in part.keys
        for rest in (_resting(k.channel),)
        if rest is not None
    )
    kept = tuple(k for k in part.keys if _resting(k.channel) is None)
    moves = tuple(
        replace(m, numbers=(m.numbers[0] * amplitude, *m.numbers[1:])) if m.kind == "beat" else m
        for m in part.moves
    )
    return replace(part, keys=kept + keys, moves=moves)


def _resting(channel: str) -> float | None:
    """A channel's value at rest; None where amplitude has no meaning."""
    head, axis = channel.split(".")
    part = head.partition("_")[0]
    if axis == "weight" or part in ("fingers", "wield"):
        return None
    return POSED.get(part, {}).get(axis, 0.0)


def mirrored(part: Part) -> Part:
    """Left for right."""
    swap = {"left": "right", "right": "left"}

    def channel(name: str) -> str:
        head, axis = name.split(".")
        what, _, hand = head.partition("_")
        return f"{what}_{swap.get(hand, hand)}.{axis}" if hand else name

    keys = tuple(
        Key(channel(k.channel), k.time, -k.value if k.channel in LATERAL else k.value) for k in part.keys
    )
    moves = []
    for m in part.moves:
        if m.kind == "beat":
            sign = -1.0 if m.words[0] in LATERAL else 1.0
            moves.append(
                replace(m, words=(channel(m.words[0]),), numbers=(sign * m.numbers[0], *m.numbers[1:]))
            )
        else:
            numbers = tuple(-x if k in _MIRRORED.get(m.kind, ()) else x for k, x in enumerate(m.numbers))
            moves.append(replace(m, words=tuple(swap.get(w, w) for w in m.words), numbers=numbers))
    return replace(part, keys=keys, moves=tuple(moves))
