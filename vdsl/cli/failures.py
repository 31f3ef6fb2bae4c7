"""Everything that can go wrong while a command works, as an exit code and one line a person can act on."""

from __future__ import annotations

import errno
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import typer

from ranker.errors import RankerError
from runtime.raster.device import DeviceError

from ..pipeline.script import ScriptError
from .check import MACHINE, WRONG, stop
from .show import print_report

INTERRUPTED = 130
_KEPT = "the last good build is as it was"
#: For work that goes on where it was when it is begun again.
RESUMED = "start again to go on from what is there"


@contextmanager
def failures_told(file: Path, format: str = "text", kept: str = _KEPT) -> Iterator[None]:
    """Turn what the block raises into a message and an exit code (1, 3 or 130).

    kept: what is left where the block does not come to its end
    """
    try:
        yield
    except ScriptError as error:
        print_report(error.report, format, str(file))
        raise typer.Exit(WRONG) from None
    except KeyboardInterrupt:
        stop(f"interrupted; {kept}", INTERRUPTED)
    except (RankerError, DeviceError) as error:
        stop(str(error), MACHINE)
    except MemoryError:
        stop("not enough memory; try fewer --proposals or a smaller --size", MACHINE)
    except UnicodeEncodeError as error:
        stop(
            f"files cannot be named {error.object!r} in this locale ({error.encoding}); "
            "use one with UTF-8, or set PYTHONUTF8=1",
            MACHINE,
        )
    except OSError as error:
        stop(_about(error, kept), MACHINE)


def _about(error: OSError, kept: str) -> str:
    if error.errno == errno.ENOSPC:
        return f"the disk is full{_of(error)}; {kept}"
    if error.errno and error.strerror and type(error) is not OSError and error.filename:
        return f"{error.strerror}: {error.filename}"
    return str(error) or type(error).__name__


def _of(error: OSError) -> str:
    return f" ({error.filename})" if error.filename else ""
