"""In which numbers the network computes: told without loading it, since kept scores hang on it.

Which are quick hangs on the processor: a wrong choice costs a factor of two, and bfloat16 on a processor that
has to take it apart one of hundreds.
"""

from __future__ import annotations

from pathlib import Path

#: Beside the weights: what computing in eight bits needs to know.
INT8 = "int8.json"
#: Flags of processors that multiply eight-bit numbers quickly and without overflow.
_EXACT = {"avx512_vnni", "avx_vnni"}
#: Of those that do so in pairs, whose sum has to fit into sixteen bits.
_PAIRS = {"avx2", "avx512bw"}
#: Of those on which bfloat16 is not slower than float32.
_BFLOAT16 = {"avx512bw", "avx512_bf16", "amx_bf16"}
_CPU = Path("/proc/cpuinfo")
#: Largest weight of an engine in whole numbers. Two products with 255 stay within sixteen bits up to 64.
HIGHEST = {"int8": 127, "int7": 64}


def engine_for(device: str, ranges: bool) -> str:
    """``int8``, ``int7`` (weights are of seven bits), ``bfloat16`` or ``float32``: quickest on this machine.

    device: ``cpu`` or ``cuda``; ranges: whether it is known what computing in whole numbers needs
    """
    if device == "cuda":
        return "bfloat16"
    flags = _flags()
    if ranges and not _EXACT.isdisjoint(flags):
        return "int8"
    if ranges and not _PAIRS.isdisjoint(flags):
        return "int7"
    return "float32" if _BFLOAT16.isdisjoint(flags) else "bfloat16"


def engine_of(folder: Path, device: str = "cpu") -> str:
    """How the weights in a folder are used on this machine."""
    return engine_for(device, (folder / INT8).exists())


def quick_bfloat16(device: str) -> bool:
    """Whether training in bfloat16 is worth it."""
    return engine_for(device, False) == "bfloat16"


def _flags() -> set[str]:
    """What the processor can do, as far as it tells: on Linux only."""
    try:
        lines = _CPU.read_text("utf-8", "replace").splitlines()
    except OSError:
        return set()
    return set(next((line for line in lines if line.startswith("flags")), "").split())
