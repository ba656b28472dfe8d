"""Critical friction of evenly against unevenly spaced balls: their ratio, with its interval.

    python benchmarks/spacing.py [--share 0.2] [--runs 256]

Two things are called uneven spacing. Pitch: each pocket with its ball is displaced by up to this share of the
pitch (`pocket_spacing_scatter`). Lead: each ball stands off the middle of its pocket by up to this share of
the half play (`ball_scatter`). Both uniform, anew in each run; even is without either. The cage is that of
`chi_law.py`, at kicks of 0.1 m/s (chi 0.043, the impact regime) and 0.5 m/s (chi 0.22).
"""

from __future__ import annotations

import argparse
import math
from dataclasses import replace

from chi_law import CAGE, CHI_MIDDLE, KICK, settings_at

from separatrix.verdict.stability_curve import CriticalFriction, critical_friction

FACTORS = (0.9, 0.8, 0.6)
KICKS = (0.1, 0.5)


def threshold(eta: float, kick: float, runs: int, pitch: float, lead: float) -> CriticalFriction:
    """Critical friction with these shares of unevenness."""
    settings = replace(settings_at(CHI_MIDDLE * kick / KICK, runs), ball_scatter=lead)
    return critical_friction(replace(CAGE, pocket_spacing_scatter=pitch), eta, settings, band=False)


def ratio(even: CriticalFriction, uneven: CriticalFriction) -> str:
    """Uneven over even, with a 95 % interval: both errors in ln f, added as squares."""
    middle = uneven.critical_friction / even.critical_friction
    half = 0.5 * math.hypot(*(math.log(p.scatter_high / p.scatter_low) for p in (even, uneven)))
    return f"{middle:.2f} ({middle * math.exp(-half):.2f} to {middle * math.exp(half):.2f})"


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--share", type=float, default=0.2, help="of the pitch, or of the half play")
    parser.add_argument("--runs", type=int, default=256, help="scale of the runs at a point")
    asked = parser.parse_args()
    uneven = {"pitch": (asked.share, 0.0), "lead": (0.0, asked.share), "both": (asked.share, asked.share)}
    for kick in KICKS:
        for eta in FACTORS:
            even = threshold(eta, kick, asked.runs, 0.0, 0.0)
            print(f"kick {kick:g} m/s, eta {eta:g}: even {even.critical_friction:.4f}", end="", flush=True)
            for name, shares in uneven.items():
                found = threshold(eta, kick, asked.runs, *shares)
                print(f", {name} {found.critical_friction:.4f} x {ratio(even, found)}", end="", flush=True)
            print(flush=True)


if __name__ == "__main__":
    main()
