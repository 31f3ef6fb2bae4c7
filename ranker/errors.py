"""The one exception of this package that people see."""

from __future__ import annotations


class RankerError(Exception):
    """The ranker cannot be used or trained; the message names the file and what can be done."""
