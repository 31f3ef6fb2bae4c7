"""Every action of the library, in every variant, is sound for a tall heavy man and for a small woman."""

from __future__ import annotations

import pytest

from vdsl.lang import Report
from vdsl.library import Catalog

from .check_action import BODIES, checked
from .checks import violations

CATALOG = Catalog(Report())


@pytest.mark.parametrize("bodies", BODIES.values(), ids=BODIES)
@pytest.mark.parametrize("name", sorted(CATALOG.names("action")))
def test_moves_as_people_do(name: str, bodies: tuple[str, str]) -> None:
    performed = list(checked(name, CATALOG, bodies))
    assert performed
    wrong = [
        f"{variant}, {who}: {what}" for variant, who, measures in performed for what in violations(measures)
    ]
    assert not wrong
