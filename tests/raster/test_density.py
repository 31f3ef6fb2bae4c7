"""How much surface of a set is where: the kernel against numpy, and both against what is known."""

from __future__ import annotations

import numpy as np
import pytest
from raster_scenes import box, room, sphere

from runtime.mesh import Mesh, join
from runtime.raster.density import density_volume
from runtime.raster.device import start

NONE = np.zeros(0, np.int32)


@pytest.mark.parametrize("on_host", [False, True])
def test_all_of_a_surface_is_in_some_cell(on_host: bool) -> None:
    start("cpu")
    volume = density_volume(box((0, 0, 0), (1, 2, 3)), NONE, on_host)
    assert float(volume.values.sum()) * volume.cell**3 == pytest.approx(2 * (2 + 3 + 6), rel=1e-4)
    middle = np.round((np.array([0.5, 1.0, 1.5]) - volume.low) / volume.cell).astype(int)
    assert volume.values[tuple(middle)] == 0  # it is hollow
    side = np.round((np.array([1.0, 1.0, 1.5]) - volume.low) / volume.cell).astype(int)
    assert volume.values[tuple(side)] > 0


def test_the_kernel_adds_up_to_the_same_bits_as_numpy() -> None:
    start("cpu")
    rng = np.random.default_rng(3)
    scraps = sphere((1.0, 1.0, 1.0), (0.7, 0.4, 0.2), (1, 1, 1))
    torn = Mesh(
        (scraps.vertices + rng.normal(0, 0.2, scraps.vertices.shape)).astype(np.float32),
        *(getattr(scraps, name) for name in list(Mesh.__dataclass_fields__)[1:]),
    )
    ground = box((-200, -200, -0.1), (200, 200, 0))  # far wider than the volume
    glass = box((0, 0, 1), (1, 1, 2), material="glass")
    for mesh in (room().static, join([torn, ground, glass]), join([glass])):
        casters = np.arange(min(40, len(mesh.faces)), dtype=np.int32)
        found, expected = (density_volume(mesh, casters, on_host) for on_host in (True, False))
        np.testing.assert_array_equal(found.values, expected.values)
        assert (found.cell, found.low.tolist()) == (expected.cell, expected.low.tolist())
