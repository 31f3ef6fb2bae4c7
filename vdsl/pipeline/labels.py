"""What the discriminator is taught to tell apart: classes of movement, size and angle.

The paper has nine movements, three sizes and three angles. Ours are more, and not all of them can be told
by eight small pictures; a class here is what a person can tell by them. What falls between two classes has
none, and counts in no class loss: a hip-level camera looks level and is ``eye-level``; one at the knee is
neither that nor ``low-angle``.
"""

from __future__ import annotations

from ranker.data import Words

from ..lang.ir import MOVEMENT_FAMILIES

#: Movements of their own beside the paper's families. ``rack-focus`` is none: what is judged is drawn sharp.
_FURTHER = ("crane", "roll", "dolly-zoom", "handheld", "whip-pan")
_SIZES = {
    "close-up": ("extreme-close-up", "big-close-up", "close-up", "medium-close-up"),
    "medium": ("medium", "cowboy"),
    "full": ("medium-long", "full"),
    "wide": ("wide", "extreme-wide"),
}
_ANGLES = {
    "eye-level": ("eye-level", "shoulder-level", "hip-level"),
    "high-angle": ("high-angle",),
    "low-angle": ("low-angle", "worms-eye"),
    "overhead": ("overhead",),
}
WORDS = Words((*MOVEMENT_FAMILIES, *_FURTHER), tuple(_SIZES), tuple(_ANGLES))

_FAMILY = {word: name for name, words in MOVEMENT_FAMILIES.items() for word in words}
_FAMILY |= {f"{name}-{way}": name for name in ("crane", "roll", "whip-pan") for way in
            ("up", "down", "left", "right")}  # fmt: skip
_FAMILY |= {"dolly-zoom-in": "dolly-zoom", "dolly-zoom-out": "dolly-zoom", "handheld": "handheld",
            "rack-focus": "static"}  # fmt: skip
_SIZE = {word: name for name, words in _SIZES.items() for word in words}
_ANGLE = {word: name for name, words in _ANGLES.items() for word in words}


def classes(movement: str, scale: str, angle: str) -> tuple[str | None, str | None, str | None]:
    """The classes of a camera's canonical words; None where it is of none, as two movements at once are."""
    parts = [part for part in movement.split("+") if part != "rack-focus"] or ["static"]
    family = _FAMILY.get(parts[0]) if len(parts) == 1 else None
    return family, _SIZE.get(scale), _ANGLE.get(angle)
