"""The studies that come with the package."""

from __future__ import annotations

from functools import cache
from pathlib import Path


@cache
def shipped_studies() -> dict[str, Path]:
    """Path of each shipped example by its name."""
    folder = Path(__file__).parents[1] / "examples"
    return {path.stem: path for path in sorted(folder.iterdir()) if path.suffix == ".toml"}


def template() -> str:
    """A commented study to fill in, valid as it stands: what `separatrix new` writes."""
    return template_path().read_text(encoding="utf-8")


def template_path() -> Path:
    """Where the template stands."""
    return Path(__file__).with_name("template.toml")
