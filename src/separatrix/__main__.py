"""`python -m separatrix` is the command line."""

from __future__ import annotations

import sys

from separatrix.front import main

sys.exit(main())
