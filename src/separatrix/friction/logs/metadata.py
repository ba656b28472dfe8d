"""Lines of metadata before a table, as keys and values."""

from __future__ import annotations

import re
from collections.abc import Sequence

_PAIR = re.compile(r"[\s#%]*([^:=\t;,]{1,60}?)\s*(?:[:=\t;,]\s*)+(\S.*?)[\s;,]*$")
_NUMBERED = re.compile(r"\s*(Run|Step)\s*(?:#|No\.?)\s*(\d+)\s*$", re.IGNORECASE)

MOST = 400
"""Pairs kept of one table."""


def metadata_of(
    lines: Sequence[str], header: Sequence[str] = (), *, keys_above: bool = False
) -> dict[str, str]:
    """Pairs in the lines: ``key: value``, ``key = value``, or a row of keys over one of values.

    Two lines of two fields each are taken as two pairs, unless the format is known for its row of keys.
    """
    kept = [line for line in lines if line not in header]
    pairs: dict[str, str] = {}
    skip = False
    for line, below in zip(kept, [*kept, ""][1:], strict=True):
        if skip:
            skip = False
            continue
        rows = _keys_over_values(line, below, 1 if keys_above else 2)
        if rows:
            pairs |= rows
            skip = True
        else:
            pairs |= _pair(line)
    return {key[:100]: value[:200] for key, value in list(pairs.items())[:MOST]}


def _pair(line: str) -> dict[str, str]:
    if numbered := _NUMBERED.match(line):
        return {numbered[1]: numbered[2]}
    found = _PAIR.match(line)
    if not found:
        return {}
    return {_clean(found[1]): _clean(found[2])}


def _keys_over_values(line: str, below: str, least: int) -> dict[str, str]:
    """Two rows of as many commas, semicolons or tabs, the upper of words alone."""
    for separator in "\t;,":
        count = line.count(separator)
        named = line.rstrip(separator).count(separator)  # every row of a sheet is as long as the longest
        if named >= least and below.count(separator) == count:
            keys, values = line.split(separator), below.split(separator)
            if not any(re.match(r"\s*[+-]?\d", key) for key in keys):
                return {
                    _clean(key): _clean(value)
                    for key, value in zip(keys, values, strict=True)
                    if key.strip() and value.strip()
                }
    return {}


def _clean(text: str) -> str:
    return "".join(c if c.isprintable() else " " for c in text).strip().strip('"').strip()
