"""torchvision, made importable beside a CPU-only torch.

PyPI's torchvision brings compiled operators that do not load into a CPU-only torch, and then fails
at import because two operator schemas are missing. They are declared here first where they are
missing; they have no implementation and none is needed for a ResNet.
"""

from __future__ import annotations

import contextlib
from functools import lru_cache
from types import ModuleType
from typing import Any

import torch

_BOX_OPERATORS = ("nms", "qnms")
_SCHEMA = "(Tensor dets, Tensor scores, float iou_threshold) -> Tensor"
_kept: list[Any] = []  # a Library takes its schemas back when it is collected


@lru_cache(maxsize=1)
def torchvision_models() -> ModuleType:
    """The module ``torchvision.models``."""
    with contextlib.suppress(Exception):
        import torchvision  # only to find out whether it works as it is

        return torchvision.models
    library = torch.library.Library("torchvision", "FRAGMENT")
    _kept.append(library)
    for name in _BOX_OPERATORS:
        if not hasattr(torch.ops.torchvision, name):
            library.define(name + _SCHEMA)
    import torchvision

    return torchvision.models
