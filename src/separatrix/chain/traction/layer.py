r"""Exact response of a film bonded to a half-plane under tangential traction: plane strain, any thickness.

With displacement i U, W ~ exp(ikx), z = k times depth, and shear S, normal stress N (both over k), the state
(U, W, S, N) of a layer follows y' = A y; the half-plane below gives two decaying solutions. Zero N and unit
S at the surface leave c(kh) = k u/q, which goes from (1 - nu)/G of the half-plane (kh -> 0) to that of the
film (kh -> oo).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.linalg import expm

from separatrix.chain.traction.master import MasterTable, master_tables
from separatrix.chain.traction.strip import log_kernel
from separatrix.ground.compiled import kernel, part
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Metre, Pascal, Ratio
from separatrix.study.study import BallBearing, Film, Material

TERMS = 16  # exponentials exp(-j kh/2) that carry c(kh); the test measures what they leave
DEEP = 8.0  # kh beyond which the half-plane below is not felt: (kh)^2 exp(-2 kh) = 7e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class BondedLayer:
    """A film of stated thickness bonded to the race, with the moduli of film, race and ball."""

    thickness: Metre
    film_modulus: Pascal
    film_poisson: Ratio
    ring_modulus: Pascal
    ring_poisson: Ratio
    ball_modulus: Pascal
    ball_poisson: Ratio

    @property
    def substrate_compliances(self) -> tuple[float, float]:
        """2 (1 - nu^2)/E of ring and ball [1/Pa]."""
        pairs = (self.ring_modulus, self.ring_poisson), (self.ball_modulus, self.ball_poisson)
        ring, ball = (2.0 * (1.0 - nu**2) / E for E, nu in pairs)
        return ring, ball


def bonded_layer(bearing: BallBearing, film: Film) -> BondedLayer:
    """Layer of a film on the race of a bearing.

    Raises
    ------
    InputError
        The races are bare.
    """
    if film.body is None or not film.thickness:
        raise InputError(
            "bonded_layer: film", "needs a material and a thickness", cure="Bare races have no layer."
        )
    ring: Material = bearing.ring_material
    return BondedLayer(
        thickness=film.thickness,
        film_modulus=film.body.elastic_modulus,
        film_poisson=film.body.poisson_ratio,
        ring_modulus=ring.elastic_modulus,
        ring_poisson=ring.poisson_ratio,
        ball_modulus=bearing.ball_material.elastic_modulus,
        ball_poisson=bearing.ball_material.poisson_ratio,
    )


def surface_compliance(layer: BondedLayer, kh: Array) -> Array:
    """Compliance c = k u/q of the coated race at wavenumber times thickness, shape of kh [1/Pa]."""
    kh = np.atleast_1d(np.asarray(kh, dtype=np.float64))
    film, ring = (
        (_shear_modulus(layer.film_modulus, layer.film_poisson), layer.film_poisson),
        (
            _shear_modulus(layer.ring_modulus, layer.ring_poisson),
            layer.ring_poisson,
        ),
    )
    decaying = _decaying_states(ring[0] / film[0], ring[1])
    surface = expm(-_state_matrix(film[1]) * np.minimum(kh, DEEP)[:, None, None]) @ decaying
    amplitudes = np.linalg.solve(surface[:, 2:, :], np.array([1.0, 0.0])[:, None])
    c = -(surface[:, 0, :] * amplitudes[:, :, 0]).sum(axis=1) / film[0]
    return np.where(kh < DEEP, c, (1.0 - film[1]) / film[0])


def _shear_modulus(elastic_modulus: Pascal, poisson_ratio: Ratio) -> Pascal:
    return elastic_modulus / (2.0 * (1.0 + poisson_ratio))


def _state_matrix(nu: Ratio) -> Array:
    """Matrix A of y' = A y for y = (U, W, S/G, N/G), Poisson's ratio nu."""
    lame = 2.0 * nu / (1.0 - 2.0 * nu)
    stiff = lame + 2.0
    return np.array(
        [
            [0.0, -1.0, 1.0, 0.0],
            [lame / stiff, 0.0, 0.0, 1.0 / stiff],
            [stiff - lame**2 / stiff, 0.0, 0.0, -lame / stiff],
            [0.0, 0.0, 1.0, 0.0],
        ]
    )


def _decaying_states(shear_ratio: Ratio, nu: Ratio) -> Array:
    """The two decaying states of the half-plane, shape (4, 2); stresses over the film's G."""
    # U = (a + b z) exp(-z), W = (-a - (3 - 4 nu) b - b z) exp(-z) at z = 0
    lame, kappa = 2.0 * nu / (1.0 - 2.0 * nu), 3.0 - 4.0 * nu
    U, W = np.array([1.0, 0.0]), np.array([-1.0, -kappa])
    dU, dW = np.array([-1.0, 1.0]), np.array([1.0, kappa - 1.0])
    return np.array([U, W, shear_ratio * (dU + W), shear_ratio * ((lame + 2.0) * dW - lame * U)])


