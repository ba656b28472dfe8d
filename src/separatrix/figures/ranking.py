"""Candidates on the stability curve (the paper's Figs 9-12), and all of them at a glance."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from itertools import cycle

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.stability import (
    ETA_LABEL,
    EXTRAPOLATED,
    draw_chain,
    draw_curve,
    explain_extrapolated,
    highest,
    stability,
)
from separatrix.figures.style import (
    BLACK,
    BLUE,
    CYCLE,
    GREY,
    MARKERS,
    PAGE,
    VERDICT_COLOURS,
    VERDICT_MARKERS,
    Look,
    canvas,
    label_lines,
    legend_below,
    stated,
    study_of,
    with_ends,
)
from separatrix.told.sentences import rank_texts

VERDICT_AT, RIGHT = 1.05, 1.24
"""Column of the verdicts in the overview, beyond the axis, and the end of the picture."""


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `rank`; an interrupted ranking has none."""
    if "restitution_factor" not in data.sizes:
        return
    yield "rank-overview", overview(data)
    yield "stability-curve", stability(data)
    top = highest(data, candidates=True)
    for i, name in enumerate(data["environment"].values):
        yield f"rank-{i + 1}-{file_name(str(name))}", environment(data.isel(environment=i), top)


def file_name(text: str) -> str:
    """Return a text as the part of a file's name."""
    plain = "".join(c if c.isascii() and c.isalnum() else "-" for c in text.lower())
    return "-".join(part for part in plain.split("-") if part)[:60] or "environment"


def own_environment(data: xr.Dataset) -> int | None:
    """Return the place of the bearing's own environment; None if the study does not name one."""
    own = stated(study_of(data), "ranking", "environment")
    names = [str(name) for name in data["environment"].values]
    return names.index(own) if own in names else (0 if len(names) == 1 else None)


def environment(data: xr.Dataset, top: float) -> Figure:
    """Stability curve up to a friction `top`, with the candidates of one environment on it."""
    figure, axes = canvas(PAGE, 4.3)
    draw_curve(axes, data, top)
    differ, labels = "own_critical_friction" in data, []
    if differ:
        _own_curves(axes, data)
    ranks = rank_texts(data["material_rank"].values.tolist())
    for i, name in enumerate(data["material"].values):
        of = data.isel(material=i)
        friction, eta = (float(of[f"material_{key}"]) for key in ("friction", "restitution_factor"))
        colour, own = VERDICT_COLOURS.get(str(of["material_verdict"].values), GREY), ""
        if np.isfinite(friction):
            _candidate(axes, of, colour)
            own = f"  {eta:.2f}" if differ and np.isfinite(eta) else ""
        mark = EXTRAPOLATED if str(of["material_extrapolation"].values) else ""
        words = f"{friction:.3g}{mark}{own}" if np.isfinite(friction) else "not measured"
        height = friction if np.isfinite(friction) else top
        labels.append((1.0, height, f"{ranks[i]}  {name}  {words}", colour))
    label_lines(axes, labels, gap=0.05, colour=BLACK)
    title = str(data["environment"].values)
    axes.set_title(title[:1].upper() + title[1:])
    beside: Look = {"xycoords": "axes fraction", "textcoords": "offset points", "fontsize": 7, "color": GREY}
    head = "rank  candidate  friction" + (r"  own $\eta$" if differ else "")
    axes.annotate(head, (1, 1), xytext=(12, 6), **beside)
    for verdict, marker in VERDICT_MARKERS.items():
        look: Look = {"color": VERDICT_COLOURS[verdict], "ms": 5, "ls": ""}
        axes.plot([], [], marker, label=f"{verdict}, at the candidate's own $\\eta$", **look)
    axes.plot([], [], "o", mfc="white", mec=GREY, ms=4.5, label="threshold with its 95 % interval")
    explain_extrapolated(axes, data["material_extrapolation"])
    legend_below(figure)
    return figure


def _own_curves(axes: Axes, data: xr.Dataset) -> None:
    """Draw the curve of every other pocket, where candidates differ in its stiffness, with whose it is."""
    reference = str(data["candidate"].values)
    axes.lines[0].set_label(f"{axes.lines[0].get_label()}: {reference}")
    lines = data["own_critical_friction"].transpose("material", "own_eta").values
    names = data["material"].values
    whose: dict[bytes, list[int]] = {}
    for place, line in enumerate(lines):
        whose.setdefault(line.tobytes(), []).append(place)
    colours = [colour for colour in CYCLE if colour not in (BLACK, BLUE)]
    for places, colour in zip(whose.values(), cycle(colours), strict=False):
        if reference not in names[places]:
            label = "half whirl: " + textwrap.fill(", ".join(names[places]), 50)
            axes.plot(data["own_eta"].values, lines[places[0]], color=colour, lw=0.8, label=label)


