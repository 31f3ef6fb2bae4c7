"""Text drawn on pictures with the font Pillow carries, so that it looks the same everywhere.

Characters the font lacks come out as empty boxes; nothing a writer can type makes this fail.
"""

from __future__ import annotations

from functools import lru_cache

from PIL import ImageDraw, ImageFont


@lru_cache(maxsize=64)
def font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    """The built-in typeface at a size in pixels."""
    return ImageFont.load_default(size)


def clean(text: str) -> str:
    """The text without line ends and control characters; lone surrogates become question marks."""
    joined = " ".join(text.split())
    return "".join(c if c.isprintable() else "?" for c in joined).encode("utf-8", "replace").decode("utf-8")


def width(text: str, size: int) -> float:
    """Width of a line in pixels."""
    return float(font(size).getlength(text))


def shortened(text: str, size: int, room: float) -> str:
    """The text, ended by an ellipsis where it is wider than ``room`` pixels."""
    text = clean(text)[:400]
    if width(text, size) <= room:
        return text
    low, high = 0, len(text)
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if width(text[:middle] + "…", size) <= room else (low, middle - 1)
    return text[:low].rstrip() + "…"


def wrapped(text: str, size: int, room: float, most: int) -> list[str]:
    """The text in at most ``most`` lines no wider than ``room`` pixels, broken between words."""
    words = clean(text)[:1000].split(" ")
    lines: list[str] = []
    while words and len(lines) < most - 1:
        line = words.pop(0)
        while words and width(f"{line} {words[0]}", size) <= room:
            line += " " + words.pop(0)
        lines.append(shortened(line, size, room))
    if words:
        lines.append(shortened(" ".join(words), size, room))
    return lines


def write(
    draw: ImageDraw.ImageDraw, at: tuple[float, float], text: str, size: int, fill: str, anchor: str = "la"
) -> None:
    """Draw one line."""
    draw.text(at, text, fill=fill, font=font(size), anchor=anchor)
