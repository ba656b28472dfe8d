"""Candidates on the stability curve (the paper's Figs 9-12), and all of them at a glance."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.stability import ETA_LABEL, chain_lines, frame
from separatrix.figures.style import (
    BLACK,
    CYCLE,
    GREY,
    PAGE,
    VERDICT_COLOURS,
    VERDICT_MARKERS,
    canvas,
    label_lines,
)


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
    limit = float(data["solid_lubrication_limit"])
    axes.axvline(
        limit, color=GREY, lw=1.0, ls="-.", label=rf"$\eta$ = {limit:g}, the paper's least (quoted above)"
    )
    for i in range(measured.sizes["material"]):
        _candidate(axes, measured.isel(material=i))
    _names(axes, measured)
    _title(axes, data)
    _legend(figure, axes, data)
    return figure


def _title(axes: Axes, data: xr.Dataset) -> None:
    """Name the environment, and at the right who was not measured in it."""
    name = str(data["environment"].values)
    axes.set_title(name[:1].upper() + name[1:])
    absent = data["material"].values[~np.isfinite(data["material_friction"].values)]
    if absent.size:
        note = f"not measured: {', '.join(absent)}"
        axes.text(0.99, 1.015, note, fontsize=7, color=GREY, ha="right", transform=axes.transAxes)
    axes.text(1.005, 1.015, "rank  candidate", fontsize=7, color=GREY, transform=axes.transAxes)


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


def _names(axes: Axes, data: xr.Dataset) -> None:
    """Write name and rank of every candidate at the right, apart from each other."""
    labels = [
        (
            1.0,
            float(data["material_friction"][i]),
            f"{int(data['material_rank'][i])}  {data['material'].values[i]}"
            if np.isfinite(data["material_rank"][i])
            else str(data["material"].values[i]),
            VERDICT_COLOURS.get(str(data["material_verdict"].values[i]), GREY),
        )
        for i in range(data.sizes["material"])
    ]
    label_lines(axes, labels, gap=0.045)


def _legend(figure: Figure, axes: Axes, data: xr.Dataset) -> None:
    """Name the lines and the verdicts' signs below the picture, with the paper's statement."""
    for verdict, marker in VERDICT_MARKERS.items():
        axes.plot(
            [], [], marker, color=VERDICT_COLOURS[verdict], ms=5, label=f"{verdict} at this bearing's $\\eta$"
        )
    axes.plot([], [], "o", mfc="white", mec=GREY, ms=4.5, label="threshold with its 95 % interval")
    figure.legend(loc="outside lower left", ncols=2, fontsize=6.5, handlelength=1.8, columnspacing=1.5)
    statement = textwrap.fill(str(data["paper_statement"].values), 110)
    axes.text(0, 1.09, statement, transform=axes.transAxes, fontsize=6.5, color=GREY, va="bottom")


def overview(data: xr.Dataset) -> Figure:
    """Restitution threshold of every candidate, overall and in each environment; best at the top."""
    order = np.argsort(np.nan_to_num(data["overall_restitution_threshold"].values, nan=-1.0), kind="stable")
    data = data.isel(material=order)
    count = data.sizes["material"]
    figure, axes = canvas(PAGE, 1.5 + 0.32 * count)
    places = np.arange(count)
    for i, name in enumerate(data["environment"].values):
        place = places + 0.26 - 0.52 * (i + 0.5) / data.sizes["environment"]
        threshold = data["material_restitution_threshold"].values[i]
        axes.plot(threshold, place, "o", color=CYCLE[i % len(CYCLE)], ms=3.2, label=str(name), clip_on=False)
    low, middle, high = (data[f"overall_restitution_threshold{end}"].values for end in ("_low", "", "_high"))
    axes.hlines(places, low, high, color=BLACK, lw=1.2)
    axes.plot(middle, places, "D", color=BLACK, ms=4.5, label="overall, with its 95 % interval")
    chain_lines(axes, data)
    limit = float(data["solid_lubrication_limit"])
    axes.axvline(limit, color=GREY, lw=1.0, ls="-.", label=rf"$\eta$ = {limit:g}, the paper's least")
    axes.set(xlim=(0, 1), ylim=(-0.6, count - 0.4), xlabel=f"threshold of the {ETA_LABEL}: larger is better")
    axes.set_yticks(places, [_ranked(data, i) for i in range(count)])
    axes.tick_params(axis="y", length=0)
    axes.set_title("Restitution thresholds; the number is the overall rank")
    figure.legend(loc="outside lower left", ncols=2, fontsize=6.5, handlelength=1.8)
    return figure


def _ranked(data: xr.Dataset, i: int) -> str:
    rank = float(data["overall_rank"][i])
    name = str(data["material"].values[i])
    return f"{name}  {int(rank)}" if np.isfinite(rank) else f"{name}  -"
