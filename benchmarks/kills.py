"""Kill the long verbs again and again: each must go on to the same bytes, with nothing half-written.

    python benchmarks/kills.py [KILLS]

Each verb is started in a folder, killed (SIGKILL) after a random time, and started again, KILLS times (40) in
all. After a kill the folder may hold the ledger and staging folders, which the next call removes, and beside
them nothing or a whole answer. Such an answer must have the bytes of one that was never interrupted; then a
new folder is begun.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from separatrix.verdict.ledger import NAME

STUDY = """
extends = "momentum-wheel"
[stability]
duration = "50 ms"
[ranking]
friction_scatter = 0.2
"""
CALLS = {
    "rank": [],
    "stability": [],
    "map": ["--points", "24"],
    "sensitivity": ["--samples", "64"],
    "sweep": ["--vary", "ball_cage_friction=0.1..0.4:12", "--verdicts"],
}
LONGEST: float = 6.0
"""A call is killed after this time at most [s]; the calls need 10 to 30 s, 2 of them to start."""


def started(verb: str, folder: Path, place: Path) -> subprocess.Popen[bytes]:
    """Start a verb whose answer goes to a folder."""
    call = [sys.executable, "-m", "separatrix", verb, "s.toml", *CALLS[verb], "--quiet", "--out", str(folder)]
    return subprocess.Popen(call, cwd=place, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def left(folder: Path) -> set[str]:
    """Names in a folder, but for the ledger's own and for what is being staged."""
    names = {path.name for path in folder.iterdir()} if folder.exists() else set()
    return {name for name in names if not name.startswith((NAME, ".separatrix-"))}


def tried(verb: str, kills: int, place: Path) -> tuple[int, int]:
    """Answers that were given, and folders that hold anything but nothing or the whole answer."""
    rng, whole = np.random.default_rng(sum(verb.encode())), place / f"{verb}-whole"
    started(verb, whole, place).wait()
    answers = wrong = done = 0
    while done < kills:
        folder = place / f"{verb}-{answers}"
        process = started(verb, folder, place)
        time.sleep(rng.uniform(0.3, LONGEST))
        done += process.poll() is None
        process.kill()
        process.wait()
        if left(folder):
            answers += 1
            wrong += left(folder) != left(whole) or contents(folder, verb) != contents(whole, verb)
    started(verb, folder, place).wait()
    return answers + 1, wrong + (contents(folder, verb) != contents(whole, verb))


def contents(folder: Path, verb: str) -> bytes:
    """Document of an answer; empty if there is none."""
    path = folder / f"{verb}.json"
    return path.read_bytes() if path.exists() else b""


def main() -> None:
    """Print a line for each verb."""
    kills = int(sys.argv[1]) if len(sys.argv) > 1 else 40
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "s.toml").write_text(STUDY)
        for verb in CALLS:
            answers, wrong = tried(verb, kills, place)
            print(f"{verb}: {kills} kills, {answers} answers, {wrong} wrong", flush=True)


if __name__ == "__main__":
    main()
