"""What a writer's choices teach the discriminator, kept in the project as ``vds.taste``.

Assumes scripts with a lock and a build that holds the chosen takes and the others; no film is looked at.
What is learnt is why somebody chose another take than ``compile`` would have: it starts from the scores of
the build, without what an earlier taste added. Guarantees that without such a file nothing is other than
without choices.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from ..cinema.traits import TRAITS
from .project import NAME as PROJECT

NAME = "vds.taste"
#: How many traits are told at most, and how much of one, in log odds a step, is worth telling.
_TOLD, _WORTH_TELLING = 3, 1.5


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


class Learnt(NamedTuple):
    """path: the file it is kept in; choices: from how many shots

    likes: log odds that a step of each trait adds, by its name
    """

    path: Path
    choices: int
    likes: dict[str, float]

    @property
    def words(self) -> tuple[str, ...]:
        """What counts most of it, in words; nothing where all counts little."""
        most = sorted(self.likes, key=lambda name: -abs(self.likes[name]))[:_TOLD]
        some = [name for name in most if abs(self.likes[name]) >= _WORTH_TELLING]
        return tuple(TRAITS[name].more if self.likes[name] > 0 else TRAITS[name].less for name in some)


def learn_taste(scripts: Sequence[Path]) -> Learnt:
    """Learn from the takes chosen for scripts.

    Raises :class:`ranker.RankerError` where nothing is chosen or no build has it, ScriptError for a lock that
    does not read, OSError.
    """
    # Only now: `compile` asks where a taste is before it needs scipy.
    from ranker.taste import Choice, learn, save_taste

    from .picked import picked

    found = [Choice(shot.traits, shot.odds, shot.chosen) for script in scripts for shot in picked(script)]
    path, taste = home_of(scripts[0]), learn(found, tuple(TRAITS))
    save_taste(path, taste)
    return Learnt(path, taste.choices, dict(zip(TRAITS, taste.likes.tolist(), strict=True)))


def digest_of(path: Path) -> str:
    """By which a build says which taste was asked; empty for a file that is not there."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()[:12]
    except OSError:
        return ""
