"""What one instrument's text files have of their own; the table itself is read the same way for all."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field


def _same(header: str) -> str:
    return header


def _no_name(lines: list[str]) -> str:  # noqa: ARG001  one signature for all
    return ""


def _no_series(head: str) -> str:  # noqa: ARG001  one signature for all
    return ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """Facts of one format that its files do not say themselves."""

    name: str
    recognised: Callable[[str], bool]
    """From the first 20 000 characters of the file."""
    header: Callable[[str], str] = _same
    """A header in the words of the published table of names."""
    units: Mapping[str, str] = field(default_factory=dict)
    """Unit of a header, as `header` gives it, where the file writes none."""
    spellings: Mapping[tuple[str, str], str] = field(default_factory=dict)
    """Unit that a spelling stands for in a column of some meaning: ``{("normal_force", "g"): "gf"}``."""
    interruption: re.Pattern[str] | None = None
    """Lines that may stand between rows of the table and are no part of it."""
    heading: re.Pattern[bytes] | None = None
    """Blocks of lines that are never rows, however many numbers they hold."""
    keys_above: bool = False
    """A line of keys stands above one of values, even if there are only two of them."""
    table_name: Callable[[list[str]], str] = _no_name
    """Name of a table from the lines before it."""
    series: Callable[[str], str] = _no_series
    """What the head of a file says of the test that it is a part of."""
    same: tuple[str, ...] = ()
    """Keys of metadata whose values, but for the sign, all parts of a test share."""
    split_by: tuple[str, ...] = ()
    """Headers, as the file writes them, whose change begins a new table; the first that is there counts."""
