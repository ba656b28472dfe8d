"""The slope of the traction curve, bare and with films of a soft material (the paper's Figs 7 and 8)."""

from separatrix.chain import bearing_state
from separatrix.study import Film
from separatrix.study_file import read_study
from separatrix.traction import film_compliance, traction_slope

study = read_study("cryogenic-turbopump")
at = bearing_state(study).outer
material = study.film.material

slopes = {}
for thickness in (None, 0.1e-6, 1e-6, 10e-6):
    film = Film(race_friction=0.1, material=material if thickness else None, thickness=thickness)
    slope, error = traction_slope(
        at.ellipse, at.creep, race_friction=film.race_friction, film_compliance=film_compliance(film)
    )
    slopes[thickness] = slope
    print(
        f"{'bare' if thickness is None else f'{thickness * 1e6:g} um':>7}: alpha = {slope:.3f} +- {error:.3f}"
    )

ratio = slopes[10e-6] / slopes[None]
