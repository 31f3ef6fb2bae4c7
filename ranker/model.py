"""The shot ranking discriminator: a temporal segment network over a few frames of a shot.

Every frame goes through the same ResNet; what comes out is fused over time at the end (paper,
section 3.3). The fusion is TSN's average consensus and, beside it, the slope and the spread of the
features over time: an average alone cannot tell a pan to the left from one to the right. How well a picture
is composed hangs on where things are in it, which the average over the picture of a ResNet forgets; so its
first moments go along (:class:`Pool`). What single frames do not show, how the picture moves as a whole,
comes in as numbers (:mod:`ranker.motion`), or better from the guides of whoever draws the pictures, which
say who is where in them as well (:mod:`ranker.guides`). And where clips come with what is known of them in
numbers (L_h), of the shot and of each frame, those are told first and judged by (a concept bottleneck, Koh et
al. 2020, with the features beside it).
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional

from .composed import fuse
from .config import ModelConfig
from .engine import quick_bfloat16
from .guided import Description, Guided, GuideNet
from .guides import pairs
from .losses import STEP_ODDS, STEPS
from .motion import NUMBERS
from .vision import torchvision_models

#: Of sRGB in 0..1, by channel, as ResNets are used to.
PIXEL_MEAN = (0.485, 0.456, 0.406)
PIXEL_STD = (0.229, 0.224, 0.225)
#: How the names of parameters begin that only guides pass through.
OF_GUIDES = (
    *("guided.", "gathered.", "judged.", "straight.", "reader_guided.", "marker_guided."),
    "reasons_guided.",
    "faults_guided",
)


class Output(NamedTuple):
    """What the network says of B shots.

    logit [B], of p_b; liked [B, steps], log odds of being liked better than each of
    :data:`ranker.losses.STEPS`; movement, scale, angle [B, classes], logits of p_c; feature [B, D], the
    average of the frames' features; contrast [B, C], unit vectors z of L_q; told [B, measures], what is read
    off the features of the numbers of L_h; marked [B, T, marks], the same of single frames; mapped [B, T,
    marks], what is told of frames by their guides; meant [B, T], by these, log odds that a frame is meant to
    show the subject, [B, 0] where that is not asked
    """

    logit: Tensor
    liked: Tensor
    movement: Tensor
    scale: Tensor
    angle: Tensor
    feature: Tensor
    contrast: Tensor
    told: Tensor
    marked: Tensor
    mapped: Tensor
    meant: Tensor


class _Judgement(NamedTuple):
    """judged [B, judgements]: logit, steps of liking, classes, one after the other; told [B, measures]
    and marked [B, T, marks], what that is said by; meant: as in :class:`Output`"""

    judged: Tensor
    told: Tensor
    marked: Tensor
    meant: Tensor


class Pool(nn.Module):
    """The average of feature maps [N, D, H, W] over the picture, and with ``moments`` their first moments.

    Returns float32 [N, D], or [N, 3 D]: average, average times place to the right, to the bottom; places
    run from -1 to 1, so that they mean the same at any size.
    """

    def __init__(self, moments: bool) -> None:
        super().__init__()
        self.moments = moments

    def forward(self, maps: Tensor) -> Tensor:
        columns = maps.float().mean(2)
        average = columns.mean(2)
        if not self.moments:
            return average
        rows = maps.float().mean(3)
        right, down = ((line * _places(line)).mean(2) for line in (columns, rows))
        return torch.cat([average, right, down], 1)


def _places(line: Tensor) -> Tensor:
    count = line.shape[2]
    return (torch.arange(count, device=line.device, dtype=line.dtype) + 0.5) * 2 / count - 1


class ShotRanker(nn.Module):
    """Backbone, fusion and heads. Untrained until weights are loaded; built without any download."""

    def __init__(self, config: ModelConfig) -> None:
        super().__init__()
        self.config = config
        backbone = getattr(torchvision_models(), config.backbone)(weights=None, zero_init_residual=True)
        width = backbone.fc.in_features
        backbone.avgpool, backbone.fc = Pool(config.moments), nn.Identity()
        self.backbone: nn.Module = backbone
        self.width = width
        #: Numbers that describe a frame: [N, described] is what the backbone makes of N frames.
        self.described = width * (3 if config.moments else 1)
        sizes = (len(config.movements), len(config.scales), len(config.angles))
        #: How many numbers each judgement has: log odds of being good, steps of liking, classes.
        self.judgements = (1, len(STEPS), *sizes)
        fused, judgements = 3 * self.described, sum(self.judgements)
        self.professional, self.liked = nn.Linear(fused, 1), nn.Linear(fused, len(STEPS))
        nn.init.zeros_(self.liked.weight)  # of sets without opinions it learns nothing
        self.movement, self.scale, self.angle = (nn.Linear(fused, n) for n in sizes)
        self.contrast = nn.Sequential(nn.Linear(width, 256), nn.ReLU(), nn.Linear(256, config.contrast))
        self.motion: nn.Module | None = None
        if config.motion:
            numbers = NUMBERS * len(pairs(config.frames))
            hidden = nn.Sequential(nn.Linear(numbers, 256), nn.ReLU(), nn.Dropout(0.35))
            self.motion = nn.Sequential(*hidden, nn.Linear(256, config.motion), nn.ReLU(), nn.Dropout(0.35))
            self.professional_moved = nn.Linear(config.motion, 1 + len(STEPS), bias=False)
            self.movement_moved = nn.Linear(config.motion, len(config.movements), bias=False)
        self.reader: nn.Module | None = None
        if config.measures:
            self.reader = nn.Linear(fused, config.measures)
            if config.motion:
                self.reader_moved = nn.Linear(config.motion, config.measures, bias=False)
            if config.marks:
                self.marker = nn.Linear(self.described, config.marks)
            self.reasons = _reasons(config, judgements)
            #: How much each fault counts: some are not seen well, and some come together.
            self.faults = nn.Parameter(torch.ones(config.faults))
        self.guided: GuideNet | None = None
        if config.guides:
            self.guided = GuideNet(config.frames, config.meant, config.people, config.crowd)
            wide = 2 * config.guides
            gathered = nn.Sequential(nn.Linear(self.guided.shot, wide), nn.ReLU(), nn.Dropout(0.1))
            last = nn.Sequential(nn.Linear(wide, config.guides), nn.ReLU(), nn.Dropout(0.1))
            self.gathered = nn.Sequential(*gathered, *last)
            self.judged = nn.Linear(config.guides, judgements)
            # Much of film grammar is a weighted sum of what is known already.
            self.straight = nn.Linear(self.guided.shot, judgements + config.measures, bias=False)
            nn.init.zeros_(self.straight.weight)
            # What pictures add where guides are known: nothing, until that has proved to be of use.
            self.trusted = nn.Parameter(torch.zeros(judgements))
            if config.measures:
                self.reader_guided = nn.Linear(config.guides, config.measures)
                self.reasons_guided = _reasons(config, judgements)
                self.faults_guided = nn.Parameter(torch.ones(config.faults))
            if config.marks:
                self.marker_guided = nn.Linear(self.guided.frame, config.marks)

    def forward(
        self,
        frames: Tensor | None,
        times: Tensor,
        moved: Tensor | None = None,
        guides: Guided | None = None,
    ) -> Output:
        """Judge shots: ``frames`` [B, T, 3, H, W] as :func:`normalised`, ``times`` [B, T] in 0..1.

        moved: their motion [B, pairs, NUMBERS]; NaN, or None for all, where that is not known
        guides: theirs, or None; frames: None to judge by these alone
        """
        batch, count = times.shape
        if frames is None:
            nothing = torch.zeros((), device=times.device).expand(batch, count, self.described)
            return self.judge(nothing, times, moved, guides, pictures=False)
        flat = frames.flatten(0, 1).contiguous(memory_format=torch.channels_last)
        features = self.backbone(flat).float().view(batch, count, self.described)
        return self.judge(features, times, moved, guides)

    def judge(
        self,
        features: Tensor,
        times: Tensor,
        moved: Tensor | None = None,
        guides: Guided | None = None,
        pictures: bool = True,
    ) -> Output:
        """The heads over what describes single frames [B, T, described], in float32.

        pictures: whether there were any, and not features of nothing
        """
        with torch.autocast(features.device.type, enabled=False):
            average = features[:, :, : self.width].mean(1)
            shown = self._by_pictures(features, times, moved, pictures)
            judged, told, mapped = shown.judged, shown.told, features.new_zeros(*features.shape[:2], 0)
            meant = shown.meant
            if self.guided is not None and guides is not None:
                by_guides = self._by_guides(self.guided, guides)
                known, mapped, meant = guides.known.unsqueeze(1), by_guides.marked, by_guides.meant
                both = by_guides.judged + self.trusted * judged if pictures else by_guides.judged
                judged = torch.where(known, both, judged)
                told = torch.where(known, by_guides.told, told)
            professional, liked, movement, scale, angle = judged.split(self.judgements, 1)
            contrast = functional.normalize(self.contrast(average), dim=1)
            classes = (movement, scale, angle)
            logit = professional.squeeze(1)
            return Output(logit, liked, *classes, average, contrast, told, shown.marked, mapped, meant)

    def _by_pictures(
        self, features: Tensor, times: Tensor, moved: Tensor | None, pictures: bool
    ) -> _Judgement:
        """What is said of shots by features of their pictures and how these move."""
        batch, count = times.shape
        judged, told = features.new_zeros(batch, sum(self.judgements)), features.new_zeros(batch, 0)
        fused = fuse(features, times) if pictures else features.new_zeros(batch, 0)
        marked = features.new_zeros(batch, count, self.config.marks)
        if pictures:
            heads = (self.professional, self.liked, self.movement, self.scale, self.angle)
            judged = torch.cat([head(fused) for head in heads], 1)
        seen = self._seen(moved)
        if seen is not None:
            more = torch.cat([self.professional_moved(seen), self.movement_moved(seen)], 1)
            judged = judged + functional.pad(more, (0, judged.shape[1] - more.shape[1]))
        if self.reader is not None:
            told = self.reader(fused) if pictures else features.new_zeros(batch, self.config.measures)
            if seen is not None:
                told = told + self.reader_moved(seen)
            if self.config.marks and pictures:
                marked = self.marker(features)
            judged = judged + self.reasons(torch.cat([told, self.over_time(marked, times)], 1))
            judged = self._faultless(judged, told, self.faults)
        return _Judgement(judged, told, marked, judged[:, :0])

    def _by_guides(self, guided: GuideNet, guides: Guided) -> _Judgement:
        """What is said of shots by their guides."""
        kind = guides.maps.device.type
        with torch.autocast(kind, torch.bfloat16, enabled=self.training and quick_bfloat16(kind)):
            described: Description = guided(guides)
        frames, shot = described.frames, described.shot
        gathered = self.gathered(shot)
        judged, told = self.straight(shot).split((sum(self.judgements), self.config.measures), 1)
        judged = judged + self.judged(gathered)
        marked = frames.new_zeros(*frames.shape[:2], self.config.marks)
        if self.config.measures:
            told = told + self.reader_guided(gathered)
            if self.config.marks:
                marked = self.marker_guided(frames)
            judged = self.by_reasons(judged, told, self.over_time(marked, guides.times))
        return _Judgement(judged, told, marked, described.meant)

    def by_reasons(self, judged: Tensor, told: Tensor, marked: Tensor) -> Tensor:
        """Judgements [B, judgements] by guides, with what is told of shots [B, measures] and of frames, over
        their time [B, 3 marks]."""
        judged = judged + self.reasons_guided(torch.cat([told, marked], 1))
        return self._faultless(judged, told, self.faults_guided)

    def _faultless(self, judged: Tensor, told: Tensor, counts: Tensor) -> Tensor:
        """Judgements of which those of being good and of being liked hold only for a shot without faults.

        One fault is enough, whatever else is good: P = P(no fault) P(good but for faults), where a sum of log
        odds would weigh them up (noisy-or, Pearl 1988).
        """
        if not self.config.faults:
            return judged
        faults = told[:, self.config.of_faults]
        free = (counts.clamp_min(0) * functional.logsigmoid(-faults)).sum(1, keepdim=True)
        count = 1 + len(STEPS)
        both = (free + functional.logsigmoid(judged[:, :count])).clamp_max(-1e-6)
        return torch.cat([both - (-both.expm1()).log(), judged[:, count:]], 1)

    def over_time(self, marked: Tensor, times: Tensor) -> Tensor:
        """What is told of frames [B, T, marks], over their time: [B, 3 marks]."""
        return fuse(marked, times) if self.config.marks else marked.flatten(1)

    def margin(self, out: Output) -> Tensor:
        """What shots are put in order by, [B]: how much greater than those of an average good one the odds
        are that they are among the best liked, above the highest step, and how well they seem composed; where
        liking is not taught, log odds of being good.

        Who looks for the best of many asks for this alone: that one is rather good than bad is said by it
        too, and sums of the two found fewer of the best.
        """
        if not self.config.liking:
            return out.logit
        liked = self.config.liking * (out.liked[:, -1] - STEP_ODDS[-1])
        if not self.config.appealing:
            return liked
        return liked + self.config.appealing * out.told[:, self.config.appeal]

    def _seen(self, moved: Tensor | None) -> Tensor | None:
        """What is made of the motion of shots; zeros where it is not known."""
        if self.motion is None or moved is None:
            return None
        known = moved.isfinite().flatten(1).all(1, keepdim=True)
        return self.motion(moved.nan_to_num().flatten(1)) * known


def _reasons(config: ModelConfig, judgements: int) -> nn.Module:
    """From what is told of shots to what is judged of them."""
    known = config.measures + 3 * config.marks
    steps = nn.Sequential(nn.Linear(known, 128), nn.ReLU(), nn.Dropout(0.2))
    return nn.Sequential(*steps, nn.Linear(128, judgements))


def normalised(frames: Tensor) -> Tensor:
    """uint8 [..., H, W, 3] sRGB -> float32 [..., 3, H, W] as ResNets are used to."""
    mean = torch.tensor(PIXEL_MEAN, device=frames.device) * 255
    std = torch.tensor(PIXEL_STD, device=frames.device) * 255
    return ((frames.float() - mean) / std).movedim(-1, -3)


def frame_times(config: ModelConfig) -> Tensor:
    """Places of a shot's stored frames in its time, 0..1, float32 [frames]."""
    return torch.linspace(0, 1, config.frames) if config.frames > 1 else torch.zeros(1)
