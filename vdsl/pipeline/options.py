"""What the command line, or a caller of the Python API, may ask of a compilation."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from ..emit.guides import NO_GUIDES, Guides
from ..lang import Settings

JUDGES = ("discriminator", "geometry")
DEVICES = ("auto", "cpu", "cuda", "vulkan")


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
    guides: what is drawn over every picture of the takes
    arrows: draw on the contact sheet what moves
    """

    settings: Settings = field(default_factory=Settings)
    device: str = "auto"
    rank: str = "discriminator"
    weights: Path | None = None
    burn_in: bool = False
    edit: bool = False
    cache: bool = True
    draft: bool = False
    guides: Guides = NO_GUIDES
    arrows: bool = True
    taste: Path | None = None

    def __post_init__(self) -> None:
        if self.rank not in JUDGES:
            raise ValueError(f"rank: expected one of {', '.join(JUDGES)}, got {self.rank!r}")
        if self.device not in DEVICES:
            raise ValueError(f"device: expected one of {', '.join(DEVICES)}, got {self.device!r}")
