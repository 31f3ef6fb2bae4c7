"""Reading files that a script or another file names, and only those inside the project's folder."""

from __future__ import annotations

import base64
import binascii
from pathlib import Path
from urllib.parse import unquote

from . import limits
from .errors import ModelFileError


def read_bytes(path: Path, limit: int = limits.FILE_BYTES) -> bytes:
    """A whole file of at most ``limit`` bytes. Anything else, also a pipe or a device, is refused."""
    try:
        if not path.is_file():
            raise ModelFileError(path, "there is no such file" if not path.exists() else "it is not a file")
        size = path.stat().st_size
        if size > limit:
            raise ModelFileError(
                path, f"it has {size / limits.MIB:,.0f} MiB; {limit // limits.MIB} are the most"
            )
        with path.open("rb") as file:
            data = file.read(limit + 1)
    except OSError as error:
        raise ModelFileError(path, f"it cannot be read: {error.strerror or error}") from None
    if not data:
        raise ModelFileError(path, "it is empty")
    return data[:limit]


def beside(path: Path, name: str, folder: Path) -> Path:
    """The file that ``path`` names, inside ``folder``. Raises for addresses, and for what leads elsewhere."""
    if "://" in name or name.startswith(("//", "\\\\", "file:")):
        raise ModelFileError(path, f"it wants {_short(name)} from elsewhere; only files beside it are read")
    try:
        written = Path(unquote(name))
        found = (path.parent / written).resolve()
        inside = not written.is_absolute() and found.is_relative_to(folder.resolve())
    except (OSError, ValueError, RuntimeError):
        raise ModelFileError(path, f"it names {_short(name)}, which is no usable path") from None
    if not inside:
        raise ModelFileError(path, f"it names {_short(name)}, which leaves the project's folder")
    return found


def data_uri(path: Path, uri: str, limit: int = limits.FILE_BYTES) -> bytes | None:
    """The bytes of ``data:…;base64,…``; None for other addresses."""
    if not uri.startswith("data:"):
        return None
    head, comma, body = uri.partition(",")
    if not comma or not head.endswith(";base64") or len(body) > limit * 4 // 3 + 4:
        raise ModelFileError(path, "it holds data that cannot be read: too long, or not base64")
    try:
        return base64.b64decode(body, validate=True)
    except (binascii.Error, ValueError):
        raise ModelFileError(path, "it holds data that cannot be read: not base64") from None


def _short(name: str) -> str:
    return repr(name if len(name) <= 60 else name[:57] + "…")
