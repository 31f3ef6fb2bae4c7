"""The top plan of a shot, or of a scene with all its cameras: as SVG for a page, as a picture for paper.

Assumes a :class:`~vdsl.emit.plan_ground.Plan`. Guarantees SVG without script, links or ids, so that many can
stand in one page; all words are escaped; colours are CSS variables that a page may set, dark where the reader
prefers dark. The painted form shows the same marks.
"""

from __future__ import annotations

import io
from collections.abc import Iterable
from dataclasses import replace
from html import escape
from itertools import groupby, pairwise
from pathlib import Path
from typing import NamedTuple

from PIL import Image, ImageDraw

from . import lettering
from .folder import write_bytes, write_text
from .plan_ground import Plan, Point, lens_words, scene_plan, shot_plan
from .plan_marks import HEIGHT, WIDTH, Mark, marks_of
from .remember import remembering
from .types import Build
from .words import line_words

#: Colours by their names in CSS: on a light page (and on paper), and on a dark one.
COLOURS = {
    "paper": ("#fbf9f4", "#17191d"),
    "ink": ("#1b1c1f", "#ece8df"),
    "quiet": ("#6f6a61", "#a39d92"),
    "thing": ("#ece7dc", "#24272d"),
    "edge": ("#b7b0a2", "#4c5058"),
    "marked": ("#f3d9a4", "#5c4a20"),
    "camera": ("#b3392b", "#f0786a"),
    "person-0": ("#1f5f8b", "#74b7e6"),
    "person-1": ("#2c7a4b", "#77cf9a"),
    "person-2": ("#7a3f8f", "#cf9be3"),
    "person-3": ("#8a5a10", "#e3b565"),
}


#: Plans that a process remembers, and pictures of such.
KEPT, PAINTED = 500, 60


class Look(NamedTuple):
    """How a role looks: names of colours, "" for none; width of its line; dash; opacity of the fill."""

    fill: str = ""
    stroke: str = ""
    width: float = 0.0
    dash: tuple[float, ...] = ()
    opacity: float = 1.0


#: How marks look, by the first word of their role; ``who`` stands for the colour of the person meant.
ROLES = {
    "thing": Look("thing", "edge", 1.0),
    "rug": Look("", "edge", 1.0, (3, 3)),
    "marked": Look("marked", "quiet", 1.2),
    "wall": Look("ink", "ink", 0.6),
    "wild": Look("paper", "edge", 1.0, (3, 2)),
    "door": Look("", "quiet", 1.0, (2, 3)),
    "jamb": Look("", "ink", 1.6),
    "window": Look("", "quiet", 2.4),
    "view": Look("camera", "camera", 0.8, (), 0.16),
    "view-end": Look("", "camera", 1.1, (5, 3)),
    "action-line": Look("", "quiet", 1.4, (8, 3, 2, 3)),
    "way": Look("", "who", 2.2),
    "arrow": Look("who", "paper", 0.8),
    "start": Look("who", "paper", 1.2),
    "end": Look("paper", "who", 2.0),
    "nose": Look("who", "paper", 0.8),
    "camera-way": Look("", "camera", 2.0),
    "camera-arrow": Look("camera", "paper", 0.8),
    "camera": Look("camera", "paper", 1.0),
    "camera-end": Look("paper", "camera", 1.4),
    "number-disc": Look("camera", "paper", 1.0),
    "number": Look("paper"),
    "lens": Look("camera"),
    "name": Look("who"),
    "thing-name": Look("quiet"),
    "marked-name": Look("ink"),
    "plate": Look("paper", "", 0.0, (), 0.8),
    "scale": Look("", "ink", 1.2),
    "scale-name": Look("quiet"),
    "north": Look("quiet"),
}
_HALOED = ("name", "lens", "marked-name", "thing-name", "scale-name")


