"""By what kept results are known: the sources that make them."""

from __future__ import annotations

from pathlib import Path

import vdsl
from vdsl.pipeline import keys


def test_all_sources_that_are_named_are_there() -> None:
    root = Path(vdsl.__file__).parents[1]
    for name in keys._CODE:
        assert any((root / name).rglob("*.py")), name
    for name in keys._FILES:
        assert (root / "vdsl" / f"{name}.py").is_file(), name
