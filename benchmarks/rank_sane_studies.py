"""`rank` on random sane studies: its time, its estimate, and whether an answer contradicts itself.

    python benchmarks/rank_sane_studies.py [--studies 100] [--first 0]

Each study (tests/properties/sane_studies.py) is ranked by the command, as a user would. A line for each that
takes more than twice its estimate, fails, or contradicts itself (tests/properties/rank_answers.py).
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "properties"))
from rank_answers import contradictions
from sane_studies import sane_text

UNITS = {"s": 1.0, "min": 60.0, "h": 3600.0}
NO_ESTIMATE = 25.0
"""What a study without an estimate may take [s]: the first line comes after 20 s."""

START = 3.0
"""Of every command [s]: reading, estimate and files."""


def estimate(stderr: str) -> float:
    """Time of the whole command by the first line that has an estimate [s]."""
    time = r"([0-9.]+) (s|min|h)"
    found = re.search(f"% after {time}, about {time} left", stderr)
    if not found:
        return NO_ESTIMATE
    passed, unit, left, its = found.groups()
    return float(passed) * UNITS[unit] + float(left) * UNITS[its]


def main() -> None:
    """Rank the studies, and print what is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--studies", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    asked = parser.parse_args()
    verdicts: Counter[str] = Counter()
    late = broken = wrong = 0
    with tempfile.TemporaryDirectory() as name:
        for seed in range(asked.first, asked.first + asked.studies):
            path = Path(name) / f"sane-{seed}.toml"
            path.write_text(sane_text(seed), encoding="utf-8")
            begun = time.perf_counter()
            command = ["separatrix", "rank", str(path), "--json", "--out", str(path.with_suffix(""))]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            took, told = time.perf_counter() - begun, estimate(done.stderr)
            if done.returncode or "Traceback" in done.stderr:
                broken += 1
                print(f"{seed:4d} exit {done.returncode}: {done.stderr[-500:]}", flush=True)
                continue
            answer = json.loads(done.stdout)
            rows = answer["environments"][0]["materials"]
            verdicts.update(row["verdict"] for row in rows)
            against = list(contradictions(answer))
            wrong += len(against)
            over = took > 2.0 * told + START
            late += over
            words = ", ".join(f"{row['name']} {row['verdict']}" for row in rows)
            print(f"{seed:4d} {took:.1f} s, told {told:.3g} s{', LATE' * over}; {words}", flush=True)
            for one in against:
                print(f"     {one}", flush=True)
    print(f"{asked.studies} studies: {broken} failed, {late} took over twice their estimate, ", end="")
    print(f"{wrong} contradictions; {dict(verdicts)}")


if __name__ == "__main__":
    main()
