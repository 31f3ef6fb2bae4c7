"""What a shot depends on, as digests of text: its line, what happens before it in its scene, and definitions.

Assumes a checked storyboard. Guarantees the same digest for the same meaning, whatever the shot is called,
wherever its line and its scene stand, and on whatever machine; and another one where anything that could be
seen in the shot changes. Definitions count by their text where the script's own are reached by name, through
the library's where those lead to them; the library itself goes by its version.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from typing import Any

from ..lang.ir import Character, Scene, Shot, Storyboard, StoryLine
from ..library import Catalog

#: Of a shot, what cannot be seen in its takes; how many are proposed and kept is said apart.
_UNSEEN = frozenset({"id", "drawn", "line", "note", "proposals", "takes", "span"})


def digest(*parts: Any) -> str:
    """SHA-256 of values as canonical JSON."""
    told = json.dumps([plain(p) for p in parts], ensure_ascii=False, separators=(",", ":"))
    return hashlib.sha256(told.encode("utf-8", "surrogatepass")).hexdigest()


def plain(value: Any) -> Any:
    """Frozen values as JSON has them; places in the source are left out, and what is as it is by default, so
    that digests stay when a kind of value gets a further field."""
    if is_dataclass(value):
        held = [(f.name, getattr(value, f.name), f.default) for f in fields(value) if f.compare]
        return {name: plain(v) for name, v, default in held if v != default}
    if isinstance(value, dict):
        return {str(k): plain(v) for k, v in sorted(value.items())}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    return value


def people_of(scene: Scene, characters: Sequence[Character], lines: Sequence[StoryLine]) -> list[Character]:
    """Those of the cast who take part in a scene: placed there, acting, or acted upon."""
    beats = [b for line in lines for b in line.beats]
    targets = [t for b in beats for t in (b.target, b.second) if t and t.kind == "character"]
    present = {p.character for p in scene.placements} | {b.character for b in beats}
    present |= {t.path[0] for t in targets}
    return [c for c in characters if c.name in present]


def scene_lines(storyboard: Storyboard, number: int) -> list[StoryLine]:
    """The lines of a scene, in order."""
    return [line for line in storyboard.lines if line.scene == number]


def scene_text(storyboard: Storyboard, number: int, catalog: Catalog) -> str:
    """Digest of a scene as it opens: the set, the hour, who is there, and how pictures are taken."""
    scene = storyboard.scenes[number]
    people = people_of(scene, storyboard.characters, scene_lines(storyboard, number))
    # the rest shows only where a line takes it out
    held = [thing for thing in scene.carried if thing.held or thing.about]
    names = [scene.set, *(c.cast for c in people), *(thing.prop for thing in held)]
    board = (storyboard.fps, storyboard.rig, storyboard.size)
    return digest(
        board, scene.set, scene.room, scene.time, scene.placements, people, catalog.reached(names), *held
    )


def line_text(line: StoryLine, catalog: Catalog) -> str:
    """Digest of what happens on a line, as its first shot has it: by that the scene goes on."""
    first = line.shots[0] if line.shots else None
    how = None if first is None else [first.duration, first.speed, first.say, first.feelings]
    return digest(line.beats, how, catalog.reached(b.action for b in line.beats))


def shot_text(shot: Shot) -> str:
    """Digest of all that a shot's own words decide about its takes."""
    return digest({name: value for name, value in plain(shot).items() if name not in _UNSEEN})


def texts_before(storyboard: Storyboard, catalog: Catalog) -> list[str]:
    """Of every line, a digest of its scene as the texts before the line leave it, without any seed."""
    out: dict[int, str] = {}
    for number in range(len(storyboard.scenes)):
        lines = scene_lines(storyboard, number)
        if not lines:
            continue
        state = scene_text(storyboard, number, catalog)
        for line in lines:
            out[id(line)] = state
            state = digest(state, line_text(line, catalog))
    return [out[id(line)] for line in storyboard.lines]


def shot_digests(storyboard: Storyboard, catalog: Catalog) -> dict[str, str]:
    """Of every shot, by id, the short digest that a choice carries."""
    before = texts_before(storyboard, catalog)
    return {
        shot.id: digest(state, line_text(line, catalog), shot_text(shot))[:12]
        for line, state in zip(storyboard.lines, before, strict=True)
        for shot in line.shots
    }
