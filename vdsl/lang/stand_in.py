"""A plain box in the place of what is no prop.

Assumes a word that names nothing in the scene and no prop that can be carried. Guarantees that a slip of the
finger gets no box, so that it is told.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .bringing import carry
from .catalog import CatalogLike
from .diagnostics import Report, is_slip
from .ir import Carried, Target
from .source import Span

if TYPE_CHECKING:
    from .placement import SceneBeingRead

#: The prop that stands in for what is none.
STAND_IN = "stand_in"
#: Nouns after which no box would be understood.
NO_THINGS = {
    "air", "answer", "attention", "back", "beach", "bit", "boat", "bottom", "breath", "bush", "bushes",
    "car", "care", "castle", "cloud", "corner", "courage", "crack", "crowd", "dark", "day", "decision",
    "dirt", "drain", "dream", "drop", "dust", "edge", "end", "engine", "evening", "everything", "face",
    "feeling", "fire", "flames", "floor", "gap", "gate", "good", "grave", "ground", "half", "hello",
    "help", "hole", "home", "house", "hug", "idea", "job", "joke", "kiss", "lamp", "left", "lesson",
    "lie", "life", "light", "lights", "line", "lines", "look", "lot", "love", "machine", "man",
    "memory", "men", "middle", "mind", "moment", "money", "morning", "move", "music", "name", "night",
    "noise", "nothing", "one", "others", "pain", "part", "peace", "people", "permission", "place",
    "plane", "point", "problem", "question", "rain", "rest", "river", "road", "room", "row", "sea",
    "seat", "second", "secret", "ship", "side", "sight", "silence", "sky", "smell", "smoke", "snow",
    "something", "song", "sound", "space", "step", "steps", "story", "street", "sun", "tears", "thing",
    "things", "thought", "time", "top", "touch", "train", "tree", "truth", "tune", "turn", "view",
    "voice", "walk", "wall", "walls", "water", "way", "weather", "week", "wind", "window", "woman",
    "word", "words", "work", "world", "year",
}  # fmt: skip


def stand_in(
    word: str, span: Span, who: str, scene: SceneBeingRead, catalog: CatalogLike, report: Report
) -> Target | None:
    """What no prop is called: a plain box in its place, lying near who acts.

    None where a word is nearly a prop's name, or none for a thing.
    """
    slip = any(is_slip(word, name) for name in (*catalog.names("prop"), *catalog.synonyms("prop")))
    if scene.scope is None or slip or word in NO_THINGS or catalog.get("prop", STAND_IN) is None:
        return None
    report.warn(
        "VDS084",
        span,
        label=f"no prop is called `{word}`: a plain box stands in for it",
        help=f"`prop {word} {{ box (20cm, 12cm, 9cm); grip (0, 0, 9cm) }}` says what it looks like",
    )
    return carry(Carried(who, word, STAND_IN, about=True), scene, span)
