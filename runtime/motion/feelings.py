"""What a feeling does to face and bearing, as numbers: the words `feeling …` knows.

Pure data without numpy, so that the language may read the words. :mod:`runtime.motion.face` lays an
expression over the face, :mod:`runtime.motion.acting` over head, shoulders and back.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Expression:
    """One feeling at full strength.

    brow: whole brows up (-1 .. 1); inner: their inner ends up, on top of that; knit: drawn together 0..1
    lid: upper lids, share of closing (negative: torn open); squint: lower lids up 0..1 (negative: down)
    smile: corners of the mouth up (-1 .. 1); wide: apart (negative: pursed); sneer: upper lip up 0..1
    jaw: open 0..1, on top of talking (negative: pressed shut)
    nod: chin down, tilt: head to the left, lean: body forward, shoulders up and forward, all radians
    breath: how fast and deep one breathes against calm
    """

    brow: float = 0.0
    inner: float = 0.0
    knit: float = 0.0
    lid: float = 0.0
    squint: float = 0.0
    smile: float = 0.0
    wide: float = 0.0
    sneer: float = 0.0
    jaw: float = 0.0
    nod: float = 0.0
    tilt: float = 0.0
    lean: float = 0.0
    shoulders: float = 0.0
    rounded: float = 0.0
    breath: float = 1.0


FEELINGS: dict[str, Expression] = {
    "neutral": Expression(),
    "happy": Expression(
        brow=0.30, squint=0.75, smile=1.0, wide=0.8, sneer=0.35, jaw=0.12,
        nod=-0.05, tilt=0.05, lean=-0.03, shoulders=0.03, rounded=-0.06, breath=1.1,
    ),
    "sad": Expression(
        brow=-0.15, inner=1.0, knit=0.5, lid=0.34, smile=-1.0, wide=0.05, jaw=-0.10,
        nod=0.20, tilt=0.08, lean=0.09, shoulders=-0.04, rounded=0.20, breath=0.85,
    ),
    "angry": Expression(
        brow=-0.55, inner=-0.9, knit=1.0, lid=0.05, squint=0.45, smile=-0.50, wide=-0.15, sneer=0.30,
        jaw=0.05, nod=0.10, lean=0.08, shoulders=0.07, rounded=-0.04, breath=1.35,
    ),
    "afraid": Expression(
        brow=0.75, inner=0.75, knit=0.6, lid=-0.32, squint=-0.3, smile=-0.55, wide=0.55, jaw=0.22,
        nod=-0.04, lean=-0.09, shoulders=0.16, rounded=0.14, breath=1.7,
    ),
    "surprised": Expression(
        brow=1.0, inner=0.10, lid=-0.38, squint=-0.4, wide=-0.55, jaw=0.70,
        nod=-0.08, lean=-0.06, shoulders=0.06, breath=1.2,
    ),
    "disgusted": Expression(
        brow=-0.35, inner=-0.25, knit=0.55, lid=0.22, squint=0.7, smile=-0.65, wide=0.15, sneer=0.75,
        jaw=-0.15, nod=-0.06, tilt=-0.10, lean=-0.07, shoulders=0.05, rounded=0.04,
    ),
}  # fmt: skip
