"""What a writer's choices teach the discriminator, kept in the project as ``vds.taste``.

Assumes scripts with a lock and a build that holds the chosen takes and the others. Guarantees that without
such a file nothing is other than without choices.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .project import NAME as PROJECT

NAME = "vds.taste"


def taste_of(script: Path) -> Path | None:
    """The taste that counts for a script: beside it, or above it up to the project's ``vds.toml``."""
    folder = script.parent.absolute()
    for place in (folder, *folder.parents):
        if (place / NAME).is_file():
            return place / NAME
        if (place / PROJECT).is_file() or (place / ".git").exists():
            return None
    return None


def home_of(script: Path) -> Path:
    """Where a script's taste is kept: beside the ``vds.toml`` it belongs to, else beside it."""
    folder = script.parent.absolute()
    for place in (folder, *folder.parents):
        if (place / PROJECT).is_file():
            return place / NAME
        if (place / ".git").exists():
            break
    return folder / NAME


def learn_taste(
    scripts: Sequence[Path], weights: Path | None = None, device: str = "auto"
) -> tuple[Path, int]:
    """Learn from the takes chosen for scripts; returns the file and from how many shots.

    Raises :class:`ranker.RankerError` where nothing is chosen or no build has it, ScriptError for a lock that
    does not read, OSError.
    """
    # Only now: `compile` asks where a taste is before it needs torch.
    from ranker.infer import Ranker
    from ranker.taste import Choice, learn, save_taste
    from ranker.weights import load_card

    from .filming import SEGMENTS
    from .realclips import preferences

    found = []
    ranker = Ranker.load(weights, device if device in ("cpu", "cuda") else "auto")
    ranker.fits(SEGMENTS)
    for script in scripts:
        for liked in preferences(script, ranker.config.size):
            scores = ranker.score(liked.frames)
            found.append(Choice(scores.feature, scores.margin, liked.chosen))
    taste = learn(found, load_card(weights).sha256)
    path = home_of(scripts[0])
    save_taste(path, taste)
    return path, taste.choices
