"""The lock of chosen takes: read, written, merged, damaged, and found again in a script that changed."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from vdsl.cli import app
from vdsl.pipeline.depends import shot_digests
from vdsl.pipeline.lock import Choice, ChoiceError, Lock, choose, clear, lock_path, read_lock, write_lock
from vdsl.pipeline.placing import placed
from vdsl.pipeline.project import project_of
from vdsl.pipeline.script import ScriptError, load_storyboard

CUP = Choice("kitchen-anna-pour-cup", "17-3f9a2c1b", "push medium high-angle", 80, 0, "9c41d2e07a55")
DOOR = Choice("kitchen-anna-open-door", "3-00ffab12", "static full eye-level", 24, 7, "0123456789ab")


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "story.vds"
    path.write_text(
        "character anna = woman\nscene kitchen = apartment.kitchen\nanna at door\n"
        "(anna walk counter) / (follow full)\n(anna wave) / (static medium)\n",
        "utf-8",
    )
    return path


def build_of(script: Path, shots: dict[str, list[str]]) -> Path:
    """A build's document with takes of such keys."""
    folder = script.parent / "build" / script.stem
    folder.mkdir(parents=True)
    words = {"movement": "static", "scale": "medium", "angle": "eye-level"}
    entries = [
        {
            "id": name,
            "wanted": 12,
            "depends": "0123456789ab",
            "takes": [{"rank": k, "key": key, **words} for k, key in enumerate(keys, start=1)],
        }
        for name, keys in shots.items()
    ]
    document = {
        "schema": "vds.storyboard/1",
        "seed": 0,
        "made_with": {"vdsl": "1", "look": "2"},
        "shots": entries,
    }
    (folder / "storyboard.json").write_text(json.dumps(document), "utf-8")
    return folder


def test_what_is_written_is_read(tmp_path: Path) -> None:
    path = tmp_path / "story.vds.lock"
    write_lock(path, Lock(0, (("vdsl", "0.1.0"), ("look", "3")), (CUP, DOOR)))
    again = read_lock(path)
    assert (again.seed, dict(again.versions)) == (0, {"vdsl": "0.1.0", "look": "3"})
    assert again.choices == (DOOR, CUP)  # sorted: a choice more is a line more, in its place
    text = path.read_text("utf-8")
    assert [line for line in text.splitlines() if line.startswith("take ")] == [
        'take kitchen-anna-open-door 3-00ffab12 of 24 seed 7 line 0123456789ab "static full eye-level"',
        'take kitchen-anna-pour-cup 17-3f9a2c1b of 80 line 9c41d2e07a55 "push medium high-angle"',
    ]
    write_lock(path, again)
    assert path.read_text("utf-8") == text
    assert again.span(CUP.shot).line_number == len(text.splitlines())


def test_no_choice_is_no_file(tmp_path: Path) -> None:
    path = tmp_path / "story.vds.lock"
    assert read_lock(path) == Lock()
    write_lock(path, Lock(0, (), (CUP,)))
    write_lock(path, Lock(0))
    assert not path.exists()


def test_remarks_stay_with_their_choice(tmp_path: Path) -> None:
    path = tmp_path / "story.vds.lock"
    write_lock(path, Lock(0, (), (CUP,)))
    text = path.read_text("utf-8").replace("take kit", "# the steam is right here\ntake kit")
    path.write_text(text, "utf-8")
    write_lock(path, Lock(0, (), (*read_lock(path).choices, DOOR)))
    lines = path.read_text("utf-8").splitlines()
    assert lines[-2] == "# the steam is right here"
    assert lines[-1].startswith("take kitchen-anna-pour-cup")


@pytest.mark.parametrize(
    ("text", "line", "said"),
    [
        ("vds.lock/1\nseed 0\n<<<<<<< HEAD\nseed 1\n=======\nseed 2\n>>>>>>> b\n", 3, "not merged"),
        ("vds.lock/1\nseed 0\ntake a 1-0000 of 8\n", 3, "does not read"),
        ("vds.lock/9\nseed 0\n", 1, "another version"),
        ("seed 0\n", 1, "vds.lock/1"),
        ("\n", 1, "no lock file"),
        ('vds.lock/1\n' + 2 * 'take a 1-00000000 of 8 line 000000000000 "x"\n', 3, "chosen above already"),
    ],
)  # fmt: skip
def test_damage_is_told_at_its_line_and_nothing_is_lost(
    script: Path, text: str, line: int, said: str
) -> None:
    path = lock_path(script)
    path.write_text(text, "utf-8")
    with pytest.raises(ScriptError) as caught:
        read_lock(path)
    first = caught.value.report.errors[0]
    assert (first.code, first.span.line_number) == ("VDS310", line)
    assert said in first.label
    folder = build_of(script, {"kitchen-anna-wave": ["1-aaaaaaaa"]})
    with pytest.raises(ScriptError):
        choose(script, "kitchen-anna-wave", 1, folder)
    assert path.read_text("utf-8") == text


