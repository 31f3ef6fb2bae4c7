"""``sheet.png``: the contact sheet, one row a shot with three keyframes and what the script says.

A long film goes on over ``sheet-2.png`` and so on, so that no picture gets too big to open.
"""

from __future__ import annotations

import io
from pathlib import Path

import cv2
import numpy as np
from PIL import Image, ImageDraw

from . import lettering
from .folder import write_bytes
from .timeline import film_frames
from .types import Build, BuiltShot
from .words import camera_words, line_words, seconds_words

SHOTS_PER_SHEET = 30
WIDTH, MARGIN, TEXT, GAP = 1800, 48, 372, 10
PAPER, INK, QUIET, RULE, ACCENT = "#f6f3ec", "#1b1c1f", "#6f6a61", "#d9d3c6", "#b3392b"
HEAD = 150
_NOTE = 24  # height of a line on what a cut breaks


def write_sheets(folder: Path, build: Build) -> list[Path]:
    """Write the sheet, or sheets, into the folder; returns their paths."""
    shots = build.shots
    pages = [shots[i : i + SHOTS_PER_SHEET] for i in range(0, len(shots), SHOTS_PER_SHEET)] or [()]
    paths = []
    for number, page in enumerate(pages):
        path = folder / ("sheet.png" if number == 0 else f"sheet-{number + 1}.png")
        buffer = io.BytesIO()
        draw_sheet(build, page, number * SHOTS_PER_SHEET, (number + 1, len(pages))).save(buffer, "PNG")
        write_bytes(path, buffer.getvalue())
        paths.append(path)
    return paths


def draw_sheet(build: Build, shots: tuple[BuiltShot, ...], first: int, page: tuple[int, int]) -> Image.Image:
    """One sheet of consecutive shots; ``first`` is the index of the first, ``page`` (number, count)."""
    cell_w = (WIDTH - 2 * MARGIN - TEXT - 2 * GAP) // 3
    cell_h = max(60, round(cell_w * build.storyboard.size[1] / build.storyboard.size[0]))
    row = max(cell_h, 196) + 40 + _NOTE * any(build.into(built.shot.id) for built in shots)
    image = Image.new("RGB", (WIDTH, HEAD + row * max(1, len(shots)) + MARGIN // 2), PAPER)
    draw = ImageDraw.Draw(image)
    _draw_head(draw, build, page)
    for i, built in enumerate(shots):
        top = HEAD + i * row
        draw.line([(MARGIN, top), (WIDTH - MARGIN, top)], fill=RULE, width=2)
        _draw_words(draw, build, built, first + i + 1, top + 18)
        _draw_keys(image, draw, built, (MARGIN + TEXT, top + 20), (cell_w, cell_h))
        _draw_cuts(draw, build, built, top + row - _NOTE - 10)
    return image


def _draw_head(draw: ImageDraw.ImageDraw, build: Build, page: tuple[int, int]) -> None:
    board = build.storyboard
    title = lettering.shortened(board.title or "Untitled", 46, WIDTH - 2 * MARGIN - 500)
    lettering.write(draw, (MARGIN, 46), title, 46, INK)
    rate = board.fps[0] / board.fps[1]
    facts = [
        f"{len(build.shots)} shots",
        seconds_words(film_frames(build), board.fps),
        f"{rate:.3f}".rstrip("0").rstrip(".") + " fps",
        f"{board.size[0]} x {board.size[1]}",
    ]
    if page[1] > 1:
        facts.append(f"sheet {page[0]} of {page[1]}")
    lettering.write(draw, (WIDTH - MARGIN, 84), "   ·   ".join(facts), 20, QUIET, "rs")


def _draw_words(draw: ImageDraw.ImageDraw, build: Build, built: BuiltShot, number: int, top: float) -> None:
    room = TEXT - 34
    lettering.write(draw, (MARGIN, top), f"{number}", 34, ACCENT)
    beside = MARGIN + lettering.width(f"{number}", 34) + 14
    lettering.write(draw, (beside, top + 1), lettering.shortened(built.scene, 17, room - 50), 17, INK)
    lettering.write(draw, (beside, top + 21), lettering.shortened(built.shot.id, 14, room - 50), 14, QUIET)
    y = top + 54
    for line in lettering.wrapped(line_words(built.line, built.scene), 24, room, 2):
        lettering.write(draw, (MARGIN, y), line, 24, INK)
        y += 30
    if built.shot.say:
        for line in lettering.wrapped(f"“{built.shot.say}”", 17, room, 2):
            lettering.write(draw, (MARGIN, y + 2), line, 17, QUIET)
            y += 22
    y += 8
    lettering.write(draw, (MARGIN, y), lettering.shortened(camera_words(built), 18, room), 18, ACCENT)
    lettering.write(draw, (MARGIN, y + 26), _facts(build, built), 15, QUIET)


def _draw_cuts(draw: ImageDraw.ImageDraw, build: Build, built: BuiltShot, top: float) -> None:
    """What the cut into the shot breaks, below its pictures."""
    words = "   ·   ".join(c.text for c in build.into(built.shot.id))
    words = words.replace("→", " to ").replace("–", " and ")  # the sheet's letters have neither
    room = WIDTH - 2 * MARGIN - TEXT
    lettering.write(draw, (MARGIN + TEXT, top), lettering.shortened(words, 16, room), 16, ACCENT)


def _facts(build: Build, built: BuiltShot) -> str:
    if not built.takes:
        return f"no take: all {sum(built.rejected.values())} proposals rejected"
    best = built.takes[0]
    focal = best.camera.track.focal
    low, high = f"{focal.min():.0f}", f"{focal.max():.0f}"
    lens = low if low == high else f"{low}-{high}"
    length = seconds_words(built.frames, build.storyboard.fps)
    return f"{length}   ·   {lens} mm   ·   score {best.score:.2f}   ·   of {built.proposals}"


def _draw_keys(
    image: Image.Image,
    draw: ImageDraw.ImageDraw,
    built: BuiltShot,
    at: tuple[int, int],
    cell: tuple[int, int],
) -> None:
    for k in range(3):
        x = at[0] + k * (cell[0] + GAP)
        box = [x - 1, at[1] - 1, x + cell[0], at[1] + cell[1]]
        if built.takes:
            key = built.takes[0].media.keys[k]
            picture = np.asarray(cv2.resize(key, cell, interpolation=cv2.INTER_AREA), np.uint8)
            image.paste(Image.fromarray(picture), (x, at[1]))
            draw.rectangle(box, outline=INK, width=1)
        else:
            draw.rectangle(box, outline=RULE, width=2)
