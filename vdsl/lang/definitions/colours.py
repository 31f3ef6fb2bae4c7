"""The words for colours, and colours as written: ``sage`` or ``"#a9b8a0"``.

Quiet ones for sets and woods, clear ones for people and what they carry. sRGB, 0..1.
"""

from __future__ import annotations

import re

from ..diagnostics import Report, nearest
from ..source import Span

Colour = tuple[float, float, float]

_WORDS = """
white #f7f5ef  cream #f1ead9  ivory #efe8d6  beige #ddd0b8  sand #d9c7a3  grey #a6aaad
silver #c3c8cc  charcoal #4a4f55  black #2c2e33  oak #d0b088  birch #e2cda6  pine #dcbf8e
walnut #916d4f  mahogany #7d4a38  brown #7a573f  tan #c39a6b  chestnut #7b4a30  caramel #b87d4b
terracotta #c98768  brick #b0664f  rust #b4562f  sage #aabaa0  olive #7f8450  moss #8aa873
green #5c9a5e  forest #3f6b4f  mint #b5d6c3  lime #a9c553  dusty-blue #8fa8b8  sky #8fc1dc
blue #3f73b5  denim #4d6a8a  navy #2c3e63  royal #3550a8  steel #8a99a5  teal #2d8a8a
turquoise #3fb0ac  petrol #2f6270  yellow #efc63e  mustard #d7a53a  gold #d9b04c  amber #e09b35
orange #e07b39  apricot #eab183  peach #f0bfa0  coral #e8745f  salmon #e8917c  red #cc3b36
crimson #b5233c  burgundy #7a2638  pink #e59aae  rose #d9768c  blush #ecc4c0  magenta #b53c86
purple #7a4f9e  plum #6d3f68  lavender #b3a4d4  violet #6a57b0  lilac #c7aed6  blond #d9b779
copper #b4653a  bronze #9a7446
"""

COLOURS: dict[str, str] = dict(re.findall(r"([\w-]+) (#[0-9a-f]{6})", _WORDS))
_HEX = re.compile(r"#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})\Z")


def colour(word: str) -> Colour | None:
    """sRGB of a colour word or ``#rgb`` / ``#rrggbb``, or None for anything else."""
    text = COLOURS.get(word, COLOURS.get(word.casefold(), word))
    if not _HEX.match(text):
        return None
    digits = text[1:] if len(text) == 7 else "".join(c + c for c in text[1:])
    return int(digits[0:2], 16) / 255, int(digits[2:4], 16) / 255, int(digits[4:6], 16) / 255


def checked_colour(word: str, span: Span, report: Report, default: Colour = (0.8, 0.8, 0.8)) -> Colour:
    """The colour, or the default where it was reported not to be one."""
    found = colour(word)
    if found is not None:
        return found
    meant = nearest(word, COLOURS)
    report.error(
        "VDS100",
        span,
        label=f"`{word}` is not a colour",
        help='a colour is a word such as sage or crimson, or a text such as "#c33a2b"',
        suggestion=meant,
    )
    return default
