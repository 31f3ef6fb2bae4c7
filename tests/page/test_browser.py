"""The page driven in Chromium, from disk and served by ``vdsc serve``."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import page_build
import pytest
from axe_playwright_python.sync_playwright import Axe
from driving import Place, at_frame, frame, opened, plays, until

from vdsl.pipeline.lock import read_lock

pytestmark = pytest.mark.slow

# --- playing ----------------------------------------------------------------------------------


def test_a_panel_plays_under_the_pointer_and_stops_after(place: Place, visit: Callable[..., Any]) -> None:
    page = visit(place.url)
    frame(page, "s2").hover()
    plays(page, "#shot-s2 video")
    page.mouse.move(2, 2)
    until(page, "!document.querySelector('.frame video')")


def test_it_plays_large_on_click_and_goes_frame_by_frame(place: Place, visit: Callable[..., Any]) -> None:
    page = opened(visit(place.url))
    plays(page, "#player")
    page.keyboard.press("Space")
    until(page, "document.getElementById('player').paused")
    page.locator("#scrub").fill("9")
    at_frame(page, 10)
    page.keyboard.press("ArrowRight")
    at_frame(page, 11)
    page.locator("#back").click()
    page.locator("#back").click()
    at_frame(page, 9)
    page.keyboard.press("Escape")
    until(page, "!document.getElementById('viewer').open")
    until(page, "document.activeElement.closest('.panel')?.id === 'shot-s2'")


def test_who_wants_no_motion_gets_none(disk: Place, visit: Callable[..., Any]) -> None:
    page = visit(disk.url, reduced_motion="reduce")
    frame(page, "s2").hover()
    page.wait_for_timeout(300)
    assert page.locator(".frame video").count() == 0
    opened(page)
    page.wait_for_timeout(300)
    assert page.evaluate("document.getElementById('player').paused")


def test_the_film_goes_to_a_shot(place: Place, visit: Callable[..., Any]) -> None:
    page = visit(place.url)
    page.locator(".cutting button").nth(1).click()
    until(page, "document.getElementById('now').textContent.startsWith('2')")
    assert page.evaluate("document.getElementById('film').currentTime") == pytest.approx(1.02, abs=0.02)
    assert page.locator('.cutting [aria-current="true"]').get_attribute("data-shot") == "s2"


# --- takes ------------------------------------------------------------------------------------


def test_takes_are_stepped_through(place: Place, visit: Callable[..., Any]) -> None:
    page = visit(place.url)
    page.locator("#shot-s1 .strip [data-take='2']").click()
    assert page.locator("#shot-s1 .frame img").get_attribute("src") == "shots/s1/take-2.jpg"
    assert "take 2, score 0.70: ranks second" in page.locator("#shot-s1 .words").inner_text()
    page.keyboard.press("1")
    assert "best of 80" in page.locator("#shot-s1 .words").inner_text()
    page.keyboard.press("2")
    opened(page, "s1")
    assert "take 2 of 2" in page.locator("#viewer-rank").inner_text()
    page.keyboard.press("1")
    assert "take 1 of 2" in page.locator("#viewer-rank").inner_text()
    assert "Ranks first" in page.locator("#viewer-why").inner_text()
    page.keyboard.press("ArrowDown")
    assert page.locator("#viewer-number").inner_text() == "2"


def test_more_takes_come_when_asked_for(disk: Place, visit: Callable[..., Any]) -> None:
    page = visit(disk.url)
    strip = page.locator("#shot-s3 .strip [data-take]:visible")
    assert strip.count() == 5
    page.get_by_role("button", name="2 more").click()
    assert strip.count() == 7
    strip.nth(6).click()
    assert page.locator("#shot-s3 .frame img").get_attribute("src") == "shots/s3/take-7.jpg"


def test_from_disk_the_command_is_given(disk: Place, visit: Callable[..., Any]) -> None:
    page = opened(visit(disk.url, permissions=["clipboard-read", "clipboard-write"]))
    page.keyboard.press("2")
    assert page.locator("#command").inner_text() == "vdsc pick story.vds s2 2"
    assert not page.locator("#choose").is_visible()
    page.locator("#copy").click()
    until(page, "/Copied|Marked/.test(document.getElementById('pick-said').textContent)")


def test_served_a_take_is_chosen_and_let_go(server: Place, visit: Callable[..., Any]) -> None:
    page = opened(visit(server.url))
    page.keyboard.press("2")
    page.locator("#choose").click()
    page.wait_for_selector("#pick-now .picked")
    until(page, "document.getElementById('pick-said').textContent.startsWith('Take 2 is kept')")
    page.wait_for_timeout(900)  # what the server tells meanwhile must not take the words away
    assert page.locator("#pick-said").inner_text().startswith("Take 2 is kept")
    (choice,) = read_lock(server.file.with_name("story.vds.lock")).choices
    assert (choice.shot, choice.key) == ("s2", "14-00000002")
    again = visit(server.url)
    again.wait_for_selector("#shot-s2 .frame .picked")
    assert "chosen" in (again.locator("#shot-s2 [data-take='2']").get_attribute("aria-label") or "")
    page.locator("#unchoose").click()
    page.wait_for_selector("#pick-now .picked", state="detached")
    again.wait_for_selector("#shot-s2 .frame .picked", state="detached")  # it goes along by itself
    assert not server.file.with_name("story.vds.lock").exists()


# --- finding, keys ----------------------------------------------------------------------------


def test_shots_are_found(place: Place, visit: Callable[..., Any]) -> None:
    page = visit(place.url)
    shown = page.locator(".panel:visible")
    page.keyboard.press("/")
    page.keyboard.type("STEAM")
    assert shown.count() == 1
    assert page.locator("#found").inner_text() == "1 of 3 shots"
    page.locator("[name=words]").fill("no such thing")
    page.locator("#clear").click()
    assert shown.count() == 3
    page.locator(".chart button[data-filter=size]").first.click()
    assert shown.count() == 3  # all are medium


def test_everything_can_be_done_by_keys(place: Place, visit: Callable[..., Any]) -> None:
    page = visit(place.url)
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    assert page.locator(".panel.at").get_attribute("data-shot") == "s2"
    page.keyboard.press("2")
    assert page.locator("#shot-s2 .frame img").get_attribute("src") == "shots/s2/take-2.jpg"
    page.keyboard.press("Space")
    plays(page, "#shot-s2 video")
    page.keyboard.press("Enter")
    page.wait_for_selector("#viewer[open]")
    page.keyboard.press("Escape")
    page.keyboard.press("?")
    assert page.locator("#help").is_visible()
    page.keyboard.press("Escape")
    assert not page.locator("#help").is_visible()


# --- looks ------------------------------------------------------------------------------------


def brightness(page: Any) -> float:
    colour = page.evaluate("getComputedStyle(document.body).backgroundColor")
    return sum(float(part) for part in re.findall(r"[\d.]+", colour)[:3]) / 3


def test_light_and_dark(place: Place, visit: Callable[..., Any]) -> None:
    assert brightness(visit(place.url, color_scheme="light")) > 200
    page = visit(place.url, color_scheme="dark")
    assert brightness(page) < 40
    page.locator("#theme").click()
    assert brightness(page) > 200
    page.reload()
    assert brightness(page) > 200
    # Chromium may lose localStorage when a page from disk is loaded again at once.
    page.evaluate("localStorage.clear()")
    page.reload()
    assert brightness(page) > 200
    page.keyboard.press("d")
    assert brightness(page) < 40


def test_a_phone_scrolls_only_down(place: Place, visit: Callable[..., Any]) -> None:
    page = visit(place.url, 380, 800, is_mobile=True, has_touch=True)
    wide = "Math.max(document.documentElement.scrollWidth, document.body.scrollWidth)"
    assert page.evaluate(wide) <= 380
    opened(page)
    assert page.evaluate("document.getElementById('viewer').scrollWidth") <= 380
    assert page.locator("#player").bounding_box()["width"] > 340
    assert page.locator("#close").bounding_box()["height"] >= 40


def test_on_paper_all_panels_stand_with_lines_to_write_on(disk: Place, visit: Callable[..., Any]) -> None:
    page = visit(disk.url)
    page.locator("[name=words]").fill("steam")
    page.emulate_media(media="print", color_scheme="dark")
    assert page.locator(".panel:visible").count() == 3
    assert not page.locator(".bar").is_visible()
    assert brightness(page) == 255
    assert len(page.pdf(format="A4")) > 10_000


def test_what_a_script_says_is_shown_as_text(place: Place, visit: Callable[..., Any]) -> None:
    page = visit(place.url)
    assert page.locator("#shot-s1 .say").inner_text() == page_build.ATTACK
    opened(page, "s1")
    assert page.locator("#viewer-say").inner_text() == page_build.ATTACK
    assert page.title() == "Morning coffee"
    assert page.locator("img[src=x]").count() == 0


# --- for everybody ----------------------------------------------------------------------------


def faults(page: Any) -> list[str]:
    """What axe-core finds serious or critical."""
    found = Axe().run(page).response["violations"]
    bad = [v for v in found if v["impact"] in ("serious", "critical")]
    return [f"{v['id']}: {node['html'][:120]}" for v in bad for node in v["nodes"]]


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 380])
def test_axe_finds_no_serious_fault(
    server: Place, visit: Callable[..., Any], scheme: str, width: int
) -> None:
    page = visit(server.url, width, color_scheme=scheme)
    assert faults(page) == []
    opened(page)
    assert faults(page) == []


@pytest.mark.parametrize("path", ["library", "stage"])
def test_axe_finds_no_serious_fault_beside_it(server: Place, visit: Callable[..., Any], path: str) -> None:
    page = visit(server.url)
    page.route("**/*.png*", lambda route: route.fulfill(body=b"", content_type="image/png"))
    page.goto(server.url + path)
    assert faults(page) == []
