"""Driving the page in Chromium: where it is, and what is waited for."""

from __future__ import annotations

import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from playwright import sync_api


@dataclass
class Place:
    """Where a page is: its address, its script and its build."""

    url: str
    file: Path
    build: Path
    served: bool


def strange(asked: str, url: str) -> bool:
    home = "file:" if url.startswith("file:") else url[: url.index("/", 8)]
    return not asked.startswith((home, "data:", "blob:"))


def frame(page: Any, shot: str) -> Any:
    return page.locator(f"#shot-{shot} .frame")


def until(page: Any, expression: str, seconds: float = 30.0) -> None:
    """Waits for an expression to hold; asked from here, as the page's policy lets no text be run in it."""
    end = time.monotonic() + seconds
    while True:
        with suppress(sync_api.Error):  # there is nothing to ask while the page is being loaded anew
            if page.evaluate(expression):
                return
        assert time.monotonic() < end, f"never: {expression}"
        page.wait_for_timeout(40)


def plays(page: Any, video: str) -> None:
    until(page, f"(v => v && !v.paused && v.currentTime > 0)(document.querySelector('{video}'))")


def at_frame(page: Any, frame: int) -> None:
    until(page, f"document.getElementById('clock').textContent.startsWith('{frame}/24')")


def opened(page: Any, shot: str = "s2") -> Any:
    frame(page, shot).click()
    page.wait_for_selector("#viewer[open]")
    until(page, "document.getElementById('player').readyState >= 2")
    return page
