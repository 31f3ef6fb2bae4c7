"""Keyframes for a comparison: from a build of the very script, else drawn quickly from its best proposals.

Assumes checked storyboards. Guarantees pictures of only those shots that are not the same on both sides, and
that a build is trusted only where it was made of the script as it stands.
"""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from ..emit.storyboard_json import SCHEMA, script_digest
from ..emit.templating import rendered
from ..emit.video import key_frames
from ..lang.ir import Storyboard
from ..propose.story import propose
from .compare import Comparison, ShotChange
from .compare_sides import Side
from .compile import Act, stage_acts
from .filming import Camerawork
from .judging import GeometryJudge
from .script import Checked

#: Proposals a shot for a draft: enough that the best one is a fair picture of what the words say.
PROPOSALS = 16
WIDTH = 480

Stills = dict[str, tuple[str, ...]]


def comparison_page(
    found: Comparison,
    sides: tuple[Side, Side],
    checked: Sequence[Checked],
    summary: str,
    device: str = "auto",
) -> str:
    """The comparison as one page with its pictures in it."""
    ids = ({s.before.id for s in found.changed if s.before}, {s.after.id for s in found.changed if s.after})
    stills = [
        stills_of(c, some, Path("build") / side.path.stem, device)
        for c, some, side in zip(checked, ids, sides, strict=True)
    ]
    rows = [_row(shot, stills) for shot in found.changed]
    names, board = [side.name for side in sides], [c.text for c in found.board]
    return rendered("compare.html.j2", names=names, board=board, rows=rows, summary=summary)


def _row(shot: ShotChange, stills: Sequence[Stills]) -> dict[str, Any]:
    """A shot as the template shows it."""
    here = shot.after or shot.before
    assert here is not None
    sides = [
        {"there": True, "words": facts.words, "stills": some.get(facts.id, ())}
        if facts
        else {"there": False, "words": "", "stills": ()}
        for facts, some in zip((shot.before, shot.after), stills, strict=True)
    ]
    told = shot.text.partition(": ")[2]
    return {"status": shot.status, "number": here.number, "words": here.words, "text": told, "sides": sides}


def stills_of(checked: Checked, shots: Collection[str], folder: Path, device: str = "auto") -> Stills:
    """Pictures of some shots by id, as data URLs; none of a shot that no camera can film.

    folder: where a build of the script may be: its posters are taken where it is of the script as it stands
    """
    if not shots:
        return {}
    built = _of_build(folder, checked.storyboard)
    found = {name: built[name] for name in shots if name in built}
    if len(found) < len(set(shots)):
        found |= _drafts(checked, set(shots) - set(found), device)
    return found


def _of_build(folder: Path, board: Storyboard) -> Mapping[str, tuple[str, ...]]:
    """Posters of the best takes of a build of this very script."""
    try:
        document = json.loads((folder / "storyboard.json").read_text("utf-8"))
        if document["schema"] != SCHEMA or document["script"] != script_digest(board):
            return {}
        takes = {s["id"]: s["takes"][0] for s in document["shots"] if s["takes"]}
        return {name: (_url(folder / take["poster"]),) for name, take in takes.items()}
    except (OSError, ValueError, KeyError, TypeError, IndexError):
        return {}


def _url(path: Path) -> str:
    with Image.open(path) as image:
        return _encoded(image.convert("RGB"))


def _encoded(image: Image.Image) -> str:
    if image.width > WIDTH:
        image = image.resize((WIDTH, round(image.height * WIDTH / image.width)), Image.Resampling.LANCZOS)
    buffer = io.BytesIO()
    image.save(buffer, "JPEG", quality=84)
    return "data:image/jpeg;base64," + base64.b64encode(buffer.getvalue()).decode("ascii")


def _drafts(checked: Checked, shots: Collection[str], device: str) -> Stills:
    """Three keyframes of each shot, by the best of a few proposals."""
    camerawork, out = Camerawork(device), dict[str, tuple[str, ...]]()
    width, height = checked.storyboard.size
    size = (WIDTH, max(2, round(WIDTH * height / width / 2) * 2))
    for act in stage_acts(checked):
        for shot in act.line.shots:
            if shot.id in shots and (drawn := _draft(act, shot.id, camerawork, size)):
                out[shot.id] = drawn
    return out


def _draft(act: Act, name: str, camerawork: Camerawork, size: tuple[int, int]) -> tuple[str, ...]:
    shot = next(s for s in act.line.shots if s.id == name)
    grid = propose(act.line, replace(shot, proposals=min(shot.proposals, PROPOSALS)), act.state, act.filming)
    if not grid.cameras:
        return ()
    camera = grid.cameras[int(np.argmax(GeometryJudge().scores(grid.cameras, None)))]
    story = next(s for s in grid.story if s.index == camera.story)
    at = np.array(key_frames(story.frames))
    drawn = camerawork.frames_at(act.staged, shot.style, story, camera, size, at)
    return tuple(_encoded(Image.fromarray(c)) for c in drawn)
