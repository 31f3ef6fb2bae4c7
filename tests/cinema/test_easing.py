"""The easing against its limits and its definition."""

import numpy as np
import pytest

from vdsl.cinema.easing import clock, ease


@pytest.mark.parametrize("lam", [0.1, 0.999999, 1.0, 1.000001, 10.0, 1000.0])
def test_begins_at_zero_ends_at_one_and_rises(lam: float) -> None:
    w = ease(np.linspace(0, 1, 101), lam)
    assert w[0] == 0.0
    assert w[-1] == pytest.approx(1.0, abs=1e-12)
    assert (np.diff(w) > 0).all()


def test_is_the_paper_s_formula_and_its_limit() -> None:
    t = np.linspace(0, 1, 11)
    np.testing.assert_allclose(ease(t, 10.0), (10.0**t - 1) / 9.0, atol=1e-14)
    np.testing.assert_allclose(ease(t, 0.1), (0.1**t - 1) / (0.1 - 1), atol=1e-14)
    np.testing.assert_array_equal(ease(t, 1.0), t)
    np.testing.assert_allclose(ease(t, 1 + 1e-9), t, atol=1e-8)


def test_a_large_lambda_is_slow_first() -> None:
    assert ease(0.5, 10.0) < 0.5 < ease(0.5, 0.1)


def test_refuses_a_lambda_that_is_not_positive() -> None:
    with pytest.raises(ValueError, match="positive"):
        ease(0.5, 0.0)


def test_a_single_frame_is_at_the_start() -> None:
    assert clock(1).tolist() == [0.0]
