"""What the command line, or a caller of the Python API, may ask of a compilation."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

from ..emit.guides import NO_GUIDES, Guides
from ..lang import Settings

JUDGES = ("discriminator", "geometry")
DEVICES = ("auto", "cpu", "cuda", "vulkan")
#: What a build is not made by: how it was come by.
_PASSING = frozenset({"cache", "draft", "firsts", "further"})


@dataclass(frozen=True)
class Options:
    """Settings of one run.

    settings: what wins over the script's header lines
    device: where pictures are drawn; rank: who judges; weights: the discriminator's, None for the shipped
    taste: what a writer's choices taught the discriminator; None for the one found with the script, if any
    burn_in: write shot, take, timecode, frame, lens and movement on every frame
    edit: choose the first takes for the sequence, so that cuts keep to the rules
    cache: take results of earlier runs, and keep those of this one
    draft: make no films, but stills of the best takes by geometry where films are not kept from earlier
    firsts: film of each shot the first take alone, and what others are kept from earlier
    guides: what is drawn over every picture of the takes
    arrows: draw on the contact sheet what moves
    further: shots by their ids of which further takes are wanted
    shutter: degrees that the shutter is open, for motion blur in films; 0 for none
    """

    settings: Settings = field(default_factory=Settings)
    device: str = "auto"
    rank: str = "discriminator"
    weights: Path | None = None
    burn_in: bool = False
    edit: bool = False
    cache: bool = True
    draft: bool = False
    firsts: bool = False
    guides: Guides = NO_GUIDES
    arrows: bool = True
    taste: Path | None = None
    further: tuple[str, ...] = ()
    shutter: float = 0.0

    def __post_init__(self) -> None:
        if not 0 <= self.shutter <= 360:
            raise ValueError(
                f"shutter: expected degrees from 0 (none) to 360, such as 180, got {self.shutter:g}"
            )
        if self.rank not in JUDGES:
            raise ValueError(f"rank: expected one of {', '.join(JUDGES)}, got {self.rank!r}")
        if self.device not in DEVICES:
            raise ValueError(f"device: expected one of {', '.join(DEVICES)}, got {self.device!r}")


def options_document(options: Options) -> dict[str, Any]:
    """The options that are not as they are by default, as plain values; :func:`made_by` reads them."""
    usual, out = Options(), dict[str, Any]()
    for name in (f.name for f in fields(options) if f.name not in _PASSING):
        value = getattr(options, name)
        if value == getattr(usual, name):
            continue
        if isinstance(value, Path):
            out[name] = str(value.absolute())
        elif isinstance(value, Settings):
            said = {k: v for k, v in vars(value).items() if v is not None}
            out[name] = {k: list(v) if isinstance(v, tuple) else v for k, v in said.items()}
        else:
            out[name] = asdict(value) if isinstance(value, Guides) else value
    return out


def made_by(build: Path) -> dict[str, Any]:
    """The options a build was made by, as arguments of :class:`Options`; none where it does not say."""
    try:
        said = json.loads((build / "report.json").read_text("utf-8"))["options"]
        return {name: _value(name, value) for name, value in said.items() if name not in _PASSING}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def _value(name: str, value: Any) -> Any:
    if name == "settings":
        said: dict[str, Any] = {k: tuple(v) if isinstance(v, list) else v for k, v in value.items()}
        return Settings(**said)
    if name == "guides":
        return Guides(**value)
    return Path(value) if name in ("weights", "taste") else value
