"""Figures of the mobility of a ball: its response, its law of traction, impacts of the cage on it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from separatrix.figures.style import BLACK, BLUE, GREEN, GREY, PAGE, VERMILION, Look, canvas, legend_below
from separatrix.units import format_number

DASHED = (0, (4, 2))


def figures(data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the pictures of `mobility`: of the ball, and with a cage of its impacts."""
    yield "mobility", mobility(data)
    if "impact" in data.sizes:
        yield "mobility-impacts", impacts(data)


def mobility(data: xr.Dataset) -> Figure:
    """Step response, size of the mobility against frequency, F(u) with the linear law and the capacity."""
    figure, (step, size, push) = canvas(PAGE, 2.7, ncols=3)
    _step(step, data)
    _size(size, data)
    _push(push, data)
    return figure


def _step(axes: Axes, data: xr.Dataset) -> None:
    """F/u after a force was put on, between the dampings of held and of relaxed spin."""
    axes.plot(data["instant"], data["step_damping"], color=BLUE)
    lines = (
        ("damping_locked", "spin held", (0, (1, 1.5))),
        ("damping", "attitude held, $C_f$", DASHED),
        ("damping_relaxed", "all relaxed, $C_{eff}$", "-"),
    )
    for name, words, dashes in lines:
        value = float(data[name])
        axes.axhline(value, color=GREY, lw=0.8, ls=dashes, label=f"{words}: {format_number(value)}")
    top = 2.0 * float(data["damping_locked"])
    axes.set(xscale="log", ylim=(0, top), title="a  Response to a step of force")
    axes.set(xlabel="time after the step [s]", ylabel="force over speed [N s/m]")
    axes.legend(loc="upper right", fontsize=6.5, handlelength=2.2)


def _size(axes: Axes, data: xr.Dataset) -> None:
    """|Y| against frequency with the rates of the modes."""
    frequency, size = data["frequency"], 1e3 * data["mobility"]
    axes.plot(frequency, size, color=BLUE, label=r"$|Y(i\omega)|$")
    real = 1e3 / data["damping_at_frequency"]
    axes.plot(frequency, real, color=BLUE, lw=0.9, ls=DASHED, label=r"Re $Y(i\omega)$")
    for rate in data["rates"].values:
        axes.axvline(rate / (2.0 * np.pi), color=GREY, lw=0.6, ls=(0, (1, 1.5)))
    low = float(size.min())
    axes.set(xscale="log", yscale="log", ylim=(0.5 * low, 2.0 * float(size.max())))
    axes.set(title="b  Mobility; dotted: rates", xlabel="frequency [Hz]", ylabel="speed over force [mm/s/N]")
    look: Look = {"frameon": True, "facecolor": "white", "edgecolor": "none", "framealpha": 0.9}
    axes.legend(loc="lower left", handlelength=2.2, **look)


def _push(axes: Axes, data: xr.Dataset) -> None:
    """F(u) of the slip fields both ways, the law, the linear law and the capacity."""
    u, capacity = data["speed"].values, float(data["capacity"])
    axes.axhline(capacity, color=GREY, lw=0.8, ls=DASHED, label=f"capacity {format_number(capacity, 3)} N")
    linear = np.array((0.0, 1.15 * capacity / float(data["damping"])))
    axes.plot(linear, float(data["damping"]) * linear, color=BLACK, lw=0.8, ls=(0, (1, 1.5)), label="$C_f u$")
    for name, words, colour in (("forward", "forward", BLUE), ("backward", "backward", VERMILION)):
        axes.plot(_from_rest(u), _from_rest(data[f"force_{name}"].values), color=colour, label=words)
    axes.plot(_from_rest(u), _from_rest(data["force_law"].values), color=GREEN, ls=DASHED, label="law")
    axes.set(xlim=(0, u[-1]), ylim=(0, 1.25 * capacity), title="c  Ball pushed along its orbit")
    axes.set(xlabel="speed beyond free orbit [m/s]", ylabel="force [N]")
    axes.legend(loc="lower right", fontsize=6.5, handlelength=2.2)


def _from_rest(values: np.ndarray) -> np.ndarray:
    """Values of a curve with its start at 0."""
    return np.append(0.0, values)


def impacts(data: xr.Dataset) -> Figure:
    """Restitution against the speed of the impact, beside the paper's; largest force beside the capacity."""
    figure, (returned, force) = canvas(PAGE, 2.9, ncols=2)
    v = data["impacts_speed"].values
    lines: tuple[tuple[str, str, Look], ...] = (
        ("restitution_forward", "slip fields, cage from behind", {"color": BLUE}),
        ("restitution_backward", "slip fields, cage from the front", {"color": VERMILION}),
        ("restitution_law", "law of traction $F(u)$", {"color": GREEN, "ls": DASHED}),
    )
    for name, words, look in lines:
        returned.plot(v, data[f"impacts_{name}"], label=words, **look)
    returned.axhline(0.0, color=GREY, lw=0.5)
    eta = float(data["impacts_restitution_summed"])
    nominal = float(data["impacts_nominal_restitution_factor"])
    returned.axhline(eta, color=BLACK, lw=0.9, ls=(0, (1, 1.5)), label=f"Eq. 18, mass felt: {eta:.2f}")
    words = rf"paper's $\eta$, whole cage: {nominal:.2f}"
    returned.axhline(nominal, color=BLACK, lw=0.9, ls=(0, (6, 1.5, 1, 1.5)), label=words)
    returned.set(xscale="log", title="a  Share of the speed that returns", xlabel="speed of the impact [m/s]")
    returned.set(ylabel="restitution [-]", ylim=(None, 1.0))
    capacity = float(data["capacity"])
    force.plot(v, data["impacts_peak_force"], color=BLUE, label="largest force of the pocket")
    force.axhline(
        capacity, color=GREY, lw=0.8, ls=DASHED, label=f"capacity of the races {format_number(capacity, 3)} N"
    )
    force.set(xscale="log", yscale="log", title="b  Largest force", xlabel="speed of the impact [m/s]")
    force.set(ylabel="force [N]")
    legend_below(figure, columns=3)
    return figure
