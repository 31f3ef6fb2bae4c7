"""Story lines in their scenes, as the lines before leave them: what shots are proposed from.

Assumes a checked script. Guarantees that every line is played once, or was played before to the same end;
what cannot be done is reported either way: a scene in which anything was found is played anew in every run.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from time import perf_counter

from ..lang.ir import Scene, StoryLine
from ..propose.cameras import Filming
from ..propose.state import SceneState, opening_state
from ..propose.story import Begun, begin
from ..stage.assemble import StagedScene
from ..stage.models import check_models
from .cache import Cache
from .depends import digest, line_text, scene_lines, scene_text
from .packing import PackError, pack, unpack
from .script import Checked, ScriptError
from .staging import Stagehand

Played = Callable[[float], None]


def _nobody(seconds: float) -> None:
    pass


@dataclass(frozen=True, eq=False)
class Act:
    """A story line with the scene it plays in and the state it starts from. begun: its first performance,
    where that is kept"""

    line: StoryLine
    staged: StagedScene
    filming: Filming
    state: SceneState
    begun: Begun | None = None


@dataclass(eq=False)
class Warm:
    """What a process keeps between runs: staged scenes and states, by digests of what they depend on."""

    staged: dict[str, StagedScene] = field(default_factory=dict)
    states: dict[str, SceneState] = field(default_factory=dict)


def stage_acts(
    checked: Checked, hand: Stagehand | None = None, played: Played = _nobody, begun: bool = False
) -> list[Act]:
    """Every line in its scene with its opening state. Raises ScriptError for what cannot be played.

    hand: one that has built sets and bodies before; played: told of every line, with the seconds it took
    begun: whether acts keep their first performance
    """
    acts = Acts(checked, Cache(kept=False), "", hand, played=played, begun=begun)
    acts.play()
    return [acts.act(line) for line in checked.storyboard.lines]


class Acts:
    """The acts of a script, staged and played where that was not done before.

    code: digest of the code that plays; warm: what this process has kept; begun: whether to keep the first
    performance of every line, which would be much of a long script
    """

    def __init__(
        self,
        checked: Checked,
        cache: Cache,
        code: str,
        hand: Stagehand | None = None,
        warm: Warm | None = None,
        played: Played = _nobody,
        begun: bool = False,
    ) -> None:
        self.checked, self.cache, self.code, self.played = checked, cache, code, played
        self.begun = begun
        self.hand = hand or Stagehand(checked.catalog)
        self.warm = warm or Warm()
        self._modelled = False
        self._scenes: dict[int, _SceneRun] = {}
        for number, scene in enumerate(checked.storyboard.scenes):
            lines = scene_lines(checked.storyboard, number)
            if lines:
                self._scenes[number] = _SceneRun(self, number, scene, lines)

    def play(self) -> None:
        """Find the states between all lines. Raises ScriptError for what cannot be played."""
        for run in self._scenes.values():
            run.play()
        if self.checked.report.has_errors:
            raise ScriptError(self.checked.report)
        used = self._scenes.values()
        keep = {run.props for run in used}
        self.warm.staged = {k: v for k, v in self.warm.staged.items() if k in keep}
        marks = {run.props + mark for run in used for mark in run.marks}
        self.warm.states = {k: v for k, v in self.warm.states.items() if k in marks}

    def act(self, line: StoryLine) -> Act:
        """A line, staged."""
        run = self._scenes[line.scene]
        k = run.at(line)
        return Act(line, run.staged, run.filming, run.state(k), run.begun.get(k))

    def seen(self, line: StoryLine) -> str:
        """Digest of a line's scene, the state before it, and what happens on it."""
        run = self._scenes[line.scene]
        k = run.at(line)
        return digest(run.text, run.marks[k], run.texts[k])

    def scene(self, number: int) -> tuple[str, Callable[[], StagedScene]] | None:
        """Digest of a scene in which something happens, and how to have it staged."""
        run = self._scenes.get(number)
        return None if run is None else (run.text, lambda: run.staged)

    def check_models(self) -> None:
        """Once, before anything is built."""
        if not self._modelled:
            self._modelled = True
            check_models(self.checked.catalog, self.checked.report)
            if self.checked.report.has_errors:
                raise ScriptError(self.checked.report)


