"""Critical friction against chi, disturbance over clearance: weak impacts to the linear limit, in one figure.

    python benchmarks/chi_law.py --out FILE.png --csv FILE.csv [--runs 128]

chi = v0 sqrt(M/k)/c_p is how far a disturbance presses a pocket in, over the clearance. The cage: 11 balls,
50 g, 3e6 N/m, c_p 0.3 mm, a thin ring free to turn, ball set at rest, no land. Only the disturbance
changes; a change of the clearance would give the same, since nothing else has a length. A run lasts 0.3 s,
or 250 crossings of the clearance if that is longer.

Points already in the CSV are not computed again, so a complete one is only drawn; Ctrl-C keeps what is
finished and draws it. In the CSV chi = inf stands for the linear limit in closed form, and chi = 0 for hard
impacts: walls instead of springs, with the same starts, by the engine of version 0.1.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from separatrix.cage import MovingCage
from separatrix.ground.units import Array
from separatrix.present.draw import NOTHING, PAGE, STYLE
from separatrix.present.figure import BLUE, GREEN, GREY, PURPLE, VERMILION
from separatrix.study.study import StabilitySettings
from separatrix.verdict.critical_friction import LADDER, Crossing, cage_at, responses
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.stability_curve import critical_friction, linear_limit

MASS, RADIUS, HALF_PLAY, STIFFNESS = 0.05, 0.03, 0.3e-3, 3e6
CAGE = MovingCage(
    mass=MASS, moment_of_inertia=MASS * RADIUS**2, ball_count=11, pitch_radius=RADIUS, cage_speed=0.0,
    inner_speed=1000.0, outer_speed=0.0, pocket_clearance=2 * HALF_PLAY, ball_cage_stiffness=STIFFNESS,
    race_damping=2000.0, ball_cage_friction=0.1,
)  # fmt: skip
KICK, DURATION, CROSSINGS = 0.5, 0.3, 250
FACTORS = (0.9, 0.8, 0.6, 0.3)
CHI_MIDDLE = KICK * math.sqrt(MASS / STIFFNESS) / HALF_PLAY
CHIS = tuple(CHI_MIDDLE * 10 ** (step / 4) for step in range(-7, 12))
CHECKED = {0.9: 0.078, 0.8: 0.115, 0.6: 0.165}
"""Critical friction at the middle chi by other programs with fixed steps, 100 runs, 10 % each."""

SHARP, AGAIN = 1.02, 16
"""Where the fitted interval is narrower than a step of the ladder, P may rise more steeply than the fit
allows for: the step is halved, 16 runs a time, down to 2 %."""


@dataclass(frozen=True)
class Point:
    """A row of the CSV: critical friction with its 95 % interval."""

    restitution_factor: float
    chi: float
    kick_m_s: float
    duration_s: float
    runs: int
    critical_friction: float
    low: float
    high: float


def settings_at(chi: float, runs: int) -> StabilitySettings:
    """Ensemble of one kick."""
    kick = KICK * chi / CHI_MIDDLE
    return StabilitySettings(
        kicks=(kick,),
        reference_kick=kick,
        runs=runs,
        duration=max(DURATION, CROSSINGS * 2 * HALF_PLAY / kick),
    )


def computed(eta: float, chi: float, runs: int) -> Point:
    """Point of a curve, or its linear limit."""
    if math.isinf(chi):
        f = linear_limit(CAGE, eta).critical_friction
        return Point(eta, chi, chi, 0.0, 0, f, f, f)
    settings = settings_at(chi, runs)
    found = pressed_pockets(eta, settings)
    whole = found.value, found.low, found.high
    return Point(eta, chi, settings.kicks[0], settings.duration, runs, *whole)


def pressed_pockets(eta: float, settings: StabilitySettings) -> Crossing:
    """Critical friction by counting runs."""
    at = critical_friction(CAGE, eta, settings, band=False)
    if at.critical_friction is None or at.scatter_low is None or at.scatter_high is None:
        raise SystemExit(f"eta {eta:g}, kick {settings.kicks[0]:g} m/s: {at.reason}")
    found = Crossing(at.critical_friction, at.scatter_low, at.scatter_high)
    low, high = step_around(found.value)
    if found.high / found.low > 1.0001 * high / low:
        return found
    counts = responses(cage_at(CAGE, eta, 0.0), settings, settings.kicks, Runner())[settings.kicks[0]]
    return sharpened(found, low, high, lambda f: counts.look(f, 0, AGAIN).interval())


def step_around(friction: float) -> tuple[float, float]:
    """Neighbours on the ladder of frictions."""
    above = next(i for i, f in enumerate(LADDER) if f > friction)
    return LADDER[above - 1], LADDER[above]


def sharpened(
    found: Crossing, low: float, high: float, interval: Callable[[float], tuple[float, float]]
) -> Crossing:
    """Bracket of a jump: one half is outside the 95 % interval of P(whirl) at its ends; else the fit."""
    step = high / low
    while high / low > SHARP:
        middle = math.sqrt(low * high)
        least, most = interval(middle)
        if least <= 0.5 <= most:
            return found if high / low == step else Crossing(middle, low, high)
        low, high = (middle, high) if most < 0.5 else (low, middle)
    return Crossing(math.sqrt(low * high), low, high)


def read(path: Path) -> list[Point]:
    """Points of an earlier call; none if there is no file."""
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return [Point(**{k: int(v) if k == "runs" else float(v) for k, v in row.items()})
                for row in csv.DictReader(file)]  # fmt: skip


def write(path: Path, points: list[Point]) -> None:
    """Write beside and rename, so that an interrupt leaves whole rows."""
    beside = path.with_name(path.name + ".part")
    with beside.open("w", newline="") as file:
        rows = csv.DictWriter(file, list(Point.__dataclass_fields__), lineterminator="\n")
        rows.writeheader()
        for point in sorted(points, key=lambda p: (-p.restitution_factor, p.chi)):
            rows.writerow({k: v if k == "runs" else f"{v:.6g}" for k, v in asdict(point).items()})
    beside.replace(path)


def wanted() -> Iterator[tuple[float, float]]:
    """Restitution factor and chi of every point, limits first."""
    for chi in (math.inf, *CHIS):
        for eta in FACTORS:
            yield eta, chi


def collect(path: Path, runs: int) -> list[Point]:
    """Compute what the CSV lacks, one row at a time, until done or interrupted."""
    points = read(path)
    known = {(p.restitution_factor, f"{p.chi:.6g}") for p in points}
    missing = [at for at in wanted() if (at[0], f"{at[1]:.6g}") not in known]
    began = time.perf_counter()
    try:
        for i, (eta, chi) in enumerate(missing, 1):
            points.append(computed(eta, chi, runs))
            write(path, points)
            p, spent = points[-1], time.perf_counter() - began
            print(f"{i}/{len(missing)} {spent:.0f} s: eta {eta:g}, chi {chi:.3g}: "
                  f"{p.critical_friction:.4f} ({p.low:.4f} to {p.high:.4f})", file=sys.stderr)  # fmt: skip
    except KeyboardInterrupt:
        print(f"interrupted: {len(points)} points are kept in {path}", file=sys.stderr)
    return points


COLOURS = dict(zip(FACTORS, (BLUE, GREEN, VERMILION, PURPLE), strict=True))
MARKS = dict(zip(FACTORS, ("o", "s", "^", "D"), strict=True))


def draw(points: list[Point], path: Path) -> None:
    """One figure: points with intervals, lines of the limits."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(PAGE, 4.4), layout="constrained")
        axes = figure.subplots()
        axes.set(xscale="log", yscale="log", xlim=(2.4e-3, 420.0), ylim=(0.018, 0.5))
        for eta in FACTORS:
            curve(axes, eta, {p.chi: p for p in points if p.restitution_factor == eta})
        for eta, friction in CHECKED.items():
            axes.plot(CHI_MIDDLE, friction, marker="x", ms=6, mew=1.2, color=COLOURS[eta], ls="")
        finish(axes)
        legend(figure)
        figure.savefig(path, metadata=NOTHING[path.suffix])


