"""Results kept between runs: what is taken from them, what is made anew, and what befalls damaged ones."""

import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from vdsl.cinema.track import CameraTrack
from vdsl.cli import app
from vdsl.emit.timeline import Placed
from vdsl.emit.video import write_part
from vdsl.pipeline import cache as cache_module
from vdsl.pipeline.cache import Cache, cleared
from vdsl.pipeline.compile import Result, Workshop, compile_file
from vdsl.pipeline.lock import choose, lock_path
from vdsl.pipeline.options import Options
from vdsl.pipeline.packing import PackError, pack, unpack

SCRIPT = """\
size 96x54
proposals 6
takes 2
character anna = woman(top crimson)
scene room = apartment.living
anna at door
(anna wave)  / (static medium eye-level) 0.5s
(anna nod)   / (push medium eye-level) 0.5s
scene kitchen = apartment.kitchen
anna at counter
(anna wave)  / (static full eye-level) 0.5s
"""
WORKSHOP = Workshop()


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the script, and results kept in a folder of their own."""
    monkeypatch.setenv(cache_module.VARIABLE, "512")
    monkeypatch.setattr(cache_module, "results_folder", lambda: tmp_path / "kept")
    (tmp_path / "story.vds").write_text(SCRIPT, "utf-8")
    return tmp_path


def made(project: Path, text: str = SCRIPT, **said: object) -> tuple[Result, list[str]]:
    """A build of a text, and the names of what was filmed for it, in seconds spent on each stage."""
    (project / "story.vds").write_text(text, "utf-8")
    options = Options(rank="geometry", **said)  # type: ignore[arg-type]
    result = compile_file(project / "story.vds", project / "build", options, workshop=WORKSHOP)
    return result, [s.name for s in result.report.stages if s.name in ("propose", "film", "sketch")]


def times(project: Path) -> dict[str, int]:
    folder = project / "build" / "shots"
    return {str(p.relative_to(folder)): p.stat().st_mtime_ns for p in folder.rglob("*") if p.is_file()}


def documents(project: Path) -> dict[str, bytes]:
    """What is to be the same however it was made, without pictures."""
    return {k: v for k, v in contents(project).items() if k.endswith((".json", ".svg", ".html"))}


def contents(project: Path) -> dict[str, bytes]:
    folder = project / "build"
    files = (p for p in folder.rglob("*") if p.is_file() and p.name != "report.json")
    return {str(p.relative_to(folder)): p.read_bytes() for p in files}


def test_only_what_changed_is_made_again(project: Path) -> None:
    _, worked = made(project)
    assert worked == ["propose", "film"]
    before, files = contents(project), times(project)

    same, worked = made(project)
    assert worked == []
    assert same.report.cache_misses == 0 < same.report.cache_hits
    assert contents(project) == before
    assert times(project) == files
    assert json.loads((project / "build" / "report.json").read_text("utf-8"))["cache"]["misses"] == 0

    _, worked = made(project, SCRIPT.replace("(push medium", "(pull medium"))
    after = times(project)
    assert worked == ["propose", "film"]
    assert {k for k in after if after[k] != files.get(k)} == {k for k in after if "nod" in k}

    _, worked = made(project)  # as it was: everything is still there
    assert worked == []
    assert contents(project) == before

    words = documents(project)
    made(project, cache=False)
    assert documents(project) == words
    assert contents(project).keys() == before.keys()


def test_parts_of_the_animatic_are_encoded_once(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = SCRIPT.replace("(anna wave)  / (static medium", "fade-in 0.2s\n(anna wave)  / (static medium", 1)
    text = text.replace("scene kitchen", "dissolve 4f\nscene kitchen")
    encoded: list[tuple[str, ...]] = []

    def noted(path: Path, shots: Sequence[tuple[Path, Placed]], fps: tuple[int, int]) -> None:
        encoded.append(tuple(film.parent.name for film, _ in shots))
        write_part(path, shots, fps)

    monkeypatch.setattr("vdsl.pipeline.parts.write_part", noted)
    made(project, text)
    faded, dissolved = ("room-anna-wave",), ("room-anna-nod", "kitchen-anna-wave")
    assert encoded == [faded, dissolved]
    animatic = contents(project)["animatic.mp4"]
    made(project, text.replace("(push medium", "(pull medium"))
    assert encoded[2:] == [dissolved]
    made(project, text.replace("fade-in 0.2s", "fade-in 0.3s"))
    assert encoded[3:] == [faded]
    made(project, text)
    assert len(encoded) == 4
    assert contents(project)["animatic.mp4"] == animatic


def test_a_name_and_the_order_of_scenes_change_nothing(project: Path) -> None:
    made(project)
    films = {k: v for k, v in contents(project).items() if k.endswith(".mp4") and "shots" in k}
    _, worked = made(
        project, SCRIPT.replace("(push medium eye-level) 0.5s", "(push medium eye-level) 0.5s, name yes")
    )
    assert worked == []
    named = contents(project)
    assert named["shots/yes/take-1.mp4"] == films["shots/room-anna-nod/take-1.mp4"]
    head, room, kitchen = SCRIPT.split("scene ")
    result, worked = made(project, f"{head}scene {kitchen}scene {room}")
    assert worked == []
    assert [s.shot.id for s in result.build.shots] == ["kitchen-anna-wave", "room-anna-wave", "room-anna-nod"]


def test_a_change_of_state_is_followed_and_nothing_else(project: Path) -> None:
    made(project)
    files = times(project)
    made(project, SCRIPT.replace("(anna wave)  / (static medium", "(anna walk sofa)  / (static medium"))
    after = times(project)
    changed = {k.split("/")[0] for k in after if after[k] != files.get(k)}
    assert changed == {"room-anna-walk-sofa", "room-anna-nod"}


def test_a_damaged_entry_is_noticed_and_made_again(project: Path) -> None:
    made(project)
    before = documents(project)
    hurt = 0
    for path in sorted((project / "kept").glob("??/*/*")):
        data = bytearray(path.read_bytes())
        data[len(data) // 2] ^= 0xFF
        path.unlink()  # not through the link, into the build
        path.write_bytes(bytes(data))
        hurt += 1
    assert hurt > 10
    result, worked = made(project)
    assert worked == ["propose", "film"]
    assert result.report.cache_hits == 0
    assert documents(project) == before
    assert made(project)[1] == []


def test_a_chosen_take_is_shown_first_even_one_that_was_not_kept(project: Path) -> None:
    first, _ = made(project, SCRIPT.replace("takes 2", "takes 6"))
    shot = first.build.shots[0]
    last = shot.takes[-1]
    made(project)
    kept = {t.key for t in made(project)[0].build.shots[0].takes}
    assert last.key not in kept
    document = project / "build" / "storyboard.json"
    told = json.loads(document.read_text("utf-8"))
    told["shots"][0]["takes"].append(told["shots"][0]["takes"][0] | {"rank": 3, "key": last.key})
    document.write_text(json.dumps(told), "utf-8")
    choose(project / "story.vds", shot.shot.id, last.key, project / "build")

    chosen, worked = made(project)
    best = chosen.build.shots[0].takes
    assert (best[0].key, best[0].chosen, len(best)) == (last.key, True, 2)
    assert worked == ["propose"] or "film" not in worked  # the film was kept from when there were six
    assert np.allclose(best[0].camera.track.position, last.camera.track.position)
    document = json.loads((project / "build" / "storyboard.json").read_text("utf-8"))
    assert [t["chosen"] for t in document["shots"][0]["takes"]] == [True, False]
    assert not chosen.warnings.diagnostics
    assert made(project)[1] == []

    reseeded, _ = made(project, f"seed 5\n{SCRIPT}")
    assert reseeded.build.shots[0].takes[0].key == last.key, "proposed again with the seed it was chosen with"

    lock = lock_path(project / "story.vds").read_text("utf-8")
    lost, _ = made(project, SCRIPT.replace("(static medium", "(pull medium"))
    (warning,) = [d for d in lost.warnings.diagnostics if d.code == "VDS311"]
    assert warning.span.text.startswith("/ (pull medium") or "pull" in warning.span.text
    assert "has changed" in warning.label
    assert lock_path(project / "story.vds").read_text("utf-8") == lock
    gone, _ = made(project, SCRIPT.replace("(anna wave)  / (static medium", "(anna bow)  / (static medium"))
    assert "VDS312" in {d.code for d in gone.warnings.diagnostics}
    assert lock_path(project / "story.vds").read_text("utf-8") == lock


@pytest.mark.parametrize("named", [False, True])
def test_a_choice_is_the_same_take_or_none_where_the_scene_is_renamed(project: Path, named: bool) -> None:
    """What is proposed goes by the scene's name: never is another take shown as the chosen one."""
    text = SCRIPT
    if named:
        text = text.replace("(static medium eye-level) 0.5s", "(static medium eye-level) 0.5s, name hello", 1)
    first, _ = made(project, text)
    shot = first.build.shots[0]
    choose(project / "story.vds", shot.shot.id, 2, project / "build")
    wanted = shot.takes[1]
    again, _ = made(project, text.replace("scene room", "scene chamber"))
    best = again.build.shots[0].takes[0]
    lost = "VDS311" in {d.code for d in again.warnings.diagnostics}
    assert best.chosen != lost
    if not named:
        assert best.chosen
    if best.chosen:
        assert best.key == wanted.key
        assert np.allclose(best.camera.track.position, wanted.camera.track.position)


