"""Shots in words, and moments as timecodes: what people read on the page, the sheet and the strip."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..lang.ir import Beat, Shot, StoryLine
from ..lang.pronouns import ALL, BOTH, ONE, OWNERS, owner

if TYPE_CHECKING:
    from .types import BuiltShot


def beat_words(beat: Beat) -> str:
    """What somebody does, as the script says it: ``anna gives ben the cup``; of what no script says, ``anna
    give cup to ben``, without a target that goes without saying."""
    if beat.said:
        return beat.said
    said = beat.span.text.strip().removeprefix("(").removesuffix(")").split()
    if beat.who is not None:
        said = [*beat.who.text.split(), *said]
    first, *_ = several = [word.rstrip(",.:;!?…").casefold() for word in said[:6]]
    name = beat.character.casefold()
    if first in ONE and said[1:2] != ["and"]:
        return " ".join((beat.character, *said[1:]))
    if first in OWNERS:
        return " ".join((f"{beat.character}'s", *said[1:]))  # `her hands tremble`
    if (owner(first) or first) in (name, "the", *BOTH, *ALL) or "and" in said[1:2] or name in several:
        return " ".join(said)
    words = [beat.character, beat.action]
    if beat.target is not None and not beat.target.implied:
        words.append(beat.target.written)
    if beat.second is not None:
        words += ["to", beat.second.written]
    return " ".join(words)


def line_words(line: StoryLine, scene: str) -> str:
    """What happens, in the script's own words; the scene's name for an establishing shot."""
    return " + ".join(dict.fromkeys(beat_words(b) for b in line.beats)) or f"{scene}, establishing"


#: What sizes are called in the margin of a storyboard.
SHORT_SIZES = {
    "extreme-close-up": "ECU", "big-close-up": "BCU", "close-up": "CU", "medium-close-up": "MCU",
    "medium": "MS", "cowboy": "CS", "medium-long": "MLS", "full": "FS", "wide": "WS", "extreme-wide": "EWS",
}  # fmt: skip


def asked_words(shot: Shot) -> str:
    """``follow full eye-level``, with ``*`` where all and ``a|b`` where several may be proposed."""
    return " ".join("|".join(w) if len(w) <= 3 else "*" for w in (shot.movements, shot.scales, shot.angles))


def camera_words(built: BuiltShot) -> str:
    """The best take's movement, size and angle; what was asked where there is no take."""
    if not built.takes:
        return asked_words(built.shot)
    camera = built.takes[0].camera
    return f"{camera.movement} {camera.scale} {camera.angle}"


def timecode(frame: int, fps: tuple[int, int]) -> str:
    """``HH:MM:SS:FF`` of a frame, non-drop, counted at the rounded rate as editing software does."""
    rate = max(1, round(fps[0] / fps[1]))
    seconds, rest = divmod(frame, rate)
    return f"{seconds // 3600:02d}:{seconds // 60 % 60:02d}:{seconds % 60:02d}:{rest:02d}"


def seconds_words(frames: int, fps: tuple[int, int]) -> str:
    """``3.2 s``."""
    return f"{frames * fps[1] / fps[0]:.1f} s"
