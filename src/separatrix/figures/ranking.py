"""Candidates on the stability curve (the paper's Figs 9-12), and all of them at a glance."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterator
from itertools import cycle
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.stability import ETA_LABEL, chain_lines, frame, mark_here
from separatrix.figures.style import (
    BLACK,
    BLUE,
    CYCLE,
    GREY,
    MARK,
    MARKERS,
    PAGE,
    VERDICT_COLOURS,
    VERDICT_MARKERS,
    canvas,
    label_lines,
)
from separatrix.units import Array


def environments(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield a figure for each environment: the candidates' frictions carried to the stability curve."""
    top = 1.12 * float(np.nanmax(data["material_friction"].values, initial=0.1))
    for i, name in enumerate(data["environment"].values):
        yield f"rank-{i + 1}-{file_name(str(name))}", environment(data.isel(environment=i), top)


def file_name(text: str) -> str:
    """Return a text as the part of a file's name."""
    plain = "".join(c if c.isascii() and c.isalnum() else "-" for c in text.lower())
    return "-".join(part for part in plain.split("-") if part)[:60] or "environment"


def environment(data: xr.Dataset, top: float) -> Figure:
    """Stability curve up to a friction `top`, with the candidates of one environment on it."""
    figure, axes = canvas(PAGE, 4.3)
    measured = data.isel(material=np.isfinite(data["material_friction"].values))
    frame(axes, data, top)
    chain_lines(axes, data)
    mark_here(axes, data)
    _own_curves(axes, data)
    for i in range(measured.sizes["material"]):
        _candidate(axes, measured.isel(material=i))
    _names(axes, data, top)
    _title(axes, data)
    _legend(figure, axes, data)
    return figure


def _own_curves(axes: Axes, data: xr.Dataset) -> None:
    """Draw the curve of every other pocket, where candidates differ in its stiffness, with whose it is."""
    if "own_critical_friction" not in data:
        return
    reference = str(data["candidate"].values)
    axes.lines[0].set_label(f"{axes.lines[0].get_label()}: {reference}")
    lines = data["own_critical_friction"].transpose("material", "own_eta").values
    names = data["material"].values.astype(str)
    whose: dict[bytes, list[int]] = {}
    for place, line in enumerate(lines):
        whose.setdefault(line.tobytes(), []).append(place)
    colours = [colour for colour in CYCLE if colour not in (BLACK, BLUE)]
    for places, colour in zip(whose.values(), cycle(colours), strict=False):
        if reference not in names[places]:
            label = "half whirl: " + textwrap.fill(", ".join(names[places]), 50)
            axes.plot(data["own_eta"].values, lines[places[0]], color=colour, lw=0.8, label=label)


def _title(axes: Axes, data: xr.Dataset) -> None:
    """Name the environment, and the column of names at the right."""
    name = str(data["environment"].values)
    axes.set_title(name[:1].upper() + name[1:])
    head = "rank  candidate  friction" + (r"  own $\eta$" if "own_critical_friction" in data else "")
    beside: Any = {"xycoords": "axes fraction", "textcoords": "offset points"}
    axes.annotate(head, (1, 1), xytext=(12, 6), fontsize=7, color=GREY, **beside)


def _candidate(axes: Axes, data: xr.Dataset) -> None:
    """Draw one candidate: its verdict at the bearing's eta, and a line to its threshold on the curve."""
    friction = float(data["material_friction"])
    verdict = str(data["material_verdict"].values)
    colour = VERDICT_COLOURS.get(verdict, GREY)
    axes.plot([0, 1], [friction, friction], color=colour, lw=0.4, alpha=0.6)
    axes.plot(
        float(data["material_restitution_factor"]),
        friction,
        VERDICT_MARKERS.get(verdict, "."),
        color=colour,
        ms=5,
    )
    threshold = float(data["material_restitution_threshold"])
    if np.isfinite(threshold):
        low, high = (float(data[f"material_restitution_threshold_{end}"]) for end in ("low", "high"))
        axes.plot([low, high], [friction, friction], color=colour, lw=1.6)
        axes.plot(threshold, friction, "o", mfc="white", mec=colour, ms=4.5, clip_on=False, zorder=4)