def curve(axes: Axes, eta: float, points: dict[float, Point]) -> None:
    """Points of one restitution factor, with its limits where they belong."""
    colour, dots = COLOURS[eta], [p for chi, p in points.items() if 0.0 < chi < math.inf]
    heights = np.array([p.critical_friction for p in dots])
    ends = np.abs(np.array([[p.low for p in dots], [p.high for p in dots]]) - heights)
    look = {"color": colour, "marker": MARKS[eta], "ms": 3.5, "lw": 0.0, "elinewidth": 0.9, "capsize": 1.8}
    axes.errorbar([p.chi for p in dots], heights, yerr=ends, **look)
    if 0.0 in points:
        hard = points[0.0]
        axes.fill_between([2.4e-3, 0.03], hard.low, hard.high, color=colour, alpha=0.2, lw=0)
        axes.plot([2.4e-3, 0.03], [hard.critical_friction] * 2, color=colour, lw=1.0, ls="-.")
    if math.inf in points:
        linear = points[math.inf].critical_friction
        axes.plot([0.3, 420.0], [linear] * 2, color=colour, lw=1.0, ls="--")
        chi = np.geomspace(2.5, 420.0, 200)
        axes.plot(chi, linear * softening(chi), color=colour, lw=0.9)
        text = rf"$\eta$ = {eta:g}"
        axes.annotate(text, (420.0, linear), (4, 0), textcoords="offset points", color=colour, va="center")


