"""What the checker and the stage need to know of a definition, whoever reads it.

Each kind of definition has its reader beside this file; it extends the class here with what only
that kind's builder in ``vdsl.stage`` needs.
"""

from __future__ import annotations

from dataclasses import dataclass, field

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
class ModelFile:
    """Another program's file, and how what is in it is brought into the film.

    path, folder: absolute, the file and the project's folder; span: where the script names it
    up: ``y``, ``z`` or "" as its format has it; turn: radians about Z
    scale: metres for one of its units; height, length (along Y), width (along X): what it has to measure
    """

    path: str
    folder: str
    span: Span = field(compare=False, repr=False)
    up: str = ""
    turn: float = 0.0
    scale: float | None = None
    height: float | None = None
    length: float | None = None
    width: float | None = None


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
