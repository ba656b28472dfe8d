"""`python -m separatrix` is the command line."""

from __future__ import annotations

from separatrix.front import process

process()
