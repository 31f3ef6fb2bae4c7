"""``index.html``: the storyboard as a page beside its media; no network, no framework.

Everything a writer typed is escaped by the template engine.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any
from urllib.parse import quote

import jinja2

from .folder import write_text
from .statistics import statistics
from .storyboard_json import storyboard_document
from .timeline import film_frames
from .types import Build
from .words import seconds_words, timecode


def write_page(path: Path, build: Build) -> None:
    """Write the page."""
    write_text(path, page_html(build))


def page_html(build: Build) -> str:
    """The page as text."""
    board = build.storyboard
    document = storyboard_document(build)
    for shot in document["shots"]:
        shot["length"] = seconds_words(shot["frames"], board.fps)
        shot["cuts"] = [c.text for c in build.into(shot["id"])]
        shot["traded"] = next((t.text for t in build.trades if t.shot == shot["id"]), "")
        shot["timecode"] = timecode(shot["start"], board.fps) if shot["start"] is not None else ""
    return _template().render(
        board=document,
        statistics=statistics(build),
        length=seconds_words(film_frames(build), board.fps),
        shown=bool(build.shown),
        broken=len({c.cut for c in build.continuity}),
        poster=next((s["takes"][0]["poster"] for s in document["shots"] if s["takes"]), ""),
    )


@lru_cache(maxsize=1)
def _template() -> jinja2.Template:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["url"] = _url
    return environment.get_template("index.html.j2")


def _url(path: Any) -> str:
    """A relative path as it stands in a link."""
    return quote(str(path).encode("utf-8", "replace"))
