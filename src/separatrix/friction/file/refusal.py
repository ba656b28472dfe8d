"""Refusal to overwrite a friction file; on its own, for it is said before anything else is imported."""

from __future__ import annotations

from pathlib import Path

from separatrix.errors import InputError


def exists_already(path: Path) -> InputError:
    """Refusal to overwrite."""
    cure = "It may hold numbers that a person wrote: name a new file, or remove it first."
    return InputError(f"--out {path}", "exists already, and was not touched", cure=cure)
