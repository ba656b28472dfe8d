"""The studies that come with the package."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from pathlib import Path


@cache
def shipped_studies() -> dict[str, Path]:
    """Path of each shipped example by its name."""
    folder = Path(str(files("separatrix") / "examples"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def template() -> str:
    """A commented study to fill in, valid as it stands: what `separatrix new` writes."""
    return template_path().read_text(encoding="utf-8")


def template_path() -> Path:
    """Where the template stands."""
    return Path(str(files("separatrix.study_file") / "template.toml"))
