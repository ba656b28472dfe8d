"""Phoenix Tribology COMPEND: tab separated text of the slow channels.

Lines about the test; ``Test started at ...``; one line of headers with units in brackets and the rows, each
beginning and ending with a tab; among the rows, lines that name a file of fast data
(``Fast data in =HYPERLINK("test-h001.tsv")``); and ``Test finished ...``. The files of fast data are logs of
their own: with neither time nor normal force in them they need a column map.
"""

from __future__ import annotations

import re

from separatrix.tribometer.formats.layout import Layout

_STARTED = re.compile(r"^\s*Test started at", re.IGNORECASE | re.MULTILINE)

LAYOUT = Layout(
    name="Phoenix Compend text",
    recognised=lambda head: _STARTED.search(head) is not None,
    interruption=re.compile(
        r"\s*(?:Fast data in|High speed data|Step \d+|Test paused|Test resumed)", re.IGNORECASE
    ),
)
