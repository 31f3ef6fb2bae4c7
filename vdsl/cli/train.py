"""``vdsc train``: film a training set from random stories, and train the discriminator on it."""

from __future__ import annotations

import json
from enum import Enum
from pathlib import Path
from typing import Annotated, Any

import typer

from .compile import Device


class Recipe(str, Enum):
    """How to train: small and short for a CPU, or as in the paper."""

    cpu = "cpu"
    paper = "paper"


def train(
    out: Annotated[Path, typer.Argument(help="Folder for the training set, checkpoints, log and weights.")],
    clips: Annotated[int, typer.Option(min=32, help="Clips to film, half of them good.")] = 2400,
    recipe: Annotated[Recipe, typer.Option(help="How to train.")] = Recipe.cpu,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the stories and the training.")] = 0,
    device: Annotated[Device, typer.Option(help="Where pictures are drawn.")] = Device.auto,
    as_json: Annotated[bool, typer.Option("--json", help="Print what was measured as JSON.")] = False,
) -> None:
    """Train the shot ranking discriminator on clips it films itself.

    Stopped and started again with the same folder, it goes on where it was. The new weights are in
    OUT/weights; use them with `vdsc compile --weights OUT/weights`.
    """
    # Only now: --help must not wait for numpy, torch and taichi.
    from dataclasses import replace

    from rich.console import Console

    from ranker.config import RECIPES
    from ranker.train import train as train_ranker

    from ..pipeline.dataset import generate
    from .failures import failures_told
    from .progress import Bars

    console = Console(stderr=True)
    with failures_told(out):
        with Bars(console) as bars:
            generate(out / "clips", clips, seed, device.value, bars)
        measured = train_ranker(
            out / "clips", out, replace(RECIPES[recipe.value], seed=seed), lambda line: _say(line, console)
        )
    if as_json:
        print(json.dumps(measured, indent=2))
    else:
        print(f"weights: {out / 'weights'}")


def _say(line: dict[str, Any], console: Any) -> None:
    """A line of the training's log for people."""
    if "epoch" in line:
        console.print(
            f"epoch {line['epoch']}/{line['epochs']}  {line['size']} px  loss {line['loss']:.3f}"
            f"  (binary {line['binary']:.3f}, class {line['class']:.3f}, contrast {line['contrast']:.3f})"
            f"  {line['seconds']:.0f} s",
            highlight=False,
        )
    elif "measured" in line:
        console.print(json.dumps(line["measured"]), highlight=False)
