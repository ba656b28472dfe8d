"""Compiled kernels and their cache."""

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

import separatrix
from separatrix import compiled
from separatrix.compiled import UNUSED, cache_folder, kernel_sources, source_stamp

PACKAGE = Path(separatrix.__file__).parent

ONE_KERNEL = """
import json
import numpy as np
from law import Law
from separatrix.cage.motion import push_of

law = Law(0.0, 0, 1.0)
pockets, w = np.arange(40.0).reshape(20, 2), np.arange(200.0).reshape(2, 100) ** 2
value = push_of(law, pockets, w, 1, 0)
stats = push_of.stats
print(json.dumps([value, sum(stats.cache_hits.values()), sum(stats.cache_misses.values())]))
"""
"""Call one small kernel of the cage, which has the numbers of slots compiled in."""


def _package(folder, **sources):
    """Package of these modules; a key of two underscores is a module in a package of its own."""
    for name, source in sources.items():
        path = folder / (name.replace("__", "/") + ".py")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(source)
    return folder


@pytest.mark.parametrize(
    "line",
    [
        "from pack.slots import FORCE",
        "from pack import other, slots",
        "import pack.slots",
        "import os, pack.slots as s",
        "from pack import (\n    other,\n    slots,\n)",
        "    from pack.slots import FORCE",
        "from pack.middle import FORCE",
    ],
)
def test_a_change_in_any_file_that_a_kernel_can_see_is_seen(tmp_path, line):
    """Another constant in an imported file, however it is imported, is another stamp; a report's is not."""
    package = _package(
        tmp_path / "pack",
        deep__a=f"from pack.compiled import kernel\n{line}\n",
        middle="from pack.slots import FORCE\n",
        slots="FORCE = 1\n",
        other="",
        report="from pack.deep.a import run\n",
        compiled="",
    )
    stamp = source_stamp(package)
    (package / "report.py").write_text("WIDTH = 2\n")
    assert source_stamp(package) == stamp
    (package / "slots.py").write_text("FORCE = 2\n")
    assert source_stamp(package) != stamp


def test_the_cage_and_the_study_are_sources_of_kernels_and_a_report_is_not():
    """What the files of today come to."""
    found = {str(path.relative_to(PACKAGE)) for path in kernel_sources(PACKAGE)}
    assert {"cage/slots.py", "cage/planar.py", "study.py", "hertz.py", "compiled.py"} <= found
    assert not any(name.startswith(("report", "figures", "cli", "results")) for name in found)


def test_caches_of_other_sources_are_removed_once_they_are_old(tmp_path, monkeypatch):
    """An old one goes, a young one and anything else stay."""
    monkeypatch.setattr(compiled.CONFIG, "CACHE_DIR", str(tmp_path))
    for name in ("separatrix-kernels-0", "separatrix-kernels-1", "other"):
        (tmp_path / name).mkdir()
    then = time.time() - 2.0 * UNUSED
    for name in ("separatrix-kernels-0", "other"):
        os.utime(tmp_path / name, (then, then))
    mine = cache_folder(PACKAGE)
    assert {path.name for path in tmp_path.iterdir()} == {mine.name, "separatrix-kernels-1", "other"}


def test_where_no_folder_can_be_written_nothing_is_cached(tmp_path, monkeypatch):
    """A file stands in the place of each folder; the kernels would be compiled at each start."""
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(compiled.CONFIG, "CACHE_DIR", str(tmp_path / "file"))
    assert cache_folder(PACKAGE) is None


@pytest.mark.slow
def test_code_that_was_compiled_from_other_sources_is_not_used(tmp_path):
    """In a copy of the package: after an edit of a constant the kernel is compiled again and obeys it."""
    package = tmp_path / "separatrix"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
    law = "from collections import namedtuple\nLaw = namedtuple('Law', 'hertz harmonics stiffness')\n"
    (tmp_path / "law.py").write_text(law)
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}

    def value_hits_misses():
        told = subprocess.run(
            [sys.executable, "-c", ONE_KERNEL],
            env=environment | {"PYTHONPATH": str(tmp_path)},
            capture_output=True,
            text=True,
            check=True,
        )
        return json.loads(told.stdout)

    def edit(name, old, new):
        source = (package / name).read_text()
        assert old in source
        (package / name).write_text(source.replace(old, new))

    value, hits, misses = value_hits_misses()
    assert (hits, misses) == (0, 1)
    edit("report/tables.py", '"""', '"""Edited. ')
    assert value_hits_misses() == [value, 1, 0]
    edit("cage/slots.py", "COSINE, SINE, PLAY,", "SINE, COSINE, PLAY,")
    swapped, *found = value_hits_misses()
    assert swapped != value
    assert found == [0, 1]
    for name in ("cage/planar.py", "study.py"):
        (package / name).write_text((package / name).read_text() + "\nADDED = 1\n")
        assert value_hits_misses() == [swapped, 0, 1]
