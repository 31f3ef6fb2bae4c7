"""The paper's ablation: the same training with and without L_c and L_q, and what comes out side by side.

Assumes a training set; guarantees that all trainings see the same clips in the same order. Stopped, it goes
on: each training keeps its own folder.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from .config import ABLATION, TrainConfig
from .data import Dataset
from .evaluate import mean
from .infer import Ranker
from .train import train

Report = Callable[[dict[str, Any]], None]
_COMPARED = 200


def ablate(
    data_dir: str | Path,
    out_dir: str | Path,
    config: TrainConfig,
    report: Report | None = None,
    start: str | Path | None = None,
) -> dict[str, Any]:
    """Train with L_b alone, with L_c, with L_q and with all; write ``ablation.json`` and ``ablation.md``.

    Returns what each measures on the held-out clips (:mod:`ranker.evaluate`), and ``diversity``:
    the mean distance between unit features of good ones among them (0..2).
    """
    out, found = Path(out_dir), {}
    data = Dataset(data_dir)
    held = data.split(config.held_out, config.seed)[1]
    held = held[~data.bare[held]]
    for name, (classes, contrast) in ABLATION.items():
        if report is not None:
            report({"training": name})
        folder = out / name
        some = replace(
            config,
            class_weight=config.class_weight * classes,
            contrast_weight=config.contrast_weight * contrast,
        )
        measured = train(data_dir, folder, some, report, start)
        found[name] = measured | {"diversity": diversity(Ranker.load(folder / "weights"), data, held)}
    (out / "ablation.json").write_text(json.dumps(found, indent=1) + "\n", "utf-8")
    (out / "ablation.md").write_text(table(found), "utf-8")
    return found


def diversity(ranker: Ranker, data: Dataset, clips: np.ndarray) -> float | None:
    """Mean distance between the unit features of good clips, of a few hundred of them; None below two."""
    good = clips[data.professional[clips] > 0.5][:_COMPARED]
    if len(good) < 2:
        return None
    c = ranker.config
    features = [ranker.score(data.clip(int(i), range(c.frames), c.size)[None]).feature[0] for i in good]
    unit = np.stack(features) / np.maximum(np.linalg.norm(features, axis=1, keepdims=True), 1e-9)
    apart = np.sqrt(np.maximum(2 - 2 * unit @ unit.T, 0.0))
    return mean(apart[np.triu_indices(len(good), 1)])


def table(found: dict[str, Any]) -> str:
    """What the trainings measure as a table of Markdown."""
    lines = ["| losses | AUC | movement | scale | angle | feature distance |", "|---|---|---|---|---|---|"]
    for name, m in found.items():
        accuracy = m.get("accuracy") or {}
        values = (
            m.get("auc"),
            *(accuracy.get(k) for k in ("movement", "scale", "angle")),
            m.get("diversity"),
        )
        said = " | ".join("–" if v is None else f"{v:.3f}" for v in values)
        lines.append(f"| {' + '.join(f'L_{k}' for k in name.split('+'))} | {said} |")
    return "\n".join(lines) + "\n"
