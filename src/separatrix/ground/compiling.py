"""Compilation by numba: a callback when it begins, no garbage collection until it ends, and its time."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable

from numba.core import event

from separatrix.ground.units import Second


class Compiling(event.Listener):
    """Calls `heard` when a compilation begins; no garbage is collected until it ends, which saves a fifth."""

    def __init__(self) -> None:
        self.heard: list[Callable[[], None]] = []
        self.reason = ""  # why the kernels that came with the package are not used; empty if none came
        self._depth, self._collects = 0, True
        self._seconds, self._begun = 0.0, 0.0

    def on_start(self, _: object) -> None:
        """Enter a kernel, or a part of it: numba compiles one at a time."""
        if self._depth == 0:
            self._collects = gc.isenabled()
            gc.disable()
            self._begun = time.monotonic()
            for tell in self.heard:
                tell()
        self._depth += 1

    def on_end(self, _: object) -> None:
        """Leave it."""
        self._depth -= 1
        if self._depth == 0:
            self._seconds += time.monotonic() - self._begun
            if self._collects:
                gc.enable()

    def clock(self) -> Second:
        """Return a time that stands still while kernels are compiled."""
        now = time.monotonic()
        return (self._begun if self._depth else now) - self._seconds


COMPILING = Compiling()
event.register("numba:compile", COMPILING)  # type: ignore[no-untyped-call]
