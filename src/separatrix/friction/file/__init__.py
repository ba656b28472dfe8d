"""Friction files: tests as a person or the verb `tribometer` writes them (docs/tribometer.md).

Nothing here is imported before it is asked for: the refusal to overwrite one comes first.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from separatrix.friction.file.reading import read_friction
    from separatrix.friction.file.writing import friction_text, write_friction

__all__ = ["friction_text", "read_friction", "write_friction"]

_HOMES = {"read_friction": "reading", "friction_text": "writing", "write_friction": "writing"}


def __getattr__(name: str) -> object:
    """Import a function when first asked for."""
    if name not in _HOMES:
        raise AttributeError(name)
    return getattr(import_module(f"separatrix.friction.file.{_HOMES[name]}"), name)
