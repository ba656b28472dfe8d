"""How kernels are compiled: strict floating point, without the interpreter's lock, and cached.

numba keeps compiled code until the file of the function changes; it does not see a change in another file
whose functions were compiled in. So the key of every cached kernel also holds a checksum of all files that
have kernels.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from numba import njit
from numba.core.caching import FunctionCache

P = ParamSpec("P")
R = TypeVar("R")


def source_stamp(package: Path) -> int:
    """Checksum of the files below a folder that use this module."""
    sources = (path.read_bytes() for path in sorted(package.rglob("*.py")))
    return zlib.crc32(b"".join(source for source in sources if b"separatrix.compiled" in source))


_STAMP = source_stamp(Path(__file__).parent)


class _SourceCache(FunctionCache):
    """numba's cache of one function, keyed by the sources of all kernels too."""

    def _index_key(self, sig: Any, codegen: Any) -> tuple[Any, ...]:
        key: Any = super()._index_key
        return (*key(sig, codegen), _STAMP)


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a kernel with numba; the signature stays visible to the type checker."""
    return _cached(function)


def inner_kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a kernel that makes no array, so that it need not count references to those it is given.

    Called from a loop of a microsecond, the counting took a third of the time.
    """
    return _cached(function, _nrt=False)


def inlined_kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile an inner kernel into those that call it."""
    return _cached(function, _nrt=False, forceinline=True)


def _cached(function: Callable[P, R], **options: bool) -> Callable[P, R]:
    """Compile with numba and cache by the sources of all kernels."""
    compile_with: Any = njit
    compiled: Any = compile_with(nogil=True, error_model="numpy", **options)(function)
    cache: Any = _SourceCache
    compiled._cache = cache(function)
    return compiled  # type: ignore[no-any-return]
