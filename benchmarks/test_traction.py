"""Speed of the traction stage: one strip, master tables, curves and slopes, all warm."""

import numpy as np

from separatrix.chain.hertz import Creep, contact_ellipse
from separatrix.chain.strip import film_tables, solve_strip
from separatrix.chain.traction_curve import traction_curve, traction_slope

ELLIPSE = contact_ellipse(500.0, 200.0, 20.0, 113e9)
FILM = 0.3 * ELLIPSE.semi_minor / ELLIPSE.contact_modulus


def curves():
    """41 increments for each of 5 spins, with film, Heathcote, free rolling and slope: the paper's Fig. 7."""
    return [
        traction_curve(ELLIPSE, Creep(spin=s, curvature=-2e4), race_friction=0.1, film_compliance=FILM)
        for s in (1.0, 5.0, 10.0, 20.0, 40.0)
    ]


def slopes():
    """40 film thicknesses for each of 5 frictions: one race of the paper's Fig. 8."""
    return [
        traction_slope(
            ELLIPSE, Creep(spin=5.0, curvature=-2e4), race_friction=mu, film_compliance=k * 0.1 * FILM
        )
        for mu in (0.02, 0.05, 0.1, 0.2, 0.4)
        for k in range(40)
    ]


def test_one_strip(benchmark):
    """Direct active set, 200 elements."""
    benchmark(solve_strip, 0.4, 0.3, nodes=200)


def test_205_traction_points_with_film(benchmark):
    """The row of the design: under 10 ms."""
    assert sum(c.traction_coefficient.size for c in benchmark(curves)) == 205


def test_200_slopes(benchmark):
    """Slopes with their errors."""
    assert len(benchmark(slopes)) == 200


def test_chain_of_two_races(benchmark):
    """Inner and outer race: curve of 41 increments and slope."""

    def both():
        return [
            traction_curve(ELLIPSE, Creep(spin=5.0, curvature=q), race_friction=0.1, film_compliance=FILM)
            for q in (-2e4, 2e4)
        ]

    assert np.isfinite([c.slope for c in benchmark(both)]).all()


def test_master_tables(benchmark):
    """Paid once a process: 56 films, strips of 200 and 400 elements."""

    def fresh():
        film_tables.cache_clear()
        return film_tables(200)

    benchmark(fresh)
