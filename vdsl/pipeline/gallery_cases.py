"""The cases of the gallery: faces, a crowd, glass, shadows, depth of field and thumbnails, as scripts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

#: Who stands in the sets.
CAST = (
    "character anna = woman(height 1.68m, hair bob, top crimson)\ncharacter ben = man(build heavy, top navy)"
)
_SQUARED = "size 224x224\n"
_ALL = ("board", "clay", "ink")
_STREET = "scene s = suburb_street at {time}\nanna at mailbox facing bus_stop\nben at bus_stop facing anna\n"
_KITCHEN = "scene s = apartment.kitchen at {time}\nanna at door facing window\nben at chair_2 sitting\n"
_MUSEUM = "scene s = museum at day\nanna at corner\n"
_CAFE = "scene s = cafe at {time}\nanna at middle facing ben\nben at queue facing anna\n"


@dataclass(frozen=True)
class CaseShot:
    """A picture of a case: its last line's best take, at a share of its length."""

    label: str
    script: str
    at: float = 0.5


@dataclass(frozen=True)
class Case:
    """A picture of the gallery: its shots in every one of its looks.

    size: pixels of each; columns: of the grid; true_size: drawn at that size, not shrunk to it
    """

    name: str
    title: str
    about: str
    shots: tuple[CaseShot, ...]
    looks: tuple[str, ...] = ("board",)
    size: tuple[int, int] = (400, 225)
    columns: int = 3
    true_size: bool = False


def _script(scene: str, line: str, cast: str = CAST, head: str = "") -> str:
    return f'storyboard "gallery"\n{head}{cast}\n{scene}\n{line}\n'


def _shot(label: str, scene: str, line: str, time: str = "day", at: float = 0.5, head: str = "") -> CaseShot:
    return CaseShot(label, _script(scene.replace("{time}", time), line, head=head), at)


_FACES = (
    "woman", "man", "girl", "boy", "old_woman", "old_man", "punk", "student", "judge", "chef", "nurse",
    "police_officer", "firefighter", "pirate", "knight", "queen", "wizard", "astronaut",
)  # fmt: skip


def _faces() -> Iterator[CaseShot]:
    scene = "scene s = cafe at day\nanna at middle\n"
    line = "/ (static close-up eye-level) focus anna, aperture 2.8"
    for name in _FACES:
        yield CaseShot(name, _script(scene, line, f"character anna = {name}", _SQUARED), 0.2)


_FEELINGS = ("neutral", "happy", "sad", "angry", "afraid", "surprised", "disgusted")


def _feelings() -> Iterator[CaseShot]:
    for feeling in _FEELINGS:
        line = f"(anna talk ben) / (static close-up eye-level) feeling {feeling}"
        yield _shot(feeling, _CAFE, line, head=_SQUARED)


_CROWD = (
    "businesswoman", "businessman", "old_man", "teenager", "tourist", "musician", "nurse", "student", "girl",
    "old_woman", "athlete", "punk", "police_officer", "builder",
)  # fmt: skip
#: Where the crowd stands, metres in the square.
_STANDS = (
    (5.2, 4.2), (6.9, 4.8), (8.3, 4.0), (10.1, 4.6), (4.3, 6.2), (6.0, 6.6), (7.8, 6.3), (9.4, 6.8),
    (11.2, 6.4), (5.1, 8.4), (6.8, 8.8), (8.7, 8.5), (10.6, 8.9), (12.0, 8.2),
)  # fmt: skip
_SQUARE = """set square {{
    time day
    area square, at (0, 0)m, size (16, 13)m, floor tile, floor-color "#d6cfc2" {{
        place house = townhouse(width 8m, floors 3, color "#c79f88"), at (3.6, 12.9)m
        place shop = shop_house(width 7m, front "#6f8a5f", awning "#c9574a"), at (11.4, 12.9)m
{spots}
    }}
}}"""


def _crowd(line: str, time: str) -> str:
    spots = "\n".join(
        f"        spot p{k}_at, at ({x}, {y})m, facing {-90 + (k * 67) % 80 - 40}deg"
        for k, (x, y) in enumerate(_STANDS)
    )
    cast = "\n".join(f"character p{k} = {name}" for k, name in enumerate(_CROWD))
    placed = "\n".join(f"p{k} at p{k}_at" for k in range(len(_CROWD)))
    return _script(f"scene s = square at {time}\n{placed}\n", line, f"{_SQUARE.format(spots=spots)}\n{cast}")


