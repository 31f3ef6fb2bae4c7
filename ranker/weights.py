"""Weights on disk: safetensors in half precision with a ``config.json`` beside them.

Nothing that is loaded is ever executed. A missing, damaged or wrong file is a :class:`RankerError`
that names it.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
from pathlib import Path
from typing import Any

import torch
from safetensors import SafetensorError
from safetensors.torch import load, save
from torch import Tensor, nn

from .config import Card, ModelConfig, model_from_json, to_json
from .engine import INT8
from .errors import RankerError
from .int8 import Ranges, layers_of
from .model import ShotRanker

WEIGHTS, CONFIG = "model.safetensors", "config.json"
SHIPPED = Path(__file__).parent / "weights"
SCHEMA = "vds.ranker/1"
INT8_SCHEMA = "vds.ranker-int8/1"
_GO_ON = "; `--rank geometry` goes on without the ranker"
_WITHOUT = "; `vdsc train` writes it anew, and without it the ranker is only slower"


def save_weights(
    folder: str | Path,
    model: ShotRanker,
    *,
    training: dict[str, Any] | None = None,
    data: dict[str, Any] | None = None,
    measured: dict[str, Any] | None = None,
    ranges: Ranges | None = None,
) -> Card:
    """Write ``model.safetensors`` and ``config.json`` into the folder. In float16, but for vectors: they stay
    float32, other than what batch norm learns, which is as coarse as the convolutions it follows.

    ranges: for computing in eight bits, into ``int8.json``; without them one that is there goes
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    norms = (f"{name}." for name, part in model.named_modules() if isinstance(part, nn.BatchNorm2d))
    coarse = {norm + learnt for norm in norms for learnt in ("weight", "bias")}
    tensors = {
        name: (value.half() if value.ndim > 1 or name in coarse else value.float()).cpu().contiguous()
        for name, value in model.state_dict().items()
        if not name.endswith("num_batches_tracked")
    }
    content = save(tensors)
    card = Card(model.config, hashlib.sha256(content).hexdigest(), training or {}, data or {}, measured or {})
    _replace(folder / WEIGHTS, content)
    text = json.dumps({"schema": SCHEMA, **to_json(card)}, indent=1, ensure_ascii=False)
    (folder / INT8).unlink(missing_ok=True)
    _replace(folder / CONFIG, (text + "\n").encode())
    if ranges is not None:
        save_ranges(folder, ranges, card)
    return card


def save_ranges(folder: str | Path, ranges: Ranges, card: Card) -> None:
    """Write ``int8.json`` beside the weights it was measured with."""
    found = {name: [float(f"{end:.6g}") for end in ends] for name, ends in ranges.items()}
    values = {"schema": INT8_SCHEMA, "weights": card.sha256, "ranges": found}
    _replace(Path(folder) / INT8, (json.dumps(values, indent=1) + "\n").encode())


def load_ranges(folder: str | Path | None, model: ShotRanker, card: Card) -> Ranges | None:
    """What computing in eight bits needs of these weights; None where it was never measured."""
    path = Path(folder or SHIPPED) / INT8
    try:
        values = json.loads(path.read_text("utf-8"))
        if values["schema"] != INT8_SCHEMA:
            raise ValueError
        if values["weights"] != card.sha256:
            raise RankerError(f"{path}: was measured with other weights{_WITHOUT}")
        ranges = {name: (float(low), float(high)) for name, (low, high) in values["ranges"].items()}
        fit = all(-math.inf < low <= 0 < high < math.inf for low, high in ranges.values())
        if not fit or list(ranges) != layers_of(model.backbone):
            raise ValueError
        return ranges
    except FileNotFoundError:
        return None
    except OSError as error:
        raise RankerError(f"{path}: cannot be read: {error.strerror or error}{_WITHOUT}") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise RankerError(f"{path}: is damaged, or not of this model{_WITHOUT}") from error


def load_card(folder: str | Path | None = None) -> Card:
    """Read ``config.json``: what the weights are and how they came about."""
    path = Path(folder or SHIPPED) / CONFIG
    try:
        values = json.loads(path.read_text("utf-8"))
        if values["schema"] != SCHEMA:
            raise RankerError(f"{path}: is not a ranker's config ({SCHEMA}){_GO_ON}")
        extra = {k: dict(values.get(k) or {}) for k in ("training", "data", "measured")}
        return Card(model_from_json(values["model"]), str(values["sha256"]), **extra)
    except OSError as error:
        raise RankerError(f"{path}: cannot be read: {error.strerror or error}{_GO_ON}") from error
    except RankerError as error:
        raise RankerError(f"{path}: {error}{'' if _GO_ON in str(error) else _GO_ON}") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise RankerError(f"{path}: is damaged or not a ranker's config{_GO_ON}") from error


def load_tensors(folder: str | Path | None = None) -> tuple[dict[str, Tensor], Card]:
    """The weights themselves in float32, by name, of whatever shape of network they are; and their card."""
    folder = Path(folder or SHIPPED)
    card = load_card(folder)
    path = folder / WEIGHTS
    try:
        content = path.read_bytes()
    except OSError as error:
        raise RankerError(f"{path}: cannot be read: {error.strerror or error}{_GO_ON}") from error
    if hashlib.sha256(content).hexdigest() != card.sha256:
        raise RankerError(f"{path}: is damaged, or not the file its {CONFIG} describes{_GO_ON}")
    try:
        return {k: v.float() for k, v in load(content).items()}, card
    except (SafetensorError, ValueError, KeyError) as error:
        raise RankerError(f"{path}: does not hold weights of this model{_GO_ON}") from error


def load_model(folder: str | Path | None = None) -> tuple[ShotRanker, Card]:
    """The model with its weights in float32, in evaluation mode; the shipped one without a folder."""
    tensors, card = load_tensors(folder)
    path = Path(folder or SHIPPED) / WEIGHTS
    try:
        model = _empty_model(card.model)
        missing, unexpected = model.load_state_dict(tensors, strict=False, assign=True)
    except (RuntimeError, ValueError, KeyError) as error:
        raise RankerError(f"{path}: does not hold weights of this model{_GO_ON}") from error
    lacking = [name for name in missing if not name.endswith("num_batches_tracked")]
    if lacking or unexpected:
        raise RankerError(f"{path}: does not hold weights of this model{_GO_ON}")
    for name, buffer in list(model.named_buffers()):
        if name.endswith("num_batches_tracked"):
            parent = model.get_submodule(name.rsplit(".", 1)[0])
            parent.register_buffer("num_batches_tracked", torch.zeros_like(buffer, device="cpu"))
    return model.eval(), card


def _empty_model(config: ModelConfig) -> ShotRanker:
    """The network without memory behind its weights: filling them at random would take a second."""
    with torch.device("meta"):
        return ShotRanker(config)


def _replace(path: Path, content: bytes) -> None:
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        part.write_bytes(content)
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise RankerError(f"{path}: cannot be written: {error.strerror or error}") from error
