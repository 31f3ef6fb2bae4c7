"""``vdsc check`` and ``vdsc explain`` as a writer meets them: exit codes, places, JSON, start-up."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from vdsl.cli import app
from vdsl.cli.show import as_text, printable
from vdsl.lang import Source, parse
from vdsl.lang.codes import CODES

EXAMPLE = Path(__file__).parents[1] / "examples" / "coffee.vds"
GOOD = "character anna = woman\nscene k = apartment.kitchen\nanna at door\n(anna walk counter)\n"
FIVE = """\
storyboard "Five"
character anna = womn
scene kitchen = apartment.kitchen
anna at dor
(anna wlk counter)
(anna walk counter) / (folow full eye-level)
(anna wave) lens 0mm
"""


def vdsc(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.fixture
def script(tmp_path: Path) -> Path:
    return tmp_path / "story.vds"


def test_a_good_script_is_fine(script: Path) -> None:
    script.write_text(GOOD)
    result = vdsc("check", script)
    assert (result.exit_code, result.stdout.strip()) == (0, f"{script}: fine, 1 scene, 1 line, 1 shot")


def test_the_example_is_fine() -> None:
    result = vdsc("check", EXAMPLE, "--format", "json")
    document = json.loads(result.stdout)
    assert result.exit_code == 0
    assert (document["errors"], document["warnings"]) == (0, 0)


def test_five_mistakes_are_all_told_and_nothing_is_written(script: Path) -> None:
    script.write_text(FIVE)
    result = vdsc("check", script)
    assert result.exit_code == 1
    for place in (":2:18", ":4:9", ":5:7", ":6:24", ":7:18"):
        assert f"--> {script}{place}" in result.stderr
    for meant in ("woman", "door", "walk", "follow"):
        assert f"did you mean `{meant}`?" in result.stderr
    assert "5 errors" in result.stderr
    assert "\x1b" not in result.stderr
    assert [p.name for p in script.parent.iterdir()] == ["story.vds"]


def test_the_underline_is_under_the_span() -> None:
    _, report = parse(Source("x.vds", '(猫é walk / door) say "x"\n'))
    lines = as_text(report.diagnostics).split("\n")
    assert lines[:2] == ["error[VDS001]: this line does not read", " --> x.vds:1:10"]
    assert lines[2] == '1 | (猫é walk / door) say "x"'
    # The cat takes two columns of a terminal.
    assert lines[3] == "  |           ^ the camera stands outside of the parentheses"


def test_what_is_said_of_several_lines_is_said_once(script: Path) -> None:
    script.write_text("scene s = apartment.kitchen\n" + "(anna waves)\n(anna smiles)\n" * 6)
    result = vdsc("check", script)
    assert result.stderr.count("no character is called `anna`") == 1
    assert "the same on lines 3, 4, 5, 6, 7, 8, 9, 10 and 3 more" in result.stderr
    assert "12 errors" in result.stderr


def test_json_has_every_place(script: Path) -> None:
    script.write_text(FIVE)
    document = json.loads(vdsc("check", script, "--format", "json").stdout)
    assert (document["schema"], document["file"], document["errors"]) == ("vds.diagnostics/1", str(script), 5)
    first = document["diagnostics"][0]
    assert (first["code"], first["severity"], first["line"], first["column"]) == ("VDS064", "error", 2, 18)
    assert (first["end_line"], first["end_column"], first["suggestion"], first["fix"]) == (
        2,
        22,
        "woman",
        "woman",
    )
    assert set(first) == {"code", "severity", "title", "message", "file", "line", "column", "end_line",
                          "end_column", "help", "suggestion", "fix", "notes"}  # fmt: skip


def test_warnings_are_told_and_fine(script: Path) -> None:
    script.write_text(GOOD.replace("anna at door\n", ""))
    result = vdsc("check", script)
    assert result.exit_code == 0
    assert "warning[VDS079]" in result.stderr
    assert "1 warning" in result.stderr


@pytest.mark.parametrize(
    "data", [b"\x89PNG\r\n\x1a\n\x00\x00", b"scene \xff\xfe", "(anna)\n".encode("utf-16"), b"\0" * 100]
)
def test_what_is_no_text_is_said_to_be_none(script: Path, data: bytes) -> None:
    script.write_bytes(data)
    result = vdsc("check", script)
    assert result.exit_code == 1
    assert "error[VDS014]" in result.stderr


@pytest.mark.parametrize("text", ["", "\n\n", "# nothing\n", "\ufeff"])
def test_an_empty_file_is_an_error(script: Path, text: str) -> None:
    script.write_text(text)
    result = vdsc("check", script)
    assert result.exit_code == 1
    assert "error[VDS034]" in result.stderr


def test_a_megabyte_in_one_line(script: Path) -> None:
    script.write_text("(anna " + "walk " * 200_000 + ")")
    result = vdsc("check", script)
    assert result.exit_code == 1
    assert "error[VDS005]" in result.stderr
    assert len(result.stderr) < 2_000


def test_ten_thousand_lines(script: Path) -> None:
    script.write_text(GOOD + "(anna walk window)\n" * 10_000)
    result = vdsc("check", script)
    assert (result.exit_code, result.stderr) == (0, "")
    assert "10001 lines" in result.stdout


def test_any_terminal_will_do(script: Path) -> None:
    strange = script.with_name(os.fsdecode("é\udcff.vds".encode("utf-8", "surrogateescape")))
    strange.write_text('(anna wave) say "猫\n', encoding="utf-8")
    for extra in ([], ["--format", "json"]):
        run = subprocess.run(
            [sys.executable, "-c", "from vdsl.cli import main; main()", "check", str(strange), *extra],
            capture_output=True,
            env={**os.environ, "PYTHONIOENCODING": "ascii"},
        )
        assert run.returncode == 1
        assert b"Traceback" not in run.stderr
    assert json.loads(run.stdout)["errors"] == 1


def test_a_missing_file_is_usage(script: Path) -> None:
    script.write_text(GOOD)
    result = vdsc("check", script.with_name("stroy.vds"))
    assert result.exit_code == 2
    assert f"Did you mean {script}?" in result.stderr
    assert vdsc("check", script.parent).exit_code == 2
    assert vdsc("check").exit_code == 2
    assert vdsc("check", script, "--format", "xml").exit_code == 2


def test_a_file_that_cannot_be_read_is_the_machines_fault(
    script: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script.write_text(GOOD)

    def vanished(*_: object) -> None:
        raise FileNotFoundError(2, "No such file or directory", str(script))

    monkeypatch.setattr(sys.modules["vdsl.pipeline.script"], "read_source", vanished)
    result = vdsc("check", script)
    assert result.exit_code == 3
    assert "cannot read" in result.stderr
    assert "Traceback" not in result.stderr


def test_nothing_from_a_script_steers_the_terminal(script: Path) -> None:
    script.write_text('(anna wave) say "\x1b[31mred\x07" \x1b]0;x\n')
    assert "\x1b" not in vdsc("check", script).stderr
    assert printable("a\x1bb\u202ec\td") == "a\ufffdb\ufffdc d"


@pytest.mark.parametrize("written", ["VDS060", "vds060", "60", "vds 60"])
def test_explain_says_more(written: str) -> None:
    result = vdsc("explain", written)
    assert result.exit_code == 0
    assert result.stdout.startswith("VDS060: unknown name")
    assert "    (anna walk conter)" in result.stdout
    assert "    (anna walk counter)" in result.stdout


def test_explain_knows_its_codes() -> None:
    assert len(vdsc("explain").stdout.strip().split("\n")) == len(CODES)
    result = vdsc("explain", "VDS999")
    assert result.exit_code == 2
    assert "there is no code" in result.stderr


def test_checking_loads_nothing_heavy() -> None:
    code = (
        "import sys; from vdsl.cli.check import check_or_exit; from pathlib import Path;"
        f"assert check_or_exit(Path({str(EXAMPLE)!r})).storyboard;"
        "print([m for m in ('numpy', 'torch', 'taichi', 'cv2', 'av', 'scipy', 'PIL') if m in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"
