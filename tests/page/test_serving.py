"""The served page: what it answers, and to whom it does not."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import httpx2
import page_build
import psutil
import pytest
import typer
from starlette.testclient import TestClient

from vdsl.cli.serve import _listen
from vdsl.pipeline.lock import Choice, Lock, choose, read_lock, write_lock
from vdsl.pipeline.serving import LARGEST_BODY, Desk, inside, serving
from vdsl.pipeline.serving_further import Further
from vdsl.pipeline.serving_state import Watched

HOST, TOKEN = "127.0.0.1:8765", "a-token-of-this-run"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    page_build.project(folder)
    return folder


@pytest.fixture
def desk(made: Path, tmp_path: Path) -> Desk:
    shutil.copytree(made, tmp_path, dirs_exist_ok=True)
    return Desk(tmp_path / "story.vds", tmp_path / "build" / "story", 8765, TOKEN, "cpu")


@pytest.fixture
def client(desk: Desk) -> Iterator[TestClient]:
    with TestClient(serving(desk), base_url=f"http://{HOST}") as client:
        yield client


def choice(client: TestClient, body: Any, **headers: str) -> Any:
    return client.post("/choose", json=body, headers={"X-VDS-Token": TOKEN, **headers})


def kept(desk: Desk) -> dict[str, str]:
    return {c.shot: c.key for c in read_lock(desk.file.with_name("story.vds.lock")).choices}


def everything(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


# --- reading ----------------------------------------------------------------------------------


def test_the_page_gets_the_token_only_from_the_server(client: TestClient, desk: Desk) -> None:
    assert TOKEN not in (desk.build / "index.html").read_text()
    page = client.get("/")
    assert page.status_code == 200
    assert f'<meta name="vds-token" content="{TOKEN}">' in page.text
    assert page.headers["cache-control"] == "no-store"
    assert "frame-ancestors 'none'" in page.headers["content-security-policy"]


def test_films_are_given_in_parts(client: TestClient, desk: Desk) -> None:
    film = (desk.build / "animatic.mp4").read_bytes()
    part = client.get("/animatic.mp4", headers={"Range": "bytes=10-19"})
    assert (part.status_code, part.content) == (206, film[10:20])
    assert part.headers["content-range"] == f"bytes 10-19/{len(film)}"
    assert client.get("/animatic.mp4").content == film
    assert client.get("/animatic.mp4", headers={"Range": f"bytes={len(film)}-"}).status_code == 416


def test_files_of_the_build_cannot_run_script_here(client: TestClient, desk: Desk) -> None:
    (desk.build / "mine.html").write_text("<script>fetch('/')</script>")
    policy = client.get("/mine.html").headers["content-security-policy"]
    assert policy.startswith("sandbox; default-src 'none'")


@pytest.mark.parametrize(
    "path",
    [
        "/../story.vds",
        "/..%2fstory.vds",
        "/%2e%2e/story.vds",
        "/%2e%2e%2fstory.vds",
        "/shots/../../../story.vds",
        "/shots/..%2f..%2f..%2fstory.vds",
        "/..%5cstory.vds",
        "/%252e%252e%252fstory.vds",
        "//etc/passwd",
        "/%2fetc%2fpasswd",
        "/shots//s1/take-1.mp4",
        "/.hidden",
        "/shots",
        "/story.vds%00.mp4",
        "/a-link",
        "/a-folder-link/story.vds",
    ],
)
def test_nothing_outside_the_build_is_read(client: TestClient, desk: Desk, path: str) -> None:
    (desk.build / ".hidden").write_text("mine")
    os.symlink(desk.file, desk.build / "a-link")
    os.symlink(desk.file.parent, desk.build / "a-folder-link")
    answer = client.get(f"http://{HOST}{path}")
    assert answer.status_code == 404
    assert page_build.SCRIPT not in answer.text


def test_a_link_that_stays_inside_is_followed(desk: Desk) -> None:
    os.symlink(desk.build / "animatic.mp4", desk.build / "best.mp4")
    assert inside(desk.build, "best.mp4") == (desk.build / "animatic.mp4").resolve()
    assert inside(desk.build, "../story/animatic.mp4") is None


def test_paths_are_taken_as_they_are_sent(desk: Desk) -> None:
    """Over a socket, as no client that tidies paths would ask."""
    with page_build.served(desk.file, desk.build) as address:
        host = address.removeprefix("http://")
        for path in (
            "/../../story.vds",
            "/shots/../../../story.vds",
            "/%2e%2e/%2e%2e/story.vds",
            "/..\\story.vds",
        ):
            assert raw(host, f"GET {path} HTTP/1.1\r\nHost: {host}\r\n").startswith("HTTP/1.1 404"), path
        assert raw(host, f"GET / HTTP/1.1\r\nHost: {host}\r\n").startswith("HTTP/1.1 200")
        twice = f"GET / HTTP/1.1\r\nHost: {host}\r\nHost: evil.example\r\n"
        assert raw(host, twice).startswith(("HTTP/1.1 403", "HTTP/1.1 400"))
        assert raw(host, "GET / HTTP/1.0\r\n").startswith("HTTP/1.1 403")
        absolute = "GET http://evil.example/ HTTP/1.1\r\nHost: evil.example\r\n"
        assert raw(host, absolute).startswith("HTTP/1.1 403")


def raw(host: str, head: str) -> str:
    """What a server answers to these bytes."""
    name, port = host.split(":")
    with socket.create_connection((name, int(port)), timeout=10) as asking:
        asking.sendall((head + "Connection: close\r\n\r\n").encode())
        return b"".join(iter(lambda: asking.recv(65536), b"")).decode("utf-8", "replace")


# --- strangers --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "host",
    ["evil.example", "evil.example:8765", "127.0.0.1", "127.0.0.1:1", "", "127.0.0.1:8765.evil.example"],
)
def test_another_host_is_not_answered(client: TestClient, desk: Desk, host: str) -> None:
    for answer in (
        client.get("/", headers={"Host": host}),
        choice(client, {"shot": "s1", "take": 1}, Host=host),
    ):
        assert answer.status_code == 403
        assert TOKEN not in answer.text
    assert kept(desk) == {}


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "null", "https://127.0.0.1:8765", "http://127.0.0.1:1", "http://localhost"],
)
def test_another_origin_is_not_answered(client: TestClient, desk: Desk, origin: str) -> None:
    assert client.get("/storyboard.json", headers={"Origin": origin}).status_code == 403
    assert choice(client, {"shot": "s1", "take": 1}, Origin=origin).status_code == 403
    assert kept(desk) == {}


def test_a_picture_on_another_site_costs_nothing_here(client: TestClient) -> None:
    strange = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "no-cors", "Sec-Fetch-Dest": "image"}
    assert client.get("/library/props/cup.png", headers=strange).status_code == 403
    link = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}
    assert client.get("/", headers=link).status_code == 200
    framed = link | {"Sec-Fetch-Dest": "iframe"}
    assert client.get("/", headers=framed).status_code == 403


@pytest.mark.parametrize("token", ["", "another", TOKEN[:-1], TOKEN + "x", "é"])
def test_without_the_token_nothing_is_written(client: TestClient, desk: Desk, token: str) -> None:
    before = everything(desk.file.parent)
    headers = {"X-VDS-Token": token.encode()} if token else {}
    for path in ("/choose", "/unchoose", "/further"):
        assert client.post(path, json={"shot": "s1", "take": 1}, headers=headers).status_code == 403  # type: ignore[arg-type]
    assert everything(desk.file.parent) == before


def test_a_form_of_another_site_cannot_write(client: TestClient, desk: Desk) -> None:
    for kind in ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"):
        headers = {"X-VDS-Token": TOKEN, "Content-Type": kind}
        answer = client.post("/choose", content=b'{"shot": "s1", "take": 1}', headers=headers)
        assert answer.status_code == 415
    assert kept(desk) == {}


@pytest.mark.parametrize("method", ["PUT", "DELETE", "PATCH", "OPTIONS", "TRACE"])
def test_there_are_no_other_ways_in(client: TestClient, method: str) -> None:
    for path in ("/", "/index.html", "/storyboard.json", "/choose"):
        assert client.request(method, path, headers={"X-VDS-Token": TOKEN}).status_code == 405


@pytest.mark.parametrize("path", ["/", "/index.html", "/storyboard.json", "/events", "/library", "/new.txt"])
def test_nothing_else_can_be_written(client: TestClient, desk: Desk, path: str) -> None:
    before = everything(desk.file.parent)
    assert (
        client.post(path, json={"shot": "s1", "take": 1}, headers={"X-VDS-Token": TOKEN}).status_code == 405
    )
    assert everything(desk.file.parent) == before


# --- choosing ---------------------------------------------------------------------------------


def test_a_choice_is_written_to_the_lock_and_nowhere_else(client: TestClient, desk: Desk) -> None:
    before = everything(desk.file.parent)
    answer = choice(client, {"shot": "s1", "take": "14-00000002"}, Origin=f"http://{HOST}")
    assert answer.status_code == 200
    assert answer.json() == {"choices": {"s1": "14-00000002"}} == {"choices": kept(desk)}
    after = everything(desk.file.parent)
    assert set(after) - set(before) == {"story.vds.lock"}
    assert all(after[name] == before[name] for name in before)
    assert client.post("/unchoose", json={"shot": "s1"}, headers={"X-VDS-Token": TOKEN}).json() == {
        "choices": {}
    }
    assert everything(desk.file.parent) == before


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ({"shot": "s9", "take": 1}, 409),
        ({"shot": "s1", "take": 99}, 409),
        ({"shot": "../../x", "take": 1}, 409),
        ({"shot": "s1"}, 422),
        ({"shot": "s1", "take": True}, 422),
        ({"shot": ["s1"], "take": 1}, 422),
        ([1, 2], 422),
        ("s1", 422),
        ({"shot": "s1", "take": 1, "more": "x" * LARGEST_BODY}, 422),
    ],
)
def test_a_choice_that_cannot_be_is_refused_with_why(
    client: TestClient, desk: Desk, body: Any, status: int
) -> None:
    answer = choice(client, body)
    assert (answer.status_code, bool(answer.json()["error"])) == (status, True)
    assert kept(desk) == {}


def test_a_lock_that_does_not_read_is_not_written_over(client: TestClient, desk: Desk) -> None:
    lock = desk.file.with_name("story.vds.lock")
    lock.write_text("<<<<<<< ours\n")
    assert choice(client, {"shot": "s1", "take": 1}).status_code == 409
    assert lock.read_text() == "<<<<<<< ours\n"


# --- more takes -------------------------------------------------------------------------------


def more(client: TestClient, body: Any) -> Any:
    return client.post("/further", json=body, headers={"X-VDS-Token": TOKEN})


def told_of(desk: Desk, **said: Any) -> None:
    """The build's document with something else in it."""
    path = desk.build / "storyboard.json"
    document = json.loads(path.read_text())
    document["script"] = hashlib.sha256(page_build.SCRIPT.encode()).hexdigest()
    path.write_text(json.dumps(document | said))


