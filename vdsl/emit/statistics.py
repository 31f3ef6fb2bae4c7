"""Counts over the whole film: what the paper's statistics window shows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import Any

from .documents import rounded
from .timeline import film_frames
from .types import Build


def statistics(build: Build) -> dict[str, Any]:
    """Counts by kind over the best takes, lengths, and proposals in all; JSON-ready."""
    shots, shown = build.shots, build.shown
    frames = film_frames(build)
    num, den = build.storyboard.fps
    best = [s.takes[0].camera for s in shown]
    seen = [name for s in shots for name in sorted({b.character for b in s.line.beats})]
    rejected: Counter[str] = Counter()
    for s in shots:
        rejected.update(s.rejected)
    return {
        "shots": len(shots),
        "takes": sum(len(s.takes) for s in shots),
        "frames": frames,
        "seconds": rounded(frames * den / num, 6),
        "mean_shot_seconds": rounded(frames * den / num / max(1, len(shown)), 6),
        "story_proposals": sum(s.story_proposals for s in shots),
        "camera_proposals": sum(s.camera_proposals for s in shots),
        "proposals": sum(s.proposals for s in shots),
        "rejected": dict(sorted(rejected.items())),
        "movements": _counts(c.movement for c in best),
        "scales": _counts(c.scale for c in best),
        "angles": _counts(c.angle for c in best),
        "characters": _counts(seen),
        "scenes": _counts(s.scene for s in shots),
    }


def _counts(words: Iterable[str]) -> dict[str, int]:
    return dict(sorted(Counter(words).items(), key=lambda item: (-item[1], item[0])))
