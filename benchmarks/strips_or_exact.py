"""Slopes, C_mu and eta of the shipped bearing by strips and by the exact contact, film by film.

``python benchmarks/strips_or_exact.py``: the tables of docs/theory/strips-or-exact.md.
"""

from __future__ import annotations

from dataclasses import replace

from separatrix.chain.contacts import race_tracks
from separatrix.chain.impact_restitution import contact_damping, restitution
from separatrix.chain.race_traction import SLOPE_ALONE, contact_traction
from separatrix.chain.solution import Solution, solve
from separatrix.ground.errors import SeparatrixError
from separatrix.study.reading import read_study
from separatrix.study.study import (
    ContactPressure,
    Film,
    KinematicModel,
    Material,
    TractionModel,
    TractionSettings,
    Wear,
)

FILMS = (
    *((0.5e9, 0.46, h) for h in (2e-7, 1e-6, 3e-6, 1e-5)),
    *((1.5e9, 0.40, h) for h in (1e-6, 3e-6, 1e-5)),
    *((4e9, 0.38, h) for h in (2e-7, 1e-6, 3e-6, 1e-5)),
    *((20e9, 0.30, h) for h in (1e-6, 1e-5)),
    *((136e9, 0.25, h) for h in (1e-6, 1e-5)),
)
"""Young's modulus [Pa], Poisson's ratio and thickness [m]."""

EXACT = TractionSettings(model=TractionModel.EXACT)
OWN = replace(EXACT, pressure=ContactPressure.COATED)


WAYS = {
    "series": TractionSettings(),
    "coated": TractionSettings(pressure=ContactPressure.COATED),
    "exact": EXACT,
    "own": OWN,
}


def cells(solution: Solution, film: Film, ways: list[str]) -> list[str]:
    """Inner slopes, outer slopes, C_mu and eta, each by every way."""
    found: list[list[str]] = [[], [], [], []]
    bearing = solution.study.bearing
    for way in ways:
        try:
            slopes = [
                contact_traction(track, WAYS[way], SLOPE_ALONE).slope
                for track in race_tracks(bearing, film, solution.bearing)
            ]
        except SeparatrixError:
            for column in found:
                column.append("-")
            continue
        state = solution.bearing
        dampings = [contact_damping(*each) for each in zip(slopes, (state.inner, state.outer), strict=True)]
        eta = restitution(*dampings, ball_cage_stiffness=3e6, cage_mass=0.025).restitution_factor
        for column, value in zip(
            found, (f"{slopes[0]:.2f}", f"{slopes[1]:.2f}", f"{sum(dampings):.0f}", f"{eta:.3f}"), strict=True
        ):
            column.append(value)
    return [" / ".join(column) for column in found]


def row(*words: str) -> None:
    """Print a row of a table."""
    print(f"| {' | '.join(words)} |", flush=True)


def main() -> None:
    """Print the tables."""
    study = read_study("cryogenic-turbopump")
    free = solve(study)
    for model in (KinematicModel.FREE, KinematicModel.OUTER_RACE_CONTROL):
        held = solve(replace(study, kinematics=model))
        for mu in (0.05, 0.1, 0.2, 0.3):
            row(model.value, f"{mu:g}", *cells(held, Film(race_friction=mu), ["series", "exact"]))
    for E, nu, h in FILMS:
        film = Film(
            race_friction=0.1,
            thickness=h,
            material=Material(name="film", elastic_modulus=E, poisson_ratio=nu),
        )
        row(f"{E / 1e9:g}, {h * 1e6:g}", *cells(free, film, [*WAYS]))
    soft = Material(name="film", elastic_modulus=1.5e9, poisson_ratio=0.4)
    for share in (0.0, 0.05, 0.1, 0.2, 0.35, 0.5, 1.0):
        wear = Wear(friction=0.3, share=share)
        film = Film(race_friction=0.1, thickness=3e-6, material=soft, wear=wear)
        row(f"{share:g}", *cells(free, film, ["series", "exact"]))


if __name__ == "__main__":
    main()
