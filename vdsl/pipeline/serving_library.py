"""Served beside the page: what there is to write with, and the scenes as they are placed. Only to look at.

Assumes a script, with or without errors. Guarantees that names are looked up, never taken as paths, and that
pictures are drawn one at a time in one thread, and kept: a page that asks for many waits for its turn.
"""

from __future__ import annotations

import asyncio
import io
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response
from starlette.routing import Route

from ..emit.templating import rendered
from ..library import Catalog
from ..library.describe import PLURALS, rows
from .script import ScriptError, load_storyboard

if TYPE_CHECKING:
    from PIL.Image import Image

    from .preview import Studio

#: Pictures that are kept, and pictures that may be waited for.
KEPT, WAITING = 200, 12
#: Cameras the set preview offers; any other may be typed.
CAMERAS = (
    "static extreme-wide high-angle",
    "static wide eye-level",
    "static wide high-angle",
    "static full low-angle",
    "static medium eye-level",
)
_LONGEST_CAMERA = 160


class BusyError(Exception):
    """Too many pictures are waited for."""


class CannotDrawError(Exception):
    """There is no such picture; the message says why."""


class Atelier:
    """Draws what is asked for, in a thread of its own: the renderer belongs to the thread that made it."""

    def __init__(self, file: Path, device: str) -> None:
        self.file, self.device = file, device
        self.turns = ThreadPoolExecutor(1, "atelier")
        self._waiting = 0
        self._kept: OrderedDict[tuple[str, ...], bytes] = OrderedDict()
        self._studio: tuple[str, Studio] | None = None

    async def done(self, key: tuple[str, ...], draw: Callable[[], Image]) -> bytes:
        """A picture as PNG, drawn once. Raises BusyError, CannotDrawError, or what drawing raises."""
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key]
        if self._waiting >= WAITING:
            raise BusyError
        self._waiting += 1
        try:
            data = await asyncio.get_running_loop().run_in_executor(self.turns, lambda: _png(_drawn(draw)))
        finally:
            self._waiting -= 1
        self._kept[key] = data
        while len(self._kept) > KEPT:
            self._kept.popitem(last=False)
        return data

    def stamp(self) -> str:
        """Another for every other text of the script."""
        try:
            found = self.file.stat()
        except OSError:
            return ""
        return f"{found.st_mtime_ns:x}.{found.st_size:x}"

    def studio(self, catalog: Catalog) -> Studio:
        """Of the script as it is now; only ever called in the atelier's thread."""
        # Here: whoever never looks at a picture does not wait for the renderer.
        from .preview import Studio

        stamp = self.stamp()
        if self._studio is None or self._studio[0] != stamp:
            self._studio = (stamp, Studio(catalog, self.device, own=self.file))
        return self._studio[1]

    def catalog(self) -> Catalog:
        """The library with the script's own definitions, or alone where the script has errors."""
        try:
            return load_storyboard(self.file).catalog
        except (ScriptError, OSError):
            return Catalog()


def library_routes(atelier: Atelier) -> list[Route]:
    """The library, the set preview, and their pictures."""
    desk = _Library(atelier)
    return [
        Route("/library", desk.library),
        Route("/library/{kind}/{name}.png", desk.picture),
        Route("/stage", desk.stage),
        Route("/stage/{scene}.png", desk.scene),
    ]


