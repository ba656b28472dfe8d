"""How kernels are compiled: strict floating point, without the interpreter's lock, and cached.

numba keeps compiled code until the file of the function changes. It does not see a change in another file,
although a constant or a function of that file may be compiled in. So the code is cached in a folder that is
named after all that can be compiled in: the versions of Python, numpy and numba, and every file of the
package that a module with kernels imports, directly or through others. A report or a figure is not one of
them, so that an edit there compiles nothing again. Nor are the time and the place of a file, so that a wheel
can carry such a folder (`tools/wheel.py` builds it): its kernels are for `TARGET`, not for the CPU at hand,
and are loaded from it if they fit, although it cannot be written.

Only kernels that Python calls are cached, with all that they call in one file. numba writes a file under
another name and then renames it, and a cached kernel has one signature only: processes that compile it at the
same time write the same file, so that they can share a folder.

Of numba this uses `njit`, its events, the setting CACHE_DIR (the variable NUMBA_CACHE_DIR), and what numba
does not document: the option `_nrt`, the method `_compile_for_args`, by which a kernel is compiled, and the
classes and methods of `numba.core.caching`, by which it is kept and loaded.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FunctionType
from typing import Any, ParamSpec, TypeVar, cast

import llvmlite.binding
import numba
import numpy as np
from numba.core import caching
from numba.core.runtime.nrt import rtsys

from separatrix.ground.compiling import COMPILING

CONFIG = vars(numba.config)
"""Settings of numba: CACHE_DIR is that of the variable NUMBA_CACHE_DIR."""

llvmlite.binding.set_option("separatrix", "--runtime-memory-check-threshold=64")
"""Pairs of arrays in a loop over lanes that the compiler checks for overlap: by default too few."""

P = ParamSpec("P")
R = TypeVar("R")

ROOM = 1 << 17
"""Values for which the interpreter's stack has room while a kernel is compiled: more than it takes."""

TARGET = "x86-64-v3"
"""CPU for which the kernels of a wheel are compiled, as LLVM names it."""

NEEDED = ("avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe")
"""What a CPU has beyond its forerunners if it is one of `TARGET`, as LLVM names it."""

VERSIONS = (
    f"{sys.implementation.cache_tag}-numba-{numba.__version__}-numpy-{np.__version__.rpartition('.')[0]}"
)
"""Versions for which compiled code is good: numba distinguishes no closer ones of Python and numpy."""

UNUSED = 14 * 86400.0
"""Time after which compiled code of other sources is removed [s]: some days of changing between versions."""

_IMPORT = re.compile(rb"^[ \t]*from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n]*)", re.MULTILINE)
_WHOLE_IMPORT = re.compile(rb"^[ \t]*import[ \t]+([^\n]+)", re.MULTILINE)


def kernel_sources(package: Path) -> list[Path]:
    """Files of a package from which its kernels can take values or functions, in order.

    These are the modules that use this one, and all that they import from the package. An import that a
    function or a type checker makes counts too: one file too many costs time, one too few a wrong answer.
    """
    name, sources = package.name, {path: path.read_bytes() for path in package.rglob("*.py")}
    modules = {_module(path.relative_to(package.parent)): path for path in sources}
    waiting = [key for key, path in modules.items() if f"{name}.ground.compiled".encode() in sources[path]]
    found: set[str] = set()
    while waiting:
        module = waiting.pop()
        if module in modules and module not in found:
            found.add(module)
            waiting += _imported(sources[modules[module]])
    return sorted(modules[module] for module in found)


def _module(path: Path) -> str:
    parts = path.with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _imported(source: bytes) -> Iterator[str]:
    """Modules that a source may import; the names that it takes out of them are tried as modules."""
    for home, names in _IMPORT.findall(source):
        yield home.decode()
        yield from (f"{home.decode()}.{name.decode()}" for name in re.findall(rb"\w+", names))
    for names in _WHOLE_IMPORT.findall(source):
        yield from (name.decode() for name in re.findall(rb"[\w.]+", names))


def source_stamp(package: Path) -> str:
    """Checksum of `kernel_sources` and of `VERSIONS`."""
    stamp = hashlib.sha256(VERSIONS.encode())
    for path in kernel_sources(package):
        text = path.read_bytes()
        stamp.update(f"{path.relative_to(package).as_posix()} {len(text)} ".encode() + text)
    return stamp.hexdigest()[:12]


def cache_folder(package: Path) -> Path | None:
    """Folder for code that is compiled from these sources; None if no folder can be written.

    It is in the folder that NUMBA_CACHE_DIR names; else beside the package's own compiled files; else,
    where that cannot be written, in the user's cache. Folders of other sources that were not used for
    `UNUSED` are removed.
    """
    user = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser(os.path.join("~", ".cache"))
    usual = [package / "__pycache__", Path(user) / package.name]
    chosen = CONFIG["CACHE_DIR"]
    for place in [Path(chosen)] if chosen else usual:
        folder = place / f"{package.name}-kernels-{source_stamp(package)}"
        with contextlib.suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            os.utime(folder)
            if os.access(folder, os.W_OK):
                _remove_unused(folder)
                return folder
    return None


