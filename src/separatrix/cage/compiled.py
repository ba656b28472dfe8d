"""How the kernels are compiled: strict floating point, no lock held, and cached with all they are made of.

numba keeps compiled code until the file of the function changes; it does not see a change in another file
whose functions were compiled in. So only entry points are cached, and the stamp of the other files is part of
their key.
"""

from __future__ import annotations

import inspect
import zlib
from typing import TYPE_CHECKING, Any

import numba as nb

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType

kernel: Any = nb.njit(nogil=True, error_model="numpy")
_cached_kernel: Any = nb.njit(cache=True, nogil=True, error_model="numpy")


def source_stamp(*modules: ModuleType) -> int:
    """Checksum of the modules' sources; 0 where they cannot be read."""
    try:
        return zlib.crc32("".join(inspect.getsource(module) for module in modules).encode())
    except OSError:
        return 0


def entry(build: Callable[[int], Callable[..., Any]], *modules: ModuleType) -> Any:
    """Compile the function that `build` makes of a stamp, and cache it by the sources of these modules.

    The function must use the stamp, which makes it part of the cache's key.
    """
    return _cached_kernel(build(source_stamp(*modules)))
