"""What the checker and the stage need to know of a definition, whoever reads it.

Each kind of definition has its reader beside this file; it extends the class here with what only
that kind's builder in ``vdsl.stage`` needs.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..source import Span


@dataclass(frozen=True)
class ParameterSpec:
    """A parameter of a prop or a cast member.

    kind: length (metres), angle (radians), number, seconds or word
    choices: the words allowed, None for any (colours are words checked by whoever reads them)
    numbers: lowest and highest bare number that may stand for a word or a number; None: only ``kind`` will do
    """

    name: str
    kind: str
    default: float | str
    choices: tuple[str, ...] | None = None
    numbers: tuple[float, float] | None = None


@dataclass(frozen=True)
class DefinitionBase:
    name: str
    parameters: tuple[ParameterSpec, ...]
    span: Span


@dataclass(frozen=True)
class SetNode:
    """A node of a set's tree.

    kind: set, room, area (outdoors), object (a placed prop) or part (a door, window or other named
        part without a prop of its own)
    prop: name of the placed prop for an object
    spots: names of the spots the set itself gives this node (those of the prop come on top)
    """

    name: str
    kind: str
    prop: str | None
    spots: tuple[str, ...]
    children: tuple[SetNode, ...]
    span: Span