def test_bytes_that_are_no_text_are_told(tmp_path: Path) -> None:
    path = tmp_path / "story.vds.lock"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ScriptError):
        read_lock(path)


def test_a_take_is_chosen_by_rank_or_key_and_taken_back(script: Path) -> None:
    folder = build_of(script, {"kitchen-anna-wave": ["5-aaaaaaaa", "2-bbbbbbbb"]})
    assert choose(script, "kitchen-anna-wave", 2, folder).key == "2-bbbbbbbb"
    assert choose(script, "kitchen-anna-wave", "5-aaaaaaaa", folder).key == "5-aaaaaaaa"
    (kept,) = read_lock(lock_path(script)).choices
    assert (kept.key, kept.proposals, kept.words) == ("5-aaaaaaaa", 12, "static medium eye-level")
    for shot, take, said in (
        ("kitchen-anna-wave", 3, "it has 1 (5-aaaaaaaa) and 2 (2-bbbbbbbb)"),
        ("kitchen-anna-wave", 3, f"`vdsc compile {script} --more kitchen-anna-wave` draws more"),
        ("kitchen-anna-wve", 1, "did you mean `kitchen-anna-wave`"),
    ):
        with pytest.raises(ChoiceError) as caught:
            choose(script, shot, take, folder)
        assert said in str(caught.value)
    with pytest.raises(ChoiceError, match="no build"):
        choose(script, "kitchen-anna-wave", 1, script.parent)
    assert [c.shot for c in clear(script, "kitchen-anna-wave")] == ["kitchen-anna-wave"]
    assert not lock_path(script).exists()


def test_clearing_a_lock_that_does_not_read_keeps_it_aside(script: Path) -> None:
    lock_path(script).write_text("garbage\n", "utf-8")
    clear(script)
    assert not lock_path(script).exists()
    assert Path(f"{lock_path(script)}.bad").read_text("utf-8") == "garbage\n"
    lock_path(script).write_text("more of it\n", "utf-8")
    told = CliRunner().invoke(app, ["pick", str(script), "--clear"])
    assert told.exit_code == 0
    assert "story.vds.lock.bad-2" in told.output
    assert Path(f"{lock_path(script)}.bad").read_text("utf-8") == "garbage\n"
    assert Path(f"{lock_path(script)}.bad-2").read_text("utf-8") == "more of it\n"


def test_many_who_choose_at_once_lose_nothing(script: Path) -> None:
    shots = [f"shot-{k}" for k in range(6)]
    folder = build_of(script, {name: ["1-aaaaaaaa"] for name in shots})
    code = (
        "import sys; from vdsl.pipeline.lock import choose; choose(sys.argv[1], sys.argv[2], 1, sys.argv[3])"
    )
    running = [
        subprocess.Popen([sys.executable, "-c", code, str(script), name, str(folder)]) for name in shots
    ]
    assert [run.wait(60) for run in running] == [0] * len(shots)
    assert [c.shot for c in read_lock(lock_path(script)).choices] == shots


def test_choices_follow_their_lines() -> None:
    depends = {"a": "1" * 12, "a--2": "2" * 12, "b": "3" * 12}
    first = Choice("a", "1-00000000", "x", 8, 0, "2" * 12)  # a line that says the same was put above
    gone = Choice("c", "1-00000000", "x", 8, 0, "3" * 12)  # renamed
    assert placed([first, gone], depends) == {"a--2": first, "b": gone}
    changed = Choice("a", "1-00000000", "x", 8, 0, "9" * 12)
    stray = Choice("z", "1-00000000", "x", 8, 0, "8" * 12)
    assert placed([changed, stray], depends) == {"a": changed}


