"""Builds every scene of a storyboard: its world, its dressed cast, and both as one drawable scene."""

from __future__ import annotations

from collections.abc import Sequence

from runtime.body.build import Body, build_body
from runtime.body.spec import BodySpec
from runtime.world import World

from ..lang.definitions.cast import CastDef
from ..lang.definitions.files import PERSON, FileCastDef
from ..lang.definitions.set import SetDef
from ..lang.ir import Carried, Character, Scene, StoryLine
from ..library import Catalog
from ..stage.assemble import StagedScene, assemble
from ..stage.cache import load_world
from ..stage.carried import with_carried
from ..stage.cast import body_spec
from ..stage.models import file_person


class Stagehand:
    """Builds worlds and bodies, each once however many scenes use them."""

    def __init__(self, catalog: Catalog) -> None:
        self._catalog = catalog
        self._worlds: dict[tuple[str, str, tuple[str, ...], tuple[Carried, ...]], World] = {}
        self._bodies: dict[BodySpec, Body] = {}

    def stage(self, scene: Scene, characters: Sequence[Character], lines: Sequence[StoryLine]) -> StagedScene:
        """The scene with those of the cast who take part in it: placed there, acting, or acted upon."""
        present = {p.character for p in scene.placements} | {
            b.character for line in lines for b in line.beats
        }
        present |= {
            t.path[0]
            for line in lines
            for b in line.beats
            for t in (b.target, b.second)
            if t and t.kind == "character"
        }
        return assemble(self.world(scene), {c.name: self.body(c) for c in characters if c.name in present})

    def world(self, scene: Scene) -> World:
        key = (scene.set, scene.time, scene.room, scene.carried)
        if key not in self._worlds:
            definition = self._catalog.get("set", scene.set)
            assert isinstance(definition, SetDef), scene.set
            empty = load_world(definition, self._catalog, scene.time, scene.room)
            self._worlds[key] = with_carried(empty, scene.carried, self._catalog)
        return self._worlds[key]

    def body(self, character: Character) -> Body:
        definition = self._catalog.get("cast", character.cast)
        assert isinstance(definition, CastDef), character.cast
        if isinstance(definition, FileCastDef):
            height = dict(character.arguments).get("height", definition.model.height or PERSON)
            return file_person(definition.model, float(height))
        spec = body_spec(definition, dict(character.arguments))
        if spec not in self._bodies:
            self._bodies[spec] = build_body(spec)
        return self._bodies[spec]