def softening(chi: Array) -> Array:
    """Share of the linear limit at which a steady whirl has the kick's energy, by harmonic balance.

    A pocket that is free for half play c_p and moves by A has the mean stiffness k s(c_p/A), and the law of
    the linear limit goes with its root; the energy of the kick is that of a whirl of radius A.
    """
    share = np.ones_like(chi)
    for _ in range(200):
        d = math.sqrt(CAGE.ball_count / 2) * np.sqrt(share) / chi
        share = 0.5 * share + 0.5 * (1.0 - 2.0 / np.pi * (np.arcsin(d) + d * np.sqrt(1.0 - d * d)))
    return np.sqrt(share)


def finish(axes: Axes) -> None:
    """Axes and their labels; the disturbance of the cage at hand along the top."""
    axes.set(
        xlabel=r"initial disturbance over clearance $\chi = v_0\,\sqrt{M/k}\,/\,c_p$ [-]",
        ylabel=r"friction at which half the runs whirl, $f_{BC}$ [-]",
    )
    axes.set_yticks([0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.5])
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter("")
    axes.xaxis.set_major_formatter("{x:g}")
    per_chi = KICK / CHI_MIDDLE
    top = axes.secondary_xaxis("top", functions=(lambda chi: chi * per_chi, lambda kick: kick / per_chi))
    top.set_xlabel(r"initial disturbance at $c_p$ = 0.3 mm, 50 g, 3 MN/m [m/s]")
    top.xaxis.set_major_formatter("{x:g}")


def legend(figure: Figure) -> None:
    """What the marks and lines are, below the picture."""
    look = {"color": GREY, "lw": 1.0}
    bar = Line2D([], [], marker="o", ms=3.5, color=GREY, lw=0.0)
    handles = {
        "runs, with 95 % interval (colours: restitution factor)": bar,
        "other programs with fixed steps, 100 runs": Line2D([], [], marker="x", ms=6, color=GREY, lw=0.0),
        "hard impacts: walls, same starts, with 95 % interval": Line2D([], [], ls="-.", **look),
        "linear limit: no clearance": Line2D([], [], ls="--", **look),
        "linear law softened by the clearance (harmonic balance)": Line2D([], [], ls="-", **look),
    }
    figure.legend(list(handles.values()), list(handles), loc="outside lower left", ncols=2, fontsize=6.5)


def main() -> None:
    """Compute what is missing, then draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True, help="picture")
    parser.add_argument("--csv", type=Path, required=True, help="its points, read and completed")
    parser.add_argument("--runs", type=int, default=128, help="scale of the runs at a point")
    asked = parser.parse_args()
    draw(collect(asked.csv, asked.runs), asked.out)


if __name__ == "__main__":
    main()
