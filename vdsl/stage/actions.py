"""Text actions into clips: :func:`build_clip`.

Assumes a checked :class:`ActionDef`. Guarantees tracks with rising times that start and end at rest
unless the action holds its last pose.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

from runtime.motion.timeline import (
    Beat,
    Drive,
    FootMove,
    Gaze,
    Grasp,
    Jump,
    Reach,
    Talk,
    Tilt,
    Timeline,
    Track,
)
from runtime.motion.types import ActionClip, GaitStyle, Variant
from vdsl.lang.definitions.action import ActionDef, GaitDef
from vdsl.lang.definitions.files import FileActionDef
from vdsl.lang.definitions.timeline import POSED, Key, Move, Part

from .models import file_motion

GRASPS = ("take", "put", "pass", "throw", "send")


def build_clip(action: ActionDef) -> ActionClip:
    """The clip of an action, with all its variants."""
    variants = tuple(
        Variant(
            v.name, v.duration, timeline(v.part), timeline(v.partner), (v.stride, v.cadence), _gait(v.gait)
        )
        for v in action.variants
    )
    clip = ActionClip(
        action.name,
        variants,
        action.travel,
        action.sit,
        action.needs,
        action.faces,
        action.turn,
        action.along,
        action.feeling,
        action.posture,
        action.posture_time,
        action.rises,
        action.apart,
        action.needs_hand,
        any(v.part.hold for v in action.variants),
        goes=action.goes,
        against=action.against,
        roams=action.group == "going"
        and action.travel != "none"
        and action.sit == "keep"
        and not action.turn,
    )
    return with_capture(clip, action) if isinstance(action, FileActionDef) else clip


def with_capture(clip: ActionClip, action: FileActionDef) -> ActionClip:
    """The clip playing its file's motion, as long as that is where the action does not say."""
    capture = file_motion(action)
    seconds = (len(capture.turns) - 1) / capture.fps
    variants = tuple(replace(v, duration=v.duration or seconds) for v in clip.variants)
    return replace(clip, variants=variants, capture=capture)


def _gait(gait: GaitDef) -> GaitStyle:
    return GaitStyle(**dict(gait.values), facing=gait.facing)


def timeline(part: Part) -> Timeline:
    """Keys gathered into tracks, moves sorted by kind."""
    by_kind: dict[str, list[Move]] = defaultdict(list)
    for move in part.moves:
        by_kind[move.kind].append(move)
    return Timeline(
        tracks=_tracks(part.keys, part.hold),
        beats=tuple(
            Beat(m.words[0], m.numbers[0], m.numbers[1], m.times[0], m.times[1], m.numbers[2])
            for m in by_kind["beat"]
        ),
        reaches=tuple(_reach(m) for m in by_kind["reach"]),
        grasps=tuple(Grasp(m.kind, m.words[0], m.times[0]) for k in GRASPS for m in by_kind[k]),
        tilts=tuple(_tilt(m) for m in by_kind["tip"]),
        gazes=tuple(Gaze(m.words[0], m.times[0], m.times[1], m.numbers[0]) for m in by_kind["gaze"]),
        talks=tuple(Talk(m.times[0], m.times[1], m.numbers[0]) for m in by_kind["talk"]),
        drives=tuple(Drive(m.words[0], m.numbers[0], m.times[0], m.times[1]) for m in by_kind["drive"]),
        steps=tuple(FootMove(m.words[0], *m.times, *m.numbers) for m in by_kind["step"]),
        jumps=tuple(Jump(m.words[0], *m.times, *m.numbers) for m in by_kind["jump"]),
    )


def _reach(move: Move) -> Reach:
    hand, to, palm, lead = move.words
    start, arrive, leave, end = move.times
    ahead, out, above, shake, times, along = move.numbers
    return Reach(hand, to, start, arrive, leave, end, (ahead, out, above), palm, shake, times, along, lead)


def _tilt(move: Move) -> Tilt:
    start, arrive, leave, end = move.times
    return Tilt(move.words[0], move.numbers[0], start, arrive, leave, end)


def _tracks(keys: tuple[Key, ...], hold: bool) -> tuple[Track, ...]:
    """One track a channel. Additive channels and pose weights begin and end at 0; pose axes keep their
    first and last value, their defaults where the pose is given without them."""
    by_channel: dict[str, dict[float, float]] = defaultdict(dict)
    for key in keys:
        by_channel[key.channel][key.time] = key.value
    for channel in list(by_channel):
        head, axis = channel.split(".")
        if axis == "weight":
            for other, default in POSED[head.partition("_")[0]].items():
                by_channel.setdefault(f"{head}.{other}", {0.0: default})
    tracks = []
    for channel in sorted(by_channel):
        head, axis = channel.split(".")
        found = by_channel[channel]
        if axis == "weight" or head.partition("_")[0] not in POSED:
            found.setdefault(0.0, 0.0)
            if not hold:
                found.setdefault(1.0, 0.0)
        times = tuple(sorted(found))
        tracks.append(Track(channel, times, tuple(found[t] for t in times)))
    return tuple(tracks)
