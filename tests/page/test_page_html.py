"""What the page says and what it never says, read without a browser."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "emit"))

import emit_film as f

from vdsl.emit import templating
from vdsl.emit.page import page_html, write_page
from vdsl.emit.page_view import page_view
from vdsl.emit.storyboard_json import storyboard_document

ATTACK = "<script>alert(1)</script>\"'&</title><img src=x onerror=alert(2)>"


class Tags(HTMLParser):
    """Collects tags with their attributes, and all text."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.text += data


def parsed(html: str) -> Tags:
    tags = Tags()
    tags.feed(html)
    return tags


def page_of(*shots: Any, **film: Any) -> str:
    return page_html(storyboard_document(f.film(shots, **film)))


def test_shots_stand_in_order_and_everything_is_beside_the_page(tmp_path: Path) -> None:
    shots = [f.built(tmp_path, "s1", say="Hello"), f.built(tmp_path, "ü2"), f.built(tmp_path, "s3", takes=0)]
    page = parsed(page_of(*shots))
    panels = [a["id"] for t, a in page.tags if t == "li" and a.get("class") == "panel"]
    assert panels == ["shot-s1", "shot-ü2", "shot-s3"]
    pictures = [a["src"] for t, a in page.tags if t == "img"]
    assert pictures[:3] == ["shots/s1/take-1.jpg", "shots/s1/take-1.jpg", "shots/s1/take-2.jpg"]
    assert "shots/%C3%BC2/take-1.mp4" in [a["href"] for t, a in page.tags if t == "a"]
    links = [v for _, a in page.tags for k, v in a.items() if k in ("src", "href", "poster")]
    served = ("/stage", "/library")  # hidden where the page is not served
    assert not [
        v for v in links if v and ("//" in v or v.startswith("/")) and v not in served and v[:5] != "data:"
    ]
    assert "Hello" in page.text
    assert "wall 5, hidden 2" in page.text


def test_what_people_type_stays_text(tmp_path: Path) -> None:
    html = page_of(f.built(tmp_path, "s1", say=ATTACK, note=ATTACK), title=ATTACK)
    assert "<script>alert" not in html
    page = parsed(html)
    assert sum(t == "script" for t, _ in page.tags) == 3  # the theme, the data, the page's own
    assert page.text.count(ATTACK) == 4  # title, heading, say and note, as typed
    data = json.loads(html.split('id="data">')[1].split("</script>")[0])
    assert data["shots"][0]["say"] == ATTACK


def test_only_the_scripts_of_the_page_may_run(tmp_path: Path) -> None:
    page = parsed(page_of(f.built(tmp_path, "s1")))
    policy = next(a["content"] for t, a in page.tags if a.get("http-equiv") == "Content-Security-Policy")
    assert policy is not None
    assert policy.count("'sha256-") == 2
    assert "unsafe" not in policy


def test_no_file_put_into_the_page_can_end_its_element(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "bad.js").write_text('const x = "</script>";')
    monkeypatch.setattr(templating, "FOLDER", tmp_path)
    with pytest.raises(ValueError, match="end tag"):
        templating._script("bad.js")


def test_every_take_says_why_it_ranks_where_it_does(tmp_path: Path) -> None:
    html = page_of(f.built(tmp_path, "s1", takes=3))
    (shot,) = json.loads(html.split('id="data">')[1].split("</script>")[0])["shots"]
    assert [t["why"].split(":")[0] for t in shot["takes"]] == ["ranks first", "ranks second", "ranks third"]
    measures = shot["takes"][0]["measures"]
    assert {"words": "nothing hides the subject", "value": "98 %", "fine": True} in measures
    assert [m["fine"] for m in measures] == sorted(m["fine"] for m in measures)


def test_more_takes_than_a_strip_holds_wait_for_being_asked_for(tmp_path: Path) -> None:
    page = parsed(page_of(f.built(tmp_path, "s1", takes=7)))
    strip = [a for t, a in page.tags if t == "button" and "data-take" in a]
    assert [a["data-take"] for a in strip if "hidden" not in a] == ["1", "2", "3", "4", "5"]
    assert "2 more" in page.text


