"""``vdsc dataset``: film a training set for the discriminator."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from .compile import Device


def dataset(
    out: Annotated[Path, typer.Argument(help="Folder for the training set; one begun is gone on with.")],
    clips: Annotated[
        int,
        typer.Option(min=0, help="Clips to film with pictures, about half of them good unless `--every`."),
    ] = 10_000,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the stories.")] = 0,
    size: Annotated[int, typer.Option(min=32, max=512, help="Side of the pictures, in pixels.")] = 224,
    pictures: Annotated[
        float,
        typer.Option(
            min=0.01,
            max=1,
            help="Share of the stories to learn from whose clips get pictures; the others get guides alone, "
            "which are far more quickly made.",
        ),
    ] = 1.0,
    every: Annotated[
        bool,
        typer.Option(
            "--every",
            help="Give pictures to all clips of these stories, also what is passed over and spoilt besides: "
            "five times as many in hardly more time, five in six of them bad.",
        ),
    ] = False,
    positives: Annotated[
        Path | None,
        typer.Option(
            help="Folder of real clips (mp4, mov), one shot a file, to add as good ones.", show_default="none"
        ),
    ] = None,
    picks: Annotated[
        list[Path] | None,
        typer.Option(help="A storyboard whose chosen takes to add as good ones; may be given again."),
    ] = None,
    device: Annotated[Device, typer.Option(help="Where pictures are drawn.")] = Device.auto,
) -> None:
    """Film a training set of random stories, and add real clips or chosen takes to it.

    Stopped and started again with the same folder and seed, it goes on where it was. Train on it with
    `vdsc train OUT --data FOLDER`.
    """
    # Only now: --help must not wait for numpy and taichi.
    from rich.console import Console

    from ..pipeline.dataset import generate, made
    from ..pipeline.realclips import add_films, add_picks
    from .failures import RESUMED, failures_told
    from .progress import Bars

    console = Console(stderr=True)
    with failures_told(out, kept=RESUMED):
        added = 0
        if positives is not None:
            added += add_films(out, positives, made(seed, pictures, every), console.print, size)
        if picks:
            added += add_picks(out, picks, made(seed, pictures, every), size)
        with Bars(console) as bars:
            film = partial(generate, progress=bars, size=size, pictures=pictures, every=every)
            filmed = film(out, clips, seed, device.value) if clips else 0
    print(f"{out}: {filmed or added} clips" + (f", {added} of them added from films" if added else ""))
