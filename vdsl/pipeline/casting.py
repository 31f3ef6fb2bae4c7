"""Random stories staged and proposed, one after the other: where training and evaluation get takes from.

Assumes the library. Guarantees that story ``n`` of a seed is the same whatever was made before it, and that
stories for testing play in sets and with a cast no story for training ever sees.
"""

from __future__ import annotations

import gc
import random
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

from ..lang import Report, Settings, Source
from ..lang.ir import Shot
from ..library import Catalog
from ..propose.story import as_filmed, film, tell
from ..propose.subjects import Filming
from ..propose.types import ProposalGrid
from ..stage.assemble import StagedScene
from .acts import stage_acts
from .script import ScriptError, check_source
from .staging import Stagehand
from .stories import Place, places, random_story, split_of

#: Every so many stories, one is for testing.
TEST_EVERY = 6
_LINES = 8
_CAMERAS = 4


@dataclass(frozen=True, eq=False)
class Scene:
    """A performed line with the proposals of its shots, which share the performances.

    split: ``train`` or ``test``; place: set and room; cast: who plays; filming: what its cameras know
    """

    number: int
    split: str
    place: str
    cast: tuple[str, ...]
    staged: StagedScene
    shots: tuple[Shot, ...]
    grids: tuple[ProposalGrid, ...]
    filming: Filming


class Troupe:
    """Plays stories by their numbers. seed: of the stories and all that is drawn in them"""

    def __init__(self, seed: int, lines: int = _LINES, cameras: int = _CAMERAS) -> None:
        self.seed, self.lines, self.cameras = seed, lines, cameras
        self.catalog = Catalog(Report())
        self.hand = Stagehand(self.catalog)
        sets = split_of(sorted(self.catalog.names("set")))
        with _nothing_collected():
            grounds = places(self.catalog)
            for name in self.catalog.names("action"):  # any may be played
                self.catalog.get("action", name)
        self._places = {
            name: tuple(p for p in grounds if p.set in side)
            for name, side in zip(("train", "test"), sets, strict=True)
        }
        cast = split_of(sorted(self.catalog.names("cast")))
        self._cast = dict(zip(("train", "test"), cast, strict=True))

    def text(self, number: int, split: str) -> tuple[str, Place]:
        """Story ``number`` as a script, and where it plays: every place in turn, in an order of its own."""
        grounds = self._places[split]
        turn, at = divmod(number // TEST_EVERY if split == "test" else number, len(grounds))
        order = random.Random(f"{self.seed} places {split} {turn}").sample(range(len(grounds)), len(grounds))
        place = grounds[order[at]]
        rng = random.Random(f"{self.seed} story {number}")
        return random_story(self.catalog, place, rng, self.lines, self._cast[split], self.cameras), place

    def scenes(
        self, number: int, proposals: int, split: str | None = None, most: int | None = None
    ) -> Iterator[Scene]:
        """The lines of story ``number`` proposed; one that cannot be played (a way blocked, say) gives none.

        split: another than the story's own; most: how many of a line's shots are wanted, None for all
        """
        side = split or split_of_story(number)
        text, place = self.text(number, side)
        try:
            settings = Settings(seed=self.seed + number)
            checked = check_source(Source(f"<story {number}>", text), overrides=settings)
            acts = stage_acts(checked, self.hand, begun=True)
        except ScriptError:
            return
        cast = tuple(c.cast for c in checked.storyboard.characters)
        for act in acts:
            told = tell(act.state, act.line, act.filming, shot=act.line.shots[0], begun=act.begun)
            shots = tuple(replace(shot, proposals=proposals) for shot in act.line.shots[:most])
            grids = tuple(film(told, shot, act.state, act.filming) for shot in shots)
            filming = as_filmed(told, act.state, act.filming)
            where = f"{place.set}.{place.room}"
            yield Scene(number, side, where, cast, act.staged, shots, grids, filming)


@contextmanager
def _nothing_collected() -> Iterator[None]:
    """While much is read that stays: Python looks in vain, and longer than it reads, for what could go."""
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            gc.enable()


def split_of_story(number: int) -> str:
    return "test" if number % TEST_EVERY == TEST_EVERY - 1 else "train"
