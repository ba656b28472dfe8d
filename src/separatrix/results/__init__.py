"""Results as plain data (`document`), as labelled arrays (`dataset`), and as files (`save`, `load`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from separatrix.results.documents import document
from separatrix.results.plain import NotFiniteError, plain

if TYPE_CHECKING:
    from separatrix.results.labelled import dataset, load, save

__all__ = ["NotFiniteError", "dataset", "document", "load", "plain", "save"]


def __getattr__(name: str) -> Any:
    """Import xarray's half when it is first used."""
    if name not in ("dataset", "load", "save"):
        raise AttributeError(f"module 'separatrix.results' has no attribute {name!r}")
    import importlib

    return getattr(importlib.import_module("separatrix.results.labelled"), name)
