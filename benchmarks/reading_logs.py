"""Time to read raw logs of a million rows, one line per format: ``python benchmarks/reading_logs.py [ROWS]``.

Processor seconds of one process, the better of two, from the file on disk to the log in memory.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "unit"))
import raw_logs

from separatrix.friction.logs import read_log


def jobs(rows: int) -> dict[str, Callable[[], bytes]]:
    """Writers of the files by what is in them."""
    t = np.arange(rows) * 0.01
    f = 0.1 + 0.01 * np.random.default_rng(1).standard_normal(rows)
    gaps = np.where(np.arange(rows) % 1000 == 5, np.nan, f)
    three = {"Time [s]": t, "COF": f, "Fz [N]": 10.0 + f}
    return {
        "Anton Paar": lambda: raw_logs.anton_paar(f, t),
        "Anton Paar, decimal comma": lambda: raw_logs.anton_paar(f, t, decimal=","),
        "Anton Paar, one x in a thousand rows": lambda: raw_logs.anton_paar(gaps, t, missing="x"),
        "Rtec": lambda: raw_logs.rtec(f, t),
        "Bruker UMT": lambda: raw_logs.umt(f, t),
        "Phoenix Compend": lambda: raw_logs.compend(f, t, fast_data_every=1000),
        "CSV": lambda: raw_logs.plain_csv(three),
        "CSV, semicolon, decimal comma": lambda: raw_logs.plain_csv(three, separator=";", decimal=","),
        "runs of blanks": lambda: raw_logs.plain_csv(three, separator="  "),
        "TSV, UTF-16": lambda: raw_logs.plain_csv(three, separator="\t", encoding="utf-16-le-mark"),
    }


def seconds(path: Path) -> float:
    """Processor time of one reading."""
    start = time.process_time()
    read_log(path)
    return time.process_time() - start


def main(rows: int) -> None:
    """Write, read and report each format."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.txt"
        for name, write in jobs(rows).items():
            content = write()
            path.write_bytes(content)
            best = min(seconds(path), seconds(path))
            print(f"| {name} | {len(content) / 1e6:.0f} MB | {best:.2f} s |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000)
