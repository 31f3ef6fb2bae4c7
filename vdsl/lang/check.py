"""Script and catalog into a checked storyboard: :func:`check`.

Assumes a script of :func:`vdsl.lang.parse.parse` and a catalog that knows its own definitions.
Guarantees that every mistake is in the report, and that the storyboard (where there is one) has every
name resolved and every default filled in. One pass over the statements, top to bottom.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import PurePath

from . import ast
from .beats import BeatReader
from .bringing import bring, bring_named, put_about
from .capitals import Named
from .catalog import CatalogLike
from .diagnostics import Report
from .files import used_scripts
from .hands import Hands
from .ids import Ids
from .ir import Beat, Character, Scene, Storyboard, StoryLine, Target
from .lookup import Lookup, Setting
from .phrases import is_small
from .placement import SceneBeingRead, appear, place, someone_or_something
from .pronouns import Mentions, owner
from .scope import Scope
from .settings import Settings, read_header
from .shots import DEFAULT_PROPOSALS, DEFAULT_STYLE, DEFAULT_TAKES, Defaults, LineContext, read_shots
from .source import Span
from .stand_in import stand_in
from .targets import unknown_character
from .transitions import Joins
from .words import fold


def check(
    script: ast.Script,
    catalog: CatalogLike,
    report: Report,
    overrides: Settings | None = None,
    defaults: Settings | None = None,
) -> Storyboard | None:
    """The checked storyboard, or None where the report has errors.

    overrides: win over header lines; defaults: hold where header lines say nothing
    """
    checker = _Checker(script, catalog, report, overrides or Settings(), defaults or Settings())
    storyboard = checker.run()
    return None if report.has_errors else storyboard


class _Checker:
    def __init__(
        self,
        script: ast.Script,
        catalog: CatalogLike,
        report: Report,
        overrides: Settings,
        unsaid: Settings,
    ) -> None:
        self.script = script
        self.catalog = catalog
        self.report = report
        self.overrides = overrides
        self.unsaid = unsaid
        self.settings = Settings()
        self.title: ast.Title | None = None
        self.characters: dict[str, Character] = {}
        self.stage: SceneBeingRead | None = None
        self.scenes: list[Scene] = []
        self.lines: list[StoryLine] = []
        self.ids = Ids()
        self.joins = Joins(report)
        self.lookup = Lookup(catalog, report)

    # -- the whole -------------------------------------------------------------------

    def run(self) -> Storyboard:
        if not self.script.statements and not self.report.has_errors:
            span = Span(self.script.source, 0, 0)
            self.report.error(
                "VDS034",
                span,
                label="there is nothing in this file",
                help="`vdsc explain VDS034` has a first script to type",
            )
        for used in used_scripts(self.script, self.report):
            for statement in used.statements:
                if isinstance(statement, ast.CharacterLine):
                    self._character(statement)
        self._headers()
        self._broken_characters()
        self.script = replace(self.script, statements=self._as_named())
        broken = [b for b in self.script.broken if b.keyword == "scene"]
        for index, statement in enumerate(self.script.statements):
            while broken and broken[0].span.start < statement.span.start:
                self._broken_scene(index - 1, broken.pop(0))
            self._statement(index, statement)
        self._finish_scene()
        if not self.lines and self.script.statements and not self.report.has_errors:
            self._nothing_to_shoot()
        return self._storyboard()

    def _as_named(self) -> tuple[ast.Statement, ...]:
        """All lines, with everybody's name as it was defined."""
        kinds = ("prop", "action")
        words = {fold(w) for kind in kinds for w in (*self.catalog.names(kind), *self.catalog.synonyms(kind))}
        names = (*self.characters, *self._later_characters(-1))
        named = Named(names, lambda word: fold(word) in words or is_small(word))
        return tuple(named.statement(each) for each in self.script.statements)

    def _broken_characters(self) -> None:
        """Who has a line that does not read is known all the same."""
        for line in self.script.broken:
            if line.keyword == "character" and line.name is not None:
                self.characters.setdefault(line.name, Character(line.name, "", (), line.span))

    def _broken_scene(self, index: int, line: ast.Broken) -> None:
        """A scene whose line does not read: what happens in it is checked as far as it can be."""
        self._finish_scene()
        members, hands = self._members(index), Hands(self.catalog, self.report)
        self.stage = SceneBeingRead(
            len(self.scenes), line.name or "", "", (), "day", None, members, hands, line.span
        )

    def _storyboard(self) -> Storyboard:
        said, over = self.settings, self.overrides
        merged = Settings(**{name: getattr(over, name) or getattr(said, name) for name in vars(said)})
        seed = over.seed if over.seed is not None else said.seed
        name = self.script.source.name
        title = self.title.text.value if self.title and self.title.text else PurePath(name).stem
        return Storyboard(
            title=title,
            fps=merged.fps or (24, 1),
            size=merged.final_size(),
            seed=seed or 0,
            rig=merged.rig or "cinema",
            style=merged.style or DEFAULT_STYLE,
            characters=tuple(self.characters.values()),
            scenes=tuple(self.scenes),
            lines=tuple(self.lines),
            source_name=name,
            ending=self.joins.ending(),
        )

    def _headers(self) -> None:
        """Headers first: frames in the story are counted at their rate."""
        begun: ast.Statement | None = None
        for statement in self.script.statements:
            if isinstance(statement, ast.SceneLine | ast.StoryNode) and begun is None:
                begun = statement
            if isinstance(statement, ast.Header):
                if begun is not None:
                    self.report.error(
                        "VDS035",
                        statement.span,
                        label="header lines stand before the first scene",
                        help="move it up, below `storyboard`",
                        notes=[(begun.span, "the story begins here")],
                    )
                read_header(statement, self.settings, self.report)
        self.settings.complete(self.unsaid)
        said, over = self.settings, self.overrides
        self.fps = over.fps or said.fps or (24, 1)
        self.defaults = Defaults(
            self.fps,
            over.proposals or said.proposals or DEFAULT_PROPOSALS,
            over.takes or said.takes or DEFAULT_TAKES,
            over.style or said.style or DEFAULT_STYLE,
            over.rig or said.rig or "cinema",
            over.aperture if over.aperture is not None else said.aperture or 0.0,
        )

    def _statement(self, index: int, statement: ast.Statement) -> None:
        if isinstance(statement, ast.Title):
            self._title(statement)
        elif isinstance(statement, ast.CharacterLine):
            self._character(statement)
        elif isinstance(statement, ast.SceneLine):
            self._scene(index, statement)
        elif isinstance(statement, ast.PlacementLine):
            stage = self._need_stage(statement.span) if self._is_known(statement.character) else None
            if stage is not None:
                place(statement, stage, tuple(self.characters), self.report)
        elif isinstance(statement, ast.StoryNode):
            self._story(statement)
        elif isinstance(statement, ast.TransitionLine):
            self.joins.take(statement, self.fps, bool(self.lines))

    def _title(self, statement: ast.Title) -> None:
        if self.title is not None:
            self.report.error(
                "VDS035",
                statement.span,
                label="a file has one `storyboard` line",
                notes=[(self.title.span, "first here")],
            )
        self.title = statement

    def _nothing_to_shoot(self) -> None:
        if all(isinstance(s, ast.Definition | ast.FileDefinition | ast.Use) for s in self.script.statements):
            return  # a file of definitions, for others to use
        last = self.script.statements[-1].span
        self.report.error(
            "VDS034",
            Span(last.source, last.start, last.end),
            label="the script ends and nothing has happened yet",
            help="add a story line, as in `(anna walk door)`",
        )

    # -- characters ------------------------------------------------------------------

    def _character(self, line: ast.CharacterLine) -> None:
        name = line.name.text
        if len(line.name.parts) > 1:
            self.report.error("VDS066", line.name.span, label="a character's name has no dots")
        if name in self.characters:
            self.report.error(
                "VDS066",
                line.name.span,
                label=f"there is a character `{name}` already",
                notes=[(self.characters[name].span, "the first one")],
            )
            return
        self.characters[name] = self.lookup.character(line)

    def _is_known(self, name: ast.Name) -> bool:
        if name.text not in self.characters:
            unknown_character(name, tuple(self.characters), self.report)
        return name.text in self.characters

    # -- scenes ----------------------------------------------------------------------

    def _scene(self, index: int, line: ast.SceneLine) -> None:
        self._finish_scene()
        if len(line.name.parts) > 1 and line.set is not None:
            self.report.error("VDS063", line.name.span, label="a scene's name has no dots")
        earlier = next((s for s in self.scenes if s.name == line.name.text), None)
        time = self.lookup.time(line.time)
        if line.set is None and earlier is not None:
            root = getattr(self.catalog.get("set", earlier.set), "root", None)
            found = Setting(earlier.set, earlier.room, earlier.time, root)
        else:
            found = self.lookup.setting(line.set or line.name)
        if earlier is not None and (earlier.set, earlier.room) != (found.set_name, found.room):
            self.report.error(
                "VDS063",
                line.name.span,
                label=f"a scene `{line.name.text}` was somewhere else",
                help="give this one another name",
                notes=[(earlier.span, "the first one")],
            )
        scope = Scope(found.root, found.room, self.catalog) if found.root is not None else None
        name = line.name.parts[-1] if line.set is None else line.name.text
        self.stage = SceneBeingRead(
            index=len(self.scenes),
            name=name,
            set_name=found.set_name,
            room=found.room,
            time=time or found.time,
            scope=scope,
            members=self._members(index),
            hands=Hands(self.catalog, self.report),
            span=line.span,
        )

    def _members(self, index: int) -> tuple[str, ...]:
        """Everyone placed or named until the next scene: those placed first, then in order."""
        placed: dict[str, None] = {}
        named: dict[str, None] = {}
        for statement in self.script.statements[index + 1 :]:
            if isinstance(statement, ast.SceneLine):
                break
            if isinstance(statement, ast.PlacementLine):
                placed[statement.character.text] = None
            elif isinstance(statement, ast.StoryNode):
                named.update((owner(w.text) or w.text, None) for beat in statement.beats for w in beat.words)
        known = {*self.characters, *self._later_characters(index)}
        return tuple(name for name in {**placed, **named} if name in known)

    def _later_characters(self, index: int) -> list[str]:
        rest = self.script.statements[index + 1 :]
        return [s.name.text for s in rest if isinstance(s, ast.CharacterLine)]

    def _finish_scene(self) -> None:
        """Close the scene being read: everyone in it has a place."""
        stage = self.stage
        if stage is None:
            return
        placements = tuple(stage.placements[name] for name in stage.members if name in stage.placements)
        carried = tuple(sorted(stage.carried.values(), key=lambda thing: not thing.held))
        self.scenes.append(
            Scene(stage.name, stage.set_name, stage.room, stage.time, placements, stage.span, carried)
        )
        self.stage = None

    def _need_stage(self, span: Span) -> SceneBeingRead | None:
        if self.stage is None and not any(s.name == "" for s in self.scenes):
            sets = self.catalog.names("set")
            self.report.error(
                "VDS063",
                span,
                label="no scene has begun",
                help=f"put a line like `scene {sets[0]}` above" if sets else "put a `scene` line above",
            )
        return self.stage

    # -- the story -------------------------------------------------------------------

    def _story(self, node: ast.StoryNode) -> None:
        stage = self._need_stage(node.span)
        if stage is None:
            return
        names = tuple(self.characters)
        if stage.reader is None or stage.reader.characters != names:
            mentions = stage.reader.mentions if stage.reader is not None else Mentions()
            stage.reader = BeatReader(self.catalog, names, stage.scope, self.report, mentions)
            stage.reader.mentions.bodies = self._bodies()
            stage.reader.targets.bring = lambda word, span, who: bring_named(
                word, span, who, stage, self.catalog
            )
            stage.reader.targets.put_about = lambda word, span, who: put_about(
                word, span, who, stage, self.catalog, self.report
            )
            stage.reader.targets.stand_in = lambda word, span, who: stand_in(
                word, span, who, stage, self.catalog, self.report
            )
        for line in stage.reader.lines(node):
            self._line(line, stage, stage.reader)

    def _line(self, node: ast.StoryNode, stage: SceneBeingRead, reader: BeatReader) -> None:
        """One line of the story, in which everybody does one thing."""
        here = tuple(name for name in self.characters if name in stage.placements)  # so far
        reader.mentions.about = here or stage.members or tuple(self.characters)
        reader.fallback.acting = {each.words[0].text for each in node.beats}
        done = tuple(beat for each in node.beats for beat in self._beats(reader, each, stage))
        self._together(done)
        for beat in done:
            stage.hands.act(beat)
        context = LineContext(
            stage.name,
            done,
            self._subject(done, stage),
            lambda name: someone_or_something(name, stage, tuple(self.characters), self.report),
            tuple(self.characters),
        )
        shots = read_shots(node, context, self.defaults, self.ids, self.report)
        self.lines.append(StoryLine(stage.index, done, shots, self.joins.give(), node.span))

    def _bodies(self) -> dict[str, str]:
        """Whether people of the storyboard are feminine or masculine, by name, where the library says."""
        out = {}
        for name, each in self.characters.items():
            features = getattr(self.catalog.get("cast", each.cast), "features", None)
            body = str(features(dict(each.arguments)).get("body", "")) if features is not None else ""
            if body in ("feminine", "masculine"):
                out[name] = body
        return out

    def _beats(self, reader: BeatReader, node: ast.BeatNode, stage: SceneBeingRead) -> tuple[Beat, ...]:
        """What a beat says: one, or where it is of several people, one each, if it is nothing two do to each
        other."""
        nodes, together = reader.each_of(node)
        who = [each.words[0].text for each in nodes]
        found: list[Beat | None] = []
        for k, each in enumerate(nodes):
            reader.mentions.partner = who[1 - k] if together and len(who) == 2 else ""
            found.append(self._beat(reader, each, stage))
            done = found[-1]
            if done is None or (len(nodes) == 2 and reader.takes_somebody(done.action) and _is_to(done, who)):
                break
        reader.mentions.partner = ""
        for other in nodes[len(found) :] if found[-1] is not None else ():  # they take part in what is done
            if other.words[0].text in self.characters:
                appear(other.words[0], stage, self.report)
        said = [beat for beat in found if beat is not None]
        if len(said) == 2 and all(beat.target is None for beat in said) and reader.between(said[0].action):
            names = [beat.character for beat in reversed(said)]
            others = [Target("character", (name,), name, node.span, implied=True) for name in names]
            said = [replace(beat, target=other) for beat, other in zip(said, others, strict=True)]
        return tuple(said)

    def _beat(self, reader: BeatReader, node: ast.BeatNode, stage: SceneBeingRead) -> Beat | None:
        for word in node.words:
            if word.text in self.characters:
                appear(word, stage, self.report)
        beat = reader.read(node)
        if beat is not None and beat.character not in (word.text for word in node.words):
            appear(ast.Name((beat.character,), node.words[0].span), stage, self.report)
        stage.acted.add(node.words[0].text if beat is None else beat.character)
        return None if beat is None else bring(beat, stage, self.catalog)

    def _together(self, beats: tuple[Beat, ...]) -> None:
        """Nobody does two things at once."""
        seen: dict[str, Beat] = {}
        for beat in beats:
            if beat.character in seen:
                self.report.error(
                    "VDS076",
                    beat.span,
                    label=f"{beat.character} does two things at once",
                    help="put it on a line of its own",
                    notes=[(seen[beat.character].span, "the first")],
                )
            seen[beat.character] = beat

    def _subject(self, beats: tuple[Beat, ...], stage: SceneBeingRead) -> Target | None:
        """Whom or what the camera is about: who acts, else the first one in the scene."""
        if beats and beats[0].about is not None:
            return beats[0].about
        if beats:
            who, span = beats[0].character, beats[0].span
        elif stage.members:
            who, span = stage.members[0], stage.span
        else:
            return None
        return Target("character", (who,), who, span)


def _is_to(beat: Beat, who: list[str]) -> bool:
    """Whether a beat is done to one of these people."""
    return beat.target is not None and beat.target.kind == "character" and beat.target.path[0] in who
