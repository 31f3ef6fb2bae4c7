"""The words for materials, and the numbers they have in meshes and pictures."""

from __future__ import annotations

#: Procedural surface patterns, evaluated by the rasteriser in world space. The index is what
#: :attr:`runtime.mesh.Mesh.materials` holds.
MATERIALS = (
    "plain",
    "wood",  # planks along X
    "tile",
    "brick",
    "grass",
    "asphalt",
    "cloth",
    "glass",  # drawn pale and bright, never shadowed
    "glow",  # emits: lamps, screens
    "carpet",
    "concrete",
    "plaster",
    "water",  # slow swells under a web of light
    "sand",
    "stone",  # hewn blocks in a wall, flags on a floor
    "metal",
    "leaves",
    "snow",
    "earth",
    "marble",
    "cobble",
    "parquet",
    "plate",  # sheets of metal with seams
)

#: The number of glass before which it is night: dark whatever lies behind it, and kept as dark as it is said
#: to be. Nothing is made of it by word.
NIGHT_GLASS = len(MATERIALS)

#: The number of skin that no light reaches, below the jaw and the nose, which paper has in strokes; nor is
#: this said in a script. Bodies call it ``shade``.
SKIN_SHADE = NIGHT_GLASS + 1
LAST = SKIN_SHADE


def number_of(word: str) -> int:
    """The number of a material, or of what bodies are made of besides. Raises ValueError."""
    return SKIN_SHADE if word == "shade" else MATERIALS.index(word)
