"""The curves of a training, as an SVG that a browser shows in light and dark: losses above, accuracies below.

Assumes the lines of a ``log.jsonl``. Guarantees one point an epoch, the last that was written of it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

_WIDTH, _HEIGHT, _LEFT, _RIGHT, _TOP, _GAP = 640, 200, 52, 190, 28, 56
_COLORS = ("#0f766e", "#b45309", "#6d28d9", "#be123c", "#475569", "#1d4ed8")
_LOSSES = ("loss", "binary", "class", "contrast", "hint", "order")


def draw_curves(folder: Path) -> None:
    """Write ``curves.svg`` beside a folder's ``log.jsonl``; nothing before the first epoch."""
    epochs: dict[int, dict[str, Any]] = {}
    for text in (folder / "log.jsonl").read_text("utf-8").splitlines():
        line = json.loads(text)
        if "epoch" in line:
            epochs[int(line["epoch"])] = line
    if epochs:
        (folder / "curves.svg").write_text(curves_svg([epochs[k] for k in sorted(epochs)]), "utf-8")


def curves_svg(epochs: Sequence[Mapping[str, Any]]) -> str:
    """The drawing; epochs: lines of the log in order."""
    losses = {name: [(e["epoch"], e[name]) for e in epochs if e.get(name) is not None] for name in _LOSSES}
    losses = {name: points for name, points in losses.items() if any(value for _, value in points)}
    names = dict.fromkeys(name for e in epochs for name in e.get("held_out") or {})
    right = {
        name: [
            (e["epoch"], e["held_out"][name])
            for e in epochs
            if (e.get("held_out") or {}).get(name) is not None
        ]
        for name in names
    }
    last = max(int(e["epochs"]) for e in epochs)
    top = max((v for points in losses.values() for _, v in points), default=1.0) or 1.0
    height = 2 * (_HEIGHT + _GAP) + _TOP
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_LEFT + _WIDTH + _RIGHT} {height}" '
        'font-family="sans-serif" font-size="12" fill="currentColor">',
        "<style>svg{color:#1f2937;background:#fff}@media(prefers-color-scheme:dark)"
        "{svg{color:#e5e7eb;background:#111827}}</style>",
        *_chart("loss", losses, last, top, _TOP),
        *_chart("held-out accuracy", right, last, 1.0, _TOP + _HEIGHT + _GAP),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


def _chart(
    title: str, series: Mapping[str, Sequence[tuple[int, float]]], last: int, top: float, y0: int
) -> list[str]:
    def at(epoch: int, value: float) -> str:
        x = _LEFT + _WIDTH * (epoch - 1) / max(last - 1, 1)
        return f"{x:.1f},{y0 + _HEIGHT * (1 - min(value, top) / top):.1f}"

    out = [f'<text x="{_LEFT}" y="{y0 - 10}" font-weight="bold">{title}</text>']
    for share in (0.0, 0.5, 1.0):
        y = y0 + _HEIGHT * (1 - share)
        out.append(
            f'<path d="M{_LEFT},{y:.1f}h{_WIDTH}" stroke="currentColor" opacity="0.2"/>'
            f'<text x="{_LEFT - 8}" y="{y + 4:.1f}" text-anchor="end">{top * share:.2g}</text>'
        )
    out.append(
        f'<text x="{_LEFT}" y="{y0 + _HEIGHT + 18}">1</text><text x="{_LEFT + _WIDTH}" '
        f'y="{y0 + _HEIGHT + 18}" text-anchor="end">epoch {last}</text>'
    )
    for number, (name, points) in enumerate(series.items()):
        color = _COLORS[number % len(_COLORS)]
        if points:
            line = " ".join(at(e, v) for e, v in points)
            out.append(f'<polyline points="{line}" fill="none" stroke="{color}" stroke-width="2"/>')
        label = f"{name} {points[-1][1]:.3g}" if points else name
        y = y0 + 14 + 18 * number
        out.append(
            f'<path d="M{_LEFT + _WIDTH + 12},{y - 4}h14" stroke="{color}" stroke-width="3"/>'
            f'<text x="{_LEFT + _WIDTH + 32}" y="{y}">{label}</text>'
        )
    return out
