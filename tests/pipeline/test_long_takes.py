"""A take is drawn and encoded as it goes: half a minute of it needs no more memory than ten seconds."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

CODE = """
import resource, sys
from dataclasses import replace
from pathlib import Path
import numpy as np
from vdsl.emit.video import write_take
from vdsl.pipeline.bench_render import filmable
from vdsl.pipeline.filming import Camerawork

script, out, frames = Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3])
act, story, camera, _ = filmable(script)
at = np.minimum(np.arange(frames), story.frames - 1)  # the last frame goes on
performances = {
    name: replace(played, world_from_joint=played.world_from_joint[at])
    for name, played in story.performances.items()
}
props = {name: placed[at] for name, placed in story.props.items()}
long = replace(story, frames=frames, performances=performances, props=props)
track = camera.track
track = replace(track, position=track.position[at], rotation=track.rotation[at], focal=track.focal[at])
drawn = Camerawork("cpu").take_frames(act.staged, "board", long, replace(camera, track=track), (320, 180))
write_take(out, "1A", 1, drawn, frames, (24, 1))
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024)
"""
SCRIPT = """storyboard "long"
character anna = woman
scene s = apartment.kitchen

/ (static wide)
(anna wave)
"""


def peak_mib(folder: Path, frames: int) -> int:
    script = folder / "long.vds"
    script.write_text(SCRIPT, encoding="utf-8")
    command = [sys.executable, "-c", CODE, str(script), str(folder / f"out{frames}"), str(frames)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return int(done.stdout.splitlines()[-1])


@pytest.mark.slow
def test_memory_does_not_grow_with_a_takes_length(tmp_path: Path) -> None:
    ten_seconds, half_a_minute = peak_mib(tmp_path, 240), peak_mib(tmp_path, 720)
    # poses and cameras are kept for the whole take, pictures are not: twenty seconds more would be 79 MiB
    assert half_a_minute < ten_seconds + 40
