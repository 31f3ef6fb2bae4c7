"""Capitals: ``Anna``, ``ANNA`` and ``anna`` are one and the same, as at the beginning of a sentence.

Assumes the names of all characters. Guarantees that who is written as defined stays who that is, that nobody
is taken for one of two who differ by capitals alone, and that a small word that is a thing's is no name.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import replace

from . import ast


class Named:
    """Who is meant by a name in whatever capitals. is_thing: whether a word is one for a thing"""

    def __init__(self, characters: Iterable[str], is_thing: Callable[[str], bool]) -> None:
        self._names = set(characters)
        self._is_thing = is_thing
        alike: dict[str, list[str]] = {}
        for name in sorted(self._names):
            alike.setdefault(name.casefold(), []).append(name)
        self._meant = {folded: names[0] for folded, names in alike.items() if len(names) == 1}

    def __call__(self, word: str) -> str:
        """The name a word stands for, or the word; ``Anna's`` too."""
        for end in ("'s", "’s"):
            if word.endswith(end) and word not in self._names:
                return self(word[: -len(end)]) + end
        meant = self._meant.get(word.casefold(), word)
        if word in self._names or (word == word.casefold() and self._is_thing(word)):
            return word
        return meant

    def statement(self, said: ast.Statement) -> ast.Statement:
        """A line of a script with the names in it as they were defined; words of cameras are left alone."""
        if isinstance(said, ast.PlacementLine):
            at, facing = (None if name is None else self._name(name) for name in (said.at, said.facing))
            return replace(said, character=self._name(said.character), at=at, facing=facing)
        if not isinstance(said, ast.StoryNode):
            return said
        beats = tuple(replace(beat, words=tuple(map(self._name, beat.words))) for beat in said.beats)
        cameras = tuple(replace(each, options=self._options(each.options)) for each in said.cameras)
        return replace(said, beats=beats, options=self._options(said.options), cameras=cameras)

    def _options(self, options: tuple[ast.Option, ...]) -> tuple[ast.Option, ...]:
        return tuple(replace(each, values=tuple(map(self._value, each.values))) for each in options)

    def _value(self, value: ast.Value) -> ast.Value:
        return self._name(value) if isinstance(value, ast.Name) else value

    def _name(self, name: ast.Name) -> ast.Name:
        first, *more = name.parts
        meant = self(first)
        return name if meant == first else replace(name, parts=(meant, *more))


def small(
    words: tuple[ast.Name, ...], is_name: Callable[[ast.Name], bool], people: Collection[str]
) -> tuple[ast.Name, ...]:
    """Words of a sentence without capitals, but for names: ``She opens The Door``."""

    def as_said(word: ast.Name) -> ast.Name:
        parts = tuple(part.casefold() for part in word.parts)
        return (
            word if is_name(word) or parts == word.parts or parts[0] in people else ast.Name(parts, word.span)
        )

    return tuple(map(as_said, words))
