r"""Surface flexibility of a layered half-space against the wavenumber of its load.

z points into the body, the load varies as exp(i k.x); r is along the wave vector, t across. Traction tau and
pressure p on the surface displace it by

    u_r = (c_rr/k) tau_r + i (c_rz/k) p,   u_z = -i (c_rz/k) tau_r + (c_zz/k) p,   u_t = (c_tt/k) tau_t.

In a layer u_r = i U, u_z = W, sigma_rz = i G k S, sigma_zz = G k N, and the state (U, W, S, N) is a sum of
two waves that decay downwards and two that decay upwards. Only decaying exponentials appear, so no wavenumber
overflows (O'Sullivan & King 1988 and Nogi & Kato 1997 have the closed form of one layer).

Influence coefficients of layered bodies as sums of buried point sources.

Each flexibility c(k) is fitted by sum_j w_j exp(-k d_j). With exp(-k d) the inverse transforms are
elementary, and so are their integrals over a rectangle: signed sums over its corners, times 1/(2 pi), of

    A = x ln(y + R) + d [atan(d y/(x R)) - atan(y/x)],  B = A with x and y exchanged,  C = R - d ln(R + d),
    K_xx = sum w_rr A + w_tt B,  K_yy = sum w_rr B + w_tt A,  K_xy = sum (w_rr - w_tt) C,
    K_zz = sum w_zz (A + B),     R^2 = x^2 + y^2 + d^2.

Depth 0 is the half-space of Boussinesq and Cerruti. A film needs no transform, no padding and no wavenumber
zero this way, however thin it is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from separatrix.ground.compiled import kernel, part
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


UNCOUPLED = [0, 1, 3]  # c_rr, c_zz and c_tt; pressure and tractions act on each other by c_rz alone
IMAGES = 24  # exponentials beside the constant
STEPS = (1.0, 1.4, 2.0)  # of the depths, in half thicknesses; stiff films respond to longer waves
NODES = 240  # wavenumbers of the fit
SMALLEST_SINGULAR = 1e-12  # over the largest: keeps the weights, of both signs, below 1e8 of the flexibility
CONTROLS = 300  # other wavenumbers at which its error is measured
LARGEST_ERROR = 1e-3  # of the span of a flexibility, above which a body is refused


@dataclass(frozen=True, slots=True)
class Images:
    """Depths, shape (image,) [m], and weights of c_rr, c_zz, c_tt, shape (3, image) [1/Pa].

    `error` is the largest error of the fit over the span of its flexibility [-].
    """

    depths: Array
    weights: Array
    error: Ratio


@lru_cache(maxsize=64)
def body_images(body: Body) -> Images:
    """Images of one body; exact at wavenumber 0 (far field) and infinity (near field).

    Raises
    ------
    InputError
        The layers are too unlike for one series of depths: error above 1e-3.
    """
    if not body.layers:
        return Images(np.zeros(1), half_space_flexibility(body.base)[UNCOUPLED, None], 0.0)
    thicknesses = {layer.thickness for layer in body.layers}
    lengths = sorted(thicknesses | {sum(layer.thickness for layer in body.layers)})
    best = min((_fit(body, step * H) for H in lengths for step in STEPS), key=lambda fit: fit.error)
    if best.error > LARGEST_ERROR:
        cure = "Use one layer, or layers of like thickness and stiffness."
        rule = f"must fit {IMAGES} images to {LARGEST_ERROR:g} of their span [-]"
        raise InputError("Body.layers", rule, f"an error of {best.error:.2g}", cure)
    return best


def _fit(body: Body, H: Metre) -> Images:
    """Weights of t^j, t = exp(-kH/2): c = c_oo + t [(c_0 - c_oo) + (1 - t) s(t)], s a polynomial."""
    c0, c_oo = (half_space_flexibility(one)[UNCOUPLED, None] for one in (body.base, body.surface))
    t = 0.5 * (1.0 - np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES))
    remainder = flexibility(body, -2.0 * np.log(t) / H)[UNCOUPLED] - c_oo - t * (c0 - c_oo)
    powers = (t - t * t) * t ** np.arange(IMAGES - 1)[:, None]
    s = np.linalg.lstsq(powers.T, remainder.T, rcond=SMALLEST_SINGULAR)[0].T
    weights = np.concatenate([c_oo, c0 - c_oo + s[:, :1], np.diff(s), -s[:, -1:]], axis=1)
    depths = 0.5 * H * np.arange(IMAGES + 1.0)
    return Images(depths, weights, _fit_error(body, depths, weights))


def _fit_error(body: Body, depths: Array, weights: Array) -> Ratio:
    """Largest difference to the exact flexibility at other wavenumbers, over its span [-]."""
    k = np.geomspace(1e-4 / depths[-1], 50.0 / depths[1], CONTROLS)
    c = flexibility(body, k)[UNCOUPLED]
    span = np.ptp(c, axis=1)
    scale = np.where(span > 1e-9 * np.abs(c).max(), span, np.abs(c).max())
    return float((np.abs(weights @ np.exp(-np.outer(depths, k)) - c).max(axis=1) / scale).max())


@lru_cache(maxsize=64)
def pair_images(first: Body, second: Body) -> Images:
    """Images of the sum of both bodies' flexibilities."""
    one, two = body_images(first), body_images(second)
    if np.array_equal(one.depths, two.depths):  # both bare, or films of the same thickness
        return Images(one.depths, one.weights + two.weights, max(one.error, two.error))
    weights = np.concatenate([one.weights, two.weights[:, 1:]], axis=1)
    weights[:, 0] += two.weights[:, 0]  # both depths are 0
    return Images(np.append(one.depths, two.depths[1:]), weights, max(one.error, two.error))


