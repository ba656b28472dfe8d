"""Answers as plain data (`document`), as labelled arrays and tables, as text (`in_words`), and as files."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from separatrix.present.arrays import dataset, save, to_dataframe, to_xarray
    from separatrix.present.nodes import NotFiniteError, document, plain
    from separatrix.present.text.answer import in_words, whereabouts

_HOME = {
    "nodes": "NotFiniteError document plain",
    "arrays": "dataset save to_dataframe to_xarray",
    "text.answer": "in_words whereabouts",
}
"""Module -> its public names."""

__all__ = [
    "NotFiniteError",
    "dataset",
    "document",
    "in_words",
    "plain",
    "save",
    "to_dataframe",
    "to_xarray",
    "whereabouts",
]


def __getattr__(name: str) -> object:
    """Import a name when it is first used: xarray takes long."""
    for module, names in _HOME.items():
        if name in names.split():
            return getattr(importlib.import_module(f"separatrix.present.{module}"), name)
    raise AttributeError(f"module 'separatrix.present' has no attribute {name!r}")
