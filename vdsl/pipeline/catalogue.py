"""The catalogue of camera styles in ``docs/styles``: pages, and a strip of three frames for each style.

``python -m vdsl.pipeline.catalogue docs/styles`` writes pages and strips, ``--pages`` the pages alone.
Assumes the situations of :mod:`vdsl.cinema.styles`. Guarantees that a strip shows the take that is best by
geometry: its first frame, its middle and its last.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby
from pathlib import Path

import numpy as np
from PIL import Image

from runtime.raster.types import Views

from ..cinema.styles import Style, styles
from ..lang import Report, Source
from ..lang.ir import Shot
from ..propose.cameras import propose_cameras
from ..propose.story import tell
from ..propose.types import ProposalGrid, StoryProposal
from .captions import row, stacked
from .compile import Act
from .filming import Camerawork, not_drawn, some_frames, story_palettes
from .judging import GeometryJudge
from .script import check_source
from .trial import stage_script

#: Frames of a strip, and their size in pixels.
SHOWN = 3
CELL = (240, 135)
_PROPOSALS = 40
TITLES = {
    "static": "Standing still", "follow": "Following", "push": "Coming nearer", "pull": "Going back",
    "zoom": "Zooms", "tilt": "Tilts", "pan": "Pans", "dolly": "Slides to the side",
    "pedestal": "Straight up and down", "arc": "Round the subject", "crane": "Cranes", "roll": "Rolls",
    "dolly-zoom": "Dolly zooms", "handheld": "Held by hand", "whip-pan": "Whip pans",
    "rack-focus": "Focus from one to another",
    "views": "Views", "pairs": "Two at once",
}  # fmt: skip
_HEAD = "<!-- Made by `make styles` from vdsl/cinema/styles.py; not edited by hand. -->\n\n# {title}\n\n"


@dataclass(eq=False)
class Catalogue:
    """Proposes and draws styles; stages every situation once."""

    device: str = "auto"
    _staged: dict[str, tuple[Act, tuple[StoryProposal, ...]]] = field(default_factory=dict, repr=False)
    _camerawork: Camerawork | None = field(default=None, repr=False)

    def situation(self, style: Style) -> tuple[Act, tuple[StoryProposal, ...]]:
        """Where a style is shown, and how its line is acted there."""
        if style.situation not in self._staged:
            act = stage_script(style.script, style.name)
            told = tell(act.state, act.line, act.filming, shot=act.line.shots[0])
            self._staged[style.situation] = (act, told.proposals)
        return self._staged[style.situation]

    def propose(self, style: Style, proposals: int = _PROPOSALS) -> tuple[Shot, ProposalGrid]:
        """The style's shot in its situation, and cameras for it."""
        act, stories = self.situation(style)
        checked = check_source(Source(style.name, style.script), Report())
        shot = replace(checked.storyboard.lines[0].shots[0], proposals=proposals)
        return shot, propose_cameras(shot, stories, act.filming)

    def strip(self, style: Style, size: tuple[int, int] = CELL) -> Image.Image:
        """First frame, middle and last of the best take, side by side."""
        act, _ = self.situation(style)
        _, grid = self.propose(style)
        camera = grid.cameras[int(np.argmax(GeometryJudge().scores(grid.cameras, None)))]
        story = next(s for s in grid.story if s.index == camera.story)
        frames = np.linspace(0, story.frames - 1, SHOWN).round().astype(int)
        hidden = np.repeat(not_drawn(act.staged, camera)[None], SHOWN, axis=0)
        views = Views(
            some_frames(camera.track, frames, optics=True), np.arange(SHOWN, dtype=np.int32), hidden
        )
        moments = story_palettes(act.staged, story, frames)
        if self._camerawork is None:
            self._camerawork = Camerawork(self.device)
        drawn = self._camerawork.stills(act.staged, "board", moments, views, size)
        return row(Image.fromarray(image) for image in drawn.color)

    def sheet(self, found: Sequence[Style]) -> Image.Image:
        """Strips below each other, each under its words."""
        return stacked([(style.words, self.strip(style)) for style in found])


def groups() -> Iterator[tuple[str, list[Style]]]:
    """The styles by page."""
    order = list(TITLES)
    ordered = sorted(styles(), key=lambda style: order.index(style.group))
    for name, members in groupby(ordered, key=lambda style: style.group):
        yield name, list(members)


def pages() -> dict[str, str]:
    """The pages by file name."""
    intro = (
        "What cameras are made of (a movement, a size, an angle, a view) goes together as one likes; these "
        f"{len(styles())} are tried on the people and places of `examples/coffee.vds`, and a test holds that "
        "cameras which keep to their words are found for every one. `vdsc assets styles` lists them, "
        '`vdsc assets styles --search "push low"` finds. What the words come to in numbers: '
        "[cinema.md](../cinema.md).\n\n| page | styles |\n|---|---|\n"
    )
    out = {}
    for name, members in groups():
        intro += f"| [{TITLES[name]}]({name}.md) | {len(members)} |\n"
        text = _HEAD.format(title=TITLES[name])
        for style in members:
            text += f"\n## `{style.words}`\n\n![{style.name}](images/{style.name}.jpg)\n\n"
            text += f"{_sentence(style.means)} Varies: {', '.join(style.varies)}. As in `{style.line}`\n"
        out[f"{name}.md"] = text
    return {"README.md": _HEAD.format(title="Camera styles") + intro} | out


def _sentence(text: str) -> str:
    return text[0].upper() + text[1:] + "."


def draw(folder: Path) -> None:
    """All strips, as JPEG into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    catalogue = Catalogue()
    for style in sorted(styles(), key=lambda style: style.situation):
        path = folder / f"{style.name}.jpg"
        catalogue.strip(style).save(path, quality=72, optimize=True)
        print(path, flush=True)


def main() -> None:
    """Write the pages, and the strips unless told otherwise."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--pages", action="store_true", help="the pages alone, no pictures")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    for name, text in pages().items():
        (given.folder / name).write_text(text, encoding="utf-8")
    if not given.pages:
        draw(given.folder / "images")


if __name__ == "__main__":
    main()
