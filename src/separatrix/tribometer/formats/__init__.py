"""The text formats that are known by their layout, and how one is recognised."""

from __future__ import annotations

from separatrix.tribometer.formats import anton_paar, compend, labview, pcs, rtec, umt
from separatrix.tribometer.formats.layout import Layout

PLAIN = Layout(name="plain text", recognised=lambda _: True)
"""A table in text of no known instrument."""

LAYOUTS = (
    labview.LAYOUT,
    pcs.LAYOUT,
    anton_paar.LAYOUT,
    rtec.LAYOUT,
    umt.LAYOUT,
    compend.LAYOUT,
    PLAIN,
)
"""In the order in which they are tried."""


def layout_of(head: str) -> Layout:
    """The first layout that recognises the beginning of a file."""
    return next(layout for layout in LAYOUTS if layout.recognised(head))


__all__ = ["LAYOUTS", "PLAIN", "Layout", "layout_of"]
