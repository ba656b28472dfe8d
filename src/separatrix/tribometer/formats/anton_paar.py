"""Anton Paar (CSM Instruments) TRB, THT and Nano tribometers: text of their own programs.

A block of ``key : value [unit]`` lines, then one line of headers with their units in brackets, separated by
tabs: Time [s], Distance [m], Laps, Sequence ID, Cycle ID, Max Linear Speed [m/s], Nominal Load [N], the Greek
letter mu for the friction coefficient, Angle [deg] or Linear Position [mm], Friction Force [N], Temperature,
Humidity, Penetration Depth [um]. Nano tribometers give forces in mN; the decimal sign is the computer's.
"""

from __future__ import annotations

import re

from separatrix.tribometer.formats.layout import Layout

_HEADER = re.compile(r"^Time \[s\]\s.*(?:\u00b5|\u03bc|\blaps\b)", re.IGNORECASE | re.MULTILINE)
_INSTRUMENT = re.compile(r"Anton Paar|CSM Instruments|TRB|TRN|THT|TriboX|Nano Tribometer", re.IGNORECASE)


def _recognised(head: str) -> bool:
    table = _HEADER.search(head) is not None
    return table and ("\tsequence id" in head.casefold() or _INSTRUMENT.search(head) is not None)


LAYOUT = Layout(name="Anton Paar text", recognised=_recognised)
