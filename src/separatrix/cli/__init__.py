"""The command line: `separatrix VERB STUDY [--json] [--out DIR] [--quiet] [--jobs N]`."""

from __future__ import annotations

from separatrix.cli.app import main

__all__ = ["main"]
