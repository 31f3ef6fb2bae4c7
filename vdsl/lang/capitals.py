"""Capitals: ``Anna``, ``ANNA`` and ``anna`` are one and the same, as at the beginning of a sentence.

Assumes the names of all characters. Guarantees that who is written as defined stays who that is, that nobody
is taken for one of two who differ by capitals alone, and that a small word that is a thing's is no name.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace

from . import ast
from .pronouns import owner
from .words import ARTICLES


class Named:
    """Who is meant by a name in whatever capitals. is_word: whether a small word is one for something else"""

    def __init__(self, characters: Iterable[str], is_word: Callable[[str], bool]) -> None:
        self._names = set(characters)
        self._is_word = is_word
        alike: dict[str, list[str]] = {}
        for name in sorted(self._names):
            alike.setdefault(name.casefold(), []).append(name)
        self._meant = {folded: names[0] for folded, names in alike.items() if len(names) == 1}

    def __call__(self, word: str, sure: bool = True) -> str:
        """The name a word stands for, or the word; ``Anna's`` too. sure: whether a name belongs there"""
        if owner(word) and word not in self._names:
            return self(word[:-2], sure) + "'s"
        if word in self._names or (not sure and word == word.casefold() and self._is_word(word)):
            return word
        return self._meant.get(word.casefold(), word)

    def statement(self, said: ast.Statement) -> ast.Statement:
        """A line of a script with the names in it as they were defined; words of cameras are left alone."""
        if isinstance(said, ast.PlacementLine):
            at, facing = (None if name is None else self._name(name) for name in (said.at, said.facing))
            return replace(said, character=self._name(said.character), at=at, facing=facing)
        if not isinstance(said, ast.StoryNode):
            return said
        beats = tuple(replace(beat, words=tuple(self._words(beat.words))) for beat in said.beats)
        cameras = tuple(replace(each, options=self._options(each.options)) for each in said.cameras)
        return replace(said, beats=beats, options=self._options(said.options), cameras=cameras)

    def _words(self, words: tuple[ast.Name, ...]) -> Iterator[ast.Name]:
        before = ""
        for word in words:
            yield word if before in ARTICLES and word.text.islower() else self._name(word, not before)
            before = word.text.casefold()

    def _options(self, options: tuple[ast.Option, ...]) -> tuple[ast.Option, ...]:
        return tuple(replace(each, values=tuple(map(self._value, each.values))) for each in options)

    def _value(self, value: ast.Value) -> ast.Value:
        return self._name(value) if isinstance(value, ast.Name) else value

    def _name(self, name: ast.Name, sure: bool = True) -> ast.Name:
        first, *more = name.parts
        meant = self(first, sure)
        return name if meant == first else replace(name, parts=(meant, *more))


def small(
    words: tuple[ast.Name, ...], is_name: Callable[[ast.Name], bool], people: Collection[str]
) -> tuple[ast.Name, ...]:
    """Words of a sentence without capitals, but for names: ``She opens The Door``."""

    def as_said(word: ast.Name) -> ast.Name:
        parts = tuple(part.casefold().replace("’", "'") for part in word.parts)
        somebody = (owner(word.text) or word.text) in people or parts[0] in people
        return word if is_name(word) or parts == word.parts or somebody else ast.Name(parts, word.span)

    return tuple(map(as_said, words))