def test_a_seed_is_pinned_by_the_lock(project: Path) -> None:
    seeded, _ = made(project, f"seed 9\n{SCRIPT}")
    choose(project / "story.vds", "room-anna-wave", 2, project / "build")
    again, _ = made(project)
    assert again.build.storyboard.seed == 9
    assert again.build.shots[0].takes[0].key == seeded.build.shots[0].takes[1].key


def test_a_draft_is_stills_of_what_changed(project: Path) -> None:
    made(project)
    text = SCRIPT.replace("(push medium", "(pull medium")
    draft, worked = made(project, text, draft=True)
    assert draft.build.draft
    assert "film" not in worked
    document = json.loads((project / "build" / "storyboard.json").read_text("utf-8"))
    films = {s["id"]: [t["video"] for t in s["takes"]] for s in document["shots"]}
    assert document["draft"]
    assert films["room-anna-nod"] == [None]
    assert None not in films["room-anna-wave"]
    assert (project / "build" / "shots" / "room-anna-nod" / "take-1.jpg").exists()
    whole, _ = made(project, text)
    assert not whole.build.draft
    again, worked = made(project, text, draft=True)
    assert (again.build.draft, worked) == (False, [])
    assert (project / "build" / "animatic.mp4").exists()


def test_first_takes_are_filmed_alone_and_kept_for_the_whole(project: Path) -> None:
    made(project)
    text = SCRIPT.replace("(push medium", "(pull medium")
    firsts, worked = made(project, text, firsts=True)
    assert (firsts.build.draft, firsts.build.waiting) == (False, 1)
    assert "film" in worked
    assert [len(s.takes) for s in firsts.build.shots] == [2, 1, 2]
    assert (project / "build" / "animatic.mp4").exists()
    film = (project / "build" / "shots" / "room-anna-nod" / "take-1.mp4").stat().st_mtime_ns
    whole, worked = made(project, text)  # from the proposals of the build before, which the workshop keeps
    assert (whole.build.waiting, worked) == (0, ["film"])
    assert [len(s.takes) for s in whole.build.shots] == [2, 2, 2]
    assert whole.build.shots[1].takes[0].key == firsts.build.shots[1].takes[0].key
    assert (project / "build" / "shots" / "room-anna-nod" / "take-1.mp4").stat().st_mtime_ns == film
    again, worked = made(project, text, firsts=True)
    assert (again.build.waiting, worked) == (0, [])


