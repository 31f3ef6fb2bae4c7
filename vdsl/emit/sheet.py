"""``sheet.png``: the contact sheet, one row a shot: what the script says, three keyframes, and the plan.

Arrows on the first keyframe show what moves: red the camera, white the people.

A long film goes on over ``sheet-2.png`` and so on, so that no picture gets too big to open.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from runtime.worker import Worker

from . import lettering
from .folder import write_bytes
from .overlay_arrows import arrowed
from .plan import plan_of, plan_picture
from .plan_ground import Plan
from .timeline import film_frames
from .types import Build, BuiltShot
from .video import key_frames
from .words import SHORT_SIZES, camera_words, line_words, seconds_words

SHOTS_PER_SHEET = 30
WIDTH, MARGIN, TEXT, GAP = 2000, 48, 372, 10
PAPER, INK, QUIET, RULE, ACCENT = "#f6f3ec", "#1b1c1f", "#6f6a61", "#d9d3c6", "#b3392b"
HEAD = 150
_NOTE = 24  # height of a line on what a cut breaks
_LEAST_ROW = 226
_AROUND = 92  # of a row's height, what is not for words on what happens
_PLAN_SHAPE, _LEAST_PLAN = 4 / 3, 200


def write_sheets(folder: Path, build: Build, worker: Worker) -> list[Path]:
    """Draw the sheet, or sheets; returns their paths in the folder, where the worker writes them."""
    shots = build.shots
    pages = [shots[i : i + SHOTS_PER_SHEET] for i in range(0, len(shots), SHOTS_PER_SHEET)] or [()]
    paths = []
    for number, page in enumerate(pages):
        path = folder / ("sheet.png" if number == 0 else f"sheet-{number + 1}.png")
        sheet = draw_sheet(build, page, number * SHOTS_PER_SHEET, (number + 1, len(pages)))
        worker.do(partial(_write_png, path, np.asarray(sheet)))
        paths.append(path)
    return paths


def _write_png(path: Path, picture: NDArray[np.uint8]) -> None:
    """Write a picture uint8 [H, W, 3], letting other threads run, as PIL does not."""
    done, content = cv2.imencode(".png", cv2.cvtColor(picture, cv2.COLOR_RGB2BGR))
    if not done:
        raise OSError(f"cannot write {path}: the picture cannot be encoded")
    write_bytes(path, content.tobytes())


def draw_sheet(build: Build, shots: tuple[BuiltShot, ...], first: int, page: tuple[int, int]) -> Image.Image:
    """One sheet of consecutive shots; ``first`` is the index of the first, ``page`` (number, count)."""
    cell = _cell(build)
    row = row_height(build)
    image = Image.new("RGB", (WIDTH, HEAD + row * max(1, len(shots)) + MARGIN // 2), PAPER)
    draw = ImageDraw.Draw(image)
    _draw_head(draw, build, page)
    for i, built in enumerate(shots):
        top = HEAD + i * row
        draw.line([(MARGIN, top), (WIDTH - MARGIN, top)], fill=RULE, width=2)
        _draw_words(draw, build, built, first + i + 1, top + 18)
        _draw_keys(image, draw, built, (MARGIN + TEXT, top + 20), cell, build.arrows)
        if build.grounds:
            _draw_plan(
                image, draw, plan_of(build, first + i), (WIDTH - MARGIN - _plan_width(cell), top + 20), cell
            )
        _draw_cuts(draw, build, built, top + row - _NOTE - 10)
    return image


def row_height(build: Build) -> int:
    """Pixels a shot takes on a sheet, the same for all of a film."""
    return max(_cell(build)[1], _LEAST_ROW) + 40 + _NOTE * bool(build.continuity)


def _cell(build: Build) -> tuple[int, int]:
    """The size of a keyframe: as wide as leaves room for the plan beside three of them."""
    room, shape = WIDTH - 2 * MARGIN - TEXT - 3 * GAP, build.storyboard.size[0] / build.storyboard.size[1]
    if not build.grounds:
        width = (room + GAP) / 3
    else:  # the plan is as high as a keyframe
        width = min(room / (3 + _PLAN_SHAPE / shape), (room - _LEAST_PLAN) / 3)
    return round(width), max(60, round(width / shape))


def _plan_width(cell: tuple[int, int]) -> int:
    return WIDTH - 2 * MARGIN - TEXT - 3 * (cell[0] + GAP)


def _draw_head(draw: ImageDraw.ImageDraw, build: Build, page: tuple[int, int]) -> None:
    board = build.storyboard
    title = lettering.shortened(board.title or "Untitled", 50, WIDTH - 2 * MARGIN - 560, bold=True)
    lettering.write(draw, (MARGIN, 88), title, 50, INK, "ls", bold=True)
    rate = board.fps[0] / board.fps[1]
    facts = [
        f"{len(build.shots)} shots",
        seconds_words(film_frames(build), board.fps),
        f"{rate:.3f}".rstrip("0").rstrip(".") + " fps",
        f"{board.size[0]} × {board.size[1]}",
    ]
    if page[1] > 1:
        facts.append(f"sheet {page[0]} of {page[1]}")
    lettering.write(draw, (WIDTH - MARGIN, 88), "   ·   ".join(facts), 22, QUIET, "rs")


def _draw_words(draw: ImageDraw.ImageDraw, build: Build, built: BuiltShot, number: int, top: float) -> None:
    """Number, place, what happens, what is said, and how it is filmed."""
    room = TEXT - 34
    lettering.write(draw, (MARGIN, top + 30), f"{number}", 42, ACCENT, "ls", bold=True)
    beside = MARGIN + lettering.width(f"{number}", 42, bold=True) + 14
    rest = MARGIN + room - beside
    place = f"{built.scene}, {build.storyboard.scenes[built.line.scene].time}"
    lettering.write(draw, (beside, top + 9), lettering.shortened(place, 19, rest), 19, INK, "ls")
    lettering.write(draw, (beside, top + 30), lettering.shortened(built.shot.id, 16, rest), 16, QUIET, "ls")
    y = top + 70
    for line in lettering.wrapped(line_words(built.line, built.scene), 27, room, 2, bold=True):
        lettering.write(draw, (MARGIN, y), line, 27, INK, "ls", bold=True)
        y += 31
    said = lettering.wrapped(f"“{built.shot.say}”", 19, room, 2) if built.shot.say else []
    left = int((row_height(build) - _AROUND - (y - top)) // 23) - len(said)
    noted = lettering.wrapped(built.shot.note, 19, room, min(left, 2)) if built.shot.note and left > 0 else []
    for line in [*said, *noted]:
        lettering.write(draw, (MARGIN, y - 4), line, 19, QUIET, "ls")
        y += 23
    foot = max(y + 6, top + 152)
    x = _draw_size(draw, built, (MARGIN, foot))
    words = lettering.shortened(_filmed(built), 21, MARGIN + room - x)
    lettering.write(draw, (x, foot), words, 21, ACCENT, "ls")
    lettering.write(
        draw, (MARGIN, foot + 28), lettering.shortened(_facts(build, built), 18, room), 18, QUIET, "ls"
    )


def _draw_size(draw: ImageDraw.ImageDraw, built: BuiltShot, at: tuple[float, float]) -> float:
    """The size's short name on a plate; returns where the next word begins."""
    if not built.takes:
        return at[0]
    short = SHORT_SIZES.get(built.takes[0].camera.scale, built.takes[0].camera.scale)
    wide = lettering.width(short, 20, bold=True)
    draw.rounded_rectangle([at[0], at[1] - 20, at[0] + wide + 16, at[1] + 6], 5, fill=ACCENT)
    lettering.write(draw, (at[0] + 8, at[1]), short, 20, PAPER, "ls", bold=True)
    return at[0] + wide + 28


