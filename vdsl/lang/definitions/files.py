"""Definitions out of other programs' files: ``prop lamp = "lamp.glb", height 40cm { … }``.

Assumes a parsed definition. Guarantees that the file is inside the project's folder, there, of a kind that
can be read, and sound as far as that shows without decoding it; what is wrong is reported at the path. What
stands in the braces is read as in a definition in text.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from runtime.formats.errors import ModelFileError
from runtime.formats.outline import FIGURES, MODELS, MOTIONS, Outline, outline

from .. import ast
from ..diagnostics import Report, listing, nearest
from ..files import inside_folder
from ..source import Span
from .action import ActionDef, read_action
from .cast import CastDef, read_cast
from .prop import PropDef, PropShape, read_prop
from .reader import Reader
from .set import SetDef, read_set
from .types import DefinitionBase, ModelFile, ParameterSpec, SetNode

ENDINGS = {"prop": MODELS, "set": MODELS, "cast": FIGURES, "action": MOTIONS}
#: Where what stands in a set from a file is: the one ground of such a set.
GROUND = "ground"
#: Height of a person from a file where nothing is said, metres.
PERSON = 1.72
SHORTEST, TALLEST = 0.7, 2.4


@dataclass(frozen=True, kw_only=True)
class FileDef(DefinitionBase):
    """A definition out of a file."""

    model: ModelFile


@dataclass(frozen=True)
class FilePropDef(FileDef, PropDef):
    """A prop out of a model file, with the shapes, spots and grip of its braces."""

    def shape(
        self, arguments: Mapping[str, float | str] | None = None, report: Report | None = None
    ) -> PropShape:
        return replace(PropDef.shape(self, arguments, report), model=self.model)


@dataclass(frozen=True)
class FileSetDef(FileDef, SetDef):
    """A set out of a model file: its named things are objects on one ground, with what its braces place."""


@dataclass(frozen=True)
class FileCastDef(FileDef, CastDef):
    """A person out of a file with a skeleton and a skin."""


@dataclass(frozen=True, kw_only=True)
class FileActionDef(FileDef, ActionDef):
    """Captured motion as an action.

    clip: name of the motion in its file, "" for the first; cut: seconds of it to play, (from, to)
    times: how often it is played over; stays: without leaving the spot
    """

    clip: str
    cut: tuple[float, float | None]
    times: int
    stays: bool


def character_cast(path: ast.Text) -> ast.FileDefinition:
    """``character robo = "robo.glb"`` as the cast definition it stands for; its name has a slash in it."""
    folder = os.path.dirname(path.span.source.name) or "."
    name = ast.Name((f"{folder}/{path.value}",), path.span)
    return ast.FileDefinition("cast", name, path, (), (), path.span)


def read_file(definition: ast.FileDefinition, folder: Path, report: Report) -> FileDef | None:
    """A definition out of a file; None where the file cannot be used (which is reported)."""
    path = _located(definition, folder, report)
    if path is None:
        return None
    try:
        about = outline(path, folder.resolve())
    except ModelFileError as error:
        broken_file(error, definition.path.span, report)
        return None
    entry = ast.Entry(
        ast.Name((definition.kind,), definition.span), (), (), definition.options, None, definition.span
    )
    reader = Reader(entry, {}, report)
    model = ModelFile(str(path), str(folder.resolve()), definition.path.span)
    if definition.kind == "action":
        return _action(definition, reader, model, about, report)
    if definition.kind == "cast":
        return _cast(definition, reader, model, about, report)
    model = _fitted(reader, model)
    reader.done()
    if definition.kind == "prop":
        text = ast.Definition("prop", definition.name, (), definition.body, definition.span)
        prop = read_prop(text, report)
        return None if prop is None else FilePropDef(
            **(_values(prop) | {"spots": tuple(dict.fromkeys((*prop.spots, "stand")))}), model=model
        )  # fmt: skip
    return _set(definition, model, about, report)


def broken_file(error: ModelFileError, span: Span, report: Report) -> None:
    """Report a file that cannot be used."""
    report.error("VDS201", span, label=f"{error.path.name}: {error.reason}")


def _values(definition: DefinitionBase) -> dict[str, Any]:
    return {f.name: getattr(definition, f.name) for f in fields(definition)}


def _located(definition: ast.FileDefinition, folder: Path, report: Report) -> Path | None:
    """The file a definition names: inside the project's folder, there, and of a kind that is read."""
    written, base = definition.path, Path(definition.path.span.source.name).parent
    path = inside_folder(written, base, folder.resolve(), "VDS200", report)
    if path is None:
        return None
    try:
        there = path.is_file()
    except OSError:
        report.error("VDS200", written.span, label="this is no usable path")
        return None
    endings = ENDINGS[definition.kind]
    if path.suffix.lower() not in endings:
        what = "an" if definition.kind == "action" else "a"
        report.error(
            "VDS200",
            written.span,
            label=f"{what} {definition.kind} does not come out of this kind of file",
            help=f"it may end in {listing(endings)}",
        )
        return None
    if not there:
        near = []
        if path.parent.is_dir():
            near = sorted(p.name for p in path.parent.iterdir() if p.suffix.lower() in endings)
        report.error(
            "VDS200",
            written.span,
            label="there is no such file",
            help=f"the folder has {listing(near, 8, last='and')}" if near else None,
            suggestion=nearest(path.name, near),
        )
        return None
    return path


