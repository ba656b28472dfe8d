"""Datasets as `present.dataset` makes them, made by hand, for the tests of the figures."""

from __future__ import annotations

import numpy as np
import xarray as xr

MADE = 12
"""Samples of a run."""


def run(
    *,
    count=5,
    samples=MADE,
    outcome="WHIRLS",
    guidance="outer",
    touching=True,
    play=0.6e-3,
    space=False,
    **changes,
):
    """One run of a cage of `count` pockets whose centre goes around, in the plane or in space."""
    time = np.linspace(0.0, 0.01, samples)
    around = 900.0 * time
    position = 4e-4 * np.stack([np.cos(around), np.sin(around)], axis=1)
    velocity = 900.0 * position[:, ::-1] * [-1.0, 1.0]
    force = np.where(np.arange(samples)[:, None] % 3 == np.arange(count) % 3, 20.0, 0.0) * touching
    angle = np.where(np.arange(count) % 2, np.pi, 0.0) * (force > 0.0)
    variables = {
        "position": (("time", "across"), position),
        "velocity": (("time", "across"), velocity),
        "rotation": ("time", 1e-3 * time),
        "axial_place": np.nan,
        "lean": np.nan,
        "lean_rate": np.nan,
        "ball_lead": (("time", "ball"), np.zeros((samples, count))),
        "ball_axial": np.nan,
        "contact_force": (("time", "ball"), force),
        "contact_angle": (("time", "ball"), angle),
        "land_force": ("time", np.where(np.arange(samples) % 4 == 1, 7.0, 0.0) * touching),
        "largest_contact_force": 20.0 * touching,
        "kinetic_energy": ("time", 1e-3 + time),
        "stored_energy": ("time", np.zeros(samples)),
        "work_pocket_friction": ("time", 3.0 * time * touching),
        "work_land_friction": ("time", np.zeros(samples)),
        "work_balls": ("time", -2.0 * time * touching),
        "energy_imbalance": 1e-3,
        "outcome": outcome,
        "kick": 0.5,
        "cage_pitch_radius": 0.0325,
        "cage_cage_speed": 600.0,
        "cage_ball_diameter": 0.0111,
        "cage_guidance": guidance,
        "cage_land_clearance": np.nan if guidance == "ball" else 1e-3,
        "cage_land_out_of_round": 0.0,
        "cage_land_lobes": 2,
        "cage_land_count": 1,
        "cage_land_spacing": np.nan,
        "cage_land_width": 3e-3,
        "cage_ramp_time": 0.0,
        "cage_ramp_start": 0.1,
        "cage_pocket_shape": "square",
        "cage_axial_half_play": 0.5 * play if space else np.nan,
        "pocket_angle": ("ball", 2 * np.pi * np.arange(count) / count),
        "half_play": ("ball", np.full(count, 0.5 * play)),
        "judged_from": 0.0,
        "followed": 0.0,
    }
    if space:
        variables |= {
            "axial_place": ("time", 1e-5 * np.sin(around)),
            "lean": (("time", "across"), 10.0 * position),
            "lean_rate": (("time", "across"), 10.0 * velocity),
            "ball_axial": (("time", "ball"), np.zeros((samples, count))),
        }
    made = xr.Dataset(variables | changes, coords={"time": time}, attrs={"study": "{}"})
    return made.transpose("time", ...)


def curve(points=4, **changes):
    """A stability curve of a cage with 13 balls."""
    eta = np.linspace(0.1, 0.9, points)
    middle = 0.3 * (1.0 - eta)
    on = "restitution_factor"
    variables = {
        "critical_friction": (on, middle),
        "critical_friction_low": (on, 0.8 * middle),
        "critical_friction_high": (on, 1.5 * middle),
        "scatter_low": (on, 0.95 * middle),
        "scatter_high": (on, 1.05 * middle),
        "linear_limit_critical_friction": (on, 2.0 * middle),
        "kicks": ("kick", [0.1, 0.5, 2.0]),
        "middle_kick": 0.5,
        "runs": 64,
        "band_few": 0.1,
        "band_most": 0.9,
        "chain_restitution_factor": 0.27,
        "chain_restitution_factor_free_spin": 0.07,
        "cage_ball_count": 13,
    }
    return xr.Dataset(variables | changes, coords={on: eta})


