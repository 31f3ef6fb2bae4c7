"""What rankers put first, side by side: the best three of the same proposals by each of several weights.

``python -m vdsl.pipeline.beside out.png L_b=run/b/weights all=run/b+c+q/weights --lines 6`` plays lines of
stories for testing, lets every ranker score all their proposals by itself, without what geometry says, and
draws two frames each of its best three; ``out.json`` beside the picture says what share of them has no fault
that the designer goes by, and how far apart they look. Assumes the library.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..propose.types import CameraProposal, ProposalGrid
from .blind import held_out_lines
from .captions import grid
from .casting import Scene
from .designer import judged
from .filming import Camerawork
from .guides import about_of
from .selection import choose_takes

if TYPE_CHECKING:
    from ranker.infer import Ranker

_TOP = 3
_AT_ONCE = 16
_AT, _CELL = (0.15, 0.85), (208, 117)  # of a take's length, and pixels of a frame


def beside(
    out: Path, weights: dict[str, Path], lines: int, seed: int = 0, proposals: int = 60, device: str = "cpu"
) -> dict[str, Any]:
    """Draw ``out``, one row a line and ranker, and return what ``out`` as JSON says of each by its name.

    Raises RankerError, OSError.
    """
    from ranker.infer import Ranker

    rankers = {name: Ranker.load(folder, "cpu") for name, folder in weights.items()}
    camerawork, cells = Camerawork(device), []
    found: dict[str, list[dict[str, Any]]] = {name: [] for name in rankers}
    for scene, shown in held_out_lines(seed, lines, proposals):
        margins = _margins(rankers, camerawork, scene, shown)
        for name, scores in margins.items():
            best = choose_takes(shown.cameras, scores, _TOP)
            taken = [shown.cameras[i] for i in best]
            strips = [_frames(camerawork, scene, shown, camera) for camera in taken]
            cells.append((name, shown.shot, Image.fromarray(np.concatenate(strips, axis=1))))
            faultless = int((judged(taken) >= 0).sum())
            found[name].append({"faultless": faultless, "of": len(taken), "apart_deg": spread(taken)})
    grid(cells, 1).save(out)
    told = {name: _told(rows) for name, rows in found.items()}
    out.with_suffix(".json").write_text(json.dumps(told, indent=1) + "\n", "utf-8")
    return told


def spread(cameras: Sequence[CameraProposal]) -> float:
    """Mean angle in degrees between the directions takes begin to look in; 0 of fewer than two."""
    pitch, yaw = (np.array([c.track.rotation[0, k] for c in cameras]) for k in (1, 2))
    ahead = np.stack([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)], axis=-1)
    pairs = np.triu_indices(len(cameras), 1)
    angles = np.degrees(np.arccos(np.clip(ahead @ ahead.T, -1.0, 1.0)))[pairs]
    return float(angles.mean()) if len(angles) else 0.0


def _margins(
    rankers: dict[str, Ranker], camerawork: Camerawork, scene: Scene, shown: ProposalGrid
) -> dict[str, NDArray[np.float64]]:
    shot = scene.shots[0]
    about = about_of(shot, shown, scene.filming, scene.staged)
    parts: dict[str, list[NDArray[np.float32]]] = {name: [] for name in rankers}
    for begin in range(0, len(shown.cameras), _AT_ONCE):
        cameras = shown.cameras[begin : begin + _AT_ONCE]
        seen = camerawork.judge_frames(
            scene.staged, shot.style, shown.story, cameras, about=[about] * len(cameras)
        )
        for name, ranker in rankers.items():
            parts[name].append(ranker.score(seen.frames, seen.guides).margin)
    return {name: np.concatenate(found).astype(float) for name, found in parts.items()}


def _frames(
    camerawork: Camerawork, scene: Scene, shown: ProposalGrid, camera: CameraProposal
) -> NDArray[np.uint8]:
    """Two frames of a take, side by side."""
    story = next(s for s in shown.story if s.index == camera.story)
    at = np.round(np.array(_AT) * (story.frames - 1)).astype(int)
    frames = camerawork.frames_at(scene.staged, scene.shots[0].style, story, camera, _CELL, at)
    return np.concatenate(list(frames), axis=1)


def _told(rows: list[dict[str, Any]]) -> dict[str, Any]:
    takes = sum(row["of"] for row in rows)
    return {
        "lines": len(rows),
        "faultless_share": round(sum(row["faultless"] for row in rows) / max(takes, 1), 3),
        "apart_deg": round(float(np.mean([row["apart_deg"] for row in rows])), 1) if rows else 0.0,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("weights", nargs="+", help="NAME=FOLDER of weights")
    parser.add_argument("--lines", type=int, default=6)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--proposals", type=int, default=60, help="of a line")
    options = parser.parse_args()
    named = dict(text.split("=", 1) for text in options.weights)
    print(
        json.dumps(beside(options.out, {k: Path(v) for k, v in named.items()}, options.lines, options.seed))
    )


if __name__ == "__main__":
    main()
