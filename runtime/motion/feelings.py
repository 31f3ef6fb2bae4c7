"""What faces show: the words for feelings, and what each does to a face."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Expression:
    """What one feeling does to a face."""


FEELINGS: dict[str, Expression] = {
    word: Expression() for word in ("neutral", "happy", "sad", "angry", "afraid", "surprised", "disgusted")
}