def test_more_takes_are_refused_with_why(client: TestClient, desk: Desk) -> None:
    before = everything(desk.file.parent)
    assert "the script has changed" in more(client, {"shot": "s1"}).json()["error"]
    for body, status in (({"shot": "s9"}, 409), ({"shot": "../x"}, 409), ({}, 422), ({"shot": 1}, 422)):
        assert more(client, body).status_code == status
    assert everything(desk.file.parent) == before
    told_of(desk, draft=True)
    assert "draft" in more(client, {"shot": "s1"}).json()["error"]
    (desk.build / "storyboard.json").unlink()
    assert "no build" in more(client, {"shot": "s1"}).json()["error"]


def drawn(desk: Desk, ending: bool = False) -> dict[str, dict[str, str]]:
    """What is told of further takes when they have been asked for and their turn is over."""
    turns = ThreadPoolExecutor(1)
    further = Further(desk.file, desk.build, turns, lambda: False, lambda: ending)
    further.ask("s1")
    further.ask("s1")  # once is enough
    turns.shutdown()
    return further.state()


def test_what_fails_while_more_takes_are_drawn_is_told(desk: Desk) -> None:
    desk.file.with_name("story.vds.lock").write_text("<<<<<<< ours\n")
    before = everything(desk.build)
    told = drawn(desk)["s1"]
    assert told["state"] == "error"
    assert told["message"].startswith("the script or its lock has errors")
    assert everything(desk.build) == before


