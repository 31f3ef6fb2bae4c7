"""The one exception of this package."""

from __future__ import annotations

from pathlib import Path


class ModelFileError(Exception):
    """A file that cannot be used. reason: half a sentence a person can act on."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path.name}: {reason}")
        self.path = path
        self.reason = reason
