"""Compiled kernels and their cache."""

import json
import os
import shutil
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest

import separatrix
from separatrix.ground import compiled
from separatrix.ground.compiled import TARGET, UNUSED, VERSIONS, cache_folder, shipped_folder, source_stamp

PACKAGE = Path(separatrix.__file__).parent
ROOT = PACKAGE.parents[1]

SOME_KERNELS = """
import json
from separatrix.chain import hertz
from separatrix.chain import traction_curve

edges = traction_curve.panel_edges(0.1, 0.2, 0.0, traction_curve.LEVELS, 1)
values = [*hertz.ellipse_shape(3.0, 0.0), *edges]
stats = [kernel.stats for kernel in (hertz.ellipse_shape, traction_curve.panel_edges)]
hits, misses = (sum(sum(getattr(s, name).values()) for s in stats) for name in ("cache_hits", "cache_misses"))
print(json.dumps([values, hits, misses]))
"""

READS_A_CONSTANT = """
from separatrix.cage.rows import LANES
from separatrix.ground.compiled import kernel


@kernel
def read() -> int:
    return LANES
"""

CALLS_IT = """
import json
from separatrix.reading import read
value = read()
print(json.dumps([value, sum(read.stats.cache_hits.values()), sum(read.stats.cache_misses.values())]))
"""


def _start(code, **environment):
    """A process that runs this code; NUMBA_CACHE_DIR is not handed on."""
    inherited = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}
    command = [sys.executable, "-c", code]
    return subprocess.Popen(command, env=inherited | environment, stdout=subprocess.PIPE, text=True)


def _answer(process):
    """What the process printed."""
    out, _ = process.communicate(timeout=500)
    assert process.returncode == 0
    return json.loads(out)


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
        deep__a=f"from pack.ground.compiled import kernel\n{line}\n",
        middle="from pack.slots import FORCE\n",
        slots="FORCE = 1\n",
        other="",
        report="from pack.deep.a import run\n",
        ground__compiled="",
    )
    stamp = source_stamp(package)
    (package / "report.py").write_text("WIDTH = 2\n")
    assert source_stamp(package) == stamp
    (package / "slots.py").write_text("FORCE = 2\n")
    assert source_stamp(package) != stamp


def test_caches_of_other_sources_are_removed_once_they_are_old(tmp_path, monkeypatch):
    """An old one goes, a young one and anything else stay; without a folder nothing is cached."""
    monkeypatch.setitem(compiled.CONFIG, "CACHE_DIR", str(tmp_path))
    for name in ("separatrix-kernels-0", "separatrix-kernels-1", "other"):
        (tmp_path / name).mkdir()
    then = time.time() - 2.0 * UNUSED
    for name in ("separatrix-kernels-0", "other"):
        os.utime(tmp_path / name, (then, then))
    mine = cache_folder(PACKAGE)
    assert {path.name for path in tmp_path.iterdir()} == {mine.name, "separatrix-kernels-1", "other"}
    # a file in the place of the folder: the kernels would be compiled at each start
    (tmp_path / "file").write_text("")
    monkeypatch.setitem(compiled.CONFIG, "CACHE_DIR", str(tmp_path / "file"))
    assert cache_folder(PACKAGE) is None


def test_kernels_that_came_with_the_package_are_used_where_they_fit(tmp_path, monkeypatch):
    """Not on a CPU that lacks an instruction, nor with other sources or versions: the reason names which."""
    package = _package(tmp_path / "pack", ground__compiled="")
    assert shipped_folder(package) == (None, "")
    there = package / "kernels" / f"{VERSIONS}-{source_stamp(package)}"
    there.mkdir(parents=True)
    monkeypatch.setattr(compiled, "NEEDED", ())
    assert shipped_folder(package) == (there, "")
    monkeypatch.setattr(compiled, "NEEDED", ("an-abacus",))
    assert shipped_folder(package) == (None, "the kernels of the package need a CPU with an-abacus")
    monkeypatch.setattr(compiled, "NEEDED", ())
    there.rename(there.with_name("cpython-39-numba-0.1"))
    assert shipped_folder(package)[1].startswith("the kernels of the package are for cpython-39-numba-0.1, ")


@pytest.mark.slow
def test_a_wheel_with_kernels_compiles_nothing_where_it_is_unpacked(tmp_path):
    """Two kernels for another CPU than this one, from another path: loaded, and the same numbers."""
    place = {"HOME": str(tmp_path), "XDG_CACHE_HOME": str(tmp_path / "user")}
    target = {"NUMBA_CPU_NAME": TARGET, "NUMBA_CPU_FEATURES": "", "NUMBA_CACHE_DIR": str(tmp_path)}
    made = _answer(_start(SOME_KERNELS, PYTHONPATH=str(PACKAGE.parent), **place | target))
    kernels = tmp_path / f"{VERSIONS}-{source_stamp(PACKAGE)}"
    (tmp_path / f"separatrix-kernels-{source_stamp(PACKAGE)}").rename(kernels)
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    environment = os.environ | {"SEPARATRIX_KERNELS": str(kernels)}
    subprocess.run(build, cwd=ROOT, env=environment, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    assert f"-{python}-{python}-" in wheel.name
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "site")
    values, hits, misses = _answer(_start(SOME_KERNELS, PYTHONPATH=str(tmp_path / "site"), **place))
    assert (values, hits, misses) == (made[0], 2, 0)
    (about,) = (tmp_path / "site").glob("*.dist-info/METADATA")
    assert "Requires-Dist: numba<=" in about.read_text()


@pytest.mark.slow
def test_code_that_was_compiled_from_other_sources_is_not_used(tmp_path):
    """In a copy of the package: after an edit of a constant the kernel is compiled again and obeys it."""
    package = tmp_path / "separatrix"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
    (package / "reading.py").write_text(READS_A_CONSTANT)

    def value_hits_misses():
        return _answer(_start(CALLS_IT, PYTHONPATH=str(tmp_path)))

    def edit(name, old, new):
        source = (package / name).read_text()
        assert old in source
        (package / name).write_text(source.replace(old, new))

    assert value_hits_misses() == [16, 0, 1]
    edit("present/text.py", '"""', '"""Edited. ')
    assert value_hits_misses() == [16, 1, 0]
    edit("cage/rows.py", "LANES = 16", "LANES = 32")
    assert value_hits_misses() == [32, 0, 1]
    (package / "study/study.py").write_text((package / "study/study.py").read_text() + "\nADDED = 1\n")
    assert value_hits_misses() == [32, 0, 1]


@pytest.mark.slow
def test_processes_that_compile_at_once_share_a_folder(tmp_path):
    """Two fill it together; a third compiles nothing; all compute the same numbers."""
    settings = {"PYTHONPATH": str(PACKAGE.parent), "NUMBA_CACHE_DIR": str(tmp_path)}
    together = [_start(SOME_KERNELS, **settings) for _ in range(2)]
    first, second = (_answer(process) for process in together)
    third = _answer(_start(SOME_KERNELS, **settings))
    assert first[0] == second[0] == third[0]
    assert third[1:] == [2, 0]
    kept = [path.name for path in tmp_path.rglob("*.nbc")]
    version = f".py{sys.version_info[0]}{sys.version_info[1]}"
    assert len(kept) >= 2
    assert all(version in name and name.endswith(".1.nbc") for name in kept)  # of one signature each