class _SceneRun:
    """One scene, built when it is first needed.

    text: digest of how it opens; props: of that and of all that people bring to it
    marks: of the state before each line, and after the last one
    texts: of what happens on each line
    begun: first performances that are kept, by the number of their line
    """

    def __init__(self, acts: Acts, number: int, scene: Scene, lines: Sequence[StoryLine]) -> None:
        self.acts, self.scene, self.lines = acts, scene, lines
        checked = acts.checked
        self.text = scene_text(checked.storyboard, number, checked.catalog)
        self.props = digest(self.text, scene.carried)
        drawn = [line.shots[0].drawn_as if line.shots else "" for line in lines]
        self.texts = [
            digest(line_text(line, checked.catalog), name) for line, name in zip(lines, drawn, strict=True)
        ]
        self.marks: list[str] = []
        self.begun: dict[int, Begun] = {}
        self._places = {id(line): k for k, line in enumerate(lines)}
        self._staged: StagedScene | None = None
        self._filming: Filming | None = None
        self._here: dict[int, SceneState] = {}
        self._packed: dict[int, bytes] = {}
        self._quiet = True

    def at(self, line: StoryLine) -> int:
        return self._places[id(line)]

    @property
    def staged(self) -> StagedScene:
        if self._staged is None:
            warm = self.acts.warm.staged
            if self.props not in warm:
                self.acts.check_models()
                cast = self.acts.checked.storyboard.characters
                warm[self.props] = self.acts.hand.stage(self.scene, cast, self.lines)
            self._staged = warm[self.props]
        return self._staged

    @property
    def filming(self) -> Filming:
        if self._filming is None:
            board, staged = self.acts.checked.storyboard, self.staged
            self._filming = Filming(
                staged.world,
                {name: body.skeleton for name, body in staged.bodies.items()},
                board.fps[0] / board.fps[1],
                board.seed,
                board.rig,
                board.size[0] / board.size[1],
                self.scene.room,
                self.acts.checked.catalog,
            )
        return self._filming

    def play(self) -> None:
        """Fill ``marks``."""
        key = digest("opening", self.acts.code, self.text)
        self.marks.append(self._mark(0, key, self._opened))
        seed = self.acts.checked.storyboard.seed
        for k in range(len(self.lines)):
            begun = perf_counter()
            key = digest("state", self.acts.code, self.props, self.marks[k], self.texts[k], seed)
            self.marks.append(self._mark(k + 1, key, lambda k=k: self._advanced(k)))  # type: ignore[misc]
            self.acts.played(perf_counter() - begun)

    def _mark(self, k: int, key: str, made: Callable[[], SceneState]) -> str:
        """Digest of a state: of one that is kept, where there is one, else of one that is made now."""
        data = self.acts.cache.read(key) if self._quiet else None
        if data is None:
            before = len(self.acts.checked.report)
            self._here[k] = made()
            self._quiet = self._quiet and len(self.acts.checked.report) == before
            try:
                data = pack((self._here[k].actors, self._here[k].props))
            except PackError:
                return key
            if self._quiet:
                self.acts.cache.put(key, {"value": data})
        mark = hashlib.sha256(data).hexdigest()
        if k in self._here:
            self.acts.warm.states[self.props + mark] = self._here[k]
        else:
            self._packed[k] = data
        return mark

    def state(self, k: int) -> SceneState:
        """Before the k-th line."""
        if k not in self._here:
            warm = self.acts.warm.states.get(self.props + self.marks[k])
            self._here[k] = warm if warm is not None else self._restored(k)
        return self._here[k]

    def _restored(self, k: int) -> SceneState:
        """Out of what is kept; played again where that does not fit."""
        try:
            actors, props = unpack(self._packed[k])
        except PackError:
            return self._opened() if k == 0 else self._advanced(k - 1)
        opened = {name: p.open for name, p in props.items() if p.hinge is not None}
        return SceneState(self.staged.world.opened(opened), actors, props, self.scene.room)

    def _opened(self) -> SceneState:
        skeletons = self.filming.skeletons
        return opening_state(self.scene, self.staged.world, skeletons, self.acts.checked.report)

    def _advanced(self, k: int) -> SceneState:
        begun = begin(self.state(k), self.lines[k], self.filming, self.acts.checked.report)
        if self.acts.begun:
            self.begun[k] = begun
        return begun.end
