"""A wheel for this platform that carries compiled kernels, so that its first answer compiles nothing.

    python tools/wheel.py build    # into dist/, from the sources of this clone
    python tools/wheel.py check    # installs it in a fresh environment that cannot be written

The kernels are compiled for `TARGET`, a family of CPUs, and not for the CPU at hand. They compute the same
bits: no floating-point operation is merged or reordered, whatever the CPU.
"""

import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).parents[1]
DIST, BUILD = ROOT / "dist", ROOT / "build" / "kernels"

VERBS = ("bearing", "traction", "restitution", "mobility")
"""Verbs that together compile every kernel but those of the cage."""

ASKED = ("rank", "bearing", "traction", "restitution", "mobility", "stability", "simulate")
"""Verbs that must compile nothing."""


def compile_for_target() -> None:
    """Compile every kernel that a verb calls; the variables of numba name the CPU."""
    import separatrix
    from separatrix.front import main
    from separatrix.study.study import BallModel

    for verb in VERBS:
        assert main([verb, "cryogenic-turbopump", "--json", "--quiet"]) == 0
    assert separatrix.solve(
        separatrix.read_study("cryogenic-turbopump")
    ).orbit_by_diameter  # of unequal balls
    with ProcessPoolExecutor() as pool:
        list(pool.map(cages, [ball for ball in BallModel if ball is not BallModel.AUTO]))


def cages(ball: object) -> None:
    """Compile the motion of cages among such balls: in space, and in the plane with both laws of contact."""
    import separatrix
    from separatrix.cage import moving_cage, run_ensemble
    from separatrix.study.study import MotionModel, StabilitySettings

    one = moving_cage(separatrix.solve(separatrix.read_study("cryogenic-turbopump")), 0.05, ball)
    moment = StabilitySettings(kicks=(0.1,), runs=1, duration=1e-3)
    kinds = ((MotionModel.SPACE, None), (MotionModel.PLANE, None), (MotionModel.PLANE, 1e9))
    for motion, hertz in kinds:
        run_ensemble(replace(one, motion=motion, hertz_coefficient=hertz), moment)


def build() -> None:
    """Compile the kernels, unless they are there, and build the wheel with them."""
    from separatrix.ground.compiled import TARGET, VERSIONS, source_stamp

    if platform.machine() not in ("x86_64", "AMD64"):
        sys.exit(f"The kernels of a wheel are for {TARGET}. Here, build one without: pip wheel --no-deps .")
    stamp = source_stamp(ROOT / "src" / "separatrix")
    kernels = BUILD / f"{VERSIONS}-{stamp}"
    if not kernels.exists():
        target = {"NUMBA_CPU_NAME": TARGET, "NUMBA_CPU_FEATURES": "", "NUMBA_CACHE_DIR": str(BUILD)}
        command = [sys.executable, "-W", "ignore", __file__, "compile_for_target"]
        subprocess.run(command, env=os.environ | target, stdout=subprocess.DEVNULL, check=True)
        made = BUILD / f"separatrix-kernels-{stamp}"
        if missing := named_kernels() - {path.name.partition("-")[0] for path in made.glob("*.nbc")}:
            sys.exit(f"No verb of this program compiles {', '.join(sorted(missing))}: add one that does.")
        made.rename(kernels)
    pip = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation"]
    named = os.environ | {"SEPARATRIX_KERNELS": str(kernels)}
    subprocess.run([*pip, "--wheel-dir", str(DIST), str(ROOT)], env=named, check=True)
    for wheel in sorted(DIST.glob("*-cp*.whl")):
        print(f"{wheel.relative_to(ROOT)}: {wheel.stat().st_size / 1e6:.1f} MB")


def named_kernels() -> set[str]:
    """Return module and name of every kernel in the sources, as numba names its files."""
    return {
        f"{path.stem}.{name}"
        for path in (ROOT / "src").rglob("*.py")
        for name in re.findall(r"^@kernel\ndef (\w+)", path.read_text(encoding="utf-8"), re.MULTILINE)
    }


def check() -> None:
    """Install the newest wheel, take away the right to write, and ask the verbs: none may compile."""
    wheel = max(DIST.glob("*-cp*.whl"), key=lambda path: path.stat().st_mtime)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        source, home, venv = place / "source", place / "home", place / "venv"
        source.mkdir()
        home.mkdir()
        shutil.copy(wheel, source)
        source.chmod(0o555)
        begun = clocks()
        subprocess.run([sys.executable, "-m", "venv", str(venv)], check=True)
        pip = [str(venv / "bin" / "pip"), "install", "--quiet", "--constraint", str(ROOT / "constraints.txt")]
        subprocess.run([*pip, str(source / wheel.name)], check=True)
        print(f"installed in {since(begun)}")
        package = next(venv.rglob("separatrix/kernels")).parent
        subprocess.run(["chmod", "-R", "a-w", str(package)], check=True)
        for verb in ASKED:
            print(f"{verb}: nothing compiled, {asked(venv, source, home, verb)}", flush=True)
        subprocess.run(["chmod", "-R", "u+w", str(place)], check=True)


def clocks() -> tuple[float, float]:
    """Time, and processor time of the processes that were waited for [s]."""
    now = os.times()
    return time.monotonic(), now.children_user + now.children_system


def since(begun: tuple[float, float]) -> str:
    """Both times since then, in words."""
    passed, spent = (now - before for now, before in zip(clocks(), begun, strict=True))
    return f"{passed:.1f} s, {spent:.1f} s of processor time"


def asked(venv: Path, source: Path, home: Path, verb: str) -> str:
    """Ask a verb where only its home can be written; return the time that it took."""
    command = [str(venv / "bin" / "separatrix"), verb, "cryogenic-turbopump", "--json"]
    if os.geteuid() == 0:  # root ignores permissions: give that up
        command = ["setpriv", "--bounding-set", "-dac_override", "--inh-caps", "-dac_override", *command]
    environment = {"PATH": os.environ["PATH"], "HOME": str(home)}
    begun = clocks()
    done = subprocess.run(command, env=environment, cwd=source, capture_output=True, text=True, check=False)
    passed = since(begun)
    assert done.returncode == 0, done.stderr
    assert "compiled once" not in done.stderr, done.stderr
    assert not [*home.rglob("*.nbc"), *venv.rglob("__pycache__/*-kernels-*/*")], "a kernel was compiled"
    return passed


if __name__ == "__main__":
    {"build": build, "check": check, "compile_for_target": compile_for_target}[sys.argv[1]]()