def write_plans(folder: Path, build: Build) -> None:
    """Plans of every shot: ``shots/<id>/plan.svg`` by its best take, ``plan-<k>.svg`` by its k-th from the
    second on; and ``plans/<n>.svg`` of the n-th scene with the cameras of all its shots.

    Writes nothing where the build does not say what its scenes are like.
    """
    if not build.grounds:
        return
    by_scene: dict[int, list[int]] = {}
    for i, built in enumerate(build.shots):
        by_scene.setdefault(built.line.scene, []).append(i)
        where = folder / "shots" / built.shot.id
        where.mkdir(parents=True, exist_ok=True)
        for rank in range(1, max(1, len(built.takes)) + 1):
            write_text(where / plan_name(rank), plan_svg(plan_of(build, i, rank)))
    (folder / "plans").mkdir(exist_ok=True)
    for scene, rows in by_scene.items():
        shots = [(i + 1, build.shots[i]) for i in rows]
        ground = build.grounds[scene]
        title = f"Plan of {ground.name} with the cameras of {len(shots)} shots"
        write_text(folder / "plans" / f"{scene + 1}.svg", plan_svg(scene_plan(ground, shots, title)))


def plan_name(rank: int) -> str:
    """The file of a shot's plan by its take of a rank, 1 the best."""
    return "plan.svg" if rank == 1 else f"plan-{rank}.svg"


def plan_of(build: Build, index: int, rank: int = 1) -> Plan:
    """The plan of the build's shot at an index, by its take of a rank, 1 the best."""
    built = build.shots[index]
    built = replace(built, takes=built.takes[rank - 1 : rank])
    label = lens_words(built.takes[0].camera.track) if built.takes else ""
    title = f"Plan of shot {index + 1}, {line_words(built.line, built.scene)}"
    return shot_plan(build.grounds[built.line.scene], built, title, label)


# --- SVG --------------------------------------------------------------------------------------


@remembering(KEPT)
def plan_svg(plan: Plan) -> str:
    """The plan as an SVG document of 400 by 300 units; it may stand in a page as it is."""
    styled = ((_style_of(mark), _svg(mark)) for mark in marks_of(plan) if _on_sheet(mark))
    body = "\n".join(_group(style, (m for _, m in row)) for style, row in groupby(styled, lambda m: m[0]))
    title = escape(lettering.clean(plan.title))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="vds-plan" viewBox="0 0 {WIDTH} {HEIGHT}" '
        f'role="img" aria-label="{title}">\n<title>{title}</title>\n<style>{_style()}</style>\n'
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="{_css("paper")}"/>\n'
        f'<svg width="{WIDTH}" height="{HEIGHT}">\n{body}\n</svg>\n</svg>\n'  # cuts off what lies beyond
    )


def _on_sheet(mark: Mark) -> bool:
    """Whether any of a mark may be seen."""
    xs, ys = zip(*mark.points, strict=True)
    far = mark.size + 10 if mark.shape == "circle" else len(mark.text) * mark.size + 10
    return -far < max(xs) and min(xs) < WIDTH + far and -far < max(ys) and min(ys) < HEIGHT + far


def _group(style: str, marks: Iterable[str]) -> str:
    """Marks that look alike, one after the other."""
    return f"<g {style}>" + "".join(marks) + "</g>"


def _style() -> str:
    """Dark where the reader prefers it; a page sets ``--plan-ink`` and so on to overrule both."""
    names = "".join(f"--plan-{k}-:{dark};" for k, (_, dark) in COLOURS.items())
    return (
        f"@media (prefers-color-scheme:dark){{.vds-plan{{{names}}}}}"
        "@media print{.vds-plan{"
        + "".join(f"--plan-{k}-:{light};" for k, (light, _) in COLOURS.items())
        + "}}"
        ".vds-plan text{font-family:system-ui,sans-serif;stroke-linejoin:round}"
    )


def _css(colour: str) -> str:
    """A colour: what the page says, else what the reader prefers, else the light one."""
    return f"var(--plan-{colour},var(--plan-{colour}-,{COLOURS[colour][0]}))" if colour else "none"


def _svg(mark: Mark) -> str:
    """A mark's shape; how it looks is said by its group."""
    if mark.shape == "text":
        x, y = mark.points[0]
        return f'<text x="{x:.1f}" y="{y:.1f}">{escape(mark.text)}</text>'
    if mark.shape == "circle":
        x, y = mark.points[0]
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{mark.size:g}"/>'
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in mark.points)
    return f'<{"polygon" if mark.shape == "polygon" else "polyline"} points="{points}"/>'


