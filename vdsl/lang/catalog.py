"""What the checker asks of a catalog of definitions; the library has the real one."""

from __future__ import annotations

from typing import Protocol

from .definitions.types import DefinitionBase


class CatalogLike(Protocol):
    """Definitions by kind (set, prop, cast, action) and name; the script's own come first."""

    def names(self, kind: str) -> tuple[str, ...]: ...

    def synonyms(self, kind: str) -> dict[str, str]: ...

    def get(self, kind: str, name: str) -> DefinitionBase | None: ...
