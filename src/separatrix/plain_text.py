"""Text that a terminal or a file can be sent, whoever wrote it."""

from __future__ import annotations

import re
import unicodedata

_SUSPECT = re.compile(r"[^\n\x20-\x7e]")


def harmless(text: str) -> str:
    """Return the text with control characters spelled out, except ends of lines.

    A terminal obeys them, and a title, a name or a log's header may come from somebody else. Characters that
    cannot be seen, such as those that turn the direction of writing, are spelled out too.
    """
    return _SUSPECT.sub(_spelled, text)


def _spelled(found: re.Match[str]) -> str:
    c = found.group()
    is_seen = c.isprintable() or unicodedata.category(c) == "Zs"
    return c if is_seen else c.encode("unicode_escape").decode()


def one_line(text: str) -> str:
    """Return the text on one line, with what no terminal should be sent spelled out."""
    return harmless(" ".join(text.split()))
