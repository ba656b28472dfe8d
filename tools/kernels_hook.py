"""Compiled kernels in a wheel: hatchling, which builds it, calls this. `tools/wheel.py` names their folder.

Without the variable SEPARATRIX_KERNELS the wheel has none and is for any platform; the program then compiles
once where it is installed.
"""

import os
import re
import sys
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class KernelsHook(BuildHookInterface):
    """Puts the folder of kernels into the wheel, with the tag and the versions that they fit."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the folder, the tag of this Python and platform, and versions up to those of the kernels."""
        kernels = Path(os.environ.get("SEPARATRIX_KERNELS", ""))
        if version == "editable" or not kernels.name:
            return
        numba, numpy, minor = re.search(r"numba-(\S+)-numpy-(\d+)\.(\d+)", kernels.name).groups()
        python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
        platform = re.sub(r"\W", "_", sysconfig.get_platform())
        build_data["pure_python"] = False
        build_data["tag"] = f"{python}-{python}-{platform}"
        build_data["force_include"][str(kernels)] = f"separatrix/kernels/{kernels.name}"
        build_data["dependencies"] += [f"numba<={numba}", f"numpy<{numpy}.{int(minor) + 1}"]
