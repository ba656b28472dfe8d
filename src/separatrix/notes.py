"""What is noted about validity on the way to an answer."""

from __future__ import annotations

import contextlib
import re
import threading
import warnings
from collections.abc import Iterable, Iterator
from typing import Any

from separatrix.errors import ValidityWarning


def grouped(notes: Iterable[str]) -> list[str]:
    """Return the first of the sentences that differ in numbers only, and how many more there are."""
    alike: dict[str, list[str]] = {}
    for note in notes:
        alike.setdefault(re.sub(r"[0-9][0-9.e+-]*", "0", note), []).append(note)
    return [f"{n[0]} (And {len(n) - 1} more with other numbers.)" if n[1:] else n[0] for n in alike.values()]


@contextlib.contextmanager
def noted_warnings() -> Iterator[list[str]]:
    """Collect what is said about validity, each sentence once; other warnings take their usual way."""
    notes: list[str] = []
    one_at_a_time = threading.Lock()  # threads of a pool warn too
    with warnings.catch_warnings():
        warnings.simplefilter("always", ValidityWarning)
        usual = warnings.showwarning

        def note(message: Warning | str, category: type[Warning], *place: Any, **rest: Any) -> None:
            if not issubclass(category, ValidityWarning):
                usual(message, category, *place, **rest)
                return
            with one_at_a_time:
                if str(message) not in notes:
                    notes.append(str(message))

        warnings.showwarning = note  # put back by catch_warnings
        yield notes
