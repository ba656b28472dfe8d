"""Units: the types that carry them, and the strict reading of text such as ``"300 daN"``."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

Ratio = Annotated[float, "-"]
Metre = Annotated[float, "m"]
PerMetre = Annotated[float, "1/m"]
PerMetre2 = Annotated[float, "1/m2"]
Second = Annotated[float, "s"]
Hertz = Annotated[float, "Hz"]
Radian = Annotated[float, "rad"]
RadianPerSecond = Annotated[float, "rad/s"]
Kilogram = Annotated[float, "kg"]
KilogramMetre = Annotated[float, "kg m"]
KilogramMetre2 = Annotated[float, "kg m2"]
KilogramPerMetre3 = Annotated[float, "kg/m3"]
MetrePerSecond = Annotated[float, "m/s"]
MetrePerSecond2 = Annotated[float, "m/s2"]
Newton = Annotated[float, "N"]
NewtonMetre = Annotated[float, "N m"]
NewtonPerMetre = Annotated[float, "N/m"]
NewtonSecondPerMetre = Annotated[float, "N s/m"]
Pascal = Annotated[float, "Pa"]
Kelvin = Annotated[float, "K"]
Joule = Annotated[float, "J"]

Array = NDArray[np.float64]
