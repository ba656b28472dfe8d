"""Friction files: tests as a person or the verb `tribometer` writes them (docs/tribometer.md)."""

from separatrix.friction_file.reading import read_friction
from separatrix.friction_file.writing import exists_already, friction_text, write_friction

__all__ = ["exists_already", "friction_text", "read_friction", "write_friction"]
