"""``vdsc explain VDS060``: what a code means, with a wrong and a right example."""

from __future__ import annotations

import re
import sys
import textwrap
from typing import Annotated

import typer

from ..lang.codes import CODES
from ..lang.diagnostics import nearest

_WIDTH = 88


def explain(
    code: Annotated[
        str,
        typer.Argument(
            help="A code such as VDS060, or just its number. Without: all codes.", show_default=False
        ),
    ] = "",
) -> None:
    """Explain a diagnostic code, or list them all."""
    if not code:
        for each, row in sorted(CODES.items()):
            print(f"{each}  {row.title}")
        return
    wanted = _normal(code)
    if wanted not in CODES:
        meant = nearest(wanted, CODES)
        hint = f" Did you mean {meant}?" if meant else ""
        print(f"vdsc: there is no code {code!r}.{hint} `vdsc explain` lists them all.", file=sys.stderr)
        raise typer.Exit(2)
    print(explanation(wanted))


def explanation(code: str) -> str:
    """The whole text of a code."""
    row = CODES[code]
    parts = [f"{code}: {row.title}"]
    for paragraph in row.why.split("\n\n"):
        parts.append(paragraph if paragraph.startswith("    ") else textwrap.fill(paragraph, _WIDTH))
    for heading, example in (("Wrong", row.wrong), ("Right", row.right)):
        if example:
            parts.append(f"{heading}:\n\n{textwrap.indent(example.strip(), '    ')}")
    return "\n\n".join(parts)


def _normal(code: str) -> str:
    """``vds60``, ``60`` and ``VDS060`` are one."""
    match = re.fullmatch(r"(?:vds)?\s*0*(\d{1,3})", code.strip(), re.IGNORECASE)
    return f"VDS{int(match.group(1)):03d}" if match else code.strip().upper()
