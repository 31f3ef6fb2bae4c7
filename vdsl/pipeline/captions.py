"""Words on pictures, and pictures put together: names where things are seen, rows, columns and grids."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from runtime.world import World

from ..emit import lettering
from ..stage.assemble import StagedScene
from .eyes import Eye, floor_area, seen_at

PAPER, INK, QUIET, PERSON, SPOT = "#f6f3ec", "#1b1c1f", "#6f6a61", "#b3392b", "#2f6f8f"
_MARGIN = 14


def write_names(image: Image.Image, eye: Eye, world: World, within: tuple[str, ...]) -> None:
    taken: list[tuple[float, float, float, float]] = []
    things = [o for o in world.objects if not within or o.path[: len(within)] == within]
    for thing in sorted(things, key=lambda o: (o.kind not in ("room", "area"), len(o.path), -floor_area(o))):
        if thing.kind in ("wall", "part"):
            continue
        room = thing.kind in ("room", "area")
        text = thing.path[-1].upper() if room else thing.path[-1]
        x, y, _ = thing.centre
        label(image, eye, (x, y, thing.high[2] if not room else thing.low[2]), text, INK if room else QUIET,
               17 if room else 12, taken)  # fmt: skip
        for spot in thing.spots if room else ():
            label(image, eye, spot.position, "· " + spot.name, SPOT, 12, taken)


def write_seen(image: Image.Image, ids: NDArray[np.int32], staged: StagedScene) -> None:
    """Names on people and things where they are seen."""
    people = {number: name for name, number in staged.object_ids.items()}
    draw = ImageDraw.Draw(image, "RGBA")
    taken: list[tuple[float, float, float, float]] = []
    numbers, counts = np.unique(ids[ids >= 0], return_counts=True)
    for number in sorted(numbers, key=lambda k: (k not in people, -counts[numbers == k][0])):
        who = people.get(int(number))
        thing = staged.world.objects[number] if who is None else None
        if thing is not None and (thing.kind in ("room", "area", "wall", "part") or len(thing.path) > 3):
            continue
        rows, columns = np.nonzero(ids == number)
        if len(rows) < 40:
            continue
        y = float(rows.min()) + 12 if who else float(np.median(rows))
        x = float(np.median(columns[rows < rows.min() + 40])) if who else float(np.median(columns))
        text = who or (thing.path[-1] if thing else "")
        _tag(draw, (x, y), text, PERSON if who else QUIET, 18 if who else 12, taken)


def _tag(
    draw: ImageDraw.ImageDraw,
    at: tuple[float, float],
    text: str,
    colour: str,
    size: int,
    taken: list[tuple[float, float, float, float]] | None = None,
) -> None:
    """A word on a pale ground; left out where it would cover another."""
    half = lettering.width(text, size) / 2
    box = (at[0] - half - 2, at[1] - size * 0.6, at[0] + half + 2, at[1] + size * 0.6)
    if taken is not None:
        if any(box[0] < b[2] and b[0] < box[2] and box[1] < b[3] and b[1] < box[3] for b in taken):
            return
        taken.append(box)
    draw.rectangle(box, fill=(255, 253, 247, 190))
    lettering.write(draw, at, text, size, colour, anchor="mm")


def label(
    image: Image.Image,
    eye: Eye,
    point: tuple[float, float, float],
    text: str,
    colour: str = PERSON,
    size: int = 20,
    taken: list[tuple[float, float, float, float]] | None = None,
) -> None:
    """A name at a point of the world; left out where it would cover another."""
    at = seen_at(eye, point, image.size)
    if at is not None:
        _tag(ImageDraw.Draw(image, "RGBA"), at, text, colour, size, taken)


def row(images: Iterable[Image.Image]) -> Image.Image:
    images = list(images)
    sheet = Image.new("RGB", (sum(i.width + 4 for i in images) - 4, max(i.height for i in images)), PAPER)
    x = 0
    for image in images:
        sheet.paste(image, (x, 0))
        x += image.width + 4
    return sheet


def stacked(rows: Sequence[tuple[str, Image.Image]]) -> Image.Image:
    """Rows of pictures below each other, each under its words."""
    width = max(image.width for _, image in rows) + 2 * _MARGIN
    height = _MARGIN + sum(image.height + (30 if head else 0) + 8 for head, image in rows)
    sheet = Image.new("RGB", (width, height), PAPER)
    draw = ImageDraw.Draw(sheet)
    y = _MARGIN
    for head, image in rows:
        if head:
            lettering.write(draw, (_MARGIN, y), lettering.shortened(head, 18, width - 2 * _MARGIN), 18, INK)
            y += 30
        sheet.paste(image, (_MARGIN, y))
        y += image.height + 8
    return sheet


def grid(cells: Sequence[tuple[str, str, Image.Image]], columns: int) -> Image.Image:
    """Pictures in rows, each over its name and a further word."""
    w, h = cells[0][2].size
    step_w, step_h = w + _MARGIN, h + 46
    rows = -(-len(cells) // columns)
    sheet = Image.new("RGB", (columns * step_w + _MARGIN, rows * step_h + _MARGIN), PAPER)
    draw = ImageDraw.Draw(sheet)
    for k, (name, more, image) in enumerate(cells):
        x, y = _MARGIN + k % columns * step_w, _MARGIN + k // columns * step_h
        sheet.paste(image, (x, y))
        lettering.write(draw, (x + 2, y + h + 4), lettering.shortened(name, 16, w), 16, INK)
        lettering.write(draw, (x + 2, y + h + 23), lettering.shortened(more, 12, w), 12, QUIET)
    return sheet
