"""How much a thicker film takes off the restitution factor: many cases of a study, one table."""

import numpy as np

from separatrix.explore.sweep import sweep
from separatrix.study_file import read_study

study = read_study("momentum-wheel")
cases = [{"film.thickness": t} for t in np.geomspace(2e-7, 2e-6, 6)]
table = sweep(study, cases, jobs=2).to_dataframe()
print(table[["film.thickness", "slope_inner", "race_damping", "restitution_factor"]])

factors = table["restitution_factor"].tolist()
