"""Posters in the terminal: what it can show, and that what is sent is what was meant."""

import base64
import io
import re
from pathlib import Path

import pytest
from PIL import Image
from rich.console import Console

from vdsl.cli.posters import as_blocks, as_picture, can_show, shown_posters, sixels


@pytest.mark.parametrize(
    ("environment", "how"),
    [
        ({"TERM": "xterm-kitty"}, "kitty"),
        ({"TERM": "xterm-256color", "KITTY_WINDOW_ID": "1"}, "kitty"),
        ({"TERM": "xterm-ghostty", "TERM_PROGRAM": "ghostty"}, "kitty"),
        ({"TERM_PROGRAM": "iTerm.app", "TERM": "xterm-256color"}, "iterm"),
        ({"TERM_PROGRAM": "WezTerm"}, "iterm"),
        ({"TERM": "foot"}, "sixel"),
        ({"TERM": "xterm-256color"}, ""),
        ({"TERM": "xterm-kitty", "TMUX": "/tmp/x"}, ""),
        ({"TERM": "screen-256color", "KITTY_WINDOW_ID": "1"}, ""),
        ({}, ""),
    ],
)
def test_what_a_terminal_can_show_goes_by_its_variables(environment: dict[str, str], how: str) -> None:
    assert can_show(environment) == how


@pytest.fixture
def poster(tmp_path: Path) -> Path:
    picture = Image.new("RGB", (160, 90), (250, 0, 0))
    picture.paste((0, 0, 250), (0, 45, 160, 90))
    picture.save(tmp_path / "take.png")
    return tmp_path / "take.png"


def test_pictures_arrive_whole(poster: Path) -> None:
    picture = Image.open(poster).convert("RGB")
    sent = as_picture(picture, "kitty", 1)
    parts = re.findall(r"\x1b_G([^;]*);([^\x1b]*)\x1b\\", sent)
    assert parts[0][0].startswith("a=T,f=100")
    assert [head[-3:] for head, _ in parts] == ["m=1"] * (len(parts) - 1) + ["m=0"]
    by_iterm = as_picture(picture, "iterm", 1).split(":")[1].split("\a")[0]
    for data in ("".join(data for _, data in parts), by_iterm):
        again = Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB")
        assert again.tobytes() == picture.tobytes()


def test_sixels_say_every_pixel(poster: Path) -> None:
    picture = Image.open(poster).convert("RGB").resize((8, 14))
    text = sixels(picture)
    assert text.startswith('\x1bPq"1;1;8;14')
    assert text.endswith("\x1b\\")
    colours = {k: (int(r), int(g), int(b)) for k, r, g, b in re.findall(r"#(\d+);2;(\d+);(\d+);(\d+)", text)}
    out = Image.new("RGB", (8, 18))
    body = re.sub(r"#\d+;2;\d+;\d+;\d+", "", text[len('\x1bPq"1;1;8;14') : -2])
    for row, band in enumerate(body.split("-")):
        for colour, data in re.findall(r"#(\d+)([^#$-]*)", band):
            x = 0
            for times, sign in re.findall(r"(?:!(\d+))?([?-~])", data):
                for _ in range(int(times or 1)):
                    for dy in range(6):
                        if (ord(sign) - 63) >> dy & 1:
                            out.putpixel((x, 6 * row + dy), tuple(round(v * 2.55) for v in colours[colour]))
                    x += 1
    for y in (0, 5, 8, 13):
        shown, meant = out.getpixel((3, y)), picture.getpixel((3, y))
        assert max(abs(a - b) for a, b in zip(shown, meant, strict=True)) < 4


def test_blocks_are_two_pixels_a_cell(poster: Path) -> None:
    text = as_blocks([Image.open(poster).convert("RGB")] * 2)
    lines = text.splitlines()
    assert 6 <= len(lines) <= 8
    assert "38;2;250;0;0" in lines[0]
    assert "48;2;0;0;250" in lines[-1]
    assert all(line.count("▀") == 52 for line in lines)


def test_nothing_is_sent_into_a_pipe_unless_asked_for(poster: Path) -> None:
    out = io.StringIO()
    console = Console(file=out, width=80)
    assert not shown_posters([("a", poster)], console, "auto", out)
    assert not shown_posters([("a", poster)], console, "none", out)
    assert out.getvalue() == ""
    assert shown_posters([("a\x1b[31m", poster)] * 4, console, "blocks", out)
    assert "\x1b[31m" not in out.getvalue()
    assert out.getvalue().count("▀") == 26 * 4 * 7
