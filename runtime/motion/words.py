"""The words of motion: hands, postures, and where hands and eyes may go to.

Plain tuples without numpy, so that the language has them at once.
"""

from __future__ import annotations

#: Places on one's own body a hand may go to.
BODY_PLACES = (
    *("mouth", "ear", "chin", "chest", "hip", "head", "heart", "belly", "eyes", "elbow", "lap", "front"),
    *("knee", "thigh", "shoulder", "neck", "cheek", "forehead", "back"),
)
#: Places on the other person's body, written ``partner.shoulder`` in a reach; for a left hand those on
#: the side that is before it.
PARTNER_PLACES = ("shoulder", "hand", "back", "waist", "head", "cheek", "chest", "elbow", "belly")
#: ``clasp`` is where two people's hands hold each other, ``floor`` the floor before one, ``held`` the thing
#: in the other hand; ``partner`` goes with one of :data:`PARTNER_PLACES`.
REACHABLE = ("target", "second", "meet", "clasp", "floor", "held", "partner", *BODY_PLACES)
#: How a body may be between two shots, and the ones it may be left in besides.
POSTURES = (
    "standing",
    "sitting",
    "kneeling",
    "crouching",
    "lying",
    "floor",
    "one-knee",
    "prone",
    "fours",
    "plank",
)
#: Where eyes may rest: ``partner`` is the other person of the action, ``held`` the thing in the hand.
GAZES = ("target", "second", "partner", "held", "ahead", "down", "up", "aside", "around")
#: Which hand an entry means; resolved when the action is performed.
HANDS = ("left", "right", "near", "other", "holding", "free")
