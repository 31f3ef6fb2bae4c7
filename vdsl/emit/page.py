"""``index.html``: the storyboard as a page beside its media; no network, no framework.

Made from ``storyboard.json`` alone, and the plans that lie beside the takes. Everything a writer typed is
escaped by the template engine.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .folder import write_text
from .page_view import page_view
from .plan import plan_name
from .storyboard_json import storyboard_document
from .templating import rendered
from .types import Build


def write_page(path: Path, build: Build) -> None:
    """Write the page of a build into its folder."""
    write_text(path, page_html(storyboard_document(build), path.parent))


def page_html(document: Mapping[str, Any], folder: Path | None = None) -> str:
    """The page of a document of schema ``vds.storyboard/1``; folder: where its files lie, for the plans."""
    plans = {
        shot["id"]: [_svg(folder, "shots", shot["id"], plan_name(take["rank"])) for take in shot["takes"]]
        for shot in document["shots"]
    }
    scenes = [_svg(folder, "plans", f"{n}.svg") for n in range(1, len(document["scenes"]) + 1)]
    return rendered("page.html.j2", **page_view(document, plans, scenes))


def _svg(folder: Path | None, *parts: str) -> str:
    """A plan that the build has drawn, or ""."""
    path = folder.joinpath(*parts) if folder else None
    return path.read_text("utf-8") if path and path.is_file() else ""
