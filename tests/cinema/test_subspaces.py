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
