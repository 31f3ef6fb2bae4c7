"""In which numbers the network computes: told without loading it, since kept scores hang on it."""

from __future__ import annotations

from pathlib import Path

#: Beside the weights: what computing in eight bits needs to know.
INT8 = "int8.json"
#: Flags of processors that multiply eight-bit numbers quickly and without overflow.
_FLAGS = {"avx512_vnni", "avx_vnni"}
_CPU = Path("/proc/cpuinfo")


def has_vnni() -> bool:
    """Whether the processor has such instructions, as far as it tells: on Linux only."""
    try:
        lines = _CPU.read_text("utf-8", "replace").splitlines()
    except OSError:
        return False
    flags = next((line for line in lines if line.startswith("flags")), "")
    return not _FLAGS.isdisjoint(flags.split())


def engine_of(folder: Path, device: str = "cpu") -> str:
    """``int8`` or ``bfloat16``: how the weights in a folder are used on this machine."""
    quick = device != "cuda" and (folder / INT8).exists() and has_vnni()
    return "int8" if quick else "bfloat16"
