"""``vdsc evaluate``: how good the discriminator is on sets and people it never saw."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from .compile import Device

SCHEMA = "vds.evaluation/1"


def evaluate(
    data: Annotated[Path, typer.Argument(help="The training set; what it keeps for testing is used.")],
    weights: Annotated[
        Path | None, typer.Option(help="Folder of the weights.", show_default="the shipped ones")
    ] = None,
    proposals: Annotated[
        int, typer.Option(min=0, help="Proposals among which designer's picks are hidden, about 100 a pick.")
    ] = 20_000,
    clips: Annotated[
        int | None, typer.Option(min=2, help="Clips for testing to use.", show_default="all")
    ] = None,
    exact: Annotated[int, typer.Option(min=0, help="Clips to compare with float32.")] = 200,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the hidden picks' stories.")] = 0,
    by_guides: Annotated[
        bool,
        typer.Option(
            "--by-guides",
            help="Judge hidden picks by their guides alone: far quicker, and nearly as with pictures.",
        ),
    ] = False,
    device: Annotated[Device, typer.Option(help="Where pictures are drawn and judged.")] = Device.auto,
    as_json: Annotated[
        bool, typer.Option("--json", help="As a document of schema vds.evaluation/1.")
    ] = False,
) -> None:
    """Measure the discriminator: picks against spoilt takes, classes, and picks hidden among proposals.

    Proposals that were scored are kept in DATA/hidden, so that a stopped evaluation goes on.
    """
    # Only now: --help must not wait for numpy, torch and taichi.
    from rich.console import Console

    from ..pipeline.evaluating import evaluated
    from .failures import RESUMED, failures_told
    from .progress import Bars

    with failures_told(data, kept=RESUMED), Bars(Console(stderr=True)) as bars:
        found = evaluated(data, weights, proposals, clips, exact, seed, device.value, bars, by_guides)
    if as_json:
        print(json.dumps({"schema": SCHEMA, **found}, indent=1, ensure_ascii=False))
    else:
        _print(found)


def _print(found: dict[str, Any]) -> None:
    def said(value: float | None) -> str:
        return "–" if value is None else f"{value:.3f}"

    print(f"clips for testing        {found['clips']}")
    print(f"AUC, against spoilt ones {said(found['auc'])}")
    print(f"AUC, against all         {said(found['auc_all'])}")
    for what in ("strength", "kind"):
        for name, value in found[f"auc_by_{what}"].items():
            print(f"  {'to ' if what == 'strength' else ''}{name:<20} {said(value)}")
    for name, value in found["accuracy"].items():
        print(f"accuracy, {name:<14} {said(value)}")
    print(f"Spearman with float32    {said(found['spearman_fp32'])}")
    print("by pictures alone, without what is known of drawn clips")
    alone = found["by_pictures_alone"]
    print(f"  {'AUC, against spoilt ones':<30} {said(alone['auc'])}")
    for name, value in alone["accuracy"].items():
        print(f"  {'accuracy, ' + name:<30} {said(value)}")
    print(f"  {'Spearman with float32':<30} {said(alone['spearman_fp32'])}")
    print(f"picks among proposals    {found['picks']} among {found['proposals']}")
    for name, of in (("", found), (", as compiled", found.get("with_prior"))):
        if of is not None:
            print(f"  {'in the top 10 %' + name:<30} {said(of['picks_in_top_10pct'])}")
            print(f"  {'median place, %' + name:<30} {said(of['picks_median_rank_pct'])}")
    for name, hits in found["agreement"].items():
        print(f"  {name:<20} top 1 {hits['top_1']:.3f}   top 5 {hits['top_5']:.3f}")