@lru_cache(maxsize=64)
def _exponentials(layer: BondedLayer) -> tuple[float, ...]:
    """Weights w_j in (c + c_ball)/(c_ring + c_ball) = sum_j w_j exp(-j kh/2); exact at kh = 0 [-]."""
    ring, ball = layer.substrate_compliances
    count = 8 * TERMS
    t = 0.5 * (1.0 - np.cos(np.pi * (np.arange(count) + 0.5) / count))  # t = exp(-kh/2)
    excess = (surface_compliance(layer, -2.0 * np.log(t)) - ring) / (ring + ball) / (1.0 - t)
    g = np.linalg.lstsq(_chebyshev(2.0 * t - 1.0), excess)[0] @ _monomials()
    weights = np.zeros(TERMS + 1)
    weights[0] = 1.0
    weights[:-1] += g
    weights[1:] -= g  # times 1 - t
    return tuple(float(w) for w in weights)


def _chebyshev(x: Array) -> Array:
    """Chebyshev polynomials T_0..T_(TERMS - 1) at x, shape (x, TERMS) [-]."""
    return np.cos(np.arange(TERMS) * np.arccos(x)[:, None])


def _monomials() -> Array:
    """Coefficients of T_i(2 t - 1) in powers of t, shape (TERMS, TERMS) [-]."""
    rows = np.zeros((TERMS, TERMS))
    rows[0, 0], rows[1, :2] = 1.0, (-1.0, 2.0)
    for i in range(2, TERMS):
        rows[i] = -2.0 * rows[i - 1] - rows[i - 2]
        rows[i, 1:] += 4.0 * rows[i - 1, :-1]
    return rows


@part
def _smooth_kernel(x: float, half_width: float, depth: float) -> float:
    """As `log_kernel`, for exp(-k depth)/k: -(1/pi) ln(x^2 + depth^2) integrated over the element."""
    displacement = 0.0
    for edge, sign in ((x + half_width, 1.0), (x - half_width, -1.0)):
        displacement -= sign * (0.5 * edge * math.log(edge**2 + depth**2) + depth * math.atan(edge / depth))
    return 2.0 / math.pi * displacement


@kernel
def layered_influence(nodes: int, thickness: float, weights: Array) -> Array:
    """Toeplitz coefficients as in `strip_influence`, for thickness h/b and weights of the exponentials."""
    dx = 2.0 / nodes
    u = np.zeros(2 * nodes)
    for k in range(2 * nodes):
        x = (nodes - k) * dx
        u[k] = weights[0] * log_kernel(x, 0.5 * dx)
        for j in range(1, weights.size):
            u[k] += weights[j] * _smooth_kernel(x, 0.5 * dx, 0.5 * j * thickness)
    t = np.empty(2 * nodes - 1)
    for k in range(2 * nodes - 1):
        t[k] = u[k + 1] - u[k]
    return t


def strip_layer(layer: BondedLayer, thickness_ratio: Ratio, nodes: int) -> Array:
    """Toeplitz coefficients of a strip under the layer, for thickness/half length, shape (2 node - 1,)."""
    return layered_influence(nodes, thickness_ratio, np.array(_exponentials(layer)))


@lru_cache(maxsize=16)
def layer_tables(layer: BondedLayer, thickness_ratio: Ratio, nodes: int) -> tuple[MasterTable, MasterTable]:
    """Tables over the strips of one ellipse: h/b(y) from `thickness_ratio` in the middle to 30 times that."""
    steps = 12
    step = math.log(30.0) / (steps - 1)
    ratios = thickness_ratio * np.exp(step * np.arange(steps))
    influences = [(strip_layer(layer, r, nodes), strip_layer(layer, r, 2 * nodes)) for r in ratios]
    return master_tables(influences, np.ones(steps), (0.0, 1e300, math.log(thickness_ratio), step, 0.0))
