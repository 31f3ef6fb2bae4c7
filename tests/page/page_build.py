"""A small build for the tests of the page: flat pictures, two scenes, takes that can be chosen."""

from __future__ import annotations

import hashlib
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import httpx2

sys.path.insert(0, str(Path(__file__).parents[1] / "emit"))

import emit_film as f

from vdsl.emit.build import write_build
from vdsl.emit.types import Build, BuiltShot

ATTACK = "<script>document.title = 'taken'</script>\"'&</title><img src=x onerror=\"document.title='taken'\">"
SCRIPT = """storyboard "Morning coffee"
character anna = woman
scene kitchen = apartment.kitchen
anna at door

(anna wave) / (static full eye-level)
"""

SERVE = (sys.executable, "-c", "from vdsl.cli import main; main()", "serve")


def with_keys(built: BuiltShot) -> BuiltShot:
    """Takes as the compiler names them, so that one can be chosen."""
    takes = tuple(replace(t, key=f"{t.camera.index}-{t.rank:08x}") for t in built.takes)
    depends = hashlib.sha256(built.shot.id.encode()).hexdigest()[:12]
    return replace(built, takes=takes, depends=depends)


def film(folder: Path, names: Sequence[str] = ("s1", "s2", "s3"), title: str = "Morning coffee") -> Build:
    """Shots of two takes each; the first says and notes what must stay text, the last has seven takes."""
    shots = [f.built(folder, names[0], 24, 90, say=ATTACK, note="Steam & light")]
    shots += [f.built(folder, name, 24, 140) for name in names[1:-1]]
    shots.append(f.built(folder, names[-1], 24, 200, takes=7))
    keyed = [with_keys(shot) for shot in shots]
    cuts = (f.crossing(names[0], names[1]),)
    return replace(f.film(keyed, title, cuts), made_with=(("vdsl", "0.1.0"), ("look", "1")))


def project(folder: Path, **said: str) -> tuple[Path, Path]:
    """A script with its build: (file, build folder)."""
    file, build = folder / "story.vds", folder / "build" / "story"
    file.write_text(SCRIPT)
    build.mkdir(parents=True)
    write_build(build, film(build, **said))  # type: ignore[arg-type]
    return file, build


@contextmanager
def serving_process(file: Path, build: Path, *more: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """``vdsc serve`` of a project, and its address without the last slash."""
    command = [*SERVE, str(file), "-o", str(build), "--no-open", "--device", "cpu", *more]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        address = process.stdout.readline().split(" ")[0].rstrip("/")
        for _ in range(20):  # it listens from the first, and answers once it has begun
            with suppress(httpx2.TransportError):
                httpx2.get(f"{address}/", timeout=30)
                break
        yield process, address
    finally:
        process.terminate()
        process.wait(20)


@contextmanager
def served(file: Path, build: Path) -> Iterator[str]:
    """The address of :func:`serving_process`."""
    with serving_process(file, build) as (_, address):
        yield address
