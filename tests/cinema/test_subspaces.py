"""The subspaces as data: what proposals draw stays within what is said of them, and fills it."""

from __future__ import annotations

import numpy as np
import pytest
from filmset import shot, skeleton, still_story, world

from vdsl.cinema.subspaces import subspace
from vdsl.lang.ir import MOVEMENTS
from vdsl.propose.cameras import Filming, propose_cameras

BODY = skeleton()
LENS, EASE = (30.0, 80.0), (0.1, 1.0, 10.0)


@pytest.mark.parametrize("movement", MOVEMENTS)
def test_what_is_drawn_lies_in_the_subspace(movement: str) -> None:
    space = {v.symbol: v for v in subspace(movement, "medium", "eye-level", LENS, EASE).free}
    grid = propose_cameras(shot(movement), [still_story(BODY)], Filming(world(), {"anna": BODY}, 24.0, 0))
    params = [c.params for c in grid.cameras]
    assert len(params) == 40
    drawn = {"μ": "mu", "ending": "ending", "k": "reference", "λ": "lambda", "f": "focal"}
    for symbol, name in drawn.items():
        if symbol not in space:
            continue
        variable, values = space[symbol], [p[name] for p in params]
        if variable.grid:
            assert set(values) <= set(variable.grid)
            assert len(set(values)) == len(variable.grid)
        else:
            numbers = [float(value) for value in values]
            assert variable.low - 1e-9 <= min(numbers) <= max(numbers) <= variable.high + 1e-9
    if "turn" in space:
        turns = np.degrees(np.abs([float(p["turn"]) for p in params]))
        assert space["turn"].low - 1e-9 <= turns.min()
        assert turns.max() <= space["turn"].high + 1e-9
    off = np.degrees([float(p["azimuth"]) for p in params]) / 45.0
    assert np.abs(off - off.round()).max() * 45.0 <= space["Δφ"].high + 1e-9
    assert set(off.round().astype(int) % 8) == set(range(len(space["φ"].grid)))


def test_static_cameras_have_no_easing_and_the_papers_have_its_lens() -> None:
    assert "λ" not in {v.symbol for v in subspace("static", "full", "eye-level", LENS, EASE).free}
    paper = subspace("push", "full", "low-angle", LENS, EASE, "paper")
    assert [str(v) for v in paper.free] == [
        "φ ∈ {0, 45, 90, 135, 180, 225, 270, 315} °", "λ ∈ {0.1, 1, 10}", "μ ∈ [0.5, 0.8]",
    ]  # fmt: skip
    assert dict(paper.fixed)["f"].startswith("50 mm")


def test_two_movements_at_once_have_both_ones_variables() -> None:
    space = {v.symbol: str(v) for v in subspace("push+pan-left", "full", "eye-level", LENS, EASE).free}
    assert {"μ", "turn", "ending", "λ", "λ′"} <= set(space)
    assert space["turn"] == "turn ∈ [12, 60] °"


def test_what_two_people_decide_is_not_said_to_be_free() -> None:
    for view in ("ots", "pov"):
        space = subspace("push", "medium", "eye-level", LENS, EASE, view=view)
        assert not {"φ", "Δφ", "f", "lead"} & {v.symbol for v in space.free}
        assert dict(space.fixed)["r, φ, f"] == "by where the two stand"


def test_arcs_go_less_far_round_than_the_papers_but_for_those_from_overhead() -> None:
    for angle, rig, least in (
        ("eye-level", "cinema", 60),
        ("overhead", "cinema", 90),
        ("eye-level", "paper", 90),
    ):
        space = subspace("arc-left", "full", angle, LENS, EASE, rig)
        assert f"turn ∈ [{least}, 120] °" in [str(v) for v in space.free]
        filming = Filming(world(), {"anna": BODY}, 24.0, 0, rig=rig)
        cameras = propose_cameras(shot("arc-left", "full", angle), [still_story(BODY)], filming).cameras
        turns = [abs(np.degrees(float(c.params["turn"]))) for c in cameras]
        assert least - 1e-9 <= min(turns) < least + 8
