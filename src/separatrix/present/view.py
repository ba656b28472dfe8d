"""One run of a cage as a page to turn and play: true shapes, small movements enlarged."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any

from separatrix.ground.units import format_number, format_quantity

WHERE = ("in the pocket (balls: white to red)", "on the land (grey to red)")


def page(heading: Sequence[str], scene: Mapping[str, Any]) -> str:
    """Return a page that needs no other file; its heading is a title and lines below it, all escaped.

    `scene` is what cage.js draws: its `largest` are the forces of a pocket and of the lands [N], its `parts`
    beginning and end of each part of the run that is shown [s].
    """
    title, *about = heading
    # a text of the study may hold any mark: the JSON is inside a script
    found = json.dumps(scene, allow_nan=False, separators=(",", ":"))
    for sign in "<>&\u2028\u2029":
        found = found.replace(sign, f"\\u{ord(sign):04x}")
    largest = scene["largest"]
    forces = [f"0 to {format_number(one, 3)} N {where}" for one, where in zip(largest, WHERE, strict=True)]
    shown = ", ".join(forces[: 1 + (largest[1] > 0.0)])
    spans = " and ".join(" to ".join(format_quantity(end, "s") for end in part) for part in scene["parts"])
    parts = {
        "TITLE": html.escape(title),
        "ABOUT": html.escape("\n".join(about)),
        "MOST": f"{shown}; root scale, the largest since the frame before",
        "SHOWN": f"Frames show {spans}.",
        "DATA": found,
        "STYLE": _static("cage.css"),
        "SCRIPT": _static("cage.js"),
    }
    return re.sub("@([A-Z]+)@", lambda mark: parts[mark[1]], _static("cage.html"))  # no mark inside a part


def _static(name: str) -> str:
    return files("separatrix.present").joinpath("static", name).read_text(encoding="utf-8")
