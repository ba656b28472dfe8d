"""How kernels are compiled: strict floating point, without the interpreter's lock, and cached.

numba keeps compiled code until the file of the function changes. It does not see a change in another file,
although a constant or a function of that file may be compiled in. So the code is cached in a folder that is
named after all that can be compiled in: the versions of Python, numpy and numba, and every file of the
package that a module with kernels imports, directly or through others. A report or a figure is not one of
them, so that an edit there compiles nothing again.

Only kernels that Python calls are cached, with all that they call in one file. numba writes a file under
another name and then renames it, and a cached kernel has one signature only: processes that compile it at the
same time write the same file, so that they can share a folder.

Of numba this uses `njit`, its events, the setting CACHE_DIR (the variable NUMBA_CACHE_DIR), and what numba
does not document: the option `_nrt`, and the methods `_compile_for_args` and `_load_overload`, by which a
kernel is compiled and loaded.
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
from functools import partial
from pathlib import Path
from types import FunctionType
from typing import Any, ParamSpec, TypeVar, cast

import llvmlite.binding
import numba
import numpy as np
from numba.core.runtime.nrt import rtsys

from separatrix.ground import compiling  # noqa: F401 - it listens from now on

CONFIG = vars(numba.config)
"""Settings of numba: CACHE_DIR is that of the variable NUMBA_CACHE_DIR."""

llvmlite.binding.set_option("separatrix", "--runtime-memory-check-threshold=64")
"""Pairs of arrays in a loop over lanes that the compiler checks for overlap: by default too few."""

P = ParamSpec("P")
R = TypeVar("R")

ROOM = 1 << 17
"""Values for which the interpreter's stack has room while a kernel is compiled: more than it takes."""

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
    """Checksum of `kernel_sources` and of the versions of Python, numpy and numba."""
    stamp = hashlib.sha256(f"{sys.version} {np.__version__} {numba.__version__}".encode())
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


_FOLDER = cache_folder(Path(__file__).parents[1])


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a kernel that Python calls, always with arguments of the same types, and cache it."""
    usual = CONFIG["CACHE_DIR"]
    try:
        CONFIG["CACHE_DIR"] = str(_FOLDER or "")
        compiled = _compiled(function, cache=_FOLDER is not None)
    finally:
        CONFIG["CACHE_DIR"] = usual
    vars(compiled)["_compile_for_args"] = _with_room(compiled._compile_for_args)  # type: ignore[attr-defined]
    if _FOLDER is not None:
        cache = compiled._cache  # type: ignore[attr-defined]
        cache.load_overload = partial(_loaded, cache)
    return compiled


def _loaded(cache: Any, signature: object, target: object) -> object:
    """Return the cached code of a kernel, None if there is none.

    numba would first fill its tables of types and functions, which only compiling needs, and which take
    longer to fill than all else that a short verb does.
    """
    rtsys.initialize(target)
    with cache._guard_against_spurious_io_errors():
        return cast(object, cache._load_overload(signature, target))


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


def _compiled(function: Callable[P, R], **options: bool | str) -> Callable[P, R]:
    """Compile with numba; the signature stays visible to the type checker."""
    jit = numba.njit(nogil=True, error_model="numpy", **options)  # type: ignore[call-overload]  # _nrt
    compiled: Callable[P, R] = jit(function)
    return compiled
