"""``vdsc bench``: how fast the stages are on this machine."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .check import check_or_exit
from .compile import Device

if TYPE_CHECKING:
    from ..pipeline.bench import Figures

_ROWS = (
    ("proposals_per_s", "proposals", "proposals/s"),
    ("rank_frames_per_s", "ranking frames, 224 x 224", "frames/s"),
    ("render_720p_per_s", "final frames, 1280 x 720", "frames/s"),
    ("render_encode_720p_per_s", "final frames with encoding", "frames/s"),
    ("ranked_shots_per_s", "ranked shots", "shots/s"),
    ("chosen_from_per_s", "proposals drawn and chosen from", "proposals/s"),
    ("check_seconds", "vdsc check", "s"),
    ("demo_seconds", "vdsc compile", "s"),
    ("demo_peak_mib", "vdsc compile, peak memory", "MiB"),
)


def bench(
    file: Annotated[Path, typer.Argument(help="The storyboard to measure on.")] = Path("examples/coffee.vds"),
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON document.")] = False,
    device: Annotated[Device, typer.Option(help="Where pictures are drawn.")] = Device.auto,
    whole: Annotated[bool, typer.Option(help="Also time one whole compilation.")] = True,
    render: Annotated[bool, typer.Option("--render", help="Measure drawing alone, against OpenGL.")] = False,
) -> None:
    """Measure proposals, drawing, ranking and a whole compilation on this machine."""
    check_or_exit(file)
    if render:
        _render(file, as_json, device)
        return
    # Only now: --help must not wait for numpy, torch and taichi.
    from rich.console import Console

    from ..pipeline.bench import measure
    from .failures import failures_told

    console = Console(stderr=True)
    with failures_told(file), console.status("") as status:
        figures = measure(file, device.value, whole, lambda what: status.update(f"measuring {what}"))
    if as_json:
        print(json.dumps(figures.document(), indent=2))
    else:
        _print(figures)


def _render(file: Path, as_json: bool, device: Device) -> None:
    from rich.console import Console

    from ..pipeline.bench_render import measure_render
    from .failures import failures_told

    console = Console(stderr=True)
    with failures_told(file), console.status("") as status:
        table = measure_render(file, device.value, said=lambda what: status.update(f"measuring {what}"))
    if as_json:
        print(json.dumps(table.document(), indent=2))
        return
    print(f"{table.triangles:,} triangles; OpenGL: {table.rival}")
    print(f"{'':<50}{'':>10} {'':<9}{'ms busy':>9}{'to OpenGL':>11}")
    for row in table.rows:
        value = "not measured" if row.value is None else _rounded(row.value)
        busy = "" if row.busy_ms is None else f"{row.busy_ms:.2f}"
        ratio = "" if row.ratio is None else f"{row.ratio:.2f}x"
        print(f"{row.what:<50}{value:>10} {row.unit:<9}{busy:>9}{ratio:>11}".rstrip())


def _rounded(value: float) -> str:
    return f"{value:,.0f}" if value >= 100 else f"{value:.2f}"


def _print(figures: Figures) -> None:
    document = figures.document()
    for key, name, unit in _ROWS:
        value = document[key]
        shown = _rounded(value) if isinstance(value, float) else "not measured"
        print(f"{name:<28}{shown:>12} {unit if isinstance(value, float) else ''}".rstrip())
