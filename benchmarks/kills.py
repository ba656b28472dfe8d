"""Kill long verbs at random moments: the same command again must leave the files of an undisturbed one.

    python benchmarks/kills.py [KILLS] [VERB...]

Each verb is killed (SIGKILL) KILLS times (25), each time in a new folder, between its start and the time that
it needs undisturbed. The folder may have the ledger, a hidden folder of what was being written, and files of
the answer, each whole. The command is run again there, must succeed without a complaint, and must leave the
files of an undisturbed one, byte by byte. `cold` kills `rank` within `LONGEST` of its start, again and again,
until it has compiled its kernels in an empty cache and has answered.
"""

import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from separatrix.verdict.long_jobs import NAME

STUDY = """
extends = "cryogenic-turbopump"
[stability]
runs = 8
duration = "20 ms"
restitution_factors = [0.3, 0.9]
[ranking]
materials = ["Armalon", "Meldin HTC 100"]
friction = "pin-on-disk-77K"
[wear]
film_wear = { between = ["5e-17 m3/(N m)", "1e-15 m3/(N m)"] }
cage_wear = { between = ["1e-15 m3/(N m)", "5e-15 m3/(N m)"] }
bare_friction = 0.3
"""
CALLS = {
    "rank": [],
    "map": ["--points", "12", "--runs", "8"],
    "life": ["--samples", "128"],
    "report": [],
}
LONGEST = 20.0
"""Time after which a verb that compiles is killed at most [s]: one kernel takes up to half of it."""

Ran = subprocess.Popen[str]


def started(verb: str, folder: Path, place: Path, **more: str) -> Ran:
    """Start a verb whose answer goes to a folder."""
    call = [sys.executable, "-m", "separatrix", verb, "s.toml", *CALLS[verb], "--quiet", "--out", str(folder)]
    pipes = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
    return subprocess.Popen(call, cwd=place, text=True, env=os.environ | more, **pipes)


def ended(process: Ran, seconds: float | None = None) -> bool:
    """Wait for a process without complaints, or kill it after some seconds; return whether it was killed."""
    try:
        process.wait(seconds)
    except subprocess.TimeoutExpired:
        process.kill()
    said = process.communicate()[1]
    assert (said, process.returncode) in (("", 0), ("", -signal.SIGKILL)), said
    return process.returncode < 0


def files(folder: Path) -> dict[str, bytes]:
    """Files of an answer: not the ledger, nor what was being written."""
    paths = folder.iterdir() if folder.exists() else ()
    return {one.name: one.read_bytes() for one in paths if not one.name.startswith((NAME, ".separatrix-"))}


def tried(verb: str, kills: int, place: Path) -> str:
    """Return in words what came of the kills of a verb."""
    rng, whole = np.random.default_rng(sum(verb.encode())), place / f"{verb}-whole"
    ended(started(verb, whole, place))  # what it compiles is compiled now
    begin = time.monotonic()
    ended(started(verb, place / f"{verb}-again", place))
    longest, answer = time.monotonic() - begin, files(whole)
    assert files(place / f"{verb}-again") == answer, "two undisturbed answers differ"
    done = number = with_runs = with_files = hidden = 0
    while done < kills:
        folder, number = place / f"{verb}-{number}", number + 1
        if not ended(started(verb, folder, place), rng.uniform(0.0, longest)):
            continue  # it was faster
        done += 1
        left = files(folder)
        assert left.items() <= answer.items(), f"{folder} has files that are not of the answer"
        with_runs += (folder / NAME).exists()
        with_files += left != {}
        hidden += any(folder.glob(".separatrix-*"))
        ended(started(verb, folder, place))
        assert files(folder) == answer, f"{folder} has another answer"
    counts = f"{kills} | {with_runs} | {with_files} | {hidden}"
    return f"| {verb} | {longest:.1f} s | {counts} | all {len(answer)} files alike |"


def cold(place: Path) -> str:
    """Return in words what came of kills while kernels compile."""
    rng, cache = np.random.default_rng(0), {"NUMBA_CACHE_DIR": str(place / "kernels")}
    kills = 0
    while ended(started("rank", place / "cold", place, **cache), rng.uniform(0.0, LONGEST)):
        kills += 1
    ended(started("rank", place / "cold", place, **cache))
    assert files(place / "cold") == files(place / "rank-whole"), "another answer"
    left = len([*(place / "kernels").rglob("*.tmp.*")])
    return f"| rank, compiling | - | {kills} | - | - | {left} in the cache | all files alike |"


def main(kills: int, verbs: list[str]) -> None:
    """Print a line for each verb."""
    print("| verb | undisturbed | kills | left runs | files of the answer | a hidden folder | run again |")
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "s.toml").write_text(STUDY)
        for verb in verbs:
            print(tried(verb, kills, Path(folder)) if verb in CALLS else cold(Path(folder)), flush=True)


if __name__ == "__main__":
    main(int((sys.argv[1:] or ["25"])[0]), sys.argv[2:] or [*CALLS, "cold"])
