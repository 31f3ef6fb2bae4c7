"""The reference pages of the library in ``docs/library``: made from the definitions, with pictures.

``python -m vdsl.pipeline.reference docs/library`` writes pages and pictures, ``--pages`` the pages alone.
The pages depend on the library alone, so a test can hold them against it.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import TypeVar

from PIL import Image

from ..lang.definitions.action import GROUPS
from ..library import Catalog
from ..library.describe import ActionRow, CastRow, PropRow, SetRow, rows

Item = TypeVar("Item", SetRow, PropRow, CastRow, ActionRow)

#: What a group of actions is called on the page.
GROUP_TITLES = {
    "going": "Going", "posture": "Postures", "gesture": "Gestures", "hand": "Hands and things",
    "social": "Between two people", "emotion": "Feelings", "sport": "Sport and dance", "work": "Work",
    "music": "Music", "talk": "Talking",
}  # fmt: skip
_HEAD = "<!-- Made by `make reference` from the library; not edited by hand. -->\n\n# {title}\n\n{intro}\n"


def pages(catalog: Catalog) -> dict[str, str]:
    """The pages by file name."""
    return {
        "sets.md": _sets(_of(catalog, "set", SetRow)),
        "props.md": _props(_of(catalog, "prop", PropRow)),
        "cast.md": _cast(_of(catalog, "cast", CastRow)),
        "actions.md": _actions(_of(catalog, "action", ActionRow)),
    }


def _of(catalog: Catalog, kind: str, row: type[Item]) -> list[Item]:
    return [each for each in rows(catalog, kind) if isinstance(each, row)]


def _sets(found: Sequence[SetRow]) -> str:
    intro = (
        f"{len(found)} sets. A scene takes one whole, or one of its places: `scene kitchen = "
        "apartment.kitchen`; `at dawn`, `day`, `dusk` or `night` sets the hour. How sets are "
        "written: [sets.md](../sets.md)."
    )
    parts = [_HEAD.format(title="Sets of the library", intro=intro)]
    for row in found:
        parts.append(f"\n## {row.name}\n\n{row.about}\n\n![{row.name}](images/set-{row.name}.jpg)\n")
        where = "outdoors" if row.outdoor else "indoors"
        parts.append(
            f"\nUnless said otherwise by {row.time}; {where}.\n\n| place | spots | things |\n|---|---|---|\n"
        )
        for place in row.places:
            parts.append(f"| `{place['name']}` | {_codes(place['spots'])} | {_words(place['things'])} |\n")
    return "".join(parts)


def _props(found: Sequence[PropRow]) -> str:
    intro = (
        f"{len(found)} props, by the file they are defined in. What can be carried is marked with ✋; "
        "parts swing or slide when they are opened. How props are written: [sets.md](../sets.md)."
    )
    parts = [_HEAD.format(title="Props of the library", intro=intro)]
    for file, group in sorted(_by_file(found).items()):
        parts.append(f"\n## {file}\n\n![{file}](images/props-{file}.jpg)\n\n")
        parts.append("| prop | parameters | spots | parts |\n|---|---|---|---|\n")
        for row in group:
            name = f"`{row.name}`" + (" ✋" if row.movable else "")
            parameters = ", ".join(f"{k} {v}" for k, v in row.parameters.items())
            parts.append(f"| {name} | {parameters} | {', '.join(row.spots)} | {', '.join(row.parts)} |\n")
    return "".join(parts)


def _by_file(found: Iterable[PropRow]) -> dict[str, list[PropRow]]:
    catalog = Catalog()
    groups: dict[str, list[PropRow]] = defaultdict(list)
    for row in found:
        source = catalog.source_of("prop", row.name)
        groups[Path(source.name).stem if source is not None else ""].append(row)
    return groups


def _cast(found: Sequence[CastRow]) -> str:
    intro = (
        f"{len(found)} people. Every feature may be said otherwise where a character is made: "
        "`character anna = chef(height 1.6m, hair bun)`. All features: [cast.md](../cast.md)."
    )
    parts = [_HEAD.format(title="Cast of the library", intro=intro), "\n![the cast](images/cast.jpg)\n\n"]
    parts.append("| cast | who |\n|---|---|\n")
    for row in found:
        parts.append(f"| `{row.name}` | {', '.join(f'{k} {v}' for k, v in row.parameters.items())} |\n")
    return "".join(parts)


def _actions(found: Sequence[ActionRow]) -> str:
    intro = (
        f"{len(found)} actions in {sum(len(row.variants) for row in found)} variants. Every variant is "
        "proposed; a word for the manner (`briskly`, `sadly`, `drunk` …) goes with any. How actions are "
        "written: [actions.md](../actions.md)."
    )
    parts = [_HEAD.format(title="Actions of the library", intro=intro)]
    for group in GROUPS:
        members = [row for row in found if row.group == group]
        if not members:
            continue
        parts.append(f"\n## {GROUP_TITLES[group]}\n\n![{group}](images/actions-{group}.jpg)\n\n")
        parts.append("| action | also | brings | variants | as in |\n|---|---|---|---|---|\n")
        for row in members:
            also = ", ".join(word.replace("-", " ") for word in row.also)
            told = (f"`{row.name}`", also, row.brings, ", ".join(row.variants), f"`({row.example})`")
            parts.append(f"| {' | '.join(told)} |\n")
    return "".join(parts)


def _codes(names: object) -> str:
    assert isinstance(names, tuple)
    return ", ".join(f"`{name}`" for name in names)


def _words(names: object) -> str:
    """Names, those that only differ by a number once."""
    assert isinstance(names, tuple)
    stems = [name.rstrip("0123456789").rstrip("_") for name in names]
    seen: dict[str, str] = {}
    for name, stem in zip(names, stems, strict=True):
        seen.setdefault(stem if stems.count(stem) > 1 else name, name)
    return ", ".join(f"{stem} ({stems.count(stem)})" if stems.count(stem) > 1 else stem for stem in seen)


def draw(catalog: Catalog, folder: Path, only: Sequence[str] = ()) -> None:
    """The pages' pictures, as JPEG into a folder; only: names of some, or how they begin, nothing for all."""
    from .preview import Studio

    folder.mkdir(parents=True, exist_ok=True)
    studio = Studio(catalog)

    def save(name: str, drawing: Callable[[], Image.Image]) -> None:
        if not only or name.startswith(tuple(only)):
            drawing().save(folder / f"{name}.jpg", quality=76, optimize=True)
            print(folder / f"{name}.jpg", flush=True)

    for group in GROUPS:
        members = [row.name for row in _of(catalog, "action", ActionRow) if row.group == group]
        if members:
            save(f"actions-{group}", partial(studio.actions, members, (112, 140), 6))
    save("cast", partial(studio.cast, list(catalog.names("cast")), 330))
    for file, props in sorted(_by_file(_of(catalog, "prop", PropRow)).items()):
        save(f"props-{file}", partial(studio.props, [row.name for row in props], 140, 8))
    for name in catalog.names("set"):
        save(f"set-{name}", partial(studio.set, name, width=560))


def main() -> None:
    """Write the pages, and their pictures unless told otherwise."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--pages", action="store_true", help="the pages alone, no pictures")
    parser.add_argument(
        "--only", nargs="+", default=(), metavar="NAME", help="of the pictures, such as set-cafe"
    )
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    catalog = Catalog()
    for name, text in pages(catalog).items():
        (given.folder / name).write_text(text, encoding="utf-8")
    if not given.pages:
        draw(catalog, given.folder / "images", given.only)


if __name__ == "__main__":
    main()
