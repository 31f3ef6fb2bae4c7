"""The table of diagnostic codes: a title, and what ``vdsc explain`` says.

Ranges: VDS001-099 the language, VDS100-139 sets and props, VDS140-159 actions, VDS160-169 the cast.
An explanation is plain text; examples are indented by four spaces, first the wrong, then the right one.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Code:
    """title: a few words, lower case; explanation: paragraphs with a wrong and a right example."""

    title: str
    explanation: str


CODES: dict[str, Code] = {}


def title(code: str) -> str:
    """The title of a code; a code nobody described is its own title."""
    return CODES[code].title if code in CODES else code