def _remove_unused(folder: Path) -> None:
    """Remove the caches beside this one that were not used for long."""
    for other in folder.parent.glob(f"{folder.name.rpartition('-')[0]}-*"):
        with contextlib.suppress(OSError):  # another process may remove it too
            if other.stat().st_mtime < time.time() - UNUSED:
                shutil.rmtree(other, ignore_errors=True)


def shipped_folder(package: Path) -> tuple[Path | None, str]:
    """Folder of the kernels that came with the package, None if there is none that can be used, and why.

    Its name is what it was compiled from: `VERSIONS` and `source_stamp`.
    """
    there = next((package / "kernels").glob("*"), None)
    if there is None:
        return None, ""
    has, here = llvmlite.binding.get_host_cpu_features(), f"{VERSIONS}-{source_stamp(package)}"
    lacking = [feature for feature in NEEDED if not has.get(feature)]
    if lacking:
        return None, f"the kernels of the package need a CPU with {', '.join(lacking)}"
    if there.name != here:
        return None, f"the kernels of the package are for {there.name}, and this is {here}"
    return there, ""


_PACKAGE = Path(__file__).parents[1]
_FOLDER = cache_folder(_PACKAGE)
_SHIPPED, COMPILING.reason = shipped_folder(_PACKAGE)


class _Place(caching._CacheLocator):
    """Where numba keeps a kernel: in the folder that is named after the sources."""

    def __init__(self, function: FunctionType, file: str) -> None:
        self._function, self._py_file = function, file

    @classmethod
    def from_function(cls, function: FunctionType, file: str) -> _Place:
        return cls(function, file)

    def get_cache_path(self) -> str:
        return str(_FOLDER or "")

    def get_source_stamp(self) -> str:
        return ""

    def get_disambiguator(self) -> str:
        return f"{self._function.__module__}-{self._function.__code__.co_firstlineno}"


class _Kept(caching.CompileResultCacheImpl):
    """How numba keeps a kernel there."""

    _locator_classes = [_Place]  # noqa: RUF012 - as numba has it


class _Cache(caching.FunctionCache):
    """What is kept of a kernel: read where it was shipped, else where it can be written."""

    _impl_class = _Kept

    def load_overload(self: Any, signature: object, target: Any) -> Any:
        """Return the compiled code of a kernel, None if there is none.

        numba would first fill its tables of types and functions, which only compiling needs, and which take
        longer to fill than all else that a short verb does.
        """
        rtsys.initialize(target)
        if _SHIPPED is not None:
            _, (triple, *_), code = self._index_key(signature, target.codegen())
            index: Any = caching.IndexDataCacheFile
            found = index(str(_SHIPPED), self._impl.filename_base, "").load(
                (signature, (triple, TARGET, ""), code)
            )
            if found is not None:
                return self._impl.rebuild(target, found)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(signature, target)

    def save_overload(self, signature: object, data: object) -> None:
        """Keep it, where there is a folder to keep it in."""
        if _FOLDER is not None:
            super().save_overload(signature, data)  # type: ignore[no-untyped-call]


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a kernel that Python calls, always with arguments of the same types, and cache it."""
    compiled: Any = _compiled(function)
    vars(compiled)["_compile_for_args"] = _with_room(compiled._compile_for_args)
    compiled._cache = _Cache(function)  # type: ignore[no-untyped-call]
    return cast(Callable[P, R], compiled)


def _with_room(function: Callable[P, R]) -> Callable[P, R]:
    """Call a function where the interpreter's stack has room for all that it calls.

    Python keeps the frames of calls in chunks of 16 kB and gives a chunk back as soon as its first call
    returns. A compiler whose calls go over such an edge again and again spends a third of its time there.
    """

    def call(*args: P.args, **options: P.kwargs) -> R:
        return function(*args, **options)

    code = call.__code__.replace(co_stacksize=ROOM)
    return cast(Callable[P, R], FunctionType(code, call.__globals__, closure=call.__closure__))


def part(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a kernel that only kernels call."""
    return _compiled(function)


def unfolded(function: Callable[P, R]) -> Callable[P, R]:
    """Write a large part out in its only caller.

    Compiled by itself, all that it calls would be optimized for it and once more for its caller.
    """
    return _compiled(function, inline="always")


def inlined(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a part into those that call it: the equations of the cage, in loops over lanes."""
    return _compiled(function, _nrt=False, forceinline=True)


def in_python_too(function: Callable[P, R]) -> Callable[P, R]:
    """A piece of compiled parts that stays plain Python for those that call it there."""
    found: Callable[P, R] = numba.extending.register_jitable(function)
    return found


def _compiled(function: Callable[P, R], **options: bool | str) -> Callable[P, R]:
    """Compile with numba; the signature stays visible to the type checker."""
    jit = numba.njit(nogil=True, error_model="numpy", **options)  # type: ignore[call-overload]  # _nrt
    compiled: Callable[P, R] = jit(function)
    return compiled
