"""Cameras of one line into :class:`vdsl.lang.ir.Shot`: words, options, defaults and ids."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from . import ast, words
from .camera import FREE, CameraWords, read_camera
from .diagnostics import Report
from .ids import Ids
from .ir import MOVEMENT_FAMILIES, RACK, Beat, Shot, Target
from .options import ShotOptions, read_options
from .targets import unknown_character
from .views import read_view

DEFAULT_LENS = (30.0, 80.0)  # the paper's, section 3.2
DEFAULT_PROPOSALS = 80
DEFAULT_TAKES = 5
DEFAULT_STYLE = "board"


@dataclass(frozen=True)
class Defaults:
    """What a shot takes where its line says nothing."""

    fps: tuple[int, int]
    proposals: int
    takes: int
    style: str
    rig: str = "cinema"
    aperture: float = 0.0


@dataclass(frozen=True)
class LineContext:
    """What a line's shots need to know of it.

    subject: whom the camera is about unless told otherwise, None where nobody is there
    resolve: finds the target of ``focus``; cast: everybody of the storyboard
    """

    scene: str
    beats: tuple[Beat, ...]
    subject: Target | None
    resolve: Callable[[ast.Name], Target | None]
    cast: tuple[str, ...] = ()


def read_shots(
    node: ast.StoryNode, context: LineContext, defaults: Defaults, ids: Ids, report: Report
) -> tuple[Shot, ...]:
    """All shots of one line; one that is free in everything where no camera is written."""
    shared = read_options(node.options, defaults.fps, report)
    cameras: Sequence[ast.CameraNode | None] = node.cameras or (None,)
    shots = []
    for camera in cameras:
        said = read_camera(camera, defaults.rig, report)
        own = read_options(camera.options, defaults.fps, report) if camera else ShotOptions()
        said = _fitting(camera, said, not node.beats, report)
        pair = own if own.focus is not None else shared
        if pair.focus_to is not None and "movement" not in said.said:
            said = replace(said, movements=(RACK,))
        view = read_view(camera, said, own.focus or shared.focus, context, report)
        said = view.words
        base = _line_words(context)
        given = len(base)
        if len(cameras) > 1:
            base = [*base, *_camera_words(said)]
        feelings = _feelings(shared, context, node, report) | _feelings(own, context, node, report)
        shot = _shot(ids.take(base), node, camera, said, own, shared, context, defaults)
        shot = _named(shot, own.name or shared.name, [] if own.name else base[given:], ids, report)
        shot = replace(shot, focus=view.focus or shot.focus, view=said.view, whose=view.whose)
        shot = replace(shot, focus_to=_racked(camera, shot, pair, context, report))
        shots.append(replace(shot, feelings=tuple(feelings.items())))
    return tuple(shots)


def _racked(
    camera: ast.CameraNode | None, shot: Shot, options: ShotOptions, context: LineContext, report: Report
) -> Target | None:
    """Whom or what the focus goes to: as said, else the other one of the line."""
    said = options.focus_to
    if camera is None or not any(RACK in movement.split("+") for movement in shot.movements):
        if said is not None:
            report.error(
                "VDS300",
                said.span,
                label="the focus stays where it is in this movement",
                help="say `rack-focus` in the parentheses, or `push+rack-focus` with another movement",
            )
        return None
    target = context.resolve(said) if said is not None else _other(shot, context)
    if target is None and said is None:
        report.error(
            "VDS301",
            camera.span,
            label="the focus goes to whom or what?",
            help="say `focus NAME to NAME` after the camera",
        )
    if target is not None and shot.focus is not None and target.path == shot.focus.path:
        report.error(
            "VDS301",
            said.span if said is not None else camera.span,
            label="the focus is there from the beginning",
            help="a rack-focus goes from one to another, as in `focus anna to ben`",
        )
        return None
    return target


def _other(shot: Shot, context: LineContext) -> Target | None:
    """Who takes part in a line besides its focus, else what it is done with."""
    own = shot.focus.path if shot.focus is not None else ()
    people = [Target("character", (beat.character,), beat.character, beat.span) for beat in context.beats]
    targets = [t for beat in context.beats for t in (beat.target, beat.second) if t is not None]
    targets.sort(key=lambda target: target.kind != "character")
    return next((t for t in (*people, *targets) if t.path != own), None)


def _named(shot: Shot, name: ast.Name | None, camera: Sequence[str], ids: Ids, report: Report) -> Shot:
    """A shot under the name it was given; cameras of one line that is named are told apart by their words."""
    if name is None:
        return shot
    found = ids.named([name.text, *camera])
    if found is None:
        label = f"another shot is called `{name.text}`"
        report.error("VDS314", name.span, label=label, help="give each its own name")
        return shot
    return replace(shot, id=found, drawn=shot.id)


def _fitting(
    camera: ast.CameraNode | None,
    said: CameraWords,
    establishing: bool,
    report: Report,
) -> CameraWords:
    """Free words narrowed to what suits the line: a place is shown wide, someone absent is not followed."""
    movements, scales = said.movements, said.scales
    if establishing and "scale" not in said.said:
        scales = ("wide", "full")
    if establishing:
        if "movement" not in said.said:
            movements = tuple(m for m in movements if m != "follow")
        elif movements == ("follow",) and camera is not None:
            report.error(
                "VDS045",
                camera.span,
                label="nobody acts on this line, so there is no one to follow",
                help="put it below a story line, or take another movement",
            )
    return replace(said, movements=movements, scales=scales)


def _shot(
    id: str,
    node: ast.StoryNode,
    camera: ast.CameraNode | None,
    said: CameraWords,
    own: ShotOptions,
    shared: ShotOptions,
    context: LineContext,
    defaults: Defaults,
) -> Shot:
    focus = own.focus or shared.focus
    span = camera.span if camera else node.span
    return Shot(
        id=id,
        line=span.line_number,
        movements=said.movements,
        scales=said.scales,
        angles=said.angles,
        lens=own.lens or shared.lens or DEFAULT_LENS,
        any_lens=not (own.lens or shared.lens),
        ease=own.ease or shared.ease or tuple(sorted(set(words.EASES.values()))),
        duration=own.duration or shared.duration,
        roll=next((r for r in (own.roll, shared.roll, said.lean) if r is not None), 0.0),
        focus=context.resolve(focus) if focus is not None else context.subject,
        say=own.say if own.say is not None else shared.say,
        note=own.note if own.note is not None else shared.note,
        proposals=own.proposals or shared.proposals or defaults.proposals,
        takes=own.takes or shared.takes or defaults.takes,
        speed=own.speed or shared.speed or 1.0,
        style=own.style or shared.style or defaults.style,
        aperture=next((a for a in (own.aperture, shared.aperture) if a is not None), defaults.aperture),
        span=span,
    )


def _feelings(
    options: ShotOptions, context: LineContext, node: ast.StoryNode, report: Report
) -> dict[str, str]:
    """Whose face shows what."""
    found: dict[str, str] = {}
    for who, word in options.feelings:
        if who is None and not context.beats:
            if not node.beats:  # else it is reported already what is wrong with them
                report.error(
                    "VDS261",
                    node.span,
                    label="nobody acts on this line",
                    help=f"say whose: `feeling NAME {word}`",
                )
            continue
        name = who.text if who is not None else context.beats[0].character
        if who is not None and name not in context.cast:
            unknown_character(who, context.cast, report)
            continue
        found[name] = word
    return found


def _line_words(context: LineContext) -> list[str]:
    """The words of a line's id."""
    found = [context.scene]
    for beat in context.beats:
        found += [beat.character, beat.action]
        found += [t.written for t in (beat.target, beat.second) if t is not None]
    return found if context.beats else [*found, "establishing"]


def _camera_words(said: CameraWords) -> list[str]:
    """The words of a camera in an id: a family by its name, what is free left out."""
    found = []
    for slot, values in (("movement", said.movements), ("scale", said.scales), ("angle", said.angles)):
        if slot not in said.said:
            continue
        family = next((name for name, members in MOVEMENT_FAMILIES.items() if members == values), None)
        found.append(family.replace("/", "-") if family else "-".join(values))
    found += [said.view] if said.view else []
    return found or ["free"]


__all__ = ["FREE", "Defaults", "LineContext", "read_shots"]
