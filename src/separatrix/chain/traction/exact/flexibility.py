r"""Surface flexibility of a layered half-space against the wavenumber of its load.

z points into the body, the load varies as exp(i k.x); r is along the wave vector, t across. Traction tau and
pressure p on the surface displace it by

    u_r = (c_rr/k) tau_r + i (c_rz/k) p,   u_z = -i (c_rz/k) tau_r + (c_zz/k) p,   u_t = (c_tt/k) tau_t.

In a layer u_r = i U, u_z = W, sigma_rz = i G k S, sigma_zz = G k N, and the state (U, W, S, N) is a sum of
two waves that decay downwards and two that decay upwards. Only decaying exponentials appear, so no wavenumber
overflows (O'Sullivan & King 1988 and Nogi & Kato 1997 have the closed form of one layer).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, Metre, Pascal, Ratio

DEEP = 700.0  # kh beyond which exp(-kh) is 0 in floating point
NEARLY_INCOMPRESSIBLE = 0.49  # Poisson's ratio above which a bonded film's compression modulus diverges


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """An isotropic elastic solid."""

    shear_modulus: Pascal
    poisson_ratio: Ratio

    def __post_init__(self) -> None:
        _check("Solid.shear_modulus", "must be finite and > 0 [Pa]", self.shear_modulus, 0.0, math.inf)
        _check_poisson("Solid.poisson_ratio", self.poisson_ratio)

    @property
    def compression_modulus(self) -> Pascal:
        """Modulus M_c of uniaxial strain, 2 G (1 - nu)/(1 - 2 nu) [Pa]."""
        nu = self.poisson_ratio
        return 2.0 * self.shear_modulus * (1.0 - nu) / (1.0 - 2.0 * nu) if nu < 0.5 else math.inf


@dataclass(frozen=True, slots=True, kw_only=True)
class Layer:
    """A film bonded to what is below it."""

    thickness: Metre
    solid: Solid

    def __post_init__(self) -> None:
        _check("Layer.thickness", "must be finite and > 0 [m]", self.thickness, 0.0, math.inf)
        if self.solid.poisson_ratio > NEARLY_INCOMPRESSIBLE:
            rule = f"must not exceed {NEARLY_INCOMPRESSIBLE} in a film [-]"
            raise InputError("Layer.solid.poisson_ratio", rule, f"{self.solid.poisson_ratio:g}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A half-space and the layers on it, the outermost first."""

    base: Solid
    layers: tuple[Layer, ...] = ()

    @property
    def surface(self) -> Solid:
        """The solid that touches the other body."""
        return self.layers[0].solid if self.layers else self.base


def solid(elastic_modulus: Pascal, poisson_ratio: Ratio) -> Solid:
    """Solid from Young's modulus [Pa] and Poisson's ratio [-]."""
    _check_poisson("solid: poisson_ratio", poisson_ratio)
    _check("solid: elastic_modulus", "must be finite and > 0 [Pa]", elastic_modulus, 0.0, math.inf)
    return Solid(shear_modulus=0.5 * elastic_modulus / (1.0 + poisson_ratio), poisson_ratio=poisson_ratio)


def _check(path: str, rule: str, value: float, low: float, high: float) -> None:
    if not low < value < high:
        raise InputError(path, rule, f"{value:g}")


def _check_poisson(path: str, value: float) -> None:
    if not 0.0 <= value <= 0.5:
        raise InputError(path, "must lie from 0 to 0.5 [-]", f"{value:g}")


def half_space_flexibility(base: Solid) -> Array:
    """c_rr, c_zz, c_rz, c_tt of a bare half-space, shape (4,) [1/Pa]."""
    G, nu = base.shear_modulus, base.poisson_ratio
    return np.array([1.0 - nu, 1.0 - nu, 0.5 * (1.0 - 2.0 * nu), 1.0]) / G


def flexibility(body: Body, wavenumber: Array) -> Array:
    """c_rr, c_zz, c_rz and c_tt of a body at wavenumbers k >= 0 [1/m], shape (4, wavenumber) [1/Pa]."""
    k = np.asarray(wavenumber, dtype=np.float64)
    D, T = _waves(body.base.poisson_ratio, np.zeros(1))
    G = body.base.shear_modulus
    Y = np.broadcast_to(D @ np.linalg.inv(T) / G, (k.size, 2, 2))
    y = np.full(k.size, 1.0 / G)
    for layer in reversed(body.layers):
        kh = np.minimum(k * layer.thickness, DEEP)
        Y, y = _under_layer(layer.solid, kh, Y), _antiplane(layer.solid.shear_modulus, kh, y)
    return np.stack([-Y[:, 0, 0], -Y[:, 1, 1], -Y[:, 0, 1], y])


def _waves(nu: Ratio, zeta: Array) -> tuple[Array, Array]:
    """Rows (U, W) and (S, N) of the two waves that decay along zeta, at zeta; shape (zeta, 2, 2) each."""
    z, one = zeta, np.ones_like(zeta)
    kappa = 3.0 - 4.0 * nu
    D = np.array([[one, z], [-one, -(z + kappa)]])
    T = np.array([[-2.0 * one, -(2.0 * (1.0 - 2.0 * nu) + 2.0 * z)], [2.0 * one, 2.0 * z + 4.0 * (1.0 - nu)]])
    decay = np.exp(-zeta)
    return np.moveaxis(D * decay, 2, 0), np.moveaxis(T * decay, 2, 0)


def _under_layer(solid: Solid, kh: Array, Y: Array) -> Array:
    """Flexibility (U, W) = Y (kGS, kGN)/k on top of a layer, from that of what is below it."""
    G, nu = solid.shear_modulus, solid.poisson_ratio
    near, far = _waves(nu, np.zeros_like(kh)), _waves(nu, kh)
    # upward waves: W and S have the opposite signs
    up_D, up_T = np.array([[1.0], [-1.0]]), np.array([[-1.0], [1.0]])
    D_top, T_top = (np.concatenate(x, axis=2) for x in ((near[0], up_D * far[0]), (near[1], up_T * far[1])))
    D_bot, T_bot = (np.concatenate(x, axis=2) for x in ((far[0], up_D * near[0]), (far[1], up_T * near[1])))
    matrix = np.concatenate([T_top, D_bot - G * Y @ T_bot], axis=1)
    unit_stress = np.concatenate([np.eye(2), np.zeros((2, 2))])
    amplitudes = np.linalg.solve(matrix, np.broadcast_to(unit_stress, (kh.size, 4, 2)))
    return np.asarray(D_top @ amplitudes / G)


def _antiplane(G: Pascal, kh: Array, y: Array) -> Array:
    """Flexibility across the wave on top of a layer, from that of what is below it."""
    reflected = (y * G - 1.0) / (y * G + 1.0) * np.exp(-2.0 * kh)
    return np.asarray((1.0 + reflected) / (1.0 - reflected) / G)
