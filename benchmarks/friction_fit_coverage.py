"""How often the intervals of the friction fit hold the truth, and how far its scatter is off on average.

    python benchmarks/friction_fit_coverage.py [SETS]

Each set is drawn anew from a known power law with known scatter between samples and between tests; the plans
of tests are what a laboratory may do. Covered are the intercept, each slope, and the friction of a next cage
made of a new sample; printed with the 95 % interval of the share itself. The scatter is that of restricted
maximum likelihood, its mean square over that of the truth, with the standard error of that ratio.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from math import exp, hypot, log, sqrt

import numpy as np
from scipy.special import ndtri

from separatrix.friction.friction_file import FrictionTest
from separatrix.friction.friction_fit import FrictionFit, MaterialFit, fit_friction
from separatrix.verdict.judgement import wilson_interval

ENVIRONMENT = {"counterface": "440C", "medium": "liquid nitrogen"}
NAME = "liquid nitrogen, 440C"
CENTRE = 0.1
Plan = Sequence[tuple[str, float, float]]
"""Sample, slip speed and pressure of each test."""


def repeated() -> Plan:
    """Five samples, each tested three times under one condition."""
    return [(f"s{i}", 2.0, 1e6) for i in range(5) for _ in range(3)]


def crossed() -> Plan:
    """Six samples, each at three speeds, two pressures among them."""
    return [(f"s{i}", v, 1e6 * (1.0 + 3.0 * (i % 2))) for i in range(6) for v in (1.0, 2.0, 5.0)]


def single() -> Plan:
    """Four tests at two speeds, each of its own sample."""
    return [(f"s{i}", v, 1e6) for i, v in enumerate((1.0, 1.0, 5.0, 5.0))]


PLANS: dict[str, tuple[Callable[[], Plan], dict[str, float], float, float]] = {
    "repeated": (repeated, {}, 0.07, 0.05),
    "crossed": (crossed, {"slip_speed": 0.12, "pressure": -0.1}, 0.07, 0.05),
    "single": (single, {"slip_speed": 0.12}, 0.07, 0.056),
}
"""Plan, slopes, and scatter between samples and between tests."""


def drawn(
    plan: Plan, slopes: dict[str, float], between: float, within: float, seed: int
) -> list[FrictionTest]:
    """One synthetic set of tests."""
    rng = np.random.Generator(np.random.Philox(seed))
    deviation = {name: between * rng.standard_normal() for name in dict.fromkeys(s for s, _, _ in plan)}
    return [
        FrictionTest(
            material="A",
            friction=exp(truth(slopes, v, p) + deviation[sample] + within * rng.standard_normal()),
            slip_speed=(v, v),
            pressure=(p, p),
            sample=sample,
            **ENVIRONMENT,
        )
        for sample, v, p in plan
    ]


def truth(slopes: dict[str, float], speed: float, pressure: float) -> float:
    """True ln f."""
    return (
        log(CENTRE)
        + slopes.get("slip_speed", 0.0) * log(speed)
        + slopes.get("pressure", 0.0) * log(pressure / 1e6)
    )


def hits(fit: FrictionFit, slopes: dict[str, float], scatter: float, seed: int) -> dict[str, bool]:
    """Whether each interval holds the truth."""
    one = fit.of("A", NAME)
    middle = dict(zip(one.covariates.names, one.covariates.centres, strict=True))
    at = truth(slopes, exp(middle.get("slip_speed", log(2.0))), exp(middle.get("pressure", log(1e6))))
    centre = np.eye(1 + len(one.covariates.names))[0]
    low, high = (one.posterior.quantile(centre, p) for p in (0.025, 0.975))
    found = {"intercept": low <= at <= high}
    found |= {name: s.low <= slopes[name] <= s.high for name, s in one.slopes.items()}
    new = at + scatter * np.random.Generator(np.random.Philox(key=[seed, 1])).standard_normal()
    return found | {"next cage": abs(new - log(one.at().mean)) <= reach(one)}


def reach(one: MaterialFit) -> float:
    """Half the 95 % interval of ln f of a next cage."""
    at = one.at()
    return float(ndtri(0.975)) * hypot(at.standard_error, at.standard_deviation) / at.mean


def report(name: str, sets: int) -> None:
    """Simulate one plan and print its shares."""
    plan, slopes, between, within = PLANS[name]
    counts: dict[str, int] = {}
    start = time.perf_counter()
    for seed in range(sets):
        tests = drawn(plan(), slopes, between, within, seed)
        fit = fit_friction(tests)
        for key, hit in hits(fit, slopes, sqrt(between**2 + within**2), seed).items():
            counts[key] = counts.get(key, 0) + hit
    print(f"{name}: {sets} sets in {time.perf_counter() - start:.0f} s")
    for key, hit in counts.items():
        low, high = wilson_interval(hit, sets)
        print(f"  {key:11} covered {100 * hit / sets:5.1f} % ({100 * low:.1f} to {100 * high:.1f})")


def main() -> None:
    """Print all plans."""
    sets = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    for name in PLANS:
        report(name, sets)


if __name__ == "__main__":
    main()