def _style_of(mark: Mark) -> str:
    look = _look(mark)
    if mark.shape == "text":
        halo = f' stroke="{_css("paper")}" stroke-width="3" paint-order="stroke"' if _haloed(mark) else ""
        return (
            f'font-size="{mark.size:g}" text-anchor="{mark.anchor}" dominant-baseline="central" '
            f'fill="{_css(look.fill)}"{halo}'
        )
    style = f'fill="{_css(look.fill)}" stroke="{_css(look.stroke)}" stroke-width="{look.width:g}"'
    if look.opacity < 1:
        style += f' fill-opacity="{_faint(mark, look):g}"'
    if look.dash:
        style += f' stroke-dasharray="{" ".join(f"{d:g}" for d in look.dash)}"'
    return style + ' stroke-linejoin="round"'


def _look(mark: Mark) -> Look:
    """The look of a mark, with the colour of the person it is of."""
    first, *rest = mark.role.split()
    look, who = ROLES[first], rest[-1] if rest and rest[-1] in COLOURS else ""
    return look._replace(
        fill=who if look.fill == "who" else look.fill, stroke=who if look.stroke == "who" else look.stroke
    )


def _faint(mark: Mark, look: Look) -> float:
    return look.opacity * (0.7 if "among" in mark.role else 1.0)


def _haloed(mark: Mark) -> bool:
    return mark.role.split()[0] in _HALOED


# --- paint ------------------------------------------------------------------------------------


@remembering(PAINTED)
def plan_picture(plan: Plan, width: int = 1200) -> Image.Image:
    """The plan painted in its light colours, RGB. For looking at, not to paint on."""
    fine = 2 * width / WIDTH  # drawn at twice the size, then reduced, so that edges are smooth
    image = Image.new("RGB", (2 * width, 2 * round(width * HEIGHT / WIDTH)), COLOURS["paper"][0])
    for mark in marks_of(plan):
        _paint(image, mark, fine)
    return image.resize((width, image.height // 2), Image.Resampling.LANCZOS)


def write_plan_picture(path: Path, image: Image.Image) -> None:
    """Write a painted plan as PNG."""
    buffer = io.BytesIO()
    image.save(buffer, "PNG")
    write_bytes(path, buffer.getvalue())


def _paint(image: Image.Image, mark: Mark, fine: float) -> None:
    look = _look(mark)
    draw = ImageDraw.Draw(image, "RGBA")
    points = [(x * fine, y * fine) for x, y in mark.points]
    fill = _rgba(look.fill, _faint(mark, look) if look.opacity < 1 else 1.0)
    if mark.shape == "text":
        anchor = {"middle": "mm", "start": "lm", "end": "rm"}[mark.anchor]
        halo = round(1.5 * fine) if _haloed(mark) else 0
        lettering.write(
            draw,
            points[0],
            mark.text,
            round(mark.size * fine),
            COLOURS[look.fill][0],
            anchor,
            halo,
            COLOURS["paper"][0],
        )
        return
    if mark.shape == "circle":
        r, (x, y) = mark.size * fine, points[0]
        draw.ellipse([x - r, y - r, x + r, y + r], fill, _rgba(look.stroke), max(1, round(look.width * fine)))
        return
    closed = mark.shape == "polygon"
    if closed and fill is not None:
        draw.polygon(points, fill)
    stroke = _rgba(look.stroke)
    if stroke is not None:
        way = [*points, points[0]] if closed else points
        for piece in _dashes(way, [d * fine for d in look.dash]) if look.dash else [way]:
            draw.line(piece, stroke, max(1, round(look.width * fine)), "curve")


def _rgba(colour: str, opacity: float = 1.0) -> tuple[int, int, int, int] | None:
    if not colour:
        return None
    value = int(COLOURS[colour][0][1:], 16)
    return value >> 16, value >> 8 & 255, value & 255, round(255 * opacity)


def _dashes(way: list[Point], dash: list[float]) -> list[list[Point]]:
    """A way cut into strokes: lengths drawn and left out by turns."""
    out: list[list[Point]] = []
    k, left, drawn = 0, dash[0], [way[0]]
    for a, b in pairwise(way):
        length, at = ((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5, 0.0
        while length - at > left:
            at += left
            p = (a[0] + (b[0] - a[0]) * at / length, a[1] + (b[1] - a[1]) * at / length)
            if k % 2 == 0:
                out.append([*drawn, p])
            k, drawn = k + 1, [p]
            left = dash[k % len(dash)]
        left -= length - at
        drawn.append(b)
    return [*out, drawn] if k % 2 == 0 and len(drawn) > 1 else out
