"""LabVIEW measurement files as text, .lvm: tab separated, in segments.

A head of keys and values that ends in ``***End_of_Header***``; then for each segment a block of keys with
one value a channel (Samples, Date, X0, Delta_X), its own ``***End_of_Header***``, a line of names
(``X_Value``, the channels, ``Comment``) and the rows, which may leave out the comment. X_Value is the time in
seconds.
"""

from __future__ import annotations

import re

from separatrix.tribometer.formats.layout import Layout


def _header(header: str) -> str:
    return "Time" if header.strip() == "X_Value" else header


LAYOUT = Layout(
    name="LabVIEW text",
    recognised=lambda head: head.startswith("LabVIEW Measurement"),
    header=_header,
    units={"Time": "s"},
    heading=re.compile(
        rb"^(?:LabVIEW Measurement|Channels[\t;,])(?:.*\n)*?\*\*\*End_of_Header\*\*\*.*\n", re.MULTILINE
    ),
)
