"""A curve on three worker processes of which one is killed in the middle, against the same without a cluster.

    python benchmarks/cluster_kill.py

Prints whether they agree to the last bit.
"""

import os
import signal
from dataclasses import replace

import distributed

from separatrix.cage import moving_cage
from separatrix.chain.solution import solve
from separatrix.study.reading import read_study
from separatrix.verdict.cluster import cluster
from separatrix.verdict.long_jobs import Runner
from separatrix.verdict.stability_curve import stability_curve


def main() -> None:
    """Run both and compare."""
    wheel = solve(read_study("momentum-wheel"))
    cage = moving_cage(wheel, 0.0)
    settings = replace(wheel.study.stability, runs=16, duration=0.02, restitution_factors=(0.2, 0.5, 0.8))
    killed: list[int] = []
    with distributed.LocalCluster(
        n_workers=3, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
    ) as three:

        def kill(done: int, total: int) -> None:  # noqa: ARG001 - as progress is reported
            if not killed:
                killed.append(three.workers[0].pid)
                os.kill(killed[0], signal.SIGKILL)

        with cluster(three.scheduler_address) as (executor, threads):
            far = stability_curve(
                cage, settings, runner=Runner(jobs=threads, executor=executor, progress=kill)
            )
    print("killed", killed, "same" if far == stability_curve(cage, settings) else "DIFFERENT")


if __name__ == "__main__":
    main()
