"""Ball loads, contact angles and the contact ellipse of a shipped bearing."""

from math import degrees

from separatrix.chain import bearing_state
from separatrix.study_file import read_study

study = read_study("cryogenic-turbopump")
state = bearing_state(study)

inner, outer = state.inner, state.outer
print(f"ball {inner.ball}, the most loaded")
for name, at in (("inner", inner), ("outer", outer)):
    print(
        f"{name}: {at.load:.0f} N at {degrees(at.contact_angle):.2f} deg, "
        f"{at.ellipse.max_pressure / 1e9:.2f} GPa, rolling at {at.rolling_speed:.1f} m/s, "
        f"spin/roll {at.spin_roll_ratio:+.3f}"
    )

heavier = outer.load - inner.load  # the centrifugal force presses on the outer race
