"""Things people have with them: in a hand when a scene opens, taken out, put away, given and set down."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from runtime.body.skeleton import JOINT
from vdsl.lang import Report, Source
from vdsl.lang.definitions.action import ActionDef
from vdsl.library import Catalog
from vdsl.pipeline.acts import Acts
from vdsl.pipeline.cache import Cache
from vdsl.pipeline.compile import stage_acts
from vdsl.pipeline.script import check_source
from vdsl.pipeline.trial import action_script
from vdsl.propose.story import tell
from vdsl.propose.types import StoryProposal
from vdsl.stage.assemble import StagedScene, palettes

HEAD = "character anna = woman\ncharacter ben = man\nscene s = park at day\nanna at {anna}\nben at bench\n"
CATALOG = Catalog(Report())


@cache
def played(lines: str, anna: str = "fountain") -> tuple[tuple[StagedScene, StoryProposal], ...]:
    """The scene and the first performance of every line."""
    acts = stage_acts(check_source(Source("x.vds", HEAD.format(anna=anna) + lines), Report()))
    return tuple((act.staged, tell(act.state, act.line, act.filming, most=1).proposals[0]) for act in acts)


def seen(scene: tuple[StagedScene, StoryProposal], path: tuple[str, ...]) -> float:
    """How large a thing is drawn in the middle of a performance: metres between its farthest corners."""
    staged, story = scene
    item = next(o for o in staged.world.objects if o.path == path)
    assert item.mesh is not None
    joints = {name: p.world_from_joint for name, p in story.performances.items()}
    matrix = palettes(staged, joints, story.props, np.array([story.frames // 2]))[
        0, staged.prop_entry[item.id]
    ]
    corners = item.mesh.vertices @ matrix[:, :3].T + matrix[:, 3]
    return float(np.linalg.norm(corners.max(0) - corners.min(0)))


def away(scene: tuple[StagedScene, StoryProposal], path: tuple[str, ...], who: str, hand: str) -> float:
    """Metres from a thing's grip to somebody's wrist, at most of all frames."""
    staged, story = scene
    item = next(o for o in staged.world.objects if o.path == path)
    moved = story.props[item.id].astype(float)
    grip = moved[:, :3, :3] @ np.array(item.grip) + moved[:, :3, 3]
    wrist = story.performances[who].world_from_joint[:, JOINT[f"hand_{hand}"], :3, 3]
    return float(np.linalg.norm(grip - wrist, axis=1).max())


def test_what_one_is_placed_with_is_in_the_hand_from_the_first_frame_on() -> None:
    (wave,) = played("(anna wave)\n", "fountain holding umbrella")
    assert away(wave, ("anna", "umbrella"), "anna", "l") < 0.12
    assert seen(wave, ("anna", "umbrella")) > 0.9


def test_a_bag_hangs_from_a_straight_arm_clear_of_the_floor() -> None:
    staged, story = played("(ben wave)\n", "fountain holding briefcase")[0]
    item = next(o for o in staged.world.objects if o.path == ("anna", "briefcase"))
    moved = story.props[item.id][story.frames // 2].astype(float)
    joints = story.performances["anna"].world_from_joint[story.frames // 2, :, :3, 3]
    shoulder, elbow, wrist = (joints[JOINT[f"{part}_l"]] for part in ("upperarm", "forearm", "hand"))
    upper, lower = elbow - shoulder, wrist - elbow
    cosine = upper @ lower / np.linalg.norm(upper) / np.linalg.norm(lower)
    assert cosine > np.cos(np.deg2rad(35))
    assert 0.02 < moved[2, 3] < 0.5
    # its handle lies along the way one faces, its long side beside the leg
    heading = story.performances["anna"].heading[story.frames // 2]
    assert abs(moved[:2, 0] @ np.array([np.cos(heading), np.sin(heading)])) > 0.8


def test_what_an_action_brings_is_to_be_seen_in_its_line_alone() -> None:
    scenes = played("(ben wave)\n(anna phone)\n(ben nod)\n(anna wave)\n(anna phone)\n")
    sizes = [seen(scene, ("anna", "phone")) for scene in scenes]
    assert [size > 0.1 for size in sizes] == [False, True, True, False, True]  # kept while another acts
    assert sizes[0] == 0.0
    assert away(scenes[1], ("anna", "phone"), "anna", "r") < 0.12


def test_one_walks_with_what_one_has_taken_out() -> None:
    _, walk = played("(anna play guitar)\n(anna walk to ben)\n")
    assert seen(walk, ("anna", "guitar")) > 0.5
    assert away(walk, ("anna", "guitar"), "anna", "r") < 0.15


def test_what_was_given_away_stays_with_whom_it_was_given() -> None:
    scenes = played("(anna play guitar)\n(anna give guitar to ben)\n(anna wave)\n(ben nod)\n")
    assert away(scenes[3], ("anna", "guitar"), "ben", "r") < 0.15
    assert seen(scenes[3], ("anna", "guitar")) > 0.5


def test_two_handed_work_sets_down_what_the_other_hand_holds() -> None:
    staged, story = played("(anna play guitar)\n", "fountain holding briefcase")[0]
    bag = next(o for o in staged.world.objects if o.path == ("anna", "briefcase"))
    x, y, z = story.props[bag.id][0, :3, 3]
    ax, ay, az = story.performances["anna"].position[0]
    assert abs(z - az) < 0.01
    assert 0.3 < np.hypot(x - ax, y - ay) < 0.6


def test_full_hands_take_nothing_out() -> None:
    lines = "(anna pick up phone_a)\n(anna pick up phone_b)\n(anna call)\n"
    own = (
        "set yard { area ground, at (0, 0)m, size (6, 6)m { spot here, at (3, 2.6)m, facing 90deg\n"
        "place table = table, at (3, 3.4)m {\nplace phone_a = apple, on top, at (-0.2, -0.1)m\n"
        "place phone_b = apple, on top, at (0.2, -0.1)m\n} } }\n"
    )
    script = own + "character anna = woman\nscene s = yard\nanna at here\n" + lines
    acts = stage_acts(check_source(Source("x.vds", script), Report()))
    scene = acts[-1].staged, tell(acts[-1].state, acts[-1].line, acts[-1].filming, most=1).proposals[0]
    assert len(acts[-1].state.actors["anna"].held) == 2
    assert seen(scene, ("anna", "phone")) == 0.0


def test_who_sits_takes_things_out_as_well() -> None:
    script = HEAD.format(anna="fountain").replace("ben at bench", "ben at bench sitting") + "(ben text)\n"
    (act,) = stage_acts(check_source(Source("x.vds", script), Report()))
    scene = act.staged, tell(act.state, act.line, act.filming, most=1).proposals[0]
    assert away(scene, ("ben", "phone"), "ben", "r") < 0.12


BRINGING = [name for name in CATALOG.names("action") if getattr(CATALOG.get("action", name), "brings", "")]


def _without(definition: ActionDef) -> ActionDef:
    """The action with its example said without what it brings."""
    words = definition.example.split()
    first, rest = words[:2], words[2:]
    if definition.needs == "second":
        rest = rest[: rest.index("with")] if "with" in rest else rest[rest.index("to") + 1 :]
    else:
        rest = [w for w in rest if w not in definition.props]
        rest = rest[:-1] if rest[-1:] == ["with"] else rest
    left = tuple(p for p in definition.props if p in rest)
    return replace(definition, example=" ".join(first + rest), props=left)


@pytest.mark.parametrize("name", BRINGING)
def test_every_action_brings_what_it_is_done_with(name: str) -> None:
    definition = CATALOG.get("action", name)
    assert isinstance(definition, ActionDef)
    script = action_script(_without(definition), CATALOG)
    (act,) = stage_acts(check_source(Source("x.vds", script), Report()))
    scene = act.staged, tell(act.state, act.line, act.filming, most=1).proposals[0]
    path = ("anna", definition.brings)
    hand = definition.needs_hand[:1] or "r"
    assert seen(scene, path) > 0.05
    assert away(scene, path, "anna", hand) < 0.16


def test_a_tool_changes_hands_where_the_action_needs_it_in_the_other() -> None:
    (swing,) = played("(anna swing bat)\n", "fountain holding bat")
    assert away(swing, ("anna", "bat"), "anna", "r") < 0.15


def test_states_are_kept_where_a_line_before_brings_something_more(tmp_path: Path) -> None:
    """Objects are numbered, and what is brought earlier comes first: a state of before must not be taken
    for one of now."""

    def last(lines: str) -> StoryProposal:
        cache = Cache(tmp_path, 1 << 28)
        checked = check_source(Source("x.vds", HEAD.format(anna="fountain") + lines), Report())
        acts = Acts(checked, cache, "code")
        acts.play()
        act = acts.act(checked.storyboard.lines[-1])
        story = tell(act.state, act.line, act.filming, most=1).proposals[0]
        guitar = next(o for o in act.staged.world.objects if o.path == ("anna", "guitar"))
        moved = story.props[guitar.id]
        wrist = story.performances["anna"].world_from_joint[:, JOINT["hand_r"], :3, 3]
        assert np.linalg.norm(moved[:, :3, 3] - wrist, axis=1).max() < 0.8
        return story

    after = "(ben wave)\n(anna play guitar)\n(anna walk to ben)\n"
    last(after)
    last(after)
    last("(ben phone)\n" + after)
    last(after)


def test_what_the_set_has_not_lies_near_who_does_something_to_it() -> None:
    """Something small on furniture, something large on the floor, and from the first line on."""
    lines = "(anna wave)\n(anna pick up letter)\n(anna pick up bucket)\n"
    for place, high in (("apartment.living", 0.35), ("farmyard.yard", 0.0)):
        text = f"character anna = woman\nscene s = {place} at day\nanna at middle\n" + lines
        wave, letter, bucket = stage_acts(check_source(Source("x.vds", text), Report()))
        near = wave.state.actors["anna"].position
        things = {o.path[-1]: o.id for o in wave.staged.world.objects if o.path[:1] == ("anna",)}
        at = {name: wave.state.props[k].world_from_object[:3, 3] for name, k in things.items()}
        floor = near[2]
        assert at["letter"][2] >= floor + high
        assert at["bucket"][2] < floor + 0.05
        for point in at.values():
            assert 0.4 < np.hypot(point[0] - near[0], point[1] - near[1]) < 3.5
        for act, name in ((letter, "letter"), (bucket, "bucket")):
            after = tell(act.state, act.line, act.filming, most=1).end
            assert things[name] in {k for _, k in after.actors["anna"].held}


def test_of_two_things_that_lie_about_none_is_in_the_other() -> None:
    text = (
        "character anna = woman\nscene s = farmyard.yard at day\nanna at middle\n"
        "(anna pick up bucket)\n(anna pick up lantern)\n"
    )
    act = stage_acts(check_source(Source("x.vds", text), Report()))[0]
    points = [p.world_from_object[:2, 3] for k, p in act.state.props.items() if _is_annas(act.staged, k)]
    assert len(points) == 2
    assert np.linalg.norm(points[0] - points[1]) > 0.4


def _is_annas(staged: StagedScene, number: int) -> bool:
    return staged.world.objects[number].path[:1] == ("anna",)


def test_who_walks_with_something_has_it_in_a_hand() -> None:
    walk, put = played("(anna walks to the bench with a bag)\n(anna puts down the bag)\n")
    assert away(walk, ("anna", "bag"), "anna", "r") < 0.35
    assert seen(put, ("anna", "bag")) > 0.2


def test_a_box_stands_in_for_what_no_prop_is_called() -> None:
    look, take = played("(anna looks at ben)\n(anna picks up the harp)\n")
    assert 0.2 < seen(look, ("anna", "harp")) < 0.4
    staged, story = take
    harp = next(o for o in staged.world.objects if o.path == ("anna", "harp"))
    assert np.linalg.norm(story.props[harp.id][-1][:3, 3] - story.props[harp.id][0][:3, 3]) > 0.3


def test_a_line_may_say_how_it_is_done() -> None:
    script = HEAD.format(anna="fountain") + "(anna kisses ben on the cheek)\n(anna kisses ben)\n"
    told = [
        tell(act.state, act.line, act.filming)
        for act in stage_acts(check_source(Source("x.vds", script), Report()))
    ]
    cheek, any_way = ({story.variant for story in each.proposals} for each in told)
    assert cheek == {"cheek"} < any_way
