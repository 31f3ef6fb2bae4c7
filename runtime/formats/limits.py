"""How large a file of another program may be; beyond it, it is refused before memory is taken for it."""

from __future__ import annotations

MIB = 1024 * 1024
#: Bytes of one file, and of the text part of a glTF.
FILE_BYTES = 64 * MIB
JSON_BYTES = 16 * MIB
#: What a model may declare in all, instances counted.
TRIANGLES = 500_000
VERTICES = 1_000_000
#: Things in a glTF's lists, and how deep its tree goes.
NODES = 10_000
LIST_ITEMS = 50_000
BUFFERS = 8
DEPTH = 128
JOINTS = 512
#: Numbers of one accessor, frames of one motion, seconds of it, and channels of a BVH.
ACCESSOR_ITEMS = 2_000_000
FRAMES = 20_000
SECONDS = 600.0
CHANNELS = 6 * JOINTS
MOTION_NUMBERS = 6_000_000
MOTION_BYTES = 32 * MIB
#: Pixels of one texture, and textures of a model.
IMAGE_PIXELS = 4096 * 4096
IMAGES = 64
#: Triangles that are kept of a thing, a person and a set; denser meshes are simplified.
PROP_TRIANGLES = 20_000
BODY_TRIANGLES = 12_000
SET_TRIANGLES = 120_000
#: Triangles more that a model gets so that its textures can be read.
DETAIL_TRIANGLES = 7_000
#: Metres: nothing in a film is larger or smaller.
LARGEST = 2_000.0
SMALLEST = 0.005
