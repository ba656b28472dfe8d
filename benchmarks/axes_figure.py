"""Axes and signs of a cage in space: docs/images/axes-and-signs.png.

python benchmarks/axes_figure.py [FILE]
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Circle, FancyArrowPatch, Polygon

HOME = Path(__file__).parents[1] / "docs" / "images" / "axes-and-signs.png"
CAGE, BALL, FORCE, SPIN, FAINT = "#1f5a99", "#777777", "#c1440e", "#2a8f6a", "#bbbbbb"
BALLS, PITCH = 8, 1.0
Place = tuple[float, float]


def main() -> None:
    """Draw the four views."""
    figure, axes = plt.subplots(2, 2, figsize=(9.6, 9.2), layout="constrained")
    plane(axes[0, 0])
    tilt(axes[0, 1])
    pocket(axes[1, 0])
    spin(axes[1, 1])
    for one in axes.flat:
        one.set_aspect("equal")
        one.axis("off")
    figure.savefig(Path(sys.argv[1]) if len(sys.argv) > 1 else HOME, dpi=110)


def arrow(
    axes: Axes, start: Place, end: Place, colour: str, *, bend: float = 0.0, width: float = 1.6
) -> None:
    """Draw an arrow, bent to the right by a share of its length."""
    style = f"arc3,rad={bend}"
    patch = FancyArrowPatch(
        start, end, arrowstyle="-|>", mutation_scale=12, linewidth=width, color=colour,
        connectionstyle=style, shrinkA=0, shrinkB=0, zorder=5,
    )  # fmt: skip
    axes.add_patch(patch)


def label(axes: Axes, at: Place, text: str, colour: str = "black", size: float = 10.0) -> None:
    """Write at a place."""
    axes.text(*at, text, color=colour, fontsize=size, ha="center", va="center", zorder=6)


def towards(axes: Axes, at: Place, text: str) -> None:
    """Mark an axis that points to the viewer."""
    axes.add_patch(Circle(at, 0.035, fill=False, linewidth=1.4, zorder=5))
    axes.add_patch(Circle(at, 0.009, color="black", zorder=5))
    label(axes, (at[0] - 0.1, at[1] - 0.09), text)


def plane(axes: Axes) -> None:
    """Seen along the bearing axis, which points to the viewer."""
    axes.set_title("The plane of the balls, seen from +z", fontsize=10)
    off = (0.13, 0.06)
    for radius in (PITCH - 0.1, PITCH + 0.1):
        axes.add_patch(Circle(off, radius, fill=False, color=CAGE, linewidth=1.4))
    axes.add_patch(Circle((0.0, 0.0), PITCH, fill=False, color=FAINT, linestyle=":"))
    for j in range(BALLS):
        a = 2.0 * math.pi * j / BALLS
        axes.add_patch(Circle((math.cos(a), math.sin(a)), 0.16, color=BALL, alpha=0.35))
    arrow(axes, (0.0, 0.0), (0.62, 0.0), "black")
    arrow(axes, (0.0, 0.0), (0.0, 0.62), "black")
    label(axes, (0.66, -0.08), "x")
    label(axes, (-0.08, 0.62), "y")
    towards(axes, (0.0, 0.0), "z")
    arrow(axes, (0.0, 0.0), off, CAGE, width=2.2)
    label(axes, (0.2, 0.13), "r", CAGE)
    a = math.pi / 4.0
    c, s = math.cos(a), math.sin(a)
    axes.plot([0.0, c], [0.0, s], color=FAINT, linewidth=0.9)
    axes.add_patch(Arc((0.0, 0.0), 0.8, 0.8, theta1=0.0, theta2=45.0, color="black", linewidth=0.9))
    label(axes, (0.47, 0.2), r"$\varphi_j$")
    arrow(axes, (c, s), (c + 0.42 * c, s + 0.42 * s), "black")
    arrow(axes, (c, s), (c - 0.42 * s, s + 0.42 * c), "black")
    label(axes, (c + 0.5 * c, s + 0.5 * s), "$e_r$")
    label(axes, (c - 0.5 * s, s + 0.5 * c), "$e_t$")
    label(axes, (c, s), "j")
    arrow(axes, (-0.3, -0.3), (0.3, -0.3), SPIN, bend=0.4)
    label(axes, (0.0, -0.58), r"$\Omega$ of balls" + "\nand cage > 0", SPIN, 9.0)
    label(axes, (0.0, -1.35), "At the start x points to azimuth 0, along the radial load.", size=9.0)
    axes.set_xlim(-1.45, 1.6)
    axes.set_ylim(-1.45, 1.5)


def tilt(axes: Axes) -> None:
    """Two views across the axis: what a positive tilt about each axis does."""
    axes.set_title("Tilt of the cage, seen across its axis", fontsize=10)
    for low, up, angle, name, lean in (
        (0.85, "x", 14.0, r"$\tau_y > 0$", "leans towards +x"),
        (-0.85, "y", -14.0, r"$\tau_x > 0$", "leans towards -y"),
    ):
        turn = math.radians(angle)
        c, s = math.cos(turn), math.sin(turn)

        def place(z: float, x: float, c: float = c, s: float = s, low: float = low) -> Place:
            return c * z - s * x, low + s * z + c * x

        for side in (1.0, -1.0):
            corners = [place(z, side * x) for z, x in ((-0.3, 0.4), (0.3, 0.4), (0.3, 0.54), (-0.3, 0.54))]
            axes.add_patch(Polygon(corners, color=CAGE, alpha=0.35))
            axes.plot([-0.5, 0.5], [low + side * 0.68] * 2, color="black", linewidth=2.0)
        axes.plot([0.0, 0.0], [low - 0.6, low + 0.6], color=FAINT, linestyle=":")
        arrow(axes, (-0.75, low), (1.0, low), "black", width=1.0)
        arrow(axes, place(-0.75, 0.0), place(1.0, 0.0), CAGE, width=1.8)
        start, end = (0.8, low), place(0.8, 0.0)
        arrow(axes, start, end, SPIN, bend=math.copysign(0.25, angle), width=2.0)
        label(axes, (1.08, low), "z")
        arrow(axes, (-0.75, low), (-0.75, low + 0.5), "black", width=1.0)
        label(axes, (-0.84, low + 0.5), up)
        label(axes, (0.3, low + math.copysign(0.24, angle)), name, SPIN)
        label(axes, (1.02, low + math.copysign(0.42, angle)), f"its axis\n{lean}", CAGE, 9.0)
    towards(axes, (-0.75, 0.85), "y")
    axes.add_patch(Circle((-0.75, -0.85), 0.035, fill=False, linewidth=1.4))
    label(axes, (-0.75, -0.85), "×", size=9.0)
    label(axes, (-0.85, -0.94), "x")
    label(axes, (-0.65, 1.53), "land", size=9.0)
    axes.annotate("", (0.0, 1.62), (0.3, 1.62), arrowprops={"arrowstyle": "<->", "linewidth": 0.9})
    label(axes, (0.38, 1.66), r"$\zeta$", size=9.0)
    axes.set_xlim(-1.1, 1.4)
    axes.set_ylim(-1.7, 1.8)


def pocket(axes: Axes) -> None:
    """A bore and its ball from outside; the clearance is drawn far too large."""
    axes.set_title("Pocket j from outside, clearance drawn too large", fontsize=10)
    ball, radius, angle = (0.0, 0.0), 0.62, math.radians(35.0)
    p = (math.cos(angle), math.sin(angle))
    centre = (-0.3 * p[0], -0.3 * p[1])
    axes.add_patch(Circle(ball, radius, color=BALL, alpha=0.3))
    axes.add_patch(Circle(centre, radius + 0.3, fill=False, color=CAGE, linewidth=2.0))
    label(axes, (-0.55, 0.78), "pocket", CAGE, 9.0)
    label(axes, (-0.36, -0.2), "ball", BALL, 9.0)
    axes.plot([0.0], [0.0], "k+")
    axes.plot([centre[0]], [centre[1]], "+", color=CAGE)
    arrow(axes, ball, centre, CAGE)
    label(axes, (-0.17, 0.08), r"$(d_t, d_z)$", CAGE, 9.0)
    touch = (radius * p[0], radius * p[1])
    arrow(axes, touch, (touch[0] + 0.45 * p[0], touch[1] + 0.45 * p[1]), FORCE, width=2.2)
    label(
        axes,
        (touch[0] + 0.62 * p[0], touch[1] + 0.62 * p[1] + 0.05),
        r"$N\hat p$" + "\non the cage",
        FORCE,
        9.0,
    )
    axes.plot([0.0, touch[0]], [0.0, touch[1]], color=FORCE, linewidth=0.8)
    axes.plot([0.0, radius], [0.0, 0.0], color="black", linewidth=0.8)
    axes.add_patch(Arc(ball, 0.6, 0.6, theta1=0.0, theta2=35.0, color="black"))
    label(axes, (0.4, 0.12), "clock", size=9.0)
    label(axes, (0.93, -0.02), "0: front of\nthe ball", size=8.0)
    axes.plot([0.0], [radius], "k.", markersize=4)
    label(axes, (0.1, radius - 0.12), "90 deg", size=8.0)
    corner = (-1.15, -1.12)
    arrow(axes, corner, (corner[0] + 0.5, corner[1]), "black")
    arrow(axes, corner, (corner[0], corner[1] + 0.5), "black")
    label(axes, (corner[0] + 0.58, corner[1]), "$e_t$")
    label(axes, (corner[0], corner[1] + 0.58), "$e_z$")
    towards(axes, corner, "$e_r$")
    axes.set_xlim(-1.45, 1.5)
    axes.set_ylim(-1.35, 1.25)


def spin(axes: Axes) -> None:
    """A ball seen from the front: its spin, what its front pole does, contacts with the races."""
    axes.set_title("Ball j from the front: spin with its pitch", fontsize=10)
    pitch, contact = math.radians(25.4), math.radians(28.0)
    c, s = math.cos(pitch), math.sin(pitch)
    axes.add_patch(Circle((0.0, 0.0), 0.7, color=BALL, alpha=0.3))
    arrow(axes, (0.95 * c, -0.95 * s), (-1.05 * c, 1.05 * s), SPIN, width=2.0)
    label(axes, (-1.2 * c, 1.2 * s + 0.04), "spin O", SPIN)
    axes.plot([-1.15, 0.0], [0.0, 0.0], color="black", linewidth=0.8)
    axes.add_patch(Arc((0.0, 0.0), 1.7, 1.7, theta1=180.0 - 25.4, theta2=180.0, color="black"))
    label(axes, (-0.95, 0.19), r"$\beta$")
    arrow(axes, (0.0, 0.0), (0.55 * s, 0.55 * c), FORCE, width=2.2)
    axes.plot([0.0], [0.0], "ko", markersize=4)
    label(axes, (0.05, -0.1), "front pole", size=8.0)
    label(axes, (0.46, 0.3), "its surface", FORCE, 9.0)
    x, r = math.sin(contact), math.cos(contact)
    for side, name in ((1.0, "outer race"), (-1.0, "inner race")):
        at = (0.7 * side * x, 0.7 * side * r)
        axes.plot([at[0], 1.45 * at[0]], [at[1], 1.45 * at[1]], color="black", linestyle="--", linewidth=1.0)
        axes.plot(
            [at[0] - 0.2 * r, at[0] + 0.2 * r],
            [at[1] + 0.2 * x, at[1] - 0.2 * x],
            color="black",
            linewidth=2.4,
        )
        label(axes, (at[0] + 0.45 * side, at[1] + 0.12 * side), name, size=9.0)
    axes.plot([0.0, 0.0], [0.7, 1.15], color=FAINT, linestyle=":")
    axes.add_patch(Arc((0.0, 0.0), 1.9, 1.9, theta1=62.0, theta2=90.0, color="black", linewidth=0.9))
    label(axes, (0.24, 1.04), r"$\alpha$")
    arrow(axes, (0.1, -0.95), (0.5, -0.95), CAGE)
    label(axes, (0.62, -1.08), "$x_j$, place along the groove", CAGE, 9.0)
    corner = (-1.15, -1.05)
    arrow(axes, corner, (corner[0] + 0.45, corner[1]), "black")
    arrow(axes, corner, (corner[0], corner[1] + 0.45), "black")
    label(axes, (corner[0] + 0.53, corner[1]), "$e_z$")
    label(axes, (corner[0], corner[1] + 0.53), "$e_r$")
    towards(axes, corner, "$e_t$")
    axes.set_xlim(-1.45, 1.5)
    axes.set_ylim(-1.35, 1.25)


if __name__ == "__main__":
    main()
