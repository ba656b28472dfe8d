"""How kernels of this package are compiled: strict floating point, cached, without the interpreter lock.

numba keeps compiled code until the file of the function changes; it does not see a change in another file
whose functions were compiled in. So the key of every cached kernel holds a checksum of the package's sources.
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

SOURCES = zlib.crc32(b"".join(path.read_bytes() for path in sorted(Path(__file__).parent.glob("*.py"))))


class PackageCache(FunctionCache):
    """numba's cache of one function, keyed by the sources of the whole package too."""

    def _index_key(self, sig: Any, codegen: Any) -> tuple[Any, ...]:
        key: Any = super()._index_key
        return (*key(sig, codegen), SOURCES)


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a kernel with numba; the signature stays visible to the type checker."""
    compiled: Any = njit(nogil=True, error_model="numpy")(function)
    cache: Any = PackageCache
    compiled._cache = cache(function)
    return compiled  # type: ignore[no-any-return]
