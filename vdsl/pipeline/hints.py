"""What the geometry knows of a take, as numbers the discriminator can be taught to see.

A clip that is only called good or bad says little; what makes it so, how far the eyes are off the third, how
much of the face is seen, how fast the camera turns, is known of every drawn take. Assumes a measured camera.
"""

from __future__ import annotations

import numpy as np

from ..cinema.track import camera_axes
from ..propose.types import CameraProposal

#: Measures that are heavy-tailed: their square root is taught.
_LONG = ("jerk", "speed", "angular_speed")


def hints_of(camera: CameraProposal) -> dict[str, float]:
    """Measures and the camera's own motion, by name; names that begin with ``right`` change their sign in a
    mirrored picture.

    Motion is from the first frame to the last: turns in radians, ways as a share of the distance to what is
    aimed at, in the camera's first axes.
    """
    track = camera.track
    found = {k: float(v) for k, v in camera.measures.items()}
    found |= {k: max(found[k], 0.0) ** 0.5 for k in _LONG if k in found}
    distance = np.maximum(np.linalg.norm(track.look_at - track.position, axis=-1), 0.2)
    way = camera_axes(track.rotation[0]) @ (track.position[-1] - track.position[0]) / distance[0]
    turn = track.rotation[-1] - track.rotation[0]
    turned = (turn + np.pi) % (2 * np.pi) - np.pi
    seen = np.log(track.focal / distance)  # how large what is aimed at appears
    found |= {
        "right_way": float(way[0]),
        "up_way": float(way[1]),
        "forward_way": float(way[2]),
        "right_roll": float(track.rotation[:, 0].mean()),
        "right_rolling": float(turned[0]),
        "pitch": float(track.rotation[:, 1].mean()),
        "tilting": float(turned[1]),
        "right_panning": float(-turned[2]),
        "zooming": float(np.log(track.focal[-1] / track.focal[0])),
        "growing": float(seen[-1] - seen[0]),
        "nearness": float(seen.mean()),
        "lens": float(np.log(track.focal.mean())),
        "distance": float(np.log(distance.mean())),
        "unsteady": float(np.abs(np.diff(track.rotation, 2, axis=0)).mean() ** 0.5),
    }
    return {k: round(v, 4) for k, v in sorted(found.items()) if np.isfinite(v)}