class _Library:
    def __init__(self, atelier: Atelier) -> None:
        self.atelier = atelier
        self._rows: tuple[str, dict[str, list[dict[str, Any]]]] | None = None

    async def library(self, request: Request) -> Response:
        """Everything there is, with search."""
        kinds = await asyncio.to_thread(self._all)
        return HTMLResponse(rendered("library.html.j2", file=self.atelier.file.name, kinds=kinds))

    def _all(self) -> dict[str, list[dict[str, Any]]]:
        stamp = self.atelier.stamp()
        if self._rows is None or self._rows[0] != stamp:
            catalog = self.atelier.catalog()
            found = {
                plural: [_told(asdict(row)) for row in rows(catalog, kind)]
                for plural, kind in PLURALS.items()
            }
            self._rows = (stamp, found)
        return self._rows[1]

    async def picture(self, request: Request) -> Response:
        """One definition, drawn."""
        plural, name = request.path_params["kind"], request.path_params["name"]

        def draw() -> Image:
            catalog = self.atelier.catalog()
            if plural not in PLURALS or name not in catalog.names(PLURALS[plural]):
                raise CannotDrawError(f"there is nothing called {name} here")
            studio = self.atelier.studio(catalog)
            if plural == "props":
                return studio.props([name])
            if plural == "cast":
                return studio.cast([name])
            return studio.action(name) if plural == "actions" else studio.set(name)

        return await self._picture((self.atelier.stamp(), plural, name), draw)

    async def stage(self, request: Request) -> Response:
        """The script's scenes, from above and by a camera."""
        try:
            storyboard = (await asyncio.to_thread(load_storyboard, self.atelier.file)).storyboard
            scenes = [
                {"name": s.name, "set": ".".join((s.set, *s.room)), "time": s.time} for s in storyboard.scenes
            ]
            wrong = ""
        except (ScriptError, OSError) as error:
            scenes, wrong = [], str(error)
        camera = request.query_params.get("from", "")[:_LONGEST_CAMERA]
        values = {"file": self.atelier.file.name, "scenes": scenes, "wrong": wrong}
        return HTMLResponse(
            rendered("stage.html.j2", cameras=CAMERAS, camera=camera, stamp=self.atelier.stamp(), **values)
        )

    async def scene(self, request: Request) -> Response:
        """One scene, drawn: from above, or by the camera that ``from`` says."""
        name, camera = request.path_params["scene"], request.query_params.get("from", "")

        def draw() -> Image:
            from .look import look_at  # here, as in Atelier.studio

            known = [s.name for s in load_storyboard(self.atelier.file).storyboard.scenes]
            if name not in known:
                raise CannotDrawError(f"there is no scene {name}")
            if len(camera) > _LONGEST_CAMERA or not camera.isprintable():
                raise CannotDrawError("this is no camera")
            return look_at(self.atelier.file, name, camera or None, self.atelier.device)[0]

        return await self._picture((self.atelier.stamp(), "stage", name, camera), draw)

    async def _picture(self, key: tuple[str, ...], draw: Callable[[], Image]) -> Response:
        try:
            data = await self.atelier.done(key, draw)
        except BusyError:
            return JSONResponse({"error": "too many pictures at once"}, status_code=503)
        except ScriptError as error:
            labels = [d.label or d.title for d in error.report.errors]
            return JSONResponse({"error": "; ".join(labels)}, status_code=422)
        except CannotDrawError as error:
            return JSONResponse({"error": str(error)}, status_code=404)
        except OSError as error:
            return JSONResponse({"error": f"cannot read {error.filename}"}, status_code=422)
        return Response(data, media_type="image/png", headers={"Cache-Control": "no-cache"})


def _told(row: dict[str, Any]) -> dict[str, Any]:
    """A row of the library in lines: what is worth a word, with its heading."""
    skipped = ("name", "kind", "about")
    lines = [
        (k.replace("_", " "), _words(v))
        for k, v in row.items()
        if k not in skipped and v not in ("", (), {}, "none")
    ]
    return {"name": row["name"], "about": row["about"], "lines": [(k, words) for k, words in lines if words]}


def _words(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else ""
    if isinstance(value, dict):
        return ", ".join(f"{k} {v}" for k, v in value.items())
    if isinstance(value, list | tuple):
        return ", ".join(str(v["name"]) if isinstance(v, dict) else str(v) for v in value)
    return str(value)


def _drawn(draw: Callable[[], Image]) -> Image:
    # Here, as in Atelier.studio.
    from runtime.raster.device import DeviceError

    from .trial import NoTrialError

    try:
        return draw()
    except (NoTrialError, DeviceError) as error:
        raise CannotDrawError(str(error)) from error


def _png(image: Image) -> bytes:
    out = io.BytesIO()
    image.save(out, "PNG")
    return out.getvalue()
