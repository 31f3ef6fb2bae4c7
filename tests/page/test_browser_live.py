"""The served page in Chromium: it goes along with what is compiled, and has more takes drawn."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import page_build
import pytest
from driving import Place, at_frame, frame, opened, until

from vdsl.emit.build import write_build
from vdsl.pipeline import cache as cache_module
from vdsl.pipeline.compile import compile_file
from vdsl.pipeline.lock import read_lock
from vdsl.pipeline.options import Options

pytestmark = pytest.mark.slow

# --- going along ------------------------------------------------------------------------------


def test_the_page_loads_a_new_build_and_stays_where_it_was(server: Place, visit: Callable[..., Any]) -> None:
    page = visit(server.url)
    page.locator("[name=words]").fill("anna")
    opened(page, "s3")
    page.keyboard.press("3")
    page.keyboard.press("Space")
    page.locator("#scrub").fill("5")
    top = page.evaluate("scrollY")
    assert top > 0
    at_frame(page, 6)
    try:
        write_build(server.build, page_build.film(server.build, title="Evening coffee"))
        until(page, "document.title === 'Evening coffee'", 15)
        page.wait_for_selector("#viewer[open]")
        at_frame(page, 6)
        assert "take 3 of 7" in page.locator("#viewer-rank").inner_text()
        assert page.evaluate("scrollY") == pytest.approx(top, abs=2)
        assert page.locator("[name=words]").input_value() == "anna"
    finally:
        write_build(server.build, page_build.film(server.build))


def test_the_take_that_is_open_stays_open_where_it_becomes_the_first(
    server: Place, visit: Callable[..., Any]
) -> None:
    """As it does, a moment after it was chosen, where somebody watches the script."""
    page = visit(server.url)
    opened(page, "s3")
    page.keyboard.press("3")
    key = page.evaluate("viewer.take.key")
    build = page_build.film(server.build, title="Chosen")
    shot = build.shots[-1]
    best = replace(shot.takes[2], media=replace(shot.takes[2].media, keys=shot.takes[0].media.keys))
    takes = [best, *shot.takes[:2], *shot.takes[3:]]
    ranked = tuple(replace(take, rank=k, chosen=k == 1) for k, take in enumerate(takes, start=1))
    try:
        write_build(server.build, replace(build, shots=(*build.shots[:-1], replace(shot, takes=ranked))))
        until(page, "document.title === 'Chosen'", 15)
        page.wait_for_selector("#viewer[open]")
        assert page.evaluate("viewer.take.key") == key
        assert "take 1 of 7" in page.locator("#viewer-rank").inner_text()
    finally:
        write_build(server.build, page_build.film(server.build))


def test_lost_choices_are_told_and_other_files_named(server: Place, visit: Callable[..., Any]) -> None:
    page = visit(server.url)
    lost = {
        "code": "VDS311",
        "severity": "warning",
        "file": "story.vds",
        "line": 7,
        "title": "a choice is lost",
        "message": "the chosen take (push medium) no longer exists",
    }
    weak = lost | {"code": "VDS192", "title": "no good take"}
    status = {"schema": "vds.status/1", "state": "done", "message": "", "diagnostics": [lost, weak]}
    status["process"] = os.getpid()
    path = server.build / "status.json"
    try:
        path.write_text(json.dumps(status))
        until(page, "document.getElementById('told').textContent.includes('line 7')")
        told = page.locator("#told").inner_text()
        assert "warning, line 7" in told
        assert "no longer exists" in told
        assert "no good take" not in told
        wrong = lost | {
            "severity": "error",
            "file": "film/story.vds.lock",
            "message": "this lock does not read",
        }
        path.write_text(json.dumps(status | {"state": "error", "message": "1 error", "diagnostics": [wrong]}))
        page.wait_for_selector("#told.wrong")
        assert "error, story.vds.lock, line 7" in page.locator("#told").inner_text()
    finally:
        path.unlink()


def test_errors_are_shown_while_the_last_build_stays(server: Place, visit: Callable[..., Any]) -> None:
    page = visit(server.url)
    found = {
        "severity": "error",
        "line": 18,
        "title": "unknown action",
        "message": page_build.ATTACK,
        "help": "walk?",
    }
    found["suggestion"] = "wave"
    status = {"schema": "vds.status/1", "state": "error", "message": "1 error", "diagnostics": [found]}
    status["process"] = os.getpid()
    path = server.build / "status.json"
    try:
        path.write_text(json.dumps(status))
        page.wait_for_selector("#told.wrong")
        told = page.locator("#told").inner_text()
        assert "line 18" in told
        assert f"{page_build.ATTACK}; did you mean `wave`?" in told
        assert frame(page, "s1").is_visible()
        path.write_text(json.dumps(status | {"state": "building", "message": "compiling", "diagnostics": []}))
        until(page, "document.getElementById('told').textContent === 'compiling'")
    finally:
        path.unlink()


def test_library_and_stage_are_reached_from_the_page(server: Place, visit: Callable[..., Any]) -> None:
    page = visit(server.url)
    page.get_by_role("link", name="Library").click()
    page.locator("#words").fill("coffee pot")
    until(page, "document.getElementById('found').textContent.endsWith('found')")
    assert page.locator(".row:visible .name").first.inner_text() == "coffee_pot"
    page.locator(".row:visible summary").first.click()
    until(page, "document.querySelector('.row[open] .drawn img')?.naturalWidth > 200", 60)
    page.get_by_role("link", name="The storyboard").click()
    page.get_by_role("link", name="Set preview").click()
    until(page, "document.querySelector('main img')?.naturalWidth > 600", 60)


# What is done before the page's own script is there: a word typed, a row opened.
EARLY = """new MutationObserver((seen, watch) => {
  const words = document.getElementById("words"), row = document.querySelector("[data-picture*=coffee_pot]");
  if (words) words.value = "coffee pot";
  if (row) { row.open = true; watch.disconnect(); }
}).observe(document, { childList: true, subtree: true });"""


def test_what_is_typed_while_the_library_is_coming_counts(server: Place, visit: Callable[..., Any]) -> None:
    page = visit(server.url)
    page.add_init_script(EARLY)
    page.goto(f"{server.url}library")
    until(page, "document.getElementById('found').textContent.endsWith('found')")
    assert page.locator(".row:visible .name").first.inner_text() == "coffee_pot"
    until(page, "document.querySelector('.row[open] .drawn img')?.naturalWidth > 200", 60)


# --- more takes ---------------------------------------------------------------------------------

STORY = """\
size 96x54
proposals 24
takes 2
character anna = woman(top crimson)
scene room = apartment.living
anna at door
(anna wave)  / (static medium eye-level) 0.3s
"""
WAVE = "room-anna-wave"


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Place]:
    """A build of a script, not of flat pictures, served; results are kept beside it."""
    folder = tmp_path_factory.mktemp("compiled")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(cache_module.VARIABLE, "512")
        file, build = folder / "story.vds", folder / "build" / "story"
        file.write_text(STORY)
        compile_file(file, build, Options(rank="geometry"))
        with page_build.served(file, build) as address:
            yield Place(f"{address}/", file, build, True)


def test_more_takes_are_drawn_and_chosen(compiled: Place, visit: Callable[..., Any]) -> None:
    page = visit(compiled.url)
    strip = page.locator(f"#shot-{WAVE} .strip [data-take]:visible")
    assert strip.count() == 2
    page.get_by_role("button", name="Draw more takes of shot 1").click()
    until(page, f"document.querySelector('#shot-{WAVE} .drawing').textContent.startsWith('More takes:')")
    until(page, f"document.querySelectorAll('#shot-{WAVE} .strip [data-take]').length > 2", 100)
    page.wait_for_selector(f"#shot-{WAVE} .strip [data-take='3']:visible")
    count = strip.count()
    assert count > 2
    strip.nth(count - 1).click()
    opened(page, WAVE)
    page.locator("#choose").click()
    page.wait_for_selector("#pick-now .picked")
    (choice,) = read_lock(compiled.file.with_name("story.vds.lock")).choices
    document = json.loads((compiled.build / "storyboard.json").read_text())
    assert choice.key == document["shots"][0]["takes"][-1]["key"]


def test_a_mistake_on_the_way_to_more_takes_is_told(compiled: Place, visit: Callable[..., Any]) -> None:
    page = visit(compiled.url, expected="409 (Conflict)")
    compiled.file.write_text(STORY.replace("wave", "nod"))
    try:
        page.locator(f"#shot-{WAVE} .frame").focus()
        page.keyboard.press("m")
        page.wait_for_selector(f"#shot-{WAVE} .drawing.wrong")
        told = page.locator(f"#shot-{WAVE} .drawing").inner_text()
        assert told == "No more takes: the script has changed since this build; compile it first."
    finally:
        compiled.file.write_text(STORY)


def test_from_disk_the_command_is_told_that_draws_more(disk: Place, visit: Callable[..., Any]) -> None:
    page = visit(disk.url)
    page.get_by_role("button", name="Draw more takes of shot 2").click()
    told = page.locator("#shot-s2 .drawing")
    until(page, "!document.querySelector('#shot-s2 .drawing').hidden")
    assert told.locator("code").inner_text() == "vdsc compile story.vds --more s2"
    opened(page, "s1")
    page.keyboard.press("m")
    until(page, "document.querySelector('#viewer-drawing code')?.textContent.endsWith('--more s1')")