def candidates(friction):
    """Columns of a ranking, for frictions of shape (environment, material)."""
    shape = np.shape(friction)
    at = ("environment", "material")
    return {
        "material_friction": (at, np.array(friction, dtype=float)),
        "material_restitution_factor": (at, np.full(shape, 0.27)),
        "material_friction_error": (at, np.zeros(shape)),
        "material_extrapolation": (at, np.full(shape, "", dtype=object)),
        "environment": [f"environment {i}" for i in range(shape[0])],
        "material": [f"material {i}" for i in range(shape[1])],
    }


def plane(share, *, x=None, y=None, **changes):
    """A stability map with these shares of whirling runs, shape (y, x); NaN is a refusal."""
    share = np.array(share, dtype=float)
    rows, columns = share.shape
    decision = np.where(np.isnan(share), "", np.where(share > 0.8, "UNSTABLE", "STABLE"))
    variables = {
        "probability_whirl": (("y", "x"), share),
        "decision": (("y", "x"), np.where((share > 0.2) & (share < 0.8), "UNDECIDED", decision)),
        "reason": (("y", "x"), np.where(np.isnan(share), "The cage cannot fit.", "As they do.")),
        "x_parameter": "restitution_factor",
        "y_parameter": "ball_cage_friction",
        "x_here": 0.27,
        "y_here": 0.22,
        "kick": 0.5,
        "stopping_most_runs": 16,
        "cage_ball_count": 13,
    }
    x = np.linspace(0.0, 1.0, columns) if x is None else x
    y = np.linspace(0.0, 0.5, rows) if y is None else y
    coords = {"x": ("x", x, {"units": "-"}), "y": ("y", y, {"units": "-"})}
    return xr.Dataset(variables, coords=coords).assign(changes)


def swept(names, verdict=("", "", "")):
    """A sweep of three cases over parameters of these names, the first a length."""
    units = {"film.thickness": "m", "operation.inner_speed": "rad/s", "operation.temperature": "K"}
    cases = {name: ("case", 1e-6 * np.arange(1.0, 4.0), {"units": units[name]}) for name in names}
    factors = {"restitution_factor": ("case", [0.1, 0.2, 0.3]), "verdict": ("case", list(verdict))}
    return xr.Dataset(cases | factors | {"parameter": ("parameter", names)})


def ranking(**changes):
    """A ranking of four materials in two environments on a curve, with these columns changed."""
    frictions = [[0.1, 0.2, 0.3, 0.4], [0.4, np.nan, 0.1, 0.1]]
    columns = {"rank": [[1.0, 2.0, 3.0, 4.0]] * 2, "margin": [[0.1] * 4] * 2, "friction": frictions}
    columns |= {"restitution_factor": [[0.27] * 4] * 2, "verdict": [["STABLE"] * 4] * 2}
    columns |= {f"restitution_threshold{end}": [[0.4] * 4] * 2 for end in ("", "_low", "_high")}
    columns |= {"friction_error": [[0.0] * 4] * 2}
    columns |= {"extrapolation": np.full((2, 4), "", dtype=object)}
    made = {f"material_{name}": column for name, column in columns.items()}
    made |= {f"overall_{name}": column[0] for name, column in columns.items()} | changes
    dims = {name: ("environment", "material")[name.startswith("overall") :] for name in made}
    made = {name: (dims[name], one) for name, one in made.items()}
    return curve(**made).assign_coords(environment=["air", "vacuum"], material=list("ABCD"))


def cloud(eta):
    """A sensitivity of two candidates, with bearings of these restitution factors (material, sample)."""
    at, count = ("environment", "material"), np.shape(eta)[1]
    friction = np.linspace(0.1, 0.3, 2 * count).reshape(1, 2, count)
    variables = {
        "cloud_restitution_factor": ((*at, "sample"), np.asarray(eta)[np.newaxis]),
        "cloud_friction": ((*at, "sample"), friction),
        "cloud_settles": ((*at, "sample"), (friction < 0.2).astype(float)),
        "material_friction": (at, [[0.15, 0.25]]),
        "material_probability_stable": (at, [[1.0, 0.0]]),
        "material_extrapolation": (at, np.array([["", "too fast"]], dtype=object)),
    }
    return xr.Dataset(variables, coords={"environment": ["air"], "material": ["A", "B"]})
