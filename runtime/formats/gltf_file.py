"""glTF files as far as they can be judged without decoding a number: containers, lists, references, sizes.

Assumes nothing about the file. Guarantees of what :func:`read_gltf_file` returns: every index the rest of
this package follows leads somewhere, every accessor lies inside its buffer, the node tree is a tree, and all
counts are within :mod:`.limits`. The standard library alone is used, so that a script is checked at once.
"""

from __future__ import annotations

import json
import re
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from . import limits
from .errors import ModelFileError
from .gltf_rules import Checker
from .paths import beside, data_uri, read_bytes


@dataclass(frozen=True, eq=False)
class GltfFile:
    """A checked glTF.

    document: the JSON part; text: as written; buffers: the bytes of each buffer
    """

    path: Path
    document: dict[str, Any]
    text: str
    buffers: tuple[bytes, ...]

    def named(self, kind: str) -> list[str]:
        """Names of the items of a list, ``""`` where one has none."""
        return [str(item.get("name") or "") for item in self.document.get(kind, [])]

    def shown(self) -> list[int]:
        """Nodes of the scene that is shown, parents first."""
        nodes = self.document.get("nodes") or []
        scenes = self.document.get("scenes") or []
        if scenes:
            waiting = list(scenes[self.document.get("scene") or 0].get("nodes") or [])
        else:
            inside = {child for node in nodes for child in node.get("children") or []}
            waiting = [i for i in range(len(nodes)) if i not in inside]
        found: dict[int, None] = {}
        while waiting:
            i = waiting.pop(0)
            if i not in found:
                found[i] = None
                waiting[:0] = nodes[i].get("children") or []
        return list(found)

    def things(self) -> dict[int, str]:
        """Shown nodes with a mesh, and a name of its own for each, as the language may say it."""
        nodes, meshes = self.document.get("nodes") or [], self.named("meshes")
        shown = [i for i in self.shown() if nodes[i].get("mesh") is not None]
        names = [str(nodes[i].get("name") or meshes[nodes[i]["mesh"]] or "") for i in shown]
        return dict(zip(shown, words(names), strict=True))

    def clips(self) -> tuple[str, ...]:
        """Names of its motions; one without is called clip_1, clip_2 …"""
        return tuple(name or f"clip_{i + 1}" for i, name in enumerate(self.named("animations")))


def words(names: list[str]) -> list[str]:
    """Names as the language may say them, each its own: letters, digits, ``_`` and ``-``, lower case."""
    count: dict[str, int] = {}
    out = []
    for name in names:
        word = re.sub(r"[^\w-]+", "_", name).strip("_-").lower()[:60] or "part"
        word = word if not word[0].isdigit() else f"part_{word}"
        count[word] = times = count.get(word, 0) + 1
        out.append(word if times == 1 else f"{word}_{times}")
    return out


def read_gltf_file(path: Path, folder: Path) -> GltfFile:
    """A .glb or .gltf and the buffers it names inside ``folder``."""
    data = read_bytes(path)
    text, binary = _glb(path, data) if path.suffix.lower() == ".glb" else (data, None)
    document = _json(path, text)
    checker = Checker(path, document)
    checker.lists()
    buffers = tuple(
        _buffer(path, b, i, binary, folder, checker) for i, b in enumerate(checker.items("buffers"))
    )
    checker.run()
    return GltfFile(path, document, text.decode("utf-8"), buffers)


def _glb(path: Path, data: bytes) -> tuple[bytes, bytes | None]:
    """The JSON chunk and the binary chunk."""
    if len(data) < 20 or data[:4] != b"glTF":
        raise ModelFileError(path, "it is no .glb file: the first bytes are not `glTF`")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise ModelFileError(path, f"it is glTF version {version}; version 2 is read")
    if length > len(data):
        raise ModelFileError(path, f"it is cut off: {length:,} bytes are declared, {len(data):,} are there")
    chunks: dict[int, bytes] = {}
    at = 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<II", data, at)
        at += 8
        if size > length - at:
            raise ModelFileError(path, "it is cut off: a part of it is longer than the file")
        chunks.setdefault(kind, data[at : at + size])
        at += size
    if 0x4E4F534A not in chunks:
        raise ModelFileError(path, "it has no description of what is in it")
    return chunks[0x4E4F534A], chunks.get(0x004E4942)


def _json(path: Path, text: bytes) -> dict[str, Any]:
    if len(text) > limits.JSON_BYTES:
        raise ModelFileError(path, f"its description is larger than {limits.JSON_BYTES // limits.MIB} MiB")

    def no_number(word: str) -> NoReturn:
        raise ModelFileError(path, f"its description has {word} for a number")

    try:
        document = json.loads(text.decode("utf-8"), parse_constant=no_number)
    except (ValueError, RecursionError):
        raise ModelFileError(path, "its description cannot be read: not JSON") from None
    asset = document.get("asset") if isinstance(document, dict) else None
    if not isinstance(asset, dict) or not str(asset.get("version", "")).startswith("2"):
        raise ModelFileError(path, "it is no glTF of version 2")
    return dict(document)


def _buffer(
    path: Path, buffer: dict[str, Any], index: int, binary: bytes | None, folder: Path, checker: Checker
) -> bytes:
    length = checker.count(buffer, "byteLength", "a buffer", limits.FILE_BYTES)
    uri = buffer.get("uri")
    if uri is None:
        data = binary if index == 0 and binary is not None else b""
    elif not isinstance(uri, str):
        checker.fail("a buffer's address is no text")
    else:
        inline = data_uri(path, uri)
        data = inline if inline is not None else read_bytes(beside(path, uri, folder))
    if len(data) < length:
        checker.fail(f"it is cut off: a buffer of {length:,} bytes has {len(data):,}")
    return data
