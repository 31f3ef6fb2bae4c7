"""``vdsc assets``: what there is to write with: sets, props, cast, actions and camera styles."""

from __future__ import annotations

import json
import sys
from collections import Counter
from dataclasses import asdict
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..lang.diagnostics import nearest
from .check import USAGE, stop

if TYPE_CHECKING:
    from rich.table import Table

    from ..library import Catalog
    from ..library.describe import Row


class Kind(str, Enum):
    """What to list."""

    sets = "sets"
    props = "props"
    cast = "cast"
    actions = "actions"
    styles = "styles"


def assets(
    kind: Annotated[
        Kind | None, typer.Argument(help="sets, props, cast, actions or styles.", show_default=False)
    ] = None,
    name: Annotated[str, typer.Argument(help="One of them, in full.", show_default=False)] = "",
    search: Annotated[
        str, typer.Option("--search", "-s", help="Only those in which these words occur.", show_default=False)
    ] = "",
    file: Annotated[
        Path | None, typer.Option(help="A script whose own definitions count too.", show_default=False)
    ] = None,
    json_out: Annotated[bool, typer.Option("--json", help="As JSON: a list of objects with `name`.")] = False,
    preview: Annotated[
        Path | None, typer.Option(help="Draw it to this PNG instead of listing it.", show_default=False)
    ] = None,
    time: Annotated[
        str, typer.Option(help="For sets: dawn, day, dusk or night.", show_default="the set's own")
    ] = "",
    device: Annotated[str, typer.Option(help="Where pictures are drawn: auto, cpu, cuda, vulkan.")] = "auto",
) -> None:
    """List what there is to write with, show one of it in full, or draw it."""
    if kind is Kind.styles:
        from .styles import list_styles

        list_styles(name, search, json_out, preview, device)
        return
    catalog = _catalog(file)
    if kind is None:
        if preview is not None or name:
            stop("say what: sets, props, cast, actions or styles", USAGE)
        _overview(catalog, search, json_out)
        return
    found = _found(catalog, kind, name, search)
    if preview is not None:
        _draw(catalog, kind, found, bool(name), preview, time, device, file)
    elif json_out:
        print(json.dumps([_plain(row) for row in found], ensure_ascii=False, indent=2))
    elif name:
        _print_one(catalog, found[0])
    else:
        _print(_table(kind, found))
        print(f"{len(found)} {kind.value}; `vdsc assets {kind.value} NAME` shows one in full")


def _catalog(file: Path | None) -> Catalog:
    from ..library import Catalog

    if file is None:
        return Catalog()
    from .check import check_or_exit

    return check_or_exit(file, "text").catalog


def _found(catalog: Catalog, kind: Kind, name: str, search: str) -> list[Row]:
    from ..library.describe import PLURALS, describe, rows

    word = PLURALS[kind.value]
    if not name:
        return rows(catalog, word, search)
    wanted = {n.casefold().replace("-", "_"): n for n in catalog.names(word)}
    for other, own in catalog.synonyms(word).items():
        wanted.setdefault(other.casefold().replace("-", "_"), own)
    if kind is Kind.sets:
        name = name.partition(".")[0]  # a room of it, as scenes are written
    known = wanted.get(name.casefold().replace("-", "_").replace(" ", "_"))
    row = describe(catalog, word, known) if known is not None else None
    if row is None:
        meant = nearest(name, catalog.names(word))
        hint = f"; did you mean `{meant}`?" if meant else ""
        stop(f"there is no {word} `{name}`{hint} (`vdsc assets {kind.value}` lists them)", USAGE)
    return [row]


def _plain(row: Row) -> dict[str, object]:
    return asdict(row)


# --- tables ---------------------------------------------------------------------------------


def _overview(catalog: Catalog, search: str, json_out: bool) -> None:
    from ..library.describe import PLURALS, rows

    found = {plural: rows(catalog, kind, search) for plural, kind in PLURALS.items()}
    if json_out:
        everything = [_plain(row) for each in found.values() for row in each]
        print(json.dumps(everything, ensure_ascii=False, indent=2))
        return
    for plural, each in found.items():
        first = ", ".join(row.name for row in each[:7]) + (" …" if len(each) > 7 else "")
        print(f"{len(each):4d} {plural:8s} {first}")
    from .styles import first_words

    count, first = first_words(search)
    print(f"{count:4d} {'styles':8s} {first}")
    print("`vdsc assets sets` lists one kind, `--search WORDS` finds, `--preview FILE.png` draws")