def _candidate(axes: Axes, data: xr.Dataset, colour: str) -> None:
    """Draw one candidate: its verdict at its own eta, and a line to its threshold on the curve."""
    friction, eta = float(data["material_friction"]), float(data["material_restitution_factor"])
    marker = VERDICT_MARKERS.get(str(data["material_verdict"].values), ".")
    axes.plot([0, 1], [friction, friction], color=colour, lw=0.4, alpha=0.6)
    axes.plot(eta, friction, marker, color=colour, ms=5, zorder=5)
    threshold, low, high = map(float, with_ends(data, "material_restitution_threshold"))
    if np.isfinite(threshold):
        axes.plot([low, high], [friction, friction], color=colour, lw=1.6)
        axes.plot(threshold, friction, "o", mfc="white", mec=colour, ms=4.5, clip_on=False, zorder=4)


def overview(data: xr.Dataset) -> Figure:
    """Restitution threshold of every candidate, overall and in each environment; best at the top."""
    data = data.isel(material=text_order(data)[::-1])
    own, places = own_environment(data), np.arange(float(data.sizes["material"]))
    figure, axes = canvas(PAGE, 1.7 + 0.32 * places.size)
    axes.set(xlim=(-0.012, RIGHT), ylim=(-0.6, places.size - 0.4), xticks=np.linspace(0, 1, 6))
    axes.set_xlabel(f"threshold of the {ETA_LABEL}: larger is better", loc="left")
    axes.spines["bottom"].set_bounds(0, 1)
    count = data.sizes["environment"]
    for i, marker, colour in zip(range(count), cycle(MARKERS), cycle(CYCLE), strict=False):
        of, row = data.isel(environment=i), places + shift(i, count)
        look: Look = {"ls": "", "color": colour, "ms": 3.6}
        name = str(of["environment"].values)
        axes.plot(of["material_restitution_threshold"].values, row, marker=marker, label=name, **look)
        absent = ~np.isfinite(of["material_friction"].values)
        axes.plot(np.full(absent.sum(), 0.985), row[absent], marker="x", **look)
    middle, low, high = with_ends(data, "overall_restitution_threshold")
    axes.hlines(places, low, high, color=BLACK, lw=1.2)
    axes.plot(middle, places, "D", color=BLACK, ms=4.5, label="overall, with its 95 % interval")
    if "own_critical_friction" in data:
        label = r"this bearing's $\eta$ with each candidate (Eq. 18)"
        axes.plot(data["overall_restitution_factor"].values, places, "|", color=BLACK, ms=16, label=label)
    else:
        draw_chain(axes, data)
    if not np.isfinite(data["material_friction"].values).all():
        label = "not measured in the environment of this colour"
        axes.plot([], [], "x", color=GREY, ms=3.6, label=label)
    _names(axes, data, own)
    where = "overall" if own is None else f"in {data['environment'].values[own]}"
    axes.set_title(f"Restitution thresholds; after each name its rank {where}, = for a tie", pad=16)
    legend_below(figure)
    return figure


def shift(place: int, count: int) -> float:
    """Return how far above the row of its candidate an environment, one of `count`, is drawn."""
    return 0.26 - 0.52 * (place + 0.5) / count


def _names(axes: Axes, data: xr.Dataset, own: int | None) -> None:
    """Write names and ranks at the left, verdicts at the right: of the own environment, or overall."""
    rows, prefix = (data, "overall") if own is None else (data.isel(environment=own), "material")
    sentences = rows[f"{prefix}_extrapolation"]
    marks = [EXTRAPOLATED if text else "" for text in sentences.values.astype(str)]
    ranks = rank_texts(rows[f"{prefix}_rank"].values.tolist())
    named = zip(data["material"].values, marks, ranks, strict=True)
    axes.set_yticks(range(len(marks)), [f"{name}{mark}  {rank}" for name, mark, rank in named])
    axes.tick_params(axis="y", length=0)
    for place, verdict in enumerate(rows[f"{prefix}_verdict"].values.astype(str)):
        colour, marker = VERDICT_COLOURS.get(verdict, GREY), VERDICT_MARKERS.get(verdict, "_")
        axes.plot(VERDICT_AT, place, marker, color=colour, ms=5)
        axes.text(VERDICT_AT + 0.02, place, verdict or "none", fontsize=7, va="center")
    head = "overall verdict" if own is None else "verdict here"
    axes.text(VERDICT_AT - 0.01, len(marks) - 0.4, head, fontsize=7, color=GREY, va="bottom")
    explain_extrapolated(axes, sentences)


def text_order(data: xr.Dataset) -> list[int]:
    """Return the places of the materials as the text lists them: those of the bearing's own environment."""
    own = own_environment(data)
    rows, prefix = (data, "overall") if own is None else (data.isel(environment=own), "material")

    def key(place: int) -> tuple[float, float, float]:
        found = [rows[f"{prefix}_{name}"].values[place] for name in ("rank", "margin", "friction")]
        known = [value not in ("", None) and bool(np.isfinite(float(value))) for value in found]
        rank, margin, friction = (
            float(v) if is_known else 0.0 for v, is_known in zip(found, known, strict=True)
        )
        return rank if known[0] else np.inf, -margin, friction

    return sorted(range(data.sizes["material"]), key=key)