def _names(axes: Axes, data: xr.Dataset, top: float) -> None:
    """Write rank, name, friction and own eta of every candidate at the right; on top those not measured."""
    ranks = _ranks(data["material_rank"].values)
    labels = []
    differ = "own_critical_friction" in data
    for name, rank, friction, eta, verdict, untested in zip(
        data["material"].values,
        ranks,
        data["material_friction"].values,
        data["material_restitution_factor"].values,
        data["material_verdict"].values,
        data["material_extrapolation"].values.astype(str),
        strict=True,
    ):
        measured = np.isfinite(friction)
        mark = MARK if untested else ""
        own = f"  {eta:.2f}" if differ and np.isfinite(eta) else ""
        text = f"{rank}  {name}  {friction:.3g}{mark}{own}" if measured else f"{rank}  {name}  not measured"
        labels.append((1.0, friction if measured else top, text, VERDICT_COLOURS.get(str(verdict), GREY)))
    label_lines(axes, labels, gap=0.05, colour=BLACK)


def _ranks(column: Any) -> list[str]:
    """Return the ranks as text: = after a shared one, a dash for none; a column of nothing is of text."""
    ranks = [int(rank) if rank not in ("", None) and np.isfinite(rank) else None for rank in column.tolist()]
    return ["-" if rank is None else f"{rank}{'=' if ranks.count(rank) > 1 else ''}" for rank in ranks]


def _legend(figure: Figure, axes: Axes, data: xr.Dataset) -> None:
    """Name the lines and the verdicts' signs below the picture."""
    for verdict, marker in VERDICT_MARKERS.items():
        axes.plot(
            [],
            [],
            marker,
            color=VERDICT_COLOURS[verdict],
            ms=5,
            label=f"{verdict}, at the candidate's own $\\eta$",
        )
    axes.plot([], [], "o", mfc="white", mec=GREY, ms=4.5, label="threshold with its 95 % interval")
    untested(axes, data["material_extrapolation"])
    figure.legend(loc="outside lower left", ncols=2, fontsize=6.5, handlelength=1.8, columnspacing=1.5)


def untested(axes: Axes, sentences: xr.DataArray) -> None:
    """Say in the legend that a friction lies outside its tests; the printed answer says in what respect."""
    if (sentences.values.astype(str) != "").any():
        label = "friction outside the tests"
        axes.plot([], [], ls="", marker=f"${MARK}$", color=GREY, ms=4, label=label)


ABSENT_AT, VERDICT_AT, RIGHT = 0.985, 1.05, 1.24
"""Columns of the overview: crosses, inside the axis at its end; verdicts beyond it; and its end."""


