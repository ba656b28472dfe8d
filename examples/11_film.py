"""Which films keep a bearing below a restitution factor: thickness and friction of the film."""

import numpy as np

from separatrix.chain import lubrication, restitution_state
from separatrix.study_file import read_study

study = read_study("cryogenic-turbopump")
films = lubrication(study, restitution_state(study))
for friction, factors in zip(films.race_friction, films.restitution_factor, strict=True):
    good = films.film_thickness[factors <= 0.6]
    some = f"a film of {1e6 * good.min():.2f} um or more" if good.size else "no film"
    said = "any film" if good.size == films.film_thickness.size else some
    print(f"race friction {friction:.2f}: eta below 0.6 with {said}")

highest = [float(np.max(factors)) for factors in films.restitution_factor]
