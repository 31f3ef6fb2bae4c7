"""A browser, and the page from disk and served."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from typing import Any

import page_build
import pytest
from driving import Place, strange
from playwright import sync_api

EXPECTED = bool(os.environ.get("VDS_EXPECT_CHROMIUM"))  # where it was installed for this, nothing is skipped
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium; where there is none, and none was promised, its tests are skipped."""
    if CHROMIUM is None and not EXPECTED:
        pytest.skip("chromium is not installed")
    with sync_api.sync_playwright() as playwright:
        arguments = ["--no-sandbox"] if sys.platform == "linux" else []
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=arguments)
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def disk(tmp_path_factory: pytest.TempPathFactory) -> Place:
    file, build = page_build.project(tmp_path_factory.mktemp("disk"))
    return Place((build / "index.html").as_uri(), file, build, False)


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Place]:
    file, build = page_build.project(tmp_path_factory.mktemp("served"))
    with page_build.served(file, build) as address:
        yield Place(f"{address}/", file, build, True)


@pytest.fixture(params=["disk", "server"])
def place(request: pytest.FixtureRequest) -> Place:
    return request.getfixturevalue(request.param)


@pytest.fixture
def visit(browser: Any) -> Iterator[Callable[..., Any]]:
    """Opens a page; a script error not expected, or something loaded from elsewhere, fails the test."""
    contexts, wrong = [], []

    def opened(url: str, width: int = 1280, height: int = 800, expected: str = "", **how: Any) -> Any:
        def bad(said: Any) -> bool:
            return said.type == "error" and not (expected and expected in said.text)

        context = browser.new_context(viewport={"width": width, "height": height}, **how)
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(90_000)  # the library's pages are made when asked for, on a busy machine too
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("console", lambda said: wrong.append(said.text) if bad(said) else None)
        page.on("request", lambda asked: wrong.append(asked.url) if strange(asked.url, url) else None)
        page.on("dialog", lambda dialog: wrong.append(dialog.message))
        page.goto(url)
        return page

    yield opened
    for context in contexts:
        context.close()
    assert wrong == []
