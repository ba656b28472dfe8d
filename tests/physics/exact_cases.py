"""Contacts that the tests of exact rolling share: ellipses of given half lengths and plane strips."""

import math

import numpy as np

from separatrix import Body, ContactEllipse, Layer, Solid
from separatrix.chain.exact.grid import Grid
from separatrix.chain.exact.operator import rolling_operator
from separatrix.chain.exact.rolling import ContactProblem, rigid_slip, rolling_contact, solve
from separatrix.chain.exact.slip import FrictionLaw, settle

MU = 0.1
P0 = 1e-3  # over G


def body(nu, *layers, G=1.0):
    """Body of shear modulus G with layers (G, nu, thickness), the outermost first."""
    made = (Layer(thickness=h, solid=Solid(shear_modulus=g, poisson_ratio=n)) for g, n, h in layers)
    return Body(base=Solid(shear_modulus=G, poisson_ratio=nu), layers=tuple(made))


def ellipse(b, a=1.0, p0=P0, modulus=1.0):
    """Ellipse of half length b along rolling and a across."""
    return ContactEllipse(
        load=2.0 / 3.0 * math.pi * a * b * p0, semi_major=a, semi_minor=b, max_pressure=p0, approach=0.0,
        curvature_rolling=1.0, curvature_transverse=1.0, contact_modulus=modulus,
    )  # fmt: skip


def contact(b, nu=0.25, *, columns=40, rows=40, friction=MU, race=None, **given):
    """Two bodies of G = 1 on an ellipse of a = 1 under p0 = P0; `race` may be coated."""
    bodies, law = (body(nu), race or body(nu)), FrictionLaw(coefficient=friction)
    problem = ContactProblem(ellipse=ellipse(b), bodies=bodies, friction=law, **given)
    return rolling_contact(problem, columns=columns, rows=rows)


def saturation(nu, mu=MU):
    """xi_s = 2 mu p0/E* of equal bodies with G = 1 and p0 = P0."""
    return 2.0 * mu * P0 * (1.0 - nu)


def kalker(made, xi=0.0, eta=0.0, phi=0.0, **options):
    """Solution under Kalker's creeps; his spin has the other sign."""
    slip = rigid_slip(made.grid, longitudinal=xi, lateral=eta, spin=-phi)
    return solve(made, slip, **options)


def strip(columns, bodies, *, fraction=1.0, compliance=0.0):
    """Operator and grid of a plane strip |x| < 1: one row so long that its ends do not matter.

    Both ends are cut to the same share of a cell.
    """
    dx = 2.0 / (columns - 2 + 2.0 * fraction)
    shares = np.ones((1, columns))
    shares[0, [0, -1]] = fraction
    x = dx * (np.arange(columns) + 0.5 - 0.5 * columns)
    grid = Grid(x=x, y=np.zeros(1), dx=dx, dy=1e4, fraction=shares)
    L = np.full((1, columns), compliance) if compliance else None
    return rolling_operator(grid, bodies, L), grid


def strip_force(columns, bodies, *, creep=1.0, bound=None, **cut):
    """Force of a plane strip per width: sticking, or under a bound, whose integral over x is given."""
    op, grid = strip(columns, bodies, **cut)
    g = np.full(grid.shape, 1e9)
    if bound is not None:
        edges = np.append(grid.x - 0.5 * grid.dx, grid.x[-1] + 0.5 * grid.dx)
        g = np.diff(bound(np.clip(edges, -1.0, 1.0)))[None, :] / grid.dx
    driving = np.zeros((2, *grid.shape))
    driving[0] = creep * grid.dx
    return -settle(op, g, driving, tolerance=1e-7).traction[0].sum() * grid.dx
