"""What of a take somebody may like better."""

from __future__ import annotations

import numpy as np
import pytest

from vdsl.cinema.measures import MEASURES
from vdsl.cinema.traits import TRAITS, traits_of

MEASURED = dict.fromkeys(MEASURES, 0.0)


def of(
    movement: str = "static", scale: str = "medium", focal: float = 50.0, **measures: float
) -> dict[str, float]:
    found = traits_of({**MEASURED, **measures}, movement, scale, np.full(24, focal))
    return dict(zip(TRAITS, found.tolist(), strict=True))


def test_one_step_of_a_measure_is_one() -> None:
    for name in TRAITS.keys() & set(MEASURES) - {"speed"}:  # that is a logarithm
        assert of(**{name: TRAITS[name].step})[name] - of()[name] == pytest.approx(1.0)


def test_words_and_lenses_are_traits_too() -> None:
    one = of("push+pan-left", "close-up", 85.0, elevation=-20.0, speed=1.0)
    assert {name for name in ("static", "push", "pan", "dolly") if one[name]} == {"push", "pan"}
    assert one["closeness"] > of()["closeness"] > of(scale="extreme-wide")["closeness"]
    assert one["focal"] > of()["focal"]
    assert one["slant"] == -one["elevation"] == 2.0
    assert one["speed"] > 0 == of()["speed"]
    assert of("dolly-zoom-in")["dolly-zoom"] == 1.0
    assert of("rack-focus")["static"] == 1.0