@part
def _log_sum(y: float, x: float, d: float) -> float:
    """ln(y + R) less ln of hypot(x, d), which cancels between the corners."""
    flat = math.sqrt(x * x + d * d)
    return math.asinh(y / flat) if flat > 0.0 else 0.0


@part
def _angle(y: float, x: float, d: float, R: float) -> float:
    """atan(y/x) - atan(d y/(x R)); its factor x or d is 0 where it is not defined."""
    return math.atan(y / x) - math.atan(d * y / (x * R)) if x != 0.0 else 0.0


@kernel
def corner_sums(x: Array, y: Array, depths: Array, weights: Array) -> Array:
    """Primitives of K_xx, K_yy, K_xy and K_zz at corners x, y >= 0, shape (4, y, x) [m/Pa]."""
    sums = np.zeros((4, y.size, x.size))
    for j in range(y.size):
        for i in range(x.size):
            for n in range(depths.size):
                d, rr, zz, tt = depths[n], weights[0, n], weights[1, n], weights[2, n]
                R = math.sqrt(x[i] * x[i] + y[j] * y[j] + d * d)
                A = x[i] * _log_sum(y[j], x[i], d) - d * _angle(y[j], x[i], d, R)
                B = y[j] * _log_sum(x[i], y[j], d) - d * _angle(x[i], y[j], d, R)
                C = R - d * math.log(R + d) if R + d > 0.0 else 0.0
                sums[0, j, i] += rr * A + tt * B
                sums[1, j, i] += rr * B + tt * A
                sums[2, j, i] += (rr - tt) * C
                sums[3, j, i] += zz * (A + B)
    return sums / (2.0 * math.pi)


ODD = np.array([True, True, False, True])[:, None, None]
"""Whether a primitive changes sign with x, or y."""


def influence(
    shape: tuple[int, int],
    spacing: tuple[Metre, Metre],
    images: Images,
    stencil: tuple[tuple[int, float], ...],
) -> Array:
    """Displacement at cell i, j of a uniform unit traction on cell 0, 0: xx, yy, xy and zz [m/Pa].

    For offsets j = 0 ... rows - 1 and i = 1 - columns ... columns - 1, shape (4, rows, 2 columns - 1). xx, yy
    and zz are even in j, xy odd. `spacing` is the width of a row and of a column, `stencil` has pairs (shift,
    factor): the sum of factor times displacement at x + shift dx/2.
    """
    rows, columns = shape
    dy, dx = spacing
    reach = 2 * columns - 1 + max(abs(shift) for shift, _ in stencil)
    corners = corner_sums(
        0.5 * dx * np.arange(reach + 1.0), dy * np.arange(0.5, rows), images.depths, images.weights
    )
    below = np.concatenate([np.where(ODD, -1.0, 1.0) * corners[:, :1], corners[:, :-1]], axis=1)
    strips = corners - below
    mirrored = np.where(ODD, -1.0, 1.0) * strips[:, :, :0:-1]
    strips = np.concatenate([mirrored, strips], axis=2)  # half steps -reach ... reach
    first = reach - 2 * (columns - 1)
    table = np.zeros((4, rows, 2 * columns - 1))
    for shift, factor in stencil:
        start = first + shift
        stop = start + 4 * columns - 3
        table += factor * (strips[:, :, start + 1 : stop + 1 : 2] - strips[:, :, start - 1 : stop - 1 : 2])
    return table
