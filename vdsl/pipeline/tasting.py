"""What a writer's choices teach the discriminator, kept in the project as ``vds.taste``.

Assumes scripts with a lock and a build that holds the chosen takes and the others. What is learnt is why
somebody chose another take than ``compile`` would have: it starts from the scores of the build. Guarantees
that without such a file nothing is other than without choices.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from ..cinema.traits import TRAITS
from .project import NAME as PROJECT

NAME = "vds.taste"
#: How many traits are told at most, and how much of one, in log odds a step, is worth telling.
_TOLD, _COUNTS = 4, 1.0


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
        some = [name for name in most if abs(self.likes[name]) >= _COUNTS]
        return tuple(TRAITS[name].more if self.likes[name] > 0 else TRAITS[name].less for name in some)


def learn_taste(scripts: Sequence[Path], weights: Path | None = None, device: str = "auto") -> Learnt:
    """Learn from the takes chosen for scripts.

    Raises :class:`ranker.RankerError` where nothing is chosen or no build has it, ScriptError for a lock that
    does not read, OSError.
    """
    # Only now: `compile` asks where a taste is before it needs torch.
    from ranker.errors import RankerError
    from ranker.infer import Ranker
    from ranker.taste import Choice, learn, load_taste, save_taste
    from ranker.weights import load_card

    from .filming import SEGMENTS
    from .realclips import preferences

    found = []
    ranker, digest = Ranker.load(weights, device if device in ("cpu", "cuda") else "auto"), None
    ranker.fits(SEGMENTS)
    card, path, names = load_card(weights), home_of(scripts[0]), tuple(TRAITS)
    with suppress(RankerError):  # none yet, or another's: builds were not put in order by such
        before, digest = load_taste(path, names, card.sha256), digest_of(path)
    for script in scripts:
        for liked in preferences(script, ranker.config.size):
            feature = ranker.score(liked.frames).feature
            # What was learnt before is learnt anew, not on top.
            known = digest is not None and liked.taste == digest
            again = before.adds(liked.traits, feature) if known else 0.0
            found.append(Choice(feature, liked.traits, liked.odds - again, liked.chosen))
    taste = learn(found, names, card.sha256)
    save_taste(path, taste)
    likes = {name: round(float(like), 3) for name, like in zip(names, taste.likes, strict=True)}
    return Learnt(path, taste.choices, likes)


def digest_of(path: Path) -> str:
    """By which a build says which taste was asked; empty for a file that is not there."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()[:12]
    except OSError:
        return ""