# -- the store ----------------------------------------------------------------------------------


@pytest.fixture
def store(tmp_path: Path) -> Callable[..., Cache]:
    return lambda limit=2**20: Cache(tmp_path / "kept", limit)


def test_entries_are_found_again_and_shared(tmp_path: Path, store: Callable[..., Cache]) -> None:
    film = tmp_path / "film.mp4"
    film.write_bytes(b"film")
    os.utime(film, ns=(10**18, 10**18))
    store().put("ab12", {"film.mp4": film, "value": b"1"})
    again = store()
    assert again.read("ab12") == b"1"
    assert again.take("ab12", {"film.mp4": tmp_path / "out" / "film.mp4"})
    assert (tmp_path / "out" / "film.mp4").stat().st_mtime_ns == 10**18
    assert again.read("cd34") is None
    assert (again.hits, again.misses) == (2, 1)


@pytest.mark.parametrize("how", ["short", "other", "missing", "table", "no table"])
def test_a_damaged_entry_counts_as_none(tmp_path: Path, store: Callable[..., Cache], how: str) -> None:
    store().put("ab12", {"value": b"12345"})
    entry = tmp_path / "kept" / "ab" / "ab12"
    if how == "table":
        (entry / "entry.json").write_text("{")
    elif how in ("missing", "no table"):
        (entry / ("value" if how == "missing" else "entry.json")).unlink()
    else:
        (entry / "value").write_bytes(b"123" if how == "short" else b"12346")
    place = tmp_path / "out"
    assert not store().take("ab12", {"value": place})
    assert not place.exists()
    assert store().read("ab12") is None
    store().put("ab12", {"value": b"new"})
    assert store().read("ab12") == b"new"


