"""Time of the chain on samples: `python benchmarks/chain_samples.py [SAMPLES]`, printed, nothing written.

The shipped turbopump bearing with six uncertain inputs that touch every stage, under its axial load and with
a radial load, on one thread and on two.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace

from separatrix.distribution import LogUniform, Normal
from separatrix.draws import sample
from separatrix.study import Study
from separatrix.study_file import read_study
from separatrix.study_numbers import with_distributions
from separatrix.uncertainty.chain_samples import chain_samples

LAWS = {
    "film.thickness": LogUniform(low=2e-7, high=1e-6),
    "film.elastic_modulus": LogUniform(low=1e9, high=5e9),
    "film.race_friction": Normal(mean=0.1, standard_deviation=0.01),
    "operation.axial_load": Normal(mean=3000.0, standard_deviation=300.0),
    "operation.inner_speed": Normal(mean=1570.0, standard_deviation=15.0),
    "bearing.inner_conformity": Normal(mean=0.52, standard_deviation=0.002),
}


def timed(study: Study, samples: int, jobs: int) -> None:
    """Print how long the samples take, and how many failed."""
    draws = sample(study, samples)
    chain_samples(study, draws.first(1))
    wall, cpu = time.perf_counter(), time.process_time()
    found = chain_samples(study, draws, jobs=jobs)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    print(f"  {jobs} threads: {wall:.1f} s of wall, {cpu:.1f} s of processor, {len(found.failures)} failed")


def main() -> None:
    """Time both loads."""
    samples = int(sys.argv[1]) if len(sys.argv) > 1 else 4096
    study = with_distributions(read_study("cryogenic-turbopump"), LAWS)
    sideways = replace(study, operation=replace(study.operation, radial_load=500.0))
    for name, one, number in (("axial load", study, samples), ("and a radial load", sideways, samples // 8)):
        print(f"{name}, {number} samples")
        for jobs in (1, 2):
            timed(one, number, jobs)


if __name__ == "__main__":
    main()
