"""Text drawn on pictures: measured, shortened, wrapped and written, whatever script it is in.

Latin, Greek and Cyrillic text is set in a typeface that comes with the program, so that it looks the same
everywhere; other letters in those of the machine (:mod:`vdsl.emit.typefaces`). Nothing a writer can type
makes this fail.
"""

from __future__ import annotations

from PIL import ImageDraw

from .typefaces import BOLD, REGULAR, font, runs


def clean(text: str) -> str:
    """The text without line ends and control characters; lone surrogates become question marks."""
    joined = " ".join(text.split())
    return "".join(c if c.isprintable() else "?" for c in joined).encode("utf-8", "replace").decode("utf-8")


def width(text: str, size: int, bold: bool = False) -> float:
    """Width of a line in pixels."""
    pieces = runs(text, BOLD if bold else REGULAR)
    return sum(float(font(size, face).getlength(piece)) for face, piece in pieces)


def shortened(text: str, size: int, room: float, bold: bool = False) -> str:
    """The text, ended by an ellipsis where it is wider than ``room`` pixels."""
    text = clean(text)[:400]
    if width(text, size, bold) <= room:
        return text
    low, high = 0, len(text)
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if width(text[:middle] + "…", size, bold) <= room else (low, middle - 1)
    return text[:low].rstrip() + "…"


def wrapped(text: str, size: int, room: float, most: int, bold: bool = False) -> list[str]:
    """The text in at most ``most`` lines no wider than ``room`` pixels, broken between words."""
    words = clean(text)[:1000].split(" ")
    lines: list[str] = []
    while words and len(lines) < most - 1:
        line = words.pop(0)
        while words and width(f"{line} {words[0]}", size, bold) <= room:
            line += " " + words.pop(0)
        lines.append(shortened(line, size, room, bold))
    if words:
        lines.append(shortened(" ".join(words), size, room, bold))
    return lines


def write(
    draw: ImageDraw.ImageDraw,
    at: tuple[float, float],
    text: str,
    size: int,
    fill: str,
    anchor: str = "la",
    halo: int = 0,
    around: str | None = None,
    bold: bool = False,
) -> None:
    """Draw one line; anchor: as Pillow names them; halo: pixels of a rim of the colour ``around``."""
    pieces = runs(text, BOLD if bold else REGULAR)
    x, y = at
    if len(pieces) > 1:  # each piece begins where the one before it ends
        x -= {"l": 0.0, "m": 0.5, "r": 1.0}[anchor[0]] * width(text, size, bold)
        anchor = "l" + anchor[1]
    for face, piece in pieces:
        letters = font(size, face)
        draw.text(
            (x, y), piece, fill=fill, font=letters, anchor=anchor, stroke_width=halo, stroke_fill=around
        )
        x += float(letters.getlength(piece))
