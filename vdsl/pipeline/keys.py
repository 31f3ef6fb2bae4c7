"""Keys of kept results: everything that decides about a result, as one digest.

Guarantees that results made by other code, another library, other weights or options are never taken for
these; whatever a setting is called, a new one counts unless it is known not to matter.
"""

from __future__ import annotations

import hashlib
from dataclasses import fields
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import vdsl
from ranker.engine import HIGHEST, INT8, engine_of
from runtime.raster.types import LOOK_VERSION

from .depends import digest
from .options import Options

#: Packages of others whose version may show in a picture or a choice.
_PACKAGES = ("numpy", "scipy", "taichi", "torch", "torchvision", "av", "opencv-python-headless", "trimesh",
             "scikit-image", "pillow")  # fmt: skip
_CODE = (
    "grammar",
    "runtime",
    "ranker",
    "vdsl/lang",
    "vdsl/library",
    "vdsl/stage",
    "vdsl/cinema",
    "vdsl/propose",
)
#: Of the rest only what judges, films and encodes.
_FILES = ("pipeline/acts", "pipeline/chosen", "pipeline/edit", "pipeline/filming", "pipeline/glance",
          "pipeline/judging", "pipeline/packing", "pipeline/selection", "pipeline/shooting",
          "pipeline/shutter", "pipeline/witness", "emit/burnin", "emit/lettering",
          "emit/overlay", "emit/plan_ground", "emit/typefaces", "emit/types", "emit/video",
          "emit/words")  # fmt: skip
_ENDINGS = (".py", ".lark", ".vds")
#: Options that decide neither what is proposed nor what is drawn, or are counted where they do.
_ELSEWHERE = frozenset(
    {
        "settings",
        "weights",
        "rank",
        "burn_in",
        "guides",
        "edit",
        "cache",
        "draft",
        "firsts",
        "arrows",
        "taste",
    }
) | {"further", "shutter"}


@lru_cache(maxsize=1)
def code_digest() -> str:
    """Of the sources and data that make results, and of the versions of what they use."""
    root = Path(vdsl.__file__).parents[1]
    told = hashlib.sha256(str(LOOK_VERSION).encode())
    found = [p for name in _CODE for p in (root / name).rglob("*") if p.suffix in _ENDINGS]
    found += [root / "vdsl" / f"{name}.py" for name in _FILES]
    for path in sorted(found):
        if path.is_file():
            told.update(path.relative_to(root).as_posix().encode() + b"\0")
            told.update(hashlib.sha256(path.read_bytes()).digest())
    for name in _PACKAGES:
        told.update(f"{name} {_version(name)}\0".encode())
    return told.hexdigest()


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


def options_digest(options: Options) -> str:
    """Of the options that may show in a picture; the settings are in the storyboard."""
    return digest({f.name: getattr(options, f.name) for f in fields(options) if f.name not in _ELSEWHERE})


def judge_digest(options: Options) -> str:
    """Of who judges: the weights of the discriminator by their contents, and in which numbers it computes."""
    if options.rank == "geometry":
        return "geometry"
    folder = options.weights or Path(vdsl.__file__).parents[1] / "ranker" / "weights"
    try:
        told = hashlib.sha256((folder / "config.json").read_bytes())  # it has the weights' digest
        engine = engine_of(folder)
        told.update(engine.encode())
        if engine in HIGHEST:
            told.update((folder / INT8).read_bytes())
        if options.taste is not None:
            told.update(options.taste.read_bytes())
        return told.hexdigest()
    except OSError:
        return ""  # loading them will say what is wrong
