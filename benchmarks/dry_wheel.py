"""What published wheels with dry cages showed, as computed of `dry-reaction-wheel`.

    python benchmarks/dry_wheel.py [--seeds 8]

Where a whirl is heard, how torque goes with speed, and which friction matters. Sources, and what is assumed,
stand in docs/validation.md. The pocket clearance, which mainly sets where the whirl is heard, was chosen with
the published band in view: a consistency check. The other rows have no free input.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import replace

import separatrix
from separatrix.cage import moving_cage, settings_for, simulate
from separatrix.chain.solution import Solution, solve
from separatrix.study.study import MotionModel, Study
from separatrix.verdict.rig_signs import lasts, loudest, shaft_torque

RPM = math.pi / 30.0


def chain(study: Study) -> Solution:
    """Chain of the study with its one candidate."""
    assert study.ranking is not None
    return solve(study, study.ranking.candidates[0])


def cage_of(study: Study, **changes: object) -> Study:
    """The study with another cage."""
    assert study.cage is not None
    return replace(study, cage=replace(study.cage, **changes))  # type: ignore[arg-type]


def heard(study: Study, seeds: int) -> None:
    """Loudest third octave and its share of the power by motion, pocket clearance and mass."""
    print("motion  clearance  mass   whirls  third octaves [Hz]: least, median, most; median share")
    for motion in (MotionModel.PLANE, MotionModel.SPACE):
        for clearance in (0.15e-3, 0.2e-3, 0.3e-3):
            for mass in (0.12e-3, 0.2e-3):
                found = chain(cage_of(study, pocket_clearance=clearance, mass=mass, motion=motion))
                cage = moving_cage(found, 0.3)
                kick = settings_for(study.stability, cage).middle_kick
                runs = [
                    simulate(cage, kick=kick, seed=one, until=0.3, samples=20_000)
                    for one in range(1, seeds + 1)
                ]
                octaves = sorted(loudest(cage, run) for run in runs if lasts(run))
                middle = octaves[len(octaves) // 2]
                print(
                    f"{motion.value:6s}  {1e3 * clearance:6.2f} mm  {1e3 * mass:.2f} g  "
                    f"{len(octaves)}/{seeds}   {octaves[0][0]:.0f} {middle[0]:.0f} {octaves[-1][0]:.0f}; {middle[1]:.2f}",
                    flush=True,
                )


def torque(study: Study) -> None:
    """Torque at 1000 to 6000 rpm with a calm and a whirling cage, and its exponent."""
    print("pocket friction  speed [rpm]: torque [mN m] (of it the cage's), how the run ends")
    for friction in (0.05, 0.3):
        values = []
        for rpm in (1000, 2000, 3000, 4000, 5000, 6000):
            found = chain(replace(study, operation=replace(study.operation, inner_speed=rpm * RPM)))
            cage = moving_cage(found, friction)
            run = simulate(
                cage, kick=settings_for(study.stability, cage).middle_kick, until=0.3, samples=20_000
            )
            whole, own, *_ = shaft_torque(found, cage, run)
            values.append((rpm, whole, own))
            print(
                f"{friction:4.2f}  {rpm}: {1e3 * whole:.4f} ({1e3 * own:.4f}), {run.outcome.name}", flush=True
            )
        (low, first, own), (high, last, more) = values[0], values[-1]
        ratio = math.log(high / low)
        print(f"exponent 1000 to 6000 rpm: {math.log(last / first) / ratio:.2f}; of the cage's part "
              f"{math.log(more / own) / ratio if own > 0 else math.nan:.2f}")  # fmt: skip


def frictions(study: Study, seeds: int) -> None:
    """Share of runs that last, over pocket friction and land friction."""
    lands = (0.05, 0.1, 0.2, 0.3)
    print("pocket friction: share of runs that whirl at land frictions", lands)
    for pocket in (0.05, 0.1, 0.15, 0.2, 0.3):
        shares = []
        for land in lands:
            found = chain(cage_of(study, land_friction=land))
            cage = moving_cage(found, pocket)
            kick = settings_for(study.stability, cage).middle_kick
            runs = [simulate(cage, kick=kick, seed=one) for one in range(1, 4 * seeds + 1)]
            shares.append(sum(lasts(run) for run in runs) / len(runs))
        print(f"{pocket:4.2f}  " + "  ".join(f"{one:.2f}" for one in shares), flush=True)


def main() -> None:
    """Print all rows."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=8)
    seeds = parser.parse_args().seeds
    study = separatrix.read_study("dry-reaction-wheel")
    contacts = chain(study).bearing
    for race, at in (("inner", contacts.inner), ("outer", contacts.outer)):
        print(f"mean contact stress, {race} race: {2e-6 / 3.0 * at.ellipse.max_pressure:.0f} MPa")
    heard(study, seeds)
    torque(study)
    frictions(study, seeds)


if __name__ == "__main__":
    main()