def test_every_take_brings_its_plan(tmp_path: Path) -> None:
    build = f.film([f.built(tmp_path, "s1", takes=3)])
    for name in ("plan", "plan-3"):  # the second has none
        (tmp_path / "shots" / "s1" / f"{name}.svg").write_text(f"<svg><title>{name}</title></svg>")
    write_page(tmp_path / "index.html", build)
    html = (tmp_path / "index.html").read_text("utf-8")
    assert '<template data-plan="s1" data-take="1"><svg><title>plan</title></svg></template>' in html
    assert '<template data-plan="s1" data-take="3"><svg><title>plan-3</title></svg></template>' in html
    assert html.count("<template") == 2


def test_the_cast_is_shown_by_pictures_they_are_in(tmp_path: Path) -> None:
    document = storyboard_document(f.film([f.built(tmp_path, name) for name in ("s1", "s2", "s3")]))
    first, second, third = document["shots"]
    name = first["story"]["char"]
    first["takes"][0] |= {
        "scale": "close-up",
        "movement": "pan-left",
    }  # near, but turning away
    second["takes"][0] |= {"scale": "medium", "movement": "static"}
    third["takes"][0] |= {"scale": "close-up", "movement": "static"}
    for shot, seen in ((first, 1.0), (second, 1.0), (third, 0.2)):
        shot["takes"][0]["measures"] |= {"head_visible": seen}
    (person,) = [p for p in page_view(document, {})["cast"] if p["name"] == name]
    assert person["poster"] == second["takes"][0]["poster"]


def test_an_empty_film_is_a_page_too() -> None:
    page = parsed(page_of())
    assert "Morning coffee" in page.text
    assert not [t for t, _ in page.tags if t == "video" and _.get("id") == "film"]


def test_what_a_take_came_out_as_is_told_where_it_differs(tmp_path: Path) -> None:
    document = storyboard_document(f.film([f.built(tmp_path, "s1")]))
    first, second = document["shots"][0]["takes"]
    first["achieved"] |= {"scale": "full"}
    second["achieved"] |= {"movement": "push"}  # the same family: as asked
    html = page_html(document)
    (shot,) = json.loads(html.split('id="data">')[1].split("</script>")[0])["shots"]
    assert [t["became"] for t in shot["takes"]] == ["full", ""]


def test_a_draft_shows_pictures_and_no_films(tmp_path: Path) -> None:
    document = storyboard_document(f.film([f.built(tmp_path, "s1", takes=1)]))
    document["draft"] = True
    document["shots"][0]["takes"][0]["video"] = None
    html = page_html(document)
    page = parsed(html)
    assert "A draft: 1 of 1 shots" in page.text
    assert "animatic.mp4" not in html
    assert [a["src"] for t, a in page.tags if a.get("class") == "film"] == ["shots/s1/take-1.jpg"]
    assert "None" not in html
    (opened,) = [a for t, a in page.tags if a.get("class") == "frame"]
    assert opened["href"] == "shots/s1/take-1.jpg"


def test_the_foot_says_who_ranked_what_is_shown(tmp_path: Path) -> None:
    films = [f.built(tmp_path, "s1"), f.built(tmp_path, "s2")]
    stills = [replace(shot, takes=tuple(drafted(t) for t in shot.takes[:1])) for shot in films]

    def foot(*shots: Any, **said: Any) -> str:
        page = parsed(page_html(storyboard_document(replace(f.film(shots), **said))))
        return page.text.partition("takes ranked by ")[2].partition(". What")[0]

    assert foot(*films) == "the ranker"
    assert foot(*films, judge="geometry") == "their geometry"
    assert foot(*stills, draft=True) == "their geometry, for this draft"
    assert foot(films[0], stills[1], draft=True) == "the ranker, in the draft's stills by their geometry"
    assert foot(*stills, draft=True, judge="geometry") == "their geometry"


def drafted(take: Any) -> Any:
    return replace(take, media=replace(take.media, sketched=True))
