"""Ball loads, contact angles and contact ellipses of a bearing under a radial load."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
study = replace(study, operation=replace(study.operation, radial_load=500.0))
state = separatrix.solve(study).bearing

for name, at in (("inner", state.inner), ("outer", state.outer)):
    print(
        f"{name}: {at.load:.0f} N at {np.degrees(at.contact_angle):.2f} deg, "
        f"{at.ellipse.max_pressure / 1e9:.2f} GPa, rolling at {at.rolling_speed:.1f} m/s, "
        f"spin/roll {at.spin_roll_ratio:+.3f}"
    )

balls = state.equilibrium
heaviest = float(np.max(balls.load_inner))

figure, (loads, angles) = plt.subplots(2, sharex=True, layout="constrained")
loads.plot(np.degrees(balls.azimuth), balls.load_inner, "o-", label="inner race")
loads.plot(np.degrees(balls.azimuth), balls.load_outer, "s-", label="outer race")
loads.set_ylabel("load [N]")
loads.legend()
angles.plot(np.degrees(balls.azimuth), np.degrees(balls.contact_angle_inner), "o-")
angles.plot(np.degrees(balls.azimuth), np.degrees(balls.contact_angle_outer), "s-")
angles.set(xlabel="azimuth [deg]", ylabel="contact angle [deg]")
