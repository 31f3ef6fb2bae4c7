"""Shot angles as polar angles θ from +Z (π/2 is eye level)."""

from __future__ import annotations

import math

#: ``rig cinema``: low-angle mirrors high-angle.
CINEMA_THETA = {
    "eye-level": math.pi / 2,
    "high-angle": 2 * math.pi / 5,
    "low-angle": 3 * math.pi / 5,
}
#: ``rig paper``: as printed (section 3.2, Shot Angle).
PAPER_THETA = {
    "eye-level": math.pi / 2,
    "high-angle": 2 * math.pi / 5,
    "low-angle": 4 * math.pi / 5,
}
#: Elevations beyond which a shot looks down or up, radians. Lower for looking up: a camera lifted off
#: the floor still reads as low when it is clearly below what it films.
LOOKS_DOWN, LOOKS_UP = math.radians(8.0), math.radians(-4.0)
