"""The standard library, written in VDS: sets, props, cast and actions; and its loader."""

from .loader import Catalog

__all__ = ["Catalog"]