def test_a_shot_has_one_choice_whatever_it_was_called(script: Path) -> None:
    folder = build_of(
        script, {"new": ["1-0000000a", "2-0000000b"], "twin": ["3-0000000c"], "twin--2": ["4-0000000d"]}
    )
    document = json.loads((folder / "storyboard.json").read_text())
    for shot, depends in zip(document["shots"], ("1" * 12, "2" * 12, "3" * 12), strict=True):
        shot["depends"] = depends
    (folder / "storyboard.json").write_text(json.dumps(document))
    old = Choice("old", "1-0000000a", "x", 8, 0, "1" * 12, ("# the one with the light",))
    over = Choice("twin", "4-0000000d", "x", 8, 0, "3" * 12)  # a line that says the same was put above
    gone = Choice("gone", "9-0000000f", "x", 8, 0, "9" * 12)
    path = lock_path(script)

    write_lock(path, Lock(0, (), (old, over, gone)))
    choose(script, "new", 2, folder)
    choose(script, "twin", 1, folder)
    chosen = {c.shot: (c.key, c.comments) for c in read_lock(path).choices}
    assert chosen == {
        "new": ("2-0000000b", old.comments), "gone": (gone.key, ()), "twin": ("3-0000000c", ()),
        "twin--2": (over.key, ()),
    }  # fmt: skip

    write_lock(path, Lock(0, (), (old, over, gone)))
    assert clear(script, "old", folder) == (old,)  # by the name it has in the lock
    write_lock(path, Lock(0, (), (old, over, gone)))
    assert clear(script, "twin", folder) == ()  # what is called so is chosen for the second
    assert clear(script, "twin--2", folder) == (over,)
    assert clear(script, "new", folder) == (old,)
    assert clear(script, "gone", folder) == (gone,)
    assert not path.exists()


def test_digests_go_by_what_is_seen(script: Path) -> None:
    def digests(text: str) -> dict[str, str]:
        script.write_text(text, "utf-8")
        checked = load_storyboard(script)
        return shot_digests(checked.storyboard, checked.catalog)

    text = script.read_text("utf-8")
    before = digests(text)
    walk, wave = before
    assert digests(f"# a remark\n{text}") == before
    assert digests(text.replace("scene kitchen", "prop thing { box (1, 1, 1)m }\nscene kitchen")) == before
    noted = digests(text.replace("(static medium)", '(static medium) note "x"'))
    assert noted == before
    named = digests(text.replace("(static medium)", "(static medium) name hello"))
    assert named == {walk: before[walk], "hello": before[wave]}
    other = digests(text.replace("(static medium)", "(push medium)"))
    assert (other[walk] == before[walk], other[wave] == before[wave]) == (True, False)
    earlier = digests(text.replace("(follow full)", "(follow full) speed brisk"))
    assert earlier[wave] != before[wave]
    dressed = digests(text.replace("= woman", "= woman(top navy)"))
    assert dressed.keys() == before.keys()
    assert not set(dressed.values()) & set(before.values())
    more = digests(text + "(anna phone) / (static medium)\n")
    assert {k: more[k] for k in before} == before, "what she has about her shows only where she takes it out"
    held = digests(text.replace("anna at door", "anna at door holding bag"))
    assert not set(held.values()) & set(before.values())
    own = digests("prop kettle { box (1, 1, 1)m }\n" + text)
    changed = digests("prop kettle { box (1, 1, 2)m }\n" + text)
    assert own != changed, "the library's kitchen has a kettle, and the script's own comes first"


def test_the_command_lists_chooses_and_takes_back(script: Path) -> None:
    folder = build_of(script, {"kitchen-anna-wave": ["5-aaaaaaaa", "2-bbbbbbbb"]})
    run = CliRunner().invoke
    at = ["--build", str(folder)]
    assert "nothing is chosen" in run(app, ["pick", str(script)]).output
    done = run(app, ["pick", str(script), "wave", "2", *at])
    assert (done.exit_code, "2-bbbbbbbb" in done.output) == (0, True)
    told = json.loads(run(app, ["pick", str(script), "--json"]).output)
    assert told["schema"] == "vds.choices/1"
    assert [c["take"] for c in told["choices"]] == ["2-bbbbbbbb"]
    for wrong in (["wave"], ["wave", "7"], ["nobody", "1"], ["wave", "1", "--clear"]):
        assert run(app, ["pick", str(script), *wrong, *at]).exit_code == 2, wrong
    assert run(app, ["pick", str(script), "--clear"]).exit_code == 0
    assert not lock_path(script).exists()


def test_choices_whose_line_or_shot_is_lost_are_listed_as_such(script: Path) -> None:
    def listed() -> str:
        return CliRunner().invoke(app, ["pick", str(script)]).output

    (script.parent / "vds.toml").write_text('style = "clay"\nrig = "paper"\n')
    checked = load_storyboard(script, None, project_of(script).settings)
    depends = shot_digests(checked.storyboard, checked.catalog)
    held = tuple(Choice(shot, "1-00000000", "x", 8, 0, text) for shot, text in depends.items())
    write_lock(lock_path(script), Lock(0, (), held))
    assert listed().count("\n") == 2
    assert "(" not in listed()
    script.write_text(script.read_text().replace("(static medium)", "(static full)"))
    assert listed().count("its line has changed since") == 1
    script.write_text(script.read_text().replace("(anna wave) / (static full)\n", ""))
    assert listed().count("there is no such shot any more") == 1
    script.write_text("(anna wlk\n")  # of what does not read nothing is said
    assert "(" not in listed()
