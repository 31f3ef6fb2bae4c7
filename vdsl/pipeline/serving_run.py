"""Runs the served page until it is stopped, and beside it, where that is wanted, ``vdsc watch``.

Assumes a socket bound to the loopback address. Guarantees that nothing goes on when it returns.
"""

from __future__ import annotations

import secrets
import signal
import socket
import subprocess
import sys
import threading
import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path

import uvicorn

from .serving import Desk, serving


def serve_until_stopped(
    file: Path, build: Path, listening: socket.socket, device: str, opening: bool, watching: bool
) -> None:
    """Serve a build until it is stopped. opening: show it in a browser; watching: compile on every save."""
    port = listening.getsockname()[1]
    desk = Desk(file, build.resolve(), port, secrets.token_urlsafe(32), device)
    app = serving(desk)
    config = uvicorn.Config(
        app,
        log_level="warning",
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=3,
        limit_concurrency=64,
        proxy_headers=False,
        ws="none",
        lifespan="off",
    )
    server = uvicorn.Server(config)
    app.state.ending = lambda: server.should_exit
    page = threading.Timer(0.6, webbrowser.open, [f"http://127.0.0.1:{port}/"])
    page.daemon = True
    # The server gives a signal back once it is down: both end this run alike, and end the watching too.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with _watch(file, build, device) if watching else nullcontext(), suppress(KeyboardInterrupt):
        if opening:
            page.start()
        server.run(sockets=[listening])


@contextmanager
def _watch(file: Path, build: Path, device: str) -> Iterator[None]:
    """``vdsc watch`` in a process of its own: whatever befalls a compile, the page stays."""
    run = (
        "from vdsl.pipeline.tether import end_with_starter",
        "end_with_starter()",
        "from vdsl.cli import main",
        "main()",
    )
    command = [sys.executable, "-c", "; ".join(run), "watch", str(file), "--out", str(build)]
    command += ["--device", device] if device != "auto" else []  # else as the project says
    watching = subprocess.Popen(command, stdin=subprocess.PIPE)  # closed when this process is no more
    ending = threading.Event()

    def mind() -> None:
        code = watching.wait()
        if not ending.is_set():
            words = f"vdsc: watching ended by itself (code {code}); the page stays, start again to go on"
            print(words, file=sys.stderr, flush=True)

    threading.Thread(target=mind, daemon=True).start()
    try:
        yield
    finally:
        ending.set()
        watching.send_signal(signal.SIGINT)
        try:
            watching.wait(10)
        except subprocess.TimeoutExpired:
            watching.kill()
            watching.wait()
