"""``vdsc diff`` as a writer meets it: files, git revisions, git's own diff, and what cannot be compared."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from vdsl.cli import app

OLD = """\
storyboard "Wave"
size 128x72
proposals 8
takes 1

character anna = woman

scene kitchen = apartment.kitchen
anna at door facing window

(anna wave)          / (static close-up eye-level)
(anna walk counter)  / (follow full eye-level)
"""
NEW = OLD.replace("close-up", "medium").replace("walk counter", "walk window")
DOCS = Path(__file__).parents[1] / "docs" / "compare.md"


def vdsc(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    old, new = tmp_path / "old.vds", tmp_path / "new.vds"
    old.write_text(OLD)
    new.write_text(NEW)
    return old, new


def git(folder: Path, *arguments: str, check: bool = True) -> str:
    """git in a folder, with nothing of this machine's settings."""
    clean = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull, "GIT_PAGER": "cat"}
    who = [a for name in ("user.name", "user.email") for a in ("-c", f"{name}=test@example.org")]
    done = subprocess.run(
        ["git", *who, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        env=os.environ | clean,
        timeout=60,
    )
    assert not check or done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """Two commits of one storyboard in a folder of a repository."""
    if shutil.which("git") is None:
        pytest.skip("git is not installed")
    git(tmp_path, "init", "-q", "-b", "main")
    folder = tmp_path / "stories"
    folder.mkdir()
    for text, message in ((OLD, "one"), (NEW, "two")):
        (folder / "story.vds").write_text(text)
        git(tmp_path, "add", ".")
        git(tmp_path, "commit", "-q", "-m", message)
    return folder


WORDS = ("~ shot 1: close-up → medium", "~ shot 2: anna walk counter → window", "2 changed; 0 shots the same")


def test_two_files(files: tuple[Path, Path]) -> None:
    result = vdsc("diff", *files)
    assert result.exit_code == 0, result.output
    assert result.stdout.splitlines() == [f"--- {files[0]}", f"+++ {files[1]}", *WORDS]
    assert "the same storyboard" in vdsc("diff", files[0], files[0]).stdout


def test_two_revisions_one_revision_and_the_last(repository: Path) -> None:
    story = repository / "story.vds"
    both = vdsc("diff", "HEAD~1", "HEAD", story)
    assert both.stdout.splitlines() == [f"--- {story}@HEAD~1", f"+++ {story}@HEAD", *WORDS]
    one = vdsc("diff", "HEAD~1", story)
    assert one.stdout.splitlines()[2:] == list(WORDS)
    assert "the same storyboard" in vdsc("diff", story).stdout
    story.write_text(NEW + "(anna wave) / (static wide eye-level)\n")
    assert "+ shot 3 added: anna wave, static wide eye-level" in vdsc("diff", story).stdout


def test_json_says_the_same(files: tuple[Path, Path]) -> None:
    document = json.loads(vdsc("diff", *files, "--json").stdout)
    assert document["schema"] == "vds.diff/1"
    assert [s["status"] for s in document["shots"]] == ["changed", "changed"]
    assert document["shots"][0]["changes"] == [
        {"what": "size", "before": "close-up", "after": "medium", "text": "close-up → medium"}
    ]
    told = set(re.findall(r"^\| `([^`]+)` \|", DOCS.read_text(), re.MULTILINE))
    made = {"schema", "before", "after", "board", "shots"}
    made |= {f"shots[].{k}" for k in document["shots"][0]}
    assert made <= told


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nope", "story.vds"], "git knows no revision 'nope'"),
        (["--", "--output=x", "story.vds"], "git knows no revision '--output=x'"),
        (["HEAD", "HEAD", "other.vds"], "there is no file other.vds, nor was there in HEAD"),
        (["old.vds", "story.vds"], "there is no file old.vds"),
        (["HEAD", "other.vds"], "there is no file other.vds"),
        (["a", "b", "c", "d"], "name two files"),
    ],
)
def test_what_cannot_be_found_is_said(
    repository: Path, monkeypatch: pytest.MonkeyPatch, words: list[str], said: str
) -> None:
    monkeypatch.chdir(repository)
    result = vdsc("diff", *words)
    assert result.exit_code == 2
    assert said in result.stderr
    assert list(repository.iterdir()) == [repository / "story.vds"]


def test_outside_of_a_repository_and_without_git(
    files: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(files[0].parent.parent))
    result = vdsc("diff", "HEAD", files[0])
    assert result.exit_code == 2
    assert "is not in a git repository" in result.stderr
    monkeypatch.setenv("PATH", "")
    assert "git is not installed" in vdsc("diff", "HEAD", files[0]).stderr


def test_a_file_that_is_new_and_one_with_errors(repository: Path) -> None:
    new = repository / "new.vds"
    new.write_text(OLD)
    assert "the file is new" in vdsc("diff", new).stderr
    new.write_text(OLD.replace("wave", "wawe"))
    result = vdsc("diff", repository / "story.vds", new)
    assert result.exit_code == 1
    assert "unknown action" in result.stderr
    assert "has errors" in result.stderr


def drive(repository: Path, *, textconv: bool) -> None:
    command = f"{sys.executable} -c 'from vdsl.cli import main; main()' diff"
    (repository / ".gitattributes").write_text("*.vds diff=vds\n")
    key = "diff.vds.textconv" if textconv else "diff.vds.command"
    git(repository, "config", key, f"{command} {'--textconv' if textconv else '--git'}")


def test_git_shows_storyboards_by_a_driver(repository: Path) -> None:
    drive(repository, textconv=False)
    shown = git(repository, "diff", "HEAD~1", "HEAD")
    assert shown.splitlines() == ["diff --vds stories/story.vds", *WORDS]
    (repository / "story.vds").write_text(NEW.replace("wave", "wawe"))
    assert "+(anna wawe)          / (static medium eye-level)" in git(
        repository, "diff"
    )  # no storyboard: as text
    (repository / "new.vds").write_text(OLD)
    git(repository, "add", "-N", "new.vds")
    assert '+storyboard "Wave"' in git(repository, "diff", "new.vds")


def test_git_compares_storyboards_as_lines(repository: Path) -> None:
    drive(repository, textconv=True)
    shown = git(repository, "diff", "-U0", "HEAD~1", "HEAD")
    assert "-    size: close-up" in shown
    assert "+    size: medium" in shown
    assert "-    story: anna walk counter" in shown
    (repository / "story.vds").write_text("(anna wawe\n")
    assert "+(anna wawe" in git(repository, "diff")


def test_the_page_has_keyframes_of_what_changed_and_escapes(files: tuple[Path, Path]) -> None:
    attack = "<script>alert('x')</script>"
    files[1].write_text(OLD.replace("close-up eye-level)", f'medium eye-level) note "{attack}"'))
    page = files[0].with_name("out.html")
    result = vdsc("diff", *files, "--page", page)
    assert result.exit_code == 0, result.output
    html = page.read_text()
    assert html.count('src="data:image/jpeg;base64,') == 6  # three keyframes on each side
    assert "<script" not in html
    assert "&lt;script&gt;" in html
    assert "close-up → medium" in html
    assert "http:" not in html
    assert "https:" not in html