def _table(kind: Kind, found: list[Row]) -> Table:
    from rich.table import Table

    from ..library.describe import ActionRow, CastRow, PropRow, SetRow

    table = Table(box=None, pad_edge=False, header_style="bold")
    heads = {
        Kind.sets: ("set", "time", "places", "about"),
        Kind.props: ("prop", "parameters", "spots", "parts"),
        Kind.cast: ("cast", "who"),
        Kind.actions: ("action", "group", "target", "ways", "example"),
    }
    for k, head in enumerate(heads[kind]):
        table.add_column(head, no_wrap=k == 0, overflow="fold")
    for row in found:
        if isinstance(row, SetRow):
            places = ", ".join(str(place["name"]) for place in row.places)
            table.add_row(row.name, row.time, places, _first_sentence(row.about))
        elif isinstance(row, PropRow):
            spots = [*row.spots, *(["in the hand"] if row.movable else [])]
            table.add_row(row.name, _pairs(row.parameters), ", ".join(spots), ", ".join(row.parts))
        elif isinstance(row, CastRow):
            table.add_row(row.name, _pairs(row.parameters))
        elif isinstance(row, ActionRow):
            table.add_row(row.name, row.group, target_words(row), ", ".join(row.variants), f"({row.example})")
    return table


def target_words(row: object) -> str:
    """What an action is done to, as one would say it; in parentheses what may be left out."""
    words = []
    for need, kinds in ((row.target, row.target_kinds), (row.second, row.second_kinds)):  # type: ignore[attr-defined]
        if need != "none":
            said = "/".join(kinds) if len(kinds) < 3 else "anything"
            words.append(said if need == "required" else f"({said})")
    return ", ".join(words)


def _pairs(parameters: dict[str, str]) -> str:
    return ", ".join(f"{name} {value}" for name, value in parameters.items())


def _first_sentence(text: str) -> str:
    return text.split(". ")[0].rstrip(".")


def _print(table: Table) -> None:
    from rich.console import Console

    # In a pipe there is no width to keep to: one line a row, for grep.
    Console(width=None if sys.stdout.isatty() else 400).print(table)


def _print_one(catalog: Catalog, row: Row) -> None:
    from ..library.describe import ActionRow, SetRow, tree

    print(f"{row.kind} {row.name}" + (f"\n{row.about}" if row.about else ""))
    if isinstance(row, SetRow):
        definition = catalog.get("set", row.name)
        print(f"time: {row.time}; {'outdoors' if row.outdoor else 'indoors'}\n")
        for depth, name, what, spots in tree(definition.root, catalog):  # type: ignore[union-attr]
            kind = "" if what == name else f" ({what})"
            print(f"{'  ' * depth}{name}{kind}" + (f": {', '.join(spots)}" if spots else ""))
        return
    for key, value in asdict(row).items():
        if key in ("name", "kind", "about") or value in ("", (), {}, []):
            continue
        if isinstance(value, dict):
            print(f"{key}:")
            for name, default in value.items():
                print(f"    {name:14s} {default}")
        else:
            shown = ", ".join(map(str, value)) if isinstance(value, (list, tuple)) else value
            print(f"{key.replace('_', ' ')}: {shown}")
    if isinstance(row, ActionRow):
        counts = Counter(row.variants)
        print(f"ways: {len(counts)}")


# --- pictures -------------------------------------------------------------------------------


def _draw(
    catalog: Catalog,
    kind: Kind,
    found: list[Row],
    one: bool,
    out: Path,
    time: str,
    device: str,
    file: Path | None,
) -> None:
    from .failures import failures_told

    if not found:
        stop("nothing to draw", USAGE)
    with failures_told(out):
        from ..pipeline.preview import Studio
        from ..pipeline.trial import NoTrialError

        studio = Studio(catalog, device, own=file)
        names = [row.name for row in found]
        try:
            if kind is Kind.props:
                image = studio.props(names)
            elif kind is Kind.cast:
                image = studio.cast(names)
            elif one:
                image = studio.action(names[0]) if kind is Kind.actions else studio.set(names[0], time)
            else:
                image = studio.actions(names) if kind is Kind.actions else studio.sets(names, time)
        except NoTrialError as error:
            stop(str(error), USAGE)
        image.save(out)
    print(out)
