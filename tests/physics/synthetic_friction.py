"""Logs whose friction is known: running-in, drift, one turn's modulation and correlated noise."""

from dataclasses import dataclass, replace

import numpy as np

from separatrix.friction.logs.column_map import Conditions
from separatrix.friction.logs.log import RawLog

SPEED = 0.5
"""Slip speed [m/s]."""


@dataclass(frozen=True)
class Recipe:
    """How a log is made; shares are of the test's length."""

    rows: int = 2000
    step: float = 0.1
    """Usual step between rows [s]."""
    friction: float = 0.12
    noise: float = 0.01
    """Standard deviation of the noise."""
    correlation: float = 0.0
    """Time in which its correlation falls to 1/e, as a share; 0 for white noise."""
    white: float = 0.0
    """Standard deviation of white noise besides."""
    run_in: float = 0.0
    """Share in which 95 % of the excess is gone: three times the length of its exponential."""
    excess: float = 0.1
    """Friction at the start less that in the end, but for the drift."""
    drift: float = 0.0
    """Change of friction over the whole test."""
    modulation: float = 0.0
    """Amplitude of what repeats with each cycle."""
    rows_of_a_cycle: float = 20.3
    missing: float = 0.0
    """Share of the rows that are not there: half of them one by one, half in one piece."""
    irregular: bool = False
    """Whether steps vary, and the first third is logged twice as densely."""


@dataclass(frozen=True)
class Made:
    """A log and what it was made from."""

    log: RawLog
    recipe: Recipe
    length: float

    def truth(self, start: float, end: float) -> float:
        """Return the friction without noise, running-in and modulation, its mean between two times."""
        return self.recipe.friction + self.recipe.drift * ((start + end) / 2.0 / self.length - 0.5)


def made(recipe: Recipe, rng: np.random.Generator, *, knows_cycle: bool = True) -> Made:
    """Return a log of a recipe."""
    steps = np.full(recipe.rows - 1, recipe.step)
    if recipe.irregular:
        steps *= rng.uniform(0.3, 1.7, steps.size)
        steps[: steps.size // 3] *= 0.5
    time = np.concatenate([[0.0], np.cumsum(steps)])
    length, x = time[-1], time / time[-1]
    cycle = recipe.rows_of_a_cycle * recipe.step
    friction = recipe.friction + recipe.drift * (x - 0.5) + noise(recipe, time, rng)
    if recipe.run_in:
        friction += recipe.excess * np.exp(-3.0 * x / recipe.run_in)
    friction += recipe.modulation * np.sin(2.0 * np.pi * (time / cycle + rng.random()))
    kept = rng.random(time.size) >= recipe.missing / 2.0
    gap = int(recipe.missing / 2.0 * time.size)
    start = int(rng.integers(1, max(2, time.size - gap - 1)))
    kept[start : start + gap] = False
    kept[[0, -1]] = True
    conditions = Conditions(
        material="PTFE", counterface="440C", medium="gaseous nitrogen", sample="S1", test="T1",
        temperature=77.0, slip_speed=SPEED, pressure=1e6, normal_force=10.0,
        cycle_time=cycle if knows_cycle else None,
    )  # fmt: skip
    log = RawLog(
        source="made.csv", checksum="0" * 64, format="made",
        friction=friction[kept], time=time[kept], conditions=conditions, missing=int((~kept).sum()),
    )  # fmt: skip
    return Made(log, recipe, length)


def noise(recipe: Recipe, time: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return Gaussian noise that forgets itself exponentially, at times that need not be even."""
    white = rng.standard_normal(time.size)
    other = recipe.white * rng.standard_normal(time.size)
    if recipe.correlation == 0.0:
        return recipe.noise * white + other
    keep = np.exp(-np.diff(time) / (recipe.correlation * time[-1]))
    return recipe.noise * remembered(white, keep) + other


def remembered(white: np.ndarray, keep: np.ndarray) -> np.ndarray:
    """Return noise of the same deviation that keeps these shares of itself from row to row."""
    out = white.copy()
    for i, k in enumerate(keep.tolist(), start=1):
        out[i] = k * out[i - 1] + (1.0 - k * k) ** 0.5 * white[i]
    return out


CORRELATIONS = (0.0, 0.003, 0.01, 0.03)
RUN_INS = (0.0, 0.05, 0.15, 0.3)
DRIFTS = (0.0, 0.15)
MISSING = (0.0, 0.1)
ROWS = (300, 1000, 4000, 20000)


def recipes(count: int, rng: np.random.Generator) -> list[Recipe]:
    """Return recipes of every kind, drawn anew; each value of each list equally often."""
    made_from = [np.resize(np.arange(4), count) for _ in range(6)]
    for column in made_from:
        rng.shuffle(column)
    kinds, found = zip(*(column.tolist() for column in made_from), strict=True), []
    for correlation, run_in, drift, missing, rows, sampling in kinds:
        friction = float(rng.uniform(0.05, 0.35))
        base = Recipe(
            rows=int(ROWS[rows] * rng.uniform(1.0, 1.3)) if ROWS[rows] < 20000 else 20000, friction=friction,
            noise=friction * float(rng.choice([0.03, 0.1, 0.2])), correlation=CORRELATIONS[correlation],
            run_in=RUN_INS[run_in] * float(rng.uniform(0.8, 1.0)),
            excess=friction * float(rng.choice([-0.4, 0.3, 1.0, 2.0])),
            drift=friction * DRIFTS[drift % 2] * float(rng.choice([-1.0, 1.0])),
            modulation=friction * float(rng.choice([0.0, 0.1, 0.25])),
            rows_of_a_cycle=float(rng.uniform(5.0, 14.0)), missing=MISSING[missing % 2],
            irregular=bool(sampling % 2),
        )  # fmt: skip
        found.append(replace(base, white=0.5 * base.noise if sampling > 1 else 0.0))
    return found
