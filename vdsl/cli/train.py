"""``vdsc train``: train the discriminator, its ablation, or the head that learns from a writer's choices."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .check import USAGE, stop
from .compile import Device

if TYPE_CHECKING:
    from ranker.config import TrainConfig


#: The word for the weights that come with VDS.
_SHIPPED = Path("shipped")
#: Clips with pictures that are filmed for a recipe, and the share of the stories whose clips get some: guides
#: are quickly made and learnt from, pictures are not.
_FILMED = {"cpu": (2_400, 0.1), "heads": (5_000, 0.1)}
_ELSE_FILMED = (10_000, 1.0)


def train(
    out: Annotated[
        Path | None,
        typer.Argument(help="Folder for checkpoints, log, curves and weights.", show_default=False),
    ] = None,
    data: Annotated[
        Path | None,
        typer.Option(help="The training set; where there is none, it is filmed.", show_default="OUT/clips"),
    ] = None,
    clips: Annotated[
        int | None,
        typer.Option(
            min=32,
            help="Clips to film with pictures, about half of them good.",
            show_default="10000; 2400 for the recipe cpu, 5000 for heads",
        ),
    ] = None,
    pictures: Annotated[
        float | None,
        typer.Option(
            min=0.01,
            max=1,
            help="Share of the stories to learn from whose clips get pictures, as in `vdsc dataset`.",
            show_default="1; 0.1 for the recipes cpu and heads",
        ),
    ] = None,
    recipe: Annotated[
        str,
        typer.Option(help="How to train: paper, cpu, heads, or a JSON file as `training` in config.json."),
    ] = "paper",
    ablation: Annotated[
        bool, typer.Option("--ablation", help="Train four times: L_b, with L_c, with L_q, all; and compare.")
    ] = False,
    picks: Annotated[
        list[Path] | None,
        typer.Option(help="Learn from the takes chosen for a storyboard instead; may be given again."),
    ] = None,
    weights: Annotated[
        Path | None,
        typer.Option(
            help="Weights to start from, a folder or `shipped`.",
            show_default="random ones",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the stories and the training.")] = 0,
    device: Annotated[Device, typer.Option(help="Where pictures are drawn.")] = Device.auto,
    as_json: Annotated[bool, typer.Option("--json", help="Print what was measured as JSON.")] = False,
) -> None:
    """Train the shot ranking discriminator on clips it films itself, or let it learn from your choices.

    Stopped and started again with the same folder, it goes on where it was. The new weights are in
    OUT/weights; use them with `vdsc compile --weights OUT/weights`. With --picks a small head is learnt from
    the takes chosen with `vdsc pick` and kept as vds.taste in the project, where compile finds it.
    """
    if picks and weights is not None:
        stop("a taste is learnt without weights: leave --weights out", USAGE)
    if picks:
        _learn(picks, as_json)
    elif out is None:
        stop("name a folder to train in, or a storyboard with --picks", USAGE)
    else:
        usual = _FILMED.get(recipe, _ELSE_FILMED)
        filmed = (usual[0] if clips is None else clips, usual[1] if pictures is None else pictures)
        _train(out, data or out / "clips", filmed, recipe, ablation, weights, seed, device, as_json)


def _learn(picks: list[Path], as_json: bool) -> None:
    # Only now: --help must not wait for numpy and scipy.
    from ..pipeline.tasting import learn_taste
    from .failures import failures_told

    with failures_told(picks[0]):
        learnt = learn_taste(picks)
    count = f"{learnt.choices} choice{'s' if learnt.choices > 1 else ''}"
    likes = f"; you seem to like {', '.join(learnt.words)}" if learnt.words else ""
    print(
        json.dumps({"taste": str(learnt.path), "choices": learnt.choices, "likes": learnt.likes})
        if as_json
        else f"{learnt.path}: learnt from {count}{likes}"
    )


def _train(
    out: Path,
    data: Path,
    filmed: tuple[int, float],
    recipe: str,
    ablation: bool,
    start: Path | None,
    seed: int,
    device: Device,
    as_json: bool,
) -> None:
    # Only now: --help must not wait for numpy, torch and taichi.
    from dataclasses import replace

    from rich.console import Console

    from ranker.ablation import ablate
    from ranker.train import check_start
    from ranker.train import train as train_ranker
    from ranker.weights import SHIPPED

    from ..pipeline.dataset import generate
    from .failures import RESUMED, failures_told
    from .progress import Bars

    console = Console(stderr=True)

    def said(line: dict[str, Any]) -> None:
        _say(line, console)

    with failures_told(out, kept=RESUMED):
        config = replace(_recipe(recipe), seed=seed)
        check_start(config, start)  # before anything is filmed
        if data == out / "clips" or not (data / "dataset.json").exists():
            with Bars(console) as bars:
                generate(data, filmed[0], seed, device.value, bars, pictures=filmed[1])
        run: Callable[..., dict[str, Any]] = ablate if ablation else train_ranker
        measured = run(data, out, config, said, SHIPPED if start == _SHIPPED else start)
    if as_json:
        print(json.dumps(measured, indent=2))
    else:
        print(f"comparison: {out / 'ablation.md'}" if ablation else f"weights: {out / 'weights'}")


def _recipe(name: str) -> TrainConfig:
    """A recipe by its name, or out of a file. Raises RankerError."""
    from ranker.config import RECIPES, train_from_json
    from ranker.errors import RankerError

    if name in RECIPES:
        return RECIPES[name]
    try:
        return train_from_json(json.loads(Path(name).read_text("utf-8")))
    except FileNotFoundError:
        raise RankerError(f"there is no recipe {name}: paper, cpu, heads, or a JSON file") from None
    except ValueError as error:
        raise RankerError(f"{name}: is no JSON: {error}") from error


def _say(line: dict[str, Any], console: Any) -> None:
    """A line of the training's log for people."""
    if "training" in line:
        console.print(f"training {line['training']}", highlight=False)
    elif "epoch" in line:
        held = ", ".join(f"{k} {v:.0%}" for k, v in line["held_out"].items() if v is not None)
        console.print(
            f"epoch {line['epoch']}/{line['epochs']}  {line['size']} px  loss {line['loss']:.3f}"
            f"  (binary {line['binary']:.3f}, class {line['class']:.3f}, contrast {line['contrast']:.3f},"
            f" hint {line['hint']:.3f})"
            f"  {held}  {line['seconds']:.0f} s",
            highlight=False,
        )
    elif "heads" in line:
        console.print(f"heads {line['heads']}/{line['epochs']}  loss {line['loss']:.3f}", highlight=False)
    elif "measured" in line:
        console.print(json.dumps(line["measured"]), highlight=False)