_TABLE = """set table_top {
    time day
    room room, at (0, 0)m, size (5, 4.4, 2.7)m, floor wood, floor-color "#c9a57c", wall-color "#e6dcc8" {
        door, wall south, at 0.9m
        window, wall east, at 2.2m, width 2m, sill 0.8m, height 1.4m
        place table = table(width 1.5m), at (2.6, 2.4)m {
            place bottle = bottle(color "#4f7a52"), on top, at (-0.3, 0.1)m
            place carafe = bottle(color "#9fb8c4"), on top, at (-0.14, 0.14)m
            place wine = wine_glass, on top, at (0.02, -0.02)m
            place water = glass, on top, at (0.17, 0.04)m
            place beer = beer_glass, on top, at (0.34, -0.04)m
            place apple = apple, on top, at (0.16, -0.16)m
        }
        place picture = picture(width 0.9m, height 0.7m), wall north, at 2.4m, up 1.3m
        place shelf = bookshelf, wall north, at 4m
        spot beside, at (2.6, 3.5)m, facing -90deg
    }
}"""


def _table(line: str, look_in: str = "anna at beside\n") -> str:
    return _script(f"scene s = table_top at day\n{look_in}", line, f"{_TABLE}\n{CAST}")


def _apertures() -> Iterator[CaseShot]:
    for number in ("off", "4", "1.4"):
        line = f"(anna talk ben) / (static close-up eye-level) aperture {number}"
        label = "everything sharp" if number == "off" else f"f/{number}"
        yield _shot(label, _CAFE, line)


def _shadows() -> Iterator[CaseShot]:
    walk = "(anna walk bus_stop) / (follow full eye-level)"
    for time in ("dawn", "day", "dusk", "night"):
        yield _shot(f"street, {time}", _STREET, walk, time)
    forest = "scene s = forest at day\nanna at tent\n"
    yield _shot("under trees", forest, "/ (static full high-angle) focus anna")
    yield _shot("kitchen", _KITCHEN, "(anna walk counter) / (static full high-angle)", "dawn")


def _thumbnails() -> Iterator[CaseShot]:
    lines = (
        (_KITCHEN, "(anna walk counter) / (static full eye-level)", "day"),
        (_KITCHEN, "(ben greet anna) / (static close-up eye-level)", "day"),
        (_STREET, "(anna run bus_stop) / (follow full low-angle)", "dusk"),
        (_STREET, "(anna wave ben) / (static medium eye-level)", "night"),
        (_CAFE, "(ben talk anna) / (static medium eye-level ots anna)", "day"),
        (_CAFE, "/ (static wide high-angle)", "night"),
    )
    for scene, line, time in lines:
        yield _shot("", scene, line, time, head=_SQUARED)


CASES: tuple[Case, ...] = (
    Case(
        "faces",
        "Faces",
        "Close-ups of the cast by the light of a window, at f/2.8.",
        tuple(_faces()),
        size=(224, 224),
        columns=6,
    ),
    Case(
        "feelings",
        "Feelings",
        "One face and the seven feelings.",
        tuple(_feelings()),
        size=(224, 224),
        columns=7,
    ),
    Case(
        "looks",
        "Looks",
        "The same shots as board, clay and ink.",
        (
            _shot("close", _CAFE, "(anna talk ben) / (static close-up eye-level)"),
            _shot("medium", _KITCHEN, "(ben greet anna) / (static medium eye-level)"),
        ),
        _ALL,
    ),
    Case(
        "crowd",
        "A crowd",
        "Fourteen people on a square.",
        (
            CaseShot("day", _crowd("/ (static wide eye-level) focus p6", "day")),
            CaseShot("night", _crowd("/ (static wide eye-level) focus p6", "night")),
        ),
        _ALL,
    ),
    Case(
        "glass",
        "Glass",
        "Bottles and glasses, a window, a vitrine, a bus shelter.",
        (
            CaseShot("table", _table("/ (static close-up eye-level) focus wine")),
            CaseShot("from above", _table("/ (static close-up high-angle) focus wine")),
            _shot("train", "scene s = train at day\nanna at end\n", "/ (static full eye-level) focus anna"),
            _shot("shelter", _STREET, "/ (static medium eye-level) focus ben"),
            _shot("bar", "scene s = bar at night\nanna at serve\n", "/ (static medium eye-level) focus anna"),
            _shot("museum", _MUSEUM, "/ (static close-up eye-level) focus case_2"),
        ),
    ),
    Case(
        "shadows",
        "Light and shadow",
        "A street through the day, trees, low morning light indoors.",
        tuple(_shadows()),
    ),
    Case(
        "depth",
        "Depth of field",
        "The same close-up without and with an aperture.",
        tuple(_apertures()),
    ),
    Case(
        "thumbnails",
        "Thumbnails",
        "At 224 pixels, as the judge sees them: a row for each look.",
        tuple(_thumbnails()),
        _ALL,
        (224, 224),
        columns=6,
        true_size=True,
    ),
)