def _filmed(built: BuiltShot) -> str:
    """Movement and angle; what was asked where there is no take."""
    if not built.takes:
        return camera_words(built)
    camera = built.takes[0].camera
    view = {"ots": "over the shoulder", "pov": "point of view"}.get(built.shot.view, built.shot.view)
    return "  ·  ".join(filter(None, (camera.movement.replace("+", " + "), camera.angle, view)))


def _draw_cuts(draw: ImageDraw.ImageDraw, build: Build, built: BuiltShot, top: float) -> None:
    """What the cut into the shot breaks, below its pictures."""
    words = "   ·   ".join(c.text for c in build.into(built.shot.id))
    room = WIDTH - 2 * MARGIN - TEXT
    lettering.write(draw, (MARGIN + TEXT, top), lettering.shortened(words, 18, room), 18, ACCENT)


def _facts(build: Build, built: BuiltShot) -> str:
    if not built.takes:
        return f"no take: all {sum(built.rejected.values())} proposals rejected"
    best = built.takes[0]
    focal = best.camera.track.focal
    low, high = f"{focal.min():.0f}", f"{focal.max():.0f}"
    lens = low if low == high else f"{low}–{high}"
    length = seconds_words(built.frames, build.storyboard.fps)
    return f"{length}   ·   {lens} mm   ·   score {best.score:.2f}   ·   of {built.proposals}"


def _draw_keys(
    image: Image.Image,
    draw: ImageDraw.ImageDraw,
    built: BuiltShot,
    at: tuple[int, int],
    cell: tuple[int, int],
    arrows: bool,
) -> None:
    """Three keyframes; on the first, arrows for what moves from there, where they are wanted."""
    for k in range(3):
        x = at[0] + k * (cell[0] + GAP)
        box = [x - 1, at[1] - 1, x + cell[0], at[1] + cell[1]]
        if built.takes:
            key = built.takes[0].media.keys[k]
            picture = Image.fromarray(
                np.asarray(cv2.resize(key, cell, interpolation=cv2.INTER_AREA), np.uint8)
            )
            if k == 0 and arrows:
                picture = arrowed(picture, built.takes[0], key_frames(built.frames)[0])
            image.paste(picture, (x, at[1]))
            draw.rectangle(box, outline=INK, width=1)
        else:
            draw.rectangle(box, outline=RULE, width=2)


def _draw_plan(
    image: Image.Image, draw: ImageDraw.ImageDraw, plan: Plan, at: tuple[int, int], cell: tuple[int, int]
) -> None:
    """The plan, as high as the keyframes where there is room for that."""
    width = min(_plan_width(cell), round(cell[1] * _PLAN_SHAPE))
    picture = plan_picture(plan, width)
    image.paste(picture, (WIDTH - MARGIN - width, at[1]))
    draw.rectangle(
        [WIDTH - MARGIN - width, at[1] - 1, WIDTH - MARGIN, at[1] + picture.height], outline=RULE, width=1
    )
