"""The storyboard page, live: what ``vdsc serve`` answers.

Assumes a script and the folder of its build, which may come, change and go. Guarantees that no file outside
that folder is ever read out, and that nothing is written but the script's lock (:mod:`vdsl.pipeline.lock`)
and a build with further takes (:mod:`vdsl.pipeline.serving_further`), for requests that
:class:`~vdsl.pipeline.serving_guard.Guard` let through.
"""

from __future__ import annotations

import asyncio
import json
import os
import stat
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, JSONResponse, Response, StreamingResponse
from starlette.routing import Route

from ..emit.templating import rendered
from .lock import ChoiceError, choose, clear
from .script import ScriptError
from .serving_further import Further, FurtherError
from .serving_guard import FILES, Guard
from .serving_library import Atelier, library_routes
from .serving_state import Watched

#: Seconds between two looks at what has changed, and between two signs of life.
LOOK, SIGN = 0.4, 15.0
LARGEST_BODY = 16 * 1024
_NO_TOKEN = '<meta name="vds-token" content="">'


@dataclass(frozen=True)
class Desk:
    """What is served. file: the script; build: its build's folder.

    port: of the server on the loopback address; token: of this run, given with the page; device: where
    previews are drawn
    """

    file: Path
    build: Path
    port: int
    token: str
    device: str = "auto"


def serving(desk: Desk) -> Starlette:
    """The application; it holds nothing that a restart would lose.

    ``app.state.ending`` says whether it is to end, so that pages that listen are let go.
    """
    atelier = Atelier(desk.file, desk.device)
    pages = _Pages(desk, atelier, lambda: bool(app.state.ending()))
    routes = [
        Route("/", pages.index),
        Route("/index.html", pages.index),
        Route("/events", pages.events),
        Route("/choose", pages.choose, methods=["POST"]),
        Route("/unchoose", pages.unchoose, methods=["POST"]),
        Route("/further", pages.more, methods=["POST"]),
        *library_routes(atelier),
        Route("/{path:path}", pages.file),
    ]
    guard = Middleware(Guard, port=desk.port, token=desk.token)
    app = Starlette(routes=routes, middleware=[guard])
    app.state.ending = lambda: False
    return app


class _Pages:
    def __init__(self, desk: Desk, atelier: Atelier, ending: Callable[[], bool]) -> None:
        self.desk = desk
        self.watched = Watched(desk.file, desk.build)
        self.further = Further(desk.file, desk.build, atelier.turns, self.watched.is_stale, ending)

    async def index(self, request: Request) -> Response:
        """The build's page with the token in it; before there is a build, what is going on."""
        try:
            page = (self.desk.build / "index.html").read_text("utf-8")
        except OSError:
            state = self.watched.state()
            words = rendered("wait.html.j2", file=self.desk.file.name, state=state)
            return HTMLResponse(words, status_code=503, headers={"Retry-After": "2"})
        return HTMLResponse(page.replace(_NO_TOKEN, _NO_TOKEN.replace('""', f'"{self.desk.token}"'), 1))

    async def file(self, request: Request) -> Response:
        """A file of the build, whole or in part."""
        path = inside(self.desk.build, request.path_params["path"])
        if path is None:
            return JSONResponse({"error": "there is no such file in the build"}, status_code=404)
        headers = {"Cache-Control": "no-cache", "Content-Security-Policy": FILES}
        return FileResponse(path, headers=headers)

    async def events(self, request: Request) -> Response:
        """Server-sent events: the state now, and again whenever it is another."""
        return StreamingResponse(self._told(request), media_type="text/event-stream")

    async def _told(self, request: Request) -> AsyncIterator[str]:
        last, quiet = "", 0.0
        while not (request.app.state.ending() or await request.is_disconnected()):
            told = await run_in_threadpool(self.watched.state)
            state = json.dumps(told | {"further": self.further.state()})
            if state != last:
                yield f"event: state\ndata: {state}\n\n"
                last, quiet = state, 0.0
            elif quiet >= SIGN:
                yield ": still here\n\n"
                quiet = 0.0
            await asyncio.sleep(LOOK)
            quiet += LOOK

    async def choose(self, request: Request) -> Response:
        """``{"shot": id, "take": key or rank}``: chosen, and written to the lock."""
        body = await _body(request)
        shot, take = body.get("shot"), body.get("take")
        if not isinstance(shot, str) or isinstance(take, bool) or not isinstance(take, int | str):
            return JSONResponse({"error": "say a shot and a take"}, status_code=422)
        return await self._change(lambda: choose(self.desk.file, shot, take, self.desk.build))

    async def unchoose(self, request: Request) -> Response:
        """``{"shot": id}``: the ranking decides again."""
        shot = (await _body(request)).get("shot")
        if not isinstance(shot, str):
            return JSONResponse({"error": "say a shot"}, status_code=422)
        return await self._change(lambda: clear(self.desk.file, shot, self.desk.build))

    async def more(self, request: Request) -> Response:
        """``{"shot": id}``: further takes of it are drawn, one shot after the other."""
        shot = (await _body(request)).get("shot")
        if not isinstance(shot, str):
            return JSONResponse({"error": "say a shot"}, status_code=422)
        try:
            await run_in_threadpool(self.further.ask, shot)
        except FurtherError as error:
            return JSONResponse({"error": str(error)}, status_code=409)
        return JSONResponse({"further": self.further.state()}, status_code=202)

    async def _change(self, change: Any) -> Response:
        try:
            await run_in_threadpool(change)
            choices = await run_in_threadpool(self.watched.choices)
        except ChoiceError as error:
            return JSONResponse({"error": str(error)}, status_code=409)
        except ScriptError as error:
            return JSONResponse({"error": f"the lock does not read: {error}"}, status_code=409)
        except OSError as error:
            return JSONResponse({"error": f"cannot write the lock: {error.strerror}"}, status_code=500)
        return JSONResponse({"choices": choices})


def inside(folder: Path, path: str) -> Path | None:
    """The file of a folder that a request names; None for anything that is not one, or that leads out."""
    parts = path.split("/")
    if any(part in ("", ".", "..") or part.startswith(".") or "\\" in part or "\0" in part for part in parts):
        return None
    root = os.path.realpath(folder)
    try:
        found = os.path.realpath(os.path.join(root, *parts))
        if os.path.commonpath([root, found]) != root or not stat.S_ISREG(os.stat(found).st_mode):
            return None
    except (OSError, ValueError):
        return None
    return Path(found)


async def _body(request: Request) -> dict[str, Any]:
    """A small JSON object; {} for anything else."""
    data = b""
    async for chunk in request.stream():
        data += chunk
        if len(data) > LARGEST_BODY:
            return {}
    try:
        body = json.loads(data)
    except ValueError:
        return {}
    return body if isinstance(body, dict) else {}
