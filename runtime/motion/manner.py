"""How something is done: the words for manners, and what each does to a performance."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Manner:
    """What one manner does to a performance."""


_WORDS = "briskly quickly slowly calmly sadly drunk proudly nervously stealthily angrily happily tiredly"
MANNERS: dict[str, Manner] = {word: Manner() for word in _WORDS.split()}