def overview(data: xr.Dataset) -> Figure:
    """Restitution threshold of every candidate, overall and in each environment; best at the top."""
    data = data.isel(material=text_order(data)[::-1])
    places = np.arange(float(data.sizes["material"]))
    figure, axes = canvas(PAGE, 1.7 + 0.32 * places.size)
    axes.set(xlim=(-0.012, RIGHT), ylim=(-0.6, places.size - 0.4), xticks=np.linspace(0, 1, 6))
    axes.set_xlabel(f"threshold of the {ETA_LABEL}: larger is better", loc="left")
    axes.spines["bottom"].set_bounds(0, 1)
    count = data.sizes["environment"]
    for i, marker, colour in zip(range(count), cycle(MARKERS), cycle(CYCLE), strict=False):
        lower = 0.26 - 0.52 * (i + 0.5) / count
        _thresholds(axes, data.isel(environment=i), places + lower, marker, colour)
    low, middle, high = (data[f"overall_restitution_threshold{end}"].values for end in ("_low", "", "_high"))
    axes.hlines(places, low, high, color=BLACK, lw=1.2)
    axes.plot(middle, places, "D", color=BLACK, ms=4.5, label="overall, with its 95 % interval")
    if "own_critical_friction" in data:
        label = r"this bearing's $\eta$ with each candidate (Eq. 18)"
        axes.plot(data["overall_restitution_factor"].values, places, "|", color=BLACK, ms=16, label=label)
    else:
        chain_lines(axes, data)
    _rows(axes, data, places)
    untested(axes, data["overall_extrapolation"])
    own = own_environment(data)
    where = "overall" if own is None else f"in {data['environment'].values[own]}"
    axes.set_title(f"Restitution thresholds; number: rank {where}, = a tie")
    figure.legend(loc="outside lower left", ncols=2, fontsize=6.5, handlelength=1.8)
    return figure


def text_order(data: xr.Dataset) -> list[int]:
    """Return the places of the materials as the text lists them: those of the bearing's own environment."""
    own = own_environment(data)
    prefix = "overall" if own is None else "material"
    rows = data if own is None else data.isel(environment=own)

    def known(key: str, place: int, missing: float) -> float:
        value = rows[f"{prefix}_{key}"].values[place]
        return missing if value in ("", None) or not np.isfinite(float(value)) else float(value)

    def key(place: int) -> tuple[float, float, float]:
        return known("rank", place, np.inf), -known("margin", place, 0.0), known("friction", place, 0.0)

    return sorted(range(data.sizes["material"]), key=key)


def own_environment(data: xr.Dataset) -> int | None:
    """Return the place of the bearing's own environment; None if the study does not say it."""
    stated = json.loads(data.attrs.get("study", "{}")).get("ranking", {}).get("environment", {}).get("value")
    names = [str(name) for name in data["environment"].values]
    return names.index(stated) if stated in names else (0 if len(names) == 1 else None)


def _thresholds(axes: Axes, data: xr.Dataset, places: Array, marker: str, colour: str) -> None:
    """Draw one environment's thresholds; a cross at the right where the candidate was not measured."""
    look: Any = {"ls": "", "color": colour}
    name = str(data["environment"].values)
    axes.plot(
        data["material_restitution_threshold"].values, places, marker=marker, ms=3.6, label=name, **look
    )
    absent = ~np.isfinite(data["material_friction"].values)
    axes.plot(np.full(absent.sum(), ABSENT_AT), places[absent], marker="x", ms=3.6, **look)


def _rows(axes: Axes, data: xr.Dataset, places: Array) -> None:
    """Write names and ranks at the left; at the right the overall verdicts and the heads of the columns."""
    own = own_environment(data)
    rows = data if own is None else data.isel(environment=own)
    prefix = "overall" if own is None else "material"
    named = zip(data["material"].values, _ranks(rows[f"{prefix}_rank"].values), strict=True)
    axes.set_yticks(places, [f"{name}  {rank}" for name, rank in named])
    axes.tick_params(axis="y", length=0)
    for place, verdict in zip(places, rows[f"{prefix}_verdict"].values.astype(str), strict=True):
        colour, marker = VERDICT_COLOURS.get(verdict, GREY), VERDICT_MARKERS.get(verdict, "_")
        axes.plot(VERDICT_AT, place, marker, color=colour, ms=5)
        axes.text(VERDICT_AT + 0.02, place, verdict or "none", fontsize=7, va="center")
    top = places.size - 0.4
    head = "overall verdict" if own is None else "verdict here"
    axes.text(VERDICT_AT - 0.01, top, head, fontsize=7, color=GREY, va="bottom")
    if not np.isfinite(data["material_friction"].values).all():
        axes.plot([], [], "x", color=GREY, ms=3.6, label="not measured in the environment of its colour")
