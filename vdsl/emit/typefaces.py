"""Typefaces: Source Sans Pro from its package, and those of the machine for letters it lacks.

Assumes nothing of the machine: its fonts are asked for by what they can show (fontconfig), and by the names
of common ones where there is no fontconfig. Guarantees a face for any text; what no face can show is told by
:func:`lacking` and comes out as empty boxes. Latin, Greek and Cyrillic text looks the same everywhere.
"""

from __future__ import annotations

import shutil
import subprocess
import unicodedata
from collections.abc import Iterable
from functools import lru_cache
from typing import NamedTuple

from font_source_sans_pro import font_files_ttf
from PIL import ImageFont

Font = ImageFont.FreeTypeFont


class Face(NamedTuple):
    """A font file, and which of its fonts."""

    file: str
    number: int = 0


REGULAR = Face(font_files_ttf["SourceSansPro"])
BOLD = Face(font_files_ttf["SourceSansProSemibold"])
#: Asked for by name where there is no fontconfig: Linux, macOS and Windows have some of them.
COMMON = (
    "DejaVuSans.ttf", "NotoSans-Regular.ttf", "segoeui.ttf", "Arial Unicode.ttf", "Arial.ttf", "arial.ttf",
    "NotoSansCJK-Regular.ttc", "DroidSansFallbackFull.ttf", "wqy-microhei.ttc", "Hiragino Sans GB.ttc",
    "AppleSDGothicNeo.ttc", "msyh.ttc", "YuGothM.ttc", "malgun.ttf", "NotoSansArabic-Regular.ttf",
    "NotoSansHebrew-Regular.ttf", "NotoSansDevanagari-Regular.ttf", "NotoSansThai-Regular.ttf", "Nirmala.ttf",
)  # fmt: skip
#: Shows nothing itself: joiners, marks on other letters, spaces.
_UNSEEN = ("Cf", "Mn", "Me", "Zs", "Cc")
_PROBE = 24  # pixels
_NOTHING = "\U0010fffe"  # no font has it: what is drawn for it is drawn for everything that is missing


@lru_cache(maxsize=256)
def font(size: int, face: Face = REGULAR) -> Font:
    """A face at a size in pixels."""
    return ImageFont.truetype(face.file, size, index=face.number)


def runs(text: str, face: Face = REGULAR) -> list[tuple[Face, str]]:
    """The text in pieces, each with a face that shows it: the one given, or another where it lacks a letter.

    One piece where one face shows everything, so that scripts written from right to left keep their order;
    but a dash or an arrow that is missing does not change the face of the words around it.
    """
    wanted = _seen(text)
    lost = wanted - _shown(face, wanted)
    if not lost:
        return [(face, text)]
    others = _faces(wanted)
    for other in others if any(map(str.isalpha, lost)) else ():
        if shows(other, wanted):
            return [(other, text)]
    return _pieces(text, [face, *others])


def lacking(text: str) -> str:
    """The letters of a text that no typeface here shows, each once, in order."""
    wanted = _seen(text)
    faces = _faces(wanted)
    return "".join(sorted(c for c in wanted if not any(c in _shown(f, frozenset(c)) for f in faces)))


def shows(face: Face, letters: Iterable[str]) -> bool:
    """Whether a face has all of some letters."""
    wanted = frozenset(letters)
    return _shown(face, wanted) == wanted


def _seen(text: str) -> frozenset[str]:
    """The letters that must be drawn; those of ASCII every face has."""
    return frozenset(c for c in text if c > "~" and unicodedata.category(c) not in _UNSEEN)


def _pieces(text: str, faces: list[Face]) -> list[tuple[Face, str]]:
    """Neighbours that the same face shows, together."""
    out: list[tuple[Face, str]] = []
    for letter in text:
        wanted = _seen(letter)
        last = out[-1][0] if out else None
        if last is not None and (unicodedata.category(letter)[0] == "M" or shows(last, wanted)):
            face = last
        else:
            face = next((f for f in faces if shows(f, wanted)), last or REGULAR)
        if out and out[-1][0] == face:
            out[-1] = (face, out[-1][1] + letter)
        else:
            out.append((face, letter))
    return out


@lru_cache(maxsize=1024)
def _faces(wanted: frozenset[str]) -> tuple[Face, ...]:
    """Faces that together show what can be shown, the most useful first."""
    found, left = [REGULAR], wanted - _shown(REGULAR, wanted)
    while left:
        face = _face_for(min(left))
        more = _shown(face, left) if face is not None else frozenset[str]()
        if face is not None and more:
            found.append(face)
        left -= more or {min(left)}
    return tuple(sorted(found, key=lambda f: -len(_shown(f, wanted))))


@lru_cache(maxsize=4096)
def _face_for(letter: str) -> Face | None:
    """A face of this machine with a letter."""
    asked = _asked_of_fontconfig(letter)
    if asked is not None and shows(asked, letter):
        return asked
    return next((f for name in COMMON if (f := _common(name)) is not None and shows(f, letter)), None)


def _asked_of_fontconfig(letter: str) -> Face | None:
    """What fontconfig would take for a letter; it answers with another where no font has it."""
    program = shutil.which("fc-match")
    if program is None:
        return None
    pattern = f"sans-serif:charset={ord(letter):x}"
    try:
        done = subprocess.run(
            [program, "-f", "%{file}\n%{index}", pattern], capture_output=True, timeout=10, check=True
        )
        file, _, index = done.stdout.decode("utf-8", "replace").partition("\n")
        return _openable(Face(file, int(index) & 0xFFFF))
    except (OSError, subprocess.SubprocessError, ValueError):
        return None


@lru_cache(maxsize=64)
def _common(name: str) -> Face | None:
    return _openable(Face(name))


def _openable(face: Face) -> Face | None:
    try:
        font(_PROBE, face)
    except (OSError, ValueError):
        return None
    return face


@lru_cache(maxsize=4096)
def _shown(face: Face, letters: frozenset[str]) -> frozenset[str]:
    """Which of some letters a face has: those that are not drawn as what is missing."""
    missing = _drawn(face, _NOTHING)
    return frozenset(c for c in letters if _drawn(face, c) != missing)


@lru_cache(maxsize=16384)
def _drawn(face: Face, letter: str) -> bytes:
    mask = font(_PROBE, face).getmask(letter)
    return bytes(mask) + bytes(str(mask.size), "ascii")
