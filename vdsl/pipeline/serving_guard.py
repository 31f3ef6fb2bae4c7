"""Who may ask the served page for what: the gate that every request passes.

Assumes a server bound to the loopback address. Guarantees that a request is answered only if it names this
server as its host, comes from no other site, and, where it writes, carries the token that only the served
page holds. So neither a page elsewhere nor one whose name was pointed at this machine can read or write.
"""

from __future__ import annotations

import secrets
from collections.abc import Mapping

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

#: What a page of this server may load and do; the pages' own policies narrow it down to their scripts.
PAGES = (
    "default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'unsafe-inline'; img-src 'self' data:; "
    "object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
)
#: Files of the build are looked at, never run: one that holds script cannot reach the token.
FILES = "sandbox; default-src 'none'; img-src 'self'; media-src 'self'; style-src 'unsafe-inline'"
_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}
_READING = ("GET", "HEAD")


class Guard:
    """Refuses what is not for this server; everything else goes on to ``app``.

    port: the server's own; token: what a request that writes must carry in ``X-VDS-Token``
    """

    def __init__(self, app: ASGIApp, port: int, token: str) -> None:
        self.app = app
        self.token = token
        names = [f"{name}:{port}" for name in ("127.0.0.1", "localhost")]
        self.hosts = frozenset([*names, *(("127.0.0.1", "localhost") if port == 80 else ())])

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        if scope["type"] != "http":
            return
        refusal = self._refusal(scope["method"], Headers(scope=scope))
        if refusal is not None:
            status, why = refusal
            answer = JSONResponse({"error": why}, status_code=status)
            await answer(scope, receive, _with_headers(send))
            return
        await self.app(scope, receive, _with_headers(send))

    def _refusal(self, method: str, headers: Headers) -> tuple[int, str] | None:
        """Status and reason where a request is not answered."""
        hosts = headers.getlist("host")
        if len(hosts) != 1 or hosts[0].lower() not in self.hosts:
            return 403, "this is not the host you asked for"
        origins = headers.getlist("origin")
        if any(origin not in {f"http://{host}" for host in self.hosts} for origin in origins):
            return 403, "another site may not ask"
        if headers.get("sec-fetch-site", "none") not in ("same-origin", "none") and not _followed_link(
            method, headers
        ):
            return 403, "another site may not ask"
        if method in _READING:
            return None
        if method != "POST":
            return 405, "only GET, HEAD and POST"
        if not secrets.compare_digest(headers.get("x-vds-token", "").encode(), self.token.encode()):
            return 403, "the token is missing or not of this run; load the page again"
        if headers.get("content-type", "").partition(";")[0].strip().lower() != "application/json":
            return 415, "only JSON is read"
        return None


def _followed_link(method: str, headers: Mapping[str, str]) -> bool:
    """Whether somebody came here by a link from another site; the page shows nothing to that site."""
    navigated = headers.get("sec-fetch-mode") == "navigate" and headers.get("sec-fetch-dest") == "document"
    return method in _READING and navigated


def _with_headers(send: Send) -> Send:
    async def sending(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in _HEADERS.items():
                headers[name] = value
            headers.setdefault("Cache-Control", "no-store")
            headers.setdefault("Content-Security-Policy", PAGES)
        await send(message)

    return sending