def test_drawing_ends_with_the_server(desk: Desk) -> None:
    before = everything(desk.build)
    assert drawn(desk, ending=True)["s1"]["state"] != "error"
    assert everything(desk.build) == before


# --- going along ------------------------------------------------------------------------------


def test_the_state_follows_what_happens(desk: Desk) -> None:
    watched = Watched(desk.file, desk.build)
    first = watched.state()
    assert first == watched.state()
    assert (first["state"], first["choices"]) == ("done", {})
    choose(desk.file, "s1", 2, desk.build)
    assert watched.state()["choices"] == {"s1": "14-00000002"}
    assert watched.state()["build"] == first["build"]
    status = {"schema": "vds.status/1", "state": "error", "message": "1 error", "diagnostics": [{"line": 3}]}
    status["process"] = os.getpid()
    (desk.build / "status.json").write_text(json.dumps(status))
    told = watched.state()
    assert (told["state"], told["message"], told["diagnostics"]) == ("error", "1 error", [{"line": 3}])
    (desk.build / "status.json").write_text("{half")
    assert watched.state()["state"] == "done"
    page = desk.build / "index.html"
    page.write_text(page.read_text() + "\n")
    assert watched.state()["build"] != first["build"]


def test_a_choice_is_seen_whatever_its_number_and_its_shot_are_now(client: TestClient, desk: Desk) -> None:
    depends = json.loads((desk.build / "storyboard.json").read_text())["shots"][1]["depends"]
    chosen = Choice("formerly", "99-00000002", "x", 12, 0, depends)
    write_lock(desk.file.with_name("story.vds.lock"), Lock(0, (), (chosen,)))
    watched = Watched(desk.file, desk.build)
    assert watched.state()["choices"] == {"s2": "14-00000002"}
    assert (
        choice(client, {"shot": "s2", "take": 1}).json()
        == {"choices": {"s2": "7-00000001"}}
        == {"choices": kept(desk)}
    )
    write_lock(desk.file.with_name("story.vds.lock"), Lock(0, (), (chosen,)))
    taken_back = client.post("/unchoose", json={"shot": "s2"}, headers={"X-VDS-Token": TOKEN})
    assert taken_back.json() == {"choices": {}}
    assert kept(desk) == {}