def _fitted(reader: Reader, model: ModelFile) -> ModelFile:
    """``up z, turn 90deg, scale 1cm`` or ``height 2m`` / ``length`` / ``width``: one size at most."""
    sizes: dict[str, float] = {}
    for name in ("height", "length", "width", "scale"):
        value = reader.length(name, None)
        if value is not None and value <= 0:
            reader.report.error("VDS101", reader.span, label="a size here is zero or less")
        elif value is not None:
            sizes[name] = value
    if len(sizes) > 1:
        reader.report.error(
            "VDS202",
            reader.span,
            label=f"{listing(sizes, last='and')} cannot all be said",
            help="say one of them",
        )
    up = reader.word("up", "", ("y", "z"))
    turn = reader.angle("turn", 0.0)
    return replace(
        model, up=up, turn=turn, scale=sizes.get("scale"), height=sizes.get("height"),
        length=sizes.get("length"), width=sizes.get("width"),
    )  # fmt: skip


# --- kinds ----------------------------------------------------------------------------


def _set(
    definition: ast.FileDefinition, model: ModelFile, about: Outline, report: Report
) -> FileSetDef | None:
    """The entries of the braces: `time` and the like are the set's, `place` and `spot` its ground's."""
    span = definition.span
    inner = tuple(e for e in definition.body if e.head.text in ("place", "spot", "repeat"))
    outer = tuple(e for e in definition.body if e not in inner)
    size = ast.Group((ast.Number(1.0, "m", span), ast.Number(1.0, "m", span)), None, span)
    area = ast.Entry(
        ast.Name(("area",), span),
        (ast.Name((GROUND,), span),),
        (),
        (ast.Option(ast.Name(("size",), span), (size,), span),),
        inner,
        span,
    )
    text = ast.Definition("set", definition.name, (), (*outer, area), span)
    made = read_set(text, report)
    if made is None:
        return None
    taken = {child.name for child in made.root.children[0].children}
    things = tuple(
        SetNode(name, "object", None, ("stand",), (), definition.path.span)
        for name in about.nodes
        if name not in taken
    )
    ground = made.root.children[0]
    ground = replace(ground, children=(*ground.children, *things))
    root = replace(made.root, children=(ground, *made.root.children[1:]))
    return FileSetDef(**(_values(made) | {"root": root, "outdoor": True}), model=model)


def _cast(
    definition: ast.FileDefinition, reader: Reader, model: ModelFile, about: Outline, report: Report
) -> FileCastDef | None:
    height = reader.length("height", PERSON)
    if not SHORTEST <= height <= TALLEST:
        help = f"from {SHORTEST:g}m to {TALLEST:g}m"
        report.error("VDS067", reader.span, label=f"nobody is {height:g}m tall", help=help)
        height = PERSON
    up = reader.word("up", "", ("y", "z"))
    turn = reader.angle("turn", 0.0)
    reader.done()
    if not about.skinned:
        report.error(
            "VDS203",
            definition.path.span,
            label="this file has no skeleton with a skin on it",
            help="somebody who moves needs one; as a thing it may be a `prop`",
        )
        return None
    text = ast.Definition("cast", definition.name, (), definition.body, definition.span)
    made = read_cast(text, report)
    if made is None:
        return None
    parameters = (ParameterSpec("height", "length", height),)
    values = _values(made) | {"parameters": parameters}
    return FileCastDef(**values, model=replace(model, up=up, turn=turn, height=height))


def _action(
    definition: ast.FileDefinition, reader: Reader, model: ModelFile, about: Outline, report: Report
) -> FileActionDef | None:
    clip = reader.text("clip", "")
    start, end = reader.seconds("from", 0.0), reader.seconds("to", None)
    times = reader.number("times", 1.0)
    stays = reader.flag("stay")
    up = reader.word("up", "", ("y", "z"))
    turn = reader.angle("turn", 0.0)
    reader.done()
    if not about.clips:
        report.error("VDS204", definition.path.span, label="there is no motion in this file")
        return None
    if clip and clip not in about.clips:
        report.error(
            "VDS204",
            reader.span,
            label=f"there is no motion `{clip}` in this file",
            help=f"it has {listing(about.clips, 12, last='and')}",
            suggestion=nearest(clip, about.clips),
        )
        return None
    if start < 0 or (end is not None and end <= start):
        report.error("VDS202", reader.span, label="`from` has to come before `to`")
        return None
    if times != int(times) or not 1 <= times <= 50:
        report.error("VDS202", reader.span, label="`times` is a whole number from 1 to 50")
        return None
    text = ast.Definition("action", definition.name, (), definition.body, definition.span)
    made = read_action(text, report)
    if made is None:
        return None
    model = replace(model, up=up, turn=turn)
    return FileActionDef(
        **_values(made), model=model, clip=clip, cut=(start, end), times=int(times), stays=stays
    )