def test_the_longest_unused_go_first(tmp_path: Path, store: Callable[..., Cache]) -> None:
    small = store(limit=6000)
    for k in range(5):
        small.put(f"{k}{k}aa", {"value": bytes(1000)})
        os.utime(tmp_path / "kept" / f"{k}{k}" / f"{k}{k}aa" / "entry.json", (k, k))
    assert small.read("00aa") is not None  # now it is the latest
    small.put("99aa", {"value": bytes(1000)})
    store(limit=4000).tidy()
    left = [key for key in ("00aa", "11aa", "22aa", "33aa", "44aa", "99aa") if small.has(key)]
    assert left == ["00aa", "99aa"]
    assert cleared(tmp_path / "kept") > 2000
    assert not small.has("00aa")


def test_a_folder_that_may_not_be_written_loses_nothing(tmp_path: Path) -> None:
    (tmp_path / "kept").write_text("a file where the folder should be")
    cache = Cache(tmp_path / "kept")
    cache.put("ab12", {"value": b"1"})
    assert cache.read("ab12") is None
    cache.tidy()


def test_values_come_back_as_they_were() -> None:
    track = CameraTrack(np.ones((3, 3)), np.zeros((3, 3)), np.full(3, 35.0), np.ones((3, 3)), (36.0, 20.25))
    value = ({"a": (1, 2.5, None, "ü")}, [True, float("inf")], frozenset({("x", 1), ("y", 2)}), track)
    data = pack(value)
    again = unpack(data)
    assert again[:3] == value[:3]
    assert (again[3].position == track.position).all()
    assert again[3].sensor == (36.0, 20.25)
    assert pack(again) == data
    for bad in (
        data[:-8],
        b"",
        data.replace(b"vdsl.cinema.track", b"os.path.cinema.tr"),
        b"\x05" + bytes(7) + b"{[]}",
    ):
        with pytest.raises(PackError):
            unpack(bad)
    with pytest.raises(PackError):
        pack(object())


def test_cleaning_removes_builds_alone(project: Path) -> None:
    made(project)
    builds = project / "builds"
    os.renames(project / "build", builds / "story")
    (builds / "story" / "mine.txt").write_text("mine")
    (builds / "other").mkdir()
    (builds / "other" / "notes.txt").write_text("notes")
    told = json.loads(CliRunner().invoke(app, ["clean", str(builds), "--all", "--json"]).output)
    assert told["schema"] == "vds.clean/1"
    assert told["bytes"] > 10_000
    assert [p.name for p in (builds / "story").iterdir()] == ["mine.txt"]
    assert (builds / "other" / "notes.txt").exists()
    assert not list((project / "kept").glob("??/*"))
    assert (project / "story.vds").exists()
