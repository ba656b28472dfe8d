"""Template."""

from pathlib import Path


def template() -> str:
    """A commented study."""
    return Path(__file__).with_name("template.toml").read_text(encoding="utf-8")
