"""Pictures in the terminal: by the protocols of kitty and iTerm2, as sixels, or as half-blocks anywhere.

Guarantees that nothing is asked of the terminal, so that nothing stray is typed into it: what it can is told
by the environment, as terminals set it.
"""

from __future__ import annotations

import base64
import io
import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TextIO

from PIL import Image
from rich.console import Console

from .show import printable

#: Columns a poster takes, and how many are shown in a row at most.
_COLUMNS, _GAP, _MOST_ROWS = 26, 2, 6
_CHUNK = 4096  # bytes of base64 in one command of kitty's protocol
_COLOURS = 64  # of a sixel picture
_SIXELS = ("foot", "mlterm", "yaft", "contour", "wezterm", "xterm-sixel", "mintty")


def can_show(environment: Mapping[str, str]) -> str:
    """``kitty``, ``iterm``, ``sixel`` or "": how the terminal shows pictures, as far as it says so."""
    if environment.get("TMUX") or environment.get("TERM", "").startswith(("screen", "tmux")):
        return ""  # what is between swallows pictures
    program = environment.get("TERM_PROGRAM", "").lower()
    term = environment.get("TERM", "").lower()
    if environment.get("KITTY_WINDOW_ID") or "kitty" in term or "ghostty" in (program or term):
        return "kitty"
    if program in ("iterm.app", "wezterm", "vscode-iterm") or environment.get("LC_TERMINAL") == "iTerm2":
        return "iterm"
    if any(name in (term, program) for name in _SIXELS) or "sixel" in term:
        return "sixel"
    return ""


def shown_posters(
    posters: Sequence[tuple[str, Path]], console: Console, show: str, stream: TextIO | None = None
) -> bool:
    """Print posters with their names below, if that is wanted and possible; whether it was.

    show: ``auto``, ``blocks`` or ``none``
    """
    stream = stream or sys.stdout
    how = can_show(os.environ) if show == "auto" and console.is_terminal else ""
    how = "blocks" if show == "blocks" else how
    if not how or not posters:
        return False
    across = max(1, (console.width + _GAP) // (_COLUMNS + _GAP))
    for first in range(0, min(len(posters), across * _MOST_ROWS), across):
        row = posters[first : first + across]
        pictures = [Image.open(path).convert("RGB") for _, path in row]
        stream.write(as_blocks(pictures) if how == "blocks" else as_picture(_joined(pictures), how, len(row)))
        names = ((printable(name)[:_COLUMNS]).ljust(_COLUMNS + _GAP) for name, _ in row)
        stream.write("".join(names).rstrip() + "\n\n")
    stream.flush()
    return True


def as_blocks(pictures: Sequence[Image.Image]) -> str:
    """Pictures side by side, two pixels a cell: upper half in the letter's colour, lower in its ground's."""
    height = 2 * max(1, round(_COLUMNS * pictures[0].height / pictures[0].width / 2))
    small = [p.resize((_COLUMNS, height), Image.Resampling.BOX) for p in pictures]
    lines = []
    for y in range(0, height, 2):
        cells = []
        for picture in small:
            for x in range(_COLUMNS):
                upper, lower = picture.getpixel((x, y)), picture.getpixel((x, y + 1))
                cells.append(f"\x1b[38;2;{_rgb(upper)};48;2;{_rgb(lower)}m▀")
            cells.append("\x1b[0m" + " " * _GAP)
        lines.append("".join(cells).rstrip(" "))
    return "\n".join(lines) + "\n"


def _rgb(pixel: object) -> str:
    assert isinstance(pixel, tuple)
    return ";".join(str(int(v)) for v in pixel)


def _joined(pictures: Sequence[Image.Image], width: int = 320, gap: int = 24) -> Image.Image:
    """Pictures side by side on one, each so many pixels wide."""
    height = round(width * pictures[0].height / pictures[0].width)
    out = Image.new("RGBA", (len(pictures) * (width + gap) - gap, height), (0, 0, 0, 0))
    for k, picture in enumerate(pictures):
        out.paste(picture.resize((width, height), Image.Resampling.LANCZOS), (k * (width + gap), 0))
    return out


def as_picture(picture: Image.Image, how: str, count: int) -> str:
    """A row of posters as the terminal takes it: ``kitty``, ``iterm`` or ``sixel``."""
    columns = count * (_COLUMNS + _GAP) - _GAP
    if how == "sixel":
        return sixels(picture.convert("RGB")) + "\n"
    buffer = io.BytesIO()
    picture.save(buffer, "PNG")
    data = base64.b64encode(buffer.getvalue()).decode()
    if how == "iterm":
        size = f"size={len(buffer.getvalue())};width={columns};preserveAspectRatio=1"
        return f"\x1b]1337;File=inline=1;{size}:{data}\a\n"
    chunks = [data[i : i + _CHUNK] for i in range(0, len(data), _CHUNK)]
    out = []
    for k, chunk in enumerate(chunks):
        head = f"a=T,f=100,q=2,c={columns}," if k == 0 else ""
        out.append(f"\x1b_G{head}m={int(k + 1 < len(chunks))};{chunk}\x1b\\")
    return "".join(out) + "\n"


def sixels(picture: Image.Image) -> str:
    """An RGB picture as DEC sixels, in few colours."""
    few = picture.quantize(_COLOURS, dither=Image.Dither.NONE)
    palette, pixels = few.getpalette() or [], few.load()
    assert pixels is not None
    out = [f'\x1bPq"1;1;{few.width};{few.height}']
    for k in range(len(palette) // 3):
        r, g, b = (round(v * 100 / 255) for v in palette[3 * k : 3 * k + 3])
        out.append(f"#{k};2;{r};{g};{b}")
    for top in range(0, few.height, 6):
        bits: dict[int, list[int]] = {}
        for dy in range(min(6, few.height - top)):
            for x in range(few.width):
                bits.setdefault(pixels[x, top + dy], [0] * few.width)[x] |= 1 << dy  # type: ignore[arg-type]
        out.append("$".join(f"#{colour}" + _run_lengths(row) for colour, row in sorted(bits.items())) + "-")
    return "".join(out) + "\x1b\\"


def _run_lengths(row: Sequence[int]) -> str:
    out, at = [], 0
    while at < len(row):
        end = at
        while end < len(row) and row[end] == row[at]:
            end += 1
        sign, times = chr(63 + row[at]), end - at
        out.append(f"!{times}{sign}" if times > 3 else sign * times)
        at = end
    return "".join(out)
