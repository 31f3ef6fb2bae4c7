"""The library's actions as clips."""

from __future__ import annotations

from functools import cache

from runtime.motion.types import ActionClip
from vdsl.lang.definitions.action import ActionDef
from vdsl.library.loader import Catalog
from vdsl.stage.actions import build_clip


@cache
def definitions() -> dict[str, ActionDef]:
    catalog = Catalog()
    found = {name: catalog.get("action", name) for name in catalog.names("action")}
    return {name: d for name, d in found.items() if isinstance(d, ActionDef)}


@cache
def clips() -> dict[str, ActionClip]:
    return {name: build_clip(d) for name, d in definitions().items()}
