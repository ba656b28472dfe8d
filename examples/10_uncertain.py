"""P(stable) over bearings whose pocket clearance and mass are not known exactly."""

import tempfile
from pathlib import Path

from separatrix.ranking import rank
from separatrix.study_file import read_study

TEXT = """
extends = "momentum-wheel"
[cage]
mass = "3.5 g +- 10 %"
pocket_clearance = "0.3 mm +- 20 %"
[stability]
runs = 32
duration = "20 ms"
"""
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "uncertain.toml"
    path.write_text(TEXT)
    found = rank(read_study(path), jobs=2)

for row in found.environments[0].materials:
    drawn = row.over_inputs
    low, high = drawn.probability_low, drawn.probability_high
    print(f"{row.name}: P(stable) {drawn.probability_stable:.2f} ({low:.2f} to {high:.2f})")

probabilities = {row.name: row.over_inputs.probability_stable for row in found.environments[0].materials}