def test_nobody_is_said_to_compile_who_was_killed(desk: Desk) -> None:
    watched, path = Watched(desk.file, desk.build), desk.build / "status.json"
    compiling = {"schema": "vds.status/1", "state": "building", "message": "compiling", "diagnostics": []}

    def said(**more: object) -> str:
        path.write_text(json.dumps(compiling | more))
        return str(watched.state()["state"])

    gone = subprocess.Popen([sys.executable, "-c", ""])
    assert gone.wait() == 0
    assert said(process=os.getpid()) == "building"
    assert said(process=gone.pid) == "done"
    for nobody in (None, "1", -1, 2**70, True):
        assert said(process=nobody) == "done", nobody
    path.write_text(json.dumps(compiling | {"process": os.getpid()}))
    os.utime(path, (1e9, 1e9))  # whoever has the number now began after this was written
    assert watched.state()["state"] == "done"


def test_a_script_that_went_on_is_told(desk: Desk) -> None:
    watched = Watched(desk.file, desk.build)
    document = json.loads((desk.build / "storyboard.json").read_text())
    document["script"] = hashlib.sha256(page_build.SCRIPT.encode()).hexdigest()
    (desk.build / "storyboard.json").write_text(json.dumps(document))
    assert watched.state()["stale"] is False
    desk.file.write_text(page_build.SCRIPT + "\n# more\n")
    assert watched.state()["stale"] is True


def test_before_the_first_build_the_page_waits(tmp_path: Path) -> None:
    file = tmp_path / "story.vds"
    file.write_text(page_build.SCRIPT)
    desk = Desk(file, tmp_path / "build" / "story", 8765, TOKEN)
    with TestClient(serving(desk), base_url=f"http://{HOST}") as client:
        page = client.get("/")
    assert page.status_code == 503
    assert "There is no build yet" in page.text


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM])
def test_it_ends_when_told_to_even_while_a_page_listens(desk: Desk, ending: signal.Signals) -> None:
    with page_build.serving_process(desk.file, desk.build) as (process, address):
        name, port = address.removeprefix("http://").split(":")
        with socket.create_connection((name, int(port)), timeout=10) as listening:
            listening.sendall(f"GET /events HTTP/1.1\r\nHost: {name}:{port}\r\n\r\n".encode())
            told = b""
            while b"event: state" not in told:
                told += listening.recv(4096)
            process.send_signal(ending)
            assert process.wait(20) == 0
    assert process.stderr is not None
    assert process.stderr.read() == ""


