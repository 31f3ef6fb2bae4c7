"""Ends of walls, which are seen where the wild wall they meet is taken away."""

from __future__ import annotations

import numpy as np
import pytest

from vdsl.lang.definitions.set import WALL_THICKNESS
from vdsl.stage.walls import Stretch, wall_mesh

GREEN, WHITE = (0.2, 0.6, 0.2), (0.9, 0.9, 0.9)


@pytest.mark.parametrize("axis", [0, 1])
def test_a_joint_closes_its_wall_and_has_the_colour_of_neither_side(axis: int) -> None:
    """No slit beside it lets the light of the backdrop through, and it does not stand out as a pale strip."""
    back = -WALL_THICKNESS / 2
    stretch = Stretch(axis, 2.0, 0.0, 4.0, 2.6, 0, 1, (back, back))
    mesh = wall_mesh(stretch, [], (GREEN, WHITE), (1, 2, 3))
    points = mesh.vertices[mesh.faces].astype(float)
    along, across = (points[..., 0], points[..., 1]) if axis == 0 else (points[..., 1], points[..., 0])
    for end, inside in ((-back, 1.0), (4.0 + back, -1.0)):
        cap = (np.ptp(along, axis=1) < 1e-6) & (np.abs(along[:, 0] - end) < 0.01)
        assert cap.sum() == 2
        assert (inside * (along[cap] - end) > 1e-3).all()  # in no plane with the wall it meets
        assert across[cap].min() == pytest.approx(2.0 + back, abs=1e-6)
        assert across[cap].max() == pytest.approx(2.0 - back, abs=1e-6)
        assert points[cap][..., 2].min() == pytest.approx(0.0)
        assert points[cap][..., 2].max() == pytest.approx(2.6)
        np.testing.assert_allclose(mesh.colors[cap], np.tile([(0.55, 0.75, 0.55)], (2, 1)), atol=1e-5)
