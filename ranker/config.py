"""Frozen settings of the model and its training, kept as JSON beside the weights.

``PAPER`` is the recipe of the paper's sections 3.3 and 4.1; ``CPU`` is meant for two cores: small pictures
first, few epochs, fewer frames of a clip.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from typing import Any

from .errors import RankerError

BACKBONES = ("resnet50", "resnet18")
#: Of :attr:`ModelConfig.liking`, where it is taught how well good shots are liked.
LIKING = 1.0
#: Of :attr:`ModelConfig.appealing`, where that is taught as well. Held-out clips come the better in order the
#: more it is (Spearman of 1,008 good ones 0.892 at 3, 0.906 at 12), but of 198 picks hidden among 19,863
#: proposals no fewer are missed: 5 at 3, 6 at 6 and at 12, by the same weights.
APPEALING = 3.0


@dataclass(frozen=True)
class ModelConfig:
    """Shape of the network, and the words its class heads know, in the order of their outputs.

    frames, size: pictures of a shot and their side in pixels, at inference; inner: side to which they are
        scaled for the network
    contrast: length of the vectors of L_q; motion: of what is made of the picture's motion, 0 for none
    moments: whether a frame is described by where in it features are too, and not by how strong alone
    measures, marks: numbers of L_h of a shot, and of a frame, that are read off the features before the heads
        judge, 0 for none
    first_fault, faults: which of the measures, one after the other, say by log odds that a shot has a fault
    guides: width of what is made of guides, 0 for none; meant: whether the frames of these that are meant to
        show the subject are found, and looked at by themselves; people: whether those in a shot are looked at
        one by one; crowd: and how they stand to each other
    liking: what log odds of being liked best count, by which shots are put in order; 0 where that is not
        taught, and those of being good are gone by
    appeal, appealing: which of the measures says how well good ones are composed, and what it counts beside
        the odds of being liked best, in standard deviations; 0 where that is not taught
    """

    movements: tuple[str, ...]
    scales: tuple[str, ...]
    angles: tuple[str, ...]
    backbone: str = "resnet50"
    frames: int = 8
    size: int = 224
    inner: int = 224
    contrast: int = 128
    motion: int = 0
    moments: bool = False
    measures: int = 0
    first_fault: int = 0
    faults: int = 0
    marks: int = 0
    guides: int = 0
    meant: bool = False
    people: bool = False
    crowd: bool = False
    liking: float = 0.0
    appeal: int = 0
    appealing: float = 0.0

    @property
    def of_faults(self) -> slice:
        """Which of the measures are of faults."""
        return slice(self.first_fault, self.first_fault + self.faults)


@dataclass(frozen=True)
class Phase:
    """Some epochs at one picture size; with a size of 0 pictures are left out, and guides alone looked at.

    frames, key_frames: how many of the stored frames the query and the key of L_q see; they never
    share one, so together they are at most all
    share: of the clips that an epoch goes through, others every time; of guides alone, the share of bare ones
    """

    epochs: int
    size: int
    frames: int = 4
    key_frames: int = 4
    batch: int = 128
    share: float = 1.0


@dataclass(frozen=True)
class TrainConfig:
    """How to train. The learning rate warms up over ``warmup`` of all steps and falls on a half cosine, once
    for all phases that look at guides alone, and once for those that look at pictures.

    contrast_weight, class_weight, hint_weight, order_weight: factors of L_q, L_c, L_h and L_o (0 leaves the
        loss out); fault_weight: of faults beside what else is known, in L_h; good_weight: of how good a shot
        is by each criterion, which counts there once more
    dictionary, momentum, temperature: K, the momentum encoder's m and τ of L_q
    motion, moments: as in :class:`ModelConfig`; unmoved: share of the clips whose motion is kept from the
        heads, since a glance at a shot does not have it
    guides: as in :class:`ModelConfig`, for clips that come with them; unguided: share of the clips whose
        guides are kept from the network, so that it can judge by pictures alone
    glanced: share of the batches in which guides are of as few frames as pictures, and motion is not known,
        as at a glance
    graded: how much less than 1 the label of a good clip is that is only just good enough, where clips say
        how good they are
    heads: how many times the clips are gone through, at last, by the heads alone, while what describes a shot
        stays as it is (:mod:`ranker.heads`): of use for weights that were taught by other clips
    anchored: what the weights keep, in the end, of those they began with: both are averaged in that share
        (Wortsman et al. 2022, "Robust fine-tuning"), so that what was learnt before is not lost
    smoothing: label smoothing; held_out: share of the clips, by whole groups, kept for evaluation
    calibration: batches over which batch-norm statistics are taken anew at full size at the end
    autocast: compute in bfloat16 where network and machine allow; augment: mirror, and vary the light
    watched: held-out clips looked at after every epoch, for the curves
    backbone, size, inner: of the model, at inference
    """

    phases: tuple[Phase, ...]
    learning_rate: float = 1e-3
    optimizer: str = "adamw"
    weight_decay: float = 0.05
    warmup: float = 0.1
    class_weight: float = 1.0
    contrast_weight: float = 1.0
    hint_weight: float = 0.0
    order_weight: float = 0.0
    fault_weight: float = 1.0
    good_weight: float = 0.0
    dictionary: int = 6553
    momentum: float = 0.999
    temperature: float = 0.07
    smoothing: float = 0.0
    motion: int = 128
    moments: bool = True
    unmoved: float = 0.3
    guides: int = 256
    unguided: float = 0.3
    glanced: float = 0.25
    graded: float = 0.3
    heads: int = 0
    anchored: float = 0.0
    held_out: float = 0.15
    calibration: int = 40
    autocast: bool = True
    augment: bool = True
    backbone: str = "resnet50"
    size: int = 224
    inner: int = 224
    seed: int = 0
    threads: int = 2
    watched: int = 256


PAPER = TrainConfig(phases=(Phase(epochs=60, size=224, batch=128),))
CPU = TrainConfig(
    phases=(
        Phase(epochs=8, size=0, batch=128, share=0.8),
        Phase(epochs=4, size=64, frames=3, key_frames=1, batch=16),
        Phase(epochs=2, size=96, frames=3, key_frames=1, batch=16),
        Phase(epochs=2, size=128, frames=3, key_frames=1, batch=16),
    ),
    inner=128,
    learning_rate=1e-3,
    momentum=0.99,
    contrast_weight=0.25,
    hint_weight=3.0,
    order_weight=4.0,
    good_weight=0.5,
    unguided=0.5,
    smoothing=0.02,
)
#: For weights that were taught by other clips: only what is told and judged is taught by these.
HEADS = replace(CPU, phases=(), heads=8)
RECIPES = {"paper": PAPER, "cpu": CPU, "heads": HEADS}
#: The trainings of the ablation by the names of their folders: whether L_c and L_q count.
ABLATION = {"b": (False, False), "b+c": (True, False), "b+q": (False, True), "b+c+q": (True, True)}


@dataclass(frozen=True)
class Card:
    """What stands in ``config.json`` beside the weights.

    sha256: of the weights file; training: the recipe; data: where the clips came from; measured: on
    the held-out groups
    """

    model: ModelConfig
    sha256: str
    training: dict[str, Any] = field(default_factory=dict)
    data: dict[str, Any] = field(default_factory=dict)
    measured: dict[str, Any] = field(default_factory=dict)


def to_json(config: ModelConfig | TrainConfig | Card) -> dict[str, Any]:
    """The settings as plain values."""
    return asdict(config)


def model_from_json(values: dict[str, Any]) -> ModelConfig:
    """Read a :class:`ModelConfig`; raises :class:`RankerError` on anything that is not one."""
    try:
        words: dict[str, Any] = {
            k: tuple(str(w) for w in values[k]) for k in ("movements", "scales", "angles")
        }
        rest: dict[str, Any] = {k: int(values[k]) for k in ("frames", "size", "contrast")}
        further = ("motion", "measures", "first_fault", "faults", "marks", "guides", "appeal")
        rest |= {k: int(values.get(k, 0)) for k in further}
        rest["inner"] = int(values.get("inner", rest["size"]))
        rest |= {k: bool(values.get(k, False)) for k in ("moments", "meant", "people", "crowd")}
        rest |= {"backbone": str(values["backbone"]), "liking": float(values.get("liking", 0.0))}
        rest["appealing"] = float(values.get("appealing", 0.0))
        config = ModelConfig(**words, **rest)
    except (KeyError, TypeError, ValueError) as error:
        raise RankerError(f"the ranker's config is not understood: {error!r}") from error
    if config.backbone not in BACKBONES or not all((config.movements, config.scales, config.angles)):
        raise RankerError("the ranker's config is not understood: unknown backbone or no classes")
    if not (
        1 <= config.frames <= 64
        and 16 <= config.inner <= config.size <= 1024
        and 1 <= config.contrast <= 4096
        and 0 <= config.motion <= 4096
        and 0 <= config.measures <= 4096
        and 0 <= config.first_fault <= config.first_fault + config.faults <= config.measures
        and 0 <= config.marks <= 4096
        and 0 <= config.guides <= 4096
        and 0 <= config.liking <= 100
        and 0 <= config.appealing <= 100
        and (config.appealing == 0 or 0 <= config.appeal < config.measures)
    ):
        raise RankerError("the ranker's config is not understood: sizes out of range")
    return config


def train_from_json(values: dict[str, Any]) -> TrainConfig:
    """Read a :class:`TrainConfig` as :func:`to_json` wrote it."""
    try:
        phases = tuple(Phase(**p) for p in values["phases"])
        return TrainConfig(**{**values, "phases": phases})
    except (KeyError, TypeError) as error:
        raise RankerError(f"the training settings are not understood: {error!r}") from error
