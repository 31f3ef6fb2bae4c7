"""The styles of camera to choose from: movement, size, angle and view, each with its words and what varies.

One table, from which ``vdsc assets styles`` and the pages of ``docs/styles`` are made. Assumes the cast and
the two places of ``examples/coffee.vds``. Guarantees (tested) that every style named here is one the language
reads and for which cameras that keep to it are found there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

from .moves import family
from .subspaces import FILM, subspace

EYE = ("eye-level",)
STEEP = ("high-angle", "low-angle")

#: Who plays in the demo, as in ``examples/coffee.vds``.
CAST = (
    "character anna = woman(height 1.68m, hair bob, top crimson)",
    "character ben  = man(build heavy, top navy)",
)


@dataclass(frozen=True)
class Situation:
    """What a style is shown on: a scene of the demo, and a line without its camera ("" for nobody acting)."""

    scene: tuple[str, ...]
    line: str


_KITCHEN = ("scene kitchen = apartment.kitchen at day",)
_STREET = ("scene street = suburb_street at day",)
SITUATIONS: dict[str, Situation] = {
    "stands": Situation((*_STREET, "anna at mailbox facing bus_stop"), "(anna wave)"),
    "walks": Situation((*_STREET, "anna at mailbox facing bus_stop"), "(anna walk bus_stop)"),
    "talks": Situation(
        (*_STREET, "anna at bus_stop facing ben", "ben at bus_stop.bench facing anna"), "(ben talk anna)"
    ),
    "far": Situation(
        (*_STREET, "anna at mailbox facing bus_stop", "ben at bus_stop facing anna"), "(anna wave ben)"
    ),
    "nobody": Situation((*_KITCHEN, "anna at door facing window", "ben at chair_2 sitting"), ""),
}


@dataclass(frozen=True)
class Style:
    """One style.

    movement, size, angle: canonical words, a movement with its direction, two at once joined by ``+``; angle
        is "" where the view has none; view: its words in a line, or ""; option: what follows the
        parenthesis, or ""; situation: which of :data:`SITUATIONS` shows it
    """

    movement: str
    size: str
    angle: str
    view: str = ""
    option: str = ""
    situation: str = "stands"

    @property
    def words(self) -> str:
        """As they stand in a line: ``(push medium ots anna) roll 12deg``."""
        inside = " ".join(word for word in (self.movement, self.size, self.angle, self.view) if word)
        return f"({inside})" + (f" {self.option}" if self.option else "")

    @property
    def name(self) -> str:
        """What it is called: ``push_medium_eye-level``; also of its picture."""
        return self.words.translate(str.maketrans(" ", "_", "()"))

    @property
    def line(self) -> str:
        """A story line of the demo with it."""
        return f"{SITUATIONS[self.situation].line} / {self.words}".strip()

    @property
    def script(self) -> str:
        """A whole script with that line."""
        scene = SITUATIONS[self.situation].scene
        return "\n".join(('storyboard "Styles"', "", *CAST, "", *scene, "", f"{self.line}{self.lasts}", ""))

    @property
    def lasts(self) -> str:
        """How long it is shown."""
        return (", " if self.option else " ") + "3s"

    @property
    def means(self) -> str:
        """What it means in one line."""
        first, *more = (MOVEMENT_MEANS[part] for part in self.movement.split("+"))
        movement = " and ".join((first, *(each.removeprefix("the camera ") for each in more)))
        view = next((told for word, told in VIEW_MEANS.items() if self.view.startswith(word)), "")
        option = next((told for word, told in OPTION_MEANS.items() if self.option.startswith(word)), "")
        told = (movement, SIZE_MEANS[self.size], ANGLE_MEANS.get(self.angle, ""), view, option)
        return "; ".join(each for each in told if each)

    @property
    def varies(self) -> tuple[str, ...]:
        """Its free variables with their grids: ``μ ∈ [0.5, 0.8]``."""
        angle, view = self.angle or "eye-level", self.view.partition(" ")[0]
        free = subspace(self.movement, self.size, angle, FILM, (0.1, 1.0, 10.0), view=view).free
        return tuple(str(variable) for variable in free)

    @property
    def group(self) -> str:
        """The page it is on: ``push``; ``views`` for those of a view; ``pairs`` for two at once."""
        if self.view:
            return "views"
        return "pairs" if "+" in self.movement else family(self.movement)


@dataclass(frozen=True)
class _Block:
    """Every movement of a block at every size and every angle."""

    movements: tuple[str, ...]
    sizes: tuple[str, ...]
    angles: tuple[str, ...] = EYE
    view: str = ""
    option: str = ""
    situation: str = "stands"

    def styles(self) -> Iterator[Style]:
        for movement, size, angle in product(self.movements, self.sizes, self.angles):
            yield Style(movement, size, angle, self.view, self.option, self.situation)


def _both(movement: str, a: str, b: str) -> tuple[str, str]:
    return f"{movement}-{a}", f"{movement}-{b}"


_SIDES = ("left", "right")
_CLOSE = ("extreme-close-up", "big-close-up", "close-up", "medium-close-up")
_MIDDLE = ("medium", "cowboy", "medium-long")
_FAR = ("full", "wide", "extreme-wide")
_BLOCKS = (
    _Block(("static",), (*_CLOSE, *_MIDDLE, *_FAR)),
    _Block(("static",), ("close-up", "medium", "cowboy", "full", "wide"), STEEP),
    _Block(("static",), ("medium", "full", "wide"), ("overhead",)),
    _Block(("static",), ("medium",), ("worms-eye",)),
    _Block(("static",), ("close-up", "medium"), ("shoulder-level",)),
    _Block(("static",), ("medium", "full"), ("hip-level",)),
    _Block(("static",), ("medium-long", "full"), ("knee-level",)),
    _Block(("static",), ("full", "wide"), ("ground-level",)),
    _Block(("static",), ("close-up", "medium", "full"), EYE, option="roll 12deg"),
    _Block(("static",), ("medium", "full"), ("low-angle",), option="roll 12deg"),
    _Block(("follow",), (*_MIDDLE, *_FAR), situation="walks"),
    _Block(("follow",), ("medium", "full"), STEEP, situation="walks"),
    _Block(("follow",), ("full",), ("overhead", "knee-level"), situation="walks"),
    _Block(("push",), ("close-up", "medium-close-up", "medium", "cowboy", "full", "wide")),
    _Block(("push",), ("medium", "full"), STEEP),
    _Block(("push",), ("medium",), ("shoulder-level",)),
    _Block(("pull",), ("close-up", "medium-close-up", "medium", "cowboy", "full", "wide")),
    _Block(("pull",), ("medium", "full"), STEEP),
    _Block(_both("zoom", "in", "out"), ("close-up", "medium", "cowboy", "full", "wide")),
    _Block(_both("zoom", "in", "out"), ("medium",), STEEP),
    _Block(_both("tilt", "up", "down"), ("close-up", "medium", "full")),
    _Block(_both("tilt", "up", "down"), ("medium",), STEEP),
    _Block(_both("pan", *_SIDES), ("close-up", "medium", "full", "wide")),
    _Block(_both("pan", *_SIDES), ("medium",), STEEP),
    _Block(_both("pan", *_SIDES), ("wide",), ("high-angle",), situation="nobody"),
    _Block(_both("dolly", *_SIDES), ("medium", "cowboy", "full", "wide")),
    _Block(_both("dolly", *_SIDES), ("full",), STEEP),
    _Block(_both("pedestal", "up", "down"), ("medium", "cowboy", "full", "wide")),
    _Block(_both("arc", *_SIDES), ("close-up", "medium", "cowboy", "full", "wide")),
    _Block(_both("arc", *_SIDES), ("medium", "full"), STEEP),
    _Block(_both("crane", "up", "down"), ("medium", "medium-long", "full", "wide")),
    _Block(_both("crane", "up", "down"), ("full",), ("high-angle",)),
    _Block(_both("roll", *_SIDES), ("close-up", "medium", "full")),
    _Block(_both("roll", *_SIDES), ("full",), ("low-angle",)),
    _Block(_both("dolly-zoom", "in", "out"), ("close-up", "medium", "cowboy", "full")),
    _Block(("handheld",), ("close-up", "medium", "cowboy", "full", "wide")),
    _Block(("handheld",), ("medium",), STEEP),
    _Block(_both("whip-pan", *_SIDES), ("close-up", "medium", "full")),
    _Block(("rack-focus",), ("medium-close-up", "medium"), situation="talks"),
    _Block(("push+rack-focus",), ("medium",), situation="talks"),
    _Block(("static",), ("close-up", "medium"), option="aperture 1.4", situation="talks"),
    _Block(("static",), ("medium-close-up", "medium"), view="ots anna", situation="talks"),
    _Block(("push",), ("medium",), view="ots anna", situation="talks"),
    _Block(("static",), ("close-up", "medium"), ("",), view="pov anna", situation="talks"),
    _Block(("static",), ("wide",), ("",), view="pov ben", situation="far"),
    _Block(("static",), ("medium", "cowboy", "full"), view="two-shot", situation="talks"),
    _Block(("push", "arc-right"), ("full",), view="two-shot", situation="talks"),
    _Block(("static",), ("full", "wide"), view="group", situation="talks"),
    _Block(
        (
            "push+pan-left", "push+tilt-up", "push+arc-right", "push+crane-down", "push+roll-left",
            "push+handheld", "pull+pan-right", "pull+pedestal-up", "pull+arc-left", "zoom-in+pan-right",
            "zoom-in+tilt-up", "zoom-out+pan-left", "dolly-right+pan-left", "dolly-left+zoom-in",
            "pedestal-up+tilt-down", "pedestal-down+pan-left", "arc-left+crane-up", "arc-right+crane-down",
            "roll-right+arc-right",
        ),
        ("medium",),
    ),
    _Block(("push+arc-left", "push+pedestal-up", "pull+crane-up", "arc-right+crane-up"), ("full",)),
    _Block(("follow+handheld", "follow+arc-left", "follow+crane-up"), ("full",), situation="walks"),
)  # fmt: skip

MOVEMENT_MEANS = {
    "static": "the camera stands still",
    "follow": "the camera goes along with its subject",
    "push": "the camera comes nearer",
    "pull": "the camera goes back",
    "zoom-in": "the lens grows longer",
    "zoom-out": "the lens grows shorter",
    "tilt-up": "the camera turns up",
    "tilt-down": "the camera turns down",
    "pan-left": "the camera turns left",
    "pan-right": "the camera turns right",
    "dolly-left": "the camera slides left",
    "dolly-right": "the camera slides right",
    "pedestal-up": "the camera rises straight",
    "pedestal-down": "the camera sinks straight",
    "arc-left": "the camera goes round its subject to the left",
    "arc-right": "the camera goes round its subject to the right",
    "crane-up": "the camera swings up over its subject",
    "crane-down": "the camera swings down to its subject",
    "roll-left": "the camera leans over to its left",
    "roll-right": "the camera leans over to its right",
    "dolly-zoom-in": "the camera comes nearer as the lens grows shorter: the background falls away",
    "dolly-zoom-out": "the camera goes back as the lens grows longer: the background closes in",
    "handheld": "the camera is carried by hand",
    "whip-pan-left": "the camera is flung round to the left onto its subject",
    "whip-pan-right": "the camera is flung round to the right onto its subject",
    "rack-focus": "the focus goes over to the other",
}
SIZE_MEANS = {
    "extreme-close-up": "from brow to nose",
    "big-close-up": "from hairline to chin",
    "close-up": "down to the collar",
    "medium-close-up": "down to the breast pocket",
    "medium": "down to the waist",
    "cowboy": "down to mid-thigh",
    "medium-long": "down to the knees",
    "full": "the whole figure",
    "wide": "the figure with room around it",
    "extreme-wide": "a small figure in its surroundings",
}
ANGLE_MEANS = {
    "eye-level": "level",
    "high-angle": "from above",
    "low-angle": "from below",
    "overhead": "straight from above",
    "worms-eye": "steeply from below, or from the ground",
    "shoulder-level": "the lens as high as the shoulders",
    "hip-level": "the lens as high as the hips",
    "knee-level": "the lens as high as the knees",
    "ground-level": "the lens at the ground",
}
VIEW_MEANS = {
    "ots": "over the other's shoulder",
    "pov": "through the other's eyes",
    "two-shot": "two in the picture",
    "group": "everybody in the picture",
}

OPTION_MEANS = {"roll": "the picture leans", "aperture": "sharp where its subject is, and soft behind"}


def styles() -> tuple[Style, ...]:
    """All of them, by kind of movement."""
    return tuple(style for block in _BLOCKS for style in block.styles())
