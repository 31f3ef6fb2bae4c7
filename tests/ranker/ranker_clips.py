"""Made-up clips for the tests of the ranker: what is good, and how it moves, can be seen."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ranker.config import ModelConfig, Phase, TrainConfig
from ranker.data import ShardWriter, Words

WORDS = Words(("static", "pan-left", "pan-right"), ("medium", "full"), ("eye-level", "low-angle"))
SIZE, FRAMES = 32, 4
TINY = TrainConfig(
    phases=(Phase(epochs=14, size=SIZE, frames=2, key_frames=2, batch=16),),
    learning_rate=2e-3,
    weight_decay=0.0,
    dictionary=24,
    momentum=0.9,
    contrast_weight=0.1,
    held_out=0.0,
    calibration=4,
    autocast=False,
    augment=False,
    backbone="resnet18",
    size=SIZE,
    threads=1,  # several processes test at a time
)


def model_config(**changes: object) -> ModelConfig:
    values = {"backbone": "resnet18", "frames": FRAMES, "size": SIZE, "inner": SIZE, "contrast": 16} | changes
    return ModelConfig(WORDS.movements, WORDS.scales, WORDS.angles, **values)  # type: ignore[arg-type]


def clip(rng: np.random.Generator, good: bool, movement: int, scale: int, angle: int) -> np.ndarray:
    """A block: red if good, sliding with the movement, as high as the scale, low or high with the angle."""
    frames = rng.integers(90, 120, (FRAMES, SIZE, SIZE, 3), dtype=np.uint8)
    high, top = (10, 20)[scale], (10, 2)[angle]
    for i in range(FRAMES):
        left = 12 + (0, -1, 1)[movement] * (3 * i - 4)
        frames[i, top : top + high, left : left + 8] = (230, 40, 40) if good else (40, 40, 230)
    return frames


def write_clips(folder: Path, count: int, seed: int = 0) -> None:
    rng = np.random.default_rng(seed)
    with ShardWriter(folder, WORDS, (SIZE, SIZE), FRAMES) as writer:
        for i in range(len(writer), count):
            good, m, s, a = i % 2 == 0, i % 3, i // 2 % 2, i // 4 % 2
            words = WORDS.movements[m], WORDS.scales[s], WORDS.angles[a]
            writer.add(
                clip(rng, good, m, s, a), good, *words, f"group-{i % 5}", 0.0 if good else (i % 4 + 1) / 4
            )
