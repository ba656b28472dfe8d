"""A long job that goes on where it was stopped: finished runs are kept in a file."""

import tempfile
from dataclasses import replace
from pathlib import Path

from separatrix.ledger import NAME, Ledger
from separatrix.ranking import rank
from separatrix.study_file import read_study

study = read_study("momentum-wheel")
quick = replace(study, stability=replace(study.stability, runs=8, duration=0.02))


def stop(done: int, _total: int) -> None:
    """Press Ctrl-C after two pieces of work."""
    if done == 2:
        raise KeyboardInterrupt


with tempfile.TemporaryDirectory() as folder:
    ledger = Ledger(Path(folder) / NAME)
    part = rank(quick, ledger=ledger, progress=stop)
    whole = rank(quick, ledger=ledger)
    print(f"complete: {part.complete}, then {whole.complete}; {ledger.taken} runs were taken from the file")
    ledger.close()

same = repr(whole) == repr(rank(quick))
