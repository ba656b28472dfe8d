"""Compilation by numba: a callback when it begins, and no garbage collection until it ends."""

from __future__ import annotations

import gc
from collections.abc import Callable

from numba.core import event


class Compiling(event.Listener):
    """Calls `heard` when a compilation begins; no garbage is collected until it ends, which saves a fifth."""

    def __init__(self) -> None:
        self.heard: list[Callable[[], None]] = []
        self._depth, self._collects = 0, True

    def on_start(self, _: object) -> None:
        """Enter a kernel, or a part of it: numba compiles one at a time."""
        if self._depth == 0:
            self._collects = gc.isenabled()
            gc.disable()
            for tell in self.heard:
                tell()
        self._depth += 1

    def on_end(self, _: object) -> None:
        """Leave it."""
        self._depth -= 1
        if self._depth == 0 and self._collects:
            gc.enable()


COMPILING = Compiling()
event.register("numba:compile", COMPILING)  # type: ignore[no-untyped-call]