def test_watching_goes_along_and_ends_with_it(tmp_path: Path) -> None:
    """Of a script with a mistake, so that nothing is compiled: what it is told is shown before any build."""
    file, build = tmp_path / "story.vds", tmp_path / "build" / "story"
    file.write_text(page_build.SCRIPT.replace("wave", "wvae"))
    with page_build.serving_process(file, build, "--watch") as (process, address):
        (watching,) = psutil.Process(process.pid).children()
        for _ in range(300):
            page = httpx2.get(f"{address}/")
            if "wvae" in page.text:
                break
            time.sleep(0.2)
        assert page.status_code == 503
        assert "error, line 6" in page.text
        assert "no action is called `wvae`" in page.text
        process.send_signal(signal.SIGTERM)
        assert process.wait(30) == 0
        assert not watching.is_running()


def test_watching_ends_also_with_a_server_that_was_killed(tmp_path: Path) -> None:
    file, build = tmp_path / "story.vds", tmp_path / "build" / "story"
    file.write_text(page_build.SCRIPT.replace("wave", "wvae"))
    with page_build.serving_process(file, build, "--watch") as (process, address):
        (watching,) = psutil.Process(process.pid).children()
        while "wvae" not in httpx2.get(f"{address}/", timeout=60).text:
            time.sleep(0.2)
        process.kill()
        watching.wait(30)
    # killed while it loads, it may end without a word; what it wrote last is whole, and names who is gone
    assert json.loads((build / "status.json").read_text())["process"] == watching.pid
    assert not psutil.pid_exists(watching.pid)


def test_two_that_begin_at_once_get_a_port_each(desk: Desk) -> None:
    with (
        page_build.serving_process(desk.file, desk.build) as (_, first),
        page_build.serving_process(desk.file, desk.build) as (_, second),
    ):
        assert first != second
        assert httpx2.get(f"{first}/", timeout=60).status_code == 200
        assert httpx2.get(f"{second}/", timeout=60).status_code == 200
    one, two = _listen(None), _listen(None)  # both before either is served
    assert one.getsockname() != two.getsockname()
    with pytest.raises(typer.Exit):
        _listen(one.getsockname()[1])
    one.close()
    two.close()


def test_watching_that_dies_is_told_and_the_page_stays(desk: Desk) -> None:
    with page_build.serving_process(desk.file, desk.build, "--watch") as (process, address):
        psutil.Process(process.pid).children()[0].kill()
        assert process.stderr is not None
        assert "watching ended by itself" in process.stderr.readline()
        assert httpx2.get(f"{address}/").status_code == 200


def test_serving_says_what_is_missing(tmp_path: Path) -> None:
    file = tmp_path / "story.vds"
    for words in (f"there is no file {file}", "there is no build at"):
        done = subprocess.run([*page_build.SERVE, str(file), "--no-open"], capture_output=True, text=True)
        assert done.returncode == 2
        assert words in done.stderr
        file.write_text(page_build.SCRIPT)


# --- the library ------------------------------------------------------------------------------


def test_the_library_lists_what_there_is(client: TestClient) -> None:
    page = client.get("/library").text
    assert 'data-picture="/library/props/coffee_pot.png"' in page
    assert "apartment" in page
    for path in ("/library/props/no_such.png", "/library/secrets/cup.png", "/library/props/..%2fcup.png"):
        assert client.get(path).status_code == 404


def test_the_stage_shows_the_scenes(client: TestClient, desk: Desk) -> None:
    page = client.get("/stage", params={"from": '"><script>alert(1)</script>'}).text
    assert "kitchen = apartment.kitchen at" in page
    assert "<script>alert" not in page
    assert client.get("/stage/attic.png").status_code == 404
    broken = client.get("/stage/kitchen.png", params={"from": "(static)\nuse x"})
    assert broken.status_code == 404
    desk.file.write_text("scene kitchen = nowhere\n")
    assert "mend the script" in client.get("/stage").text
