"""Shot ids: made from what a shot shows, so that they stay when other lines come and go.

An id is a slug of scene, character, action and targets; the camera's words are added where a line
has several cameras; a number (``--2``) only where two shots would otherwise be the same. Ids are
lower case, hold no path separators and are short enough for any file system. A shot that is named has its
name as id.
"""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections.abc import Sequence

LONGEST = 72
_NOT_SLUG = re.compile(r"[^\w]+")


def slug(words: Sequence[str]) -> str:
    """Words as one name for a folder: letters, digits, ``_`` and single ``-``."""
    text = unicodedata.normalize("NFC", "-".join(words)).casefold()
    text = _NOT_SLUG.sub("-", text).strip("-") or "shot"
    if len(text.encode()) <= LONGEST:
        return text
    mark = hashlib.sha256(text.encode()).hexdigest()[:8]
    return text.encode()[: LONGEST - 9].decode(errors="ignore").rstrip("-") + "-" + mark


class Ids:
    """Hands out ids; the same slug a second time gets ``--2``."""

    def __init__(self) -> None:
        self._used: dict[str, int] = {}

    def take(self, words: Sequence[str]) -> str:
        base = slug(words)
        self._used[base] = self._used.get(base, 0) + 1
        return base if self._used[base] == 1 else f"{base}--{self._used[base]}"

    def named(self, words: Sequence[str]) -> str | None:
        """The id of a shot that is named so; None where another has that id."""
        base = slug(words)
        if base in self._used:
            return None
        self._used[base] = 1
        return base
