"""``report.json``: how long the run took, on what, with which versions (docs/output.md)."""

from __future__ import annotations

import os
import platform
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from .documents import rounded, write_document
from .types import RunReport

SCHEMA = "vds.report/1"
PACKAGES = ("vdsl", "numpy", "taichi", "torch", "torchvision", "av", "opencv-python-headless", "pillow")


def write_report(path: Path, report: RunReport) -> None:
    """Write the document."""
    write_document(path, report_document(report))


def report_document(report: RunReport) -> dict[str, Any]:
    """The document as plain values."""
    return {
        "schema": SCHEMA,
        "finished": datetime.now(timezone.utc).isoformat(timespec="seconds"),
        "seconds": rounded(report.seconds, 3),
        "stages": [
            {
                "name": s.name,
                "seconds": rounded(s.seconds, 3),
                "count": s.count,
                "unit": s.unit,
                "per_second": rounded(s.count / s.seconds, 2) if s.seconds > 0 else None,
            }
            for s in report.stages
        ],
        "cache": {"hits": report.cache_hits, "misses": report.cache_misses},
        "peak_mib": rounded(report.peak_mib, 1),
        "machine": {
            "device": report.device,
            "system": platform.system(),
            "processor": platform.machine(),
            "cores": os.cpu_count() or 1,
        },
        "versions": {"python": platform.python_version(), **{name: _version(name) for name in PACKAGES}},
        "notes": list(report.notes),
        "options": dict(report.options),
    }


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None
