"""How each quantity of an answer is told: its name in the documents, its label, symbol and digits.

The unit stands at the field of its record and in every document; so does the meaning, in the reference of
answers. A name means the same everywhere, so each stands here once.
"""

from __future__ import annotations

from separatrix.ground.quantity import Quantity

Q = Quantity

QUANTITIES: dict[str, Quantity] = {
    # The ball set and its contacts.
    "azimuth": Q(label="azimuth of the ball", head="azimuth", digits=4),
    "contact_angle_inner": Q(label="contact angle at the inner race", head="angle in", digits=4),
    "contact_angle_outer": Q(label="contact angle at the outer race", head="angle out", digits=4),
    "load_inner": Q(label="load on the inner race", head="load in", symbol="Q_i", digits=4),
    "load_outer": Q(label="load on the outer race", head="load out", symbol="Q_o", digits=4),
    "orbital_speed": Q(label="orbital speed of the ball", head="orbit", unit="rad/s", digits=5),
    "pitch_angle": Q(label="pitch angle of the ball's spin", head="pitch", digits=4),
    "spin_roll_ratio_inner": Q(label="spin/roll ratio at the inner race", head="spin/roll in", form=".4f"),
    "spin_roll_ratio_outer": Q(label="spin/roll ratio at the outer race", head="spin/roll out", form=".4f"),
    "axial_displacement": Q(label="axial displacement of the inner ring", digits=4),
    "radial_displacement": Q(label="radial displacement of the inner ring", digits=4),
    "tilt": Q(label="tilt of the inner ring", digits=4),
    "moment": Q(label="moment of the balls", digits=4),
    "load": Q(label="load", symbol="Q", digits=4),
    "contact_angle": Q(label="contact angle", digits=4),
    "semi_major": Q(label="semi-major axis a, across the groove", symbol="a", digits=4),
    "semi_minor": Q(label="semi-minor axis b, along rolling", symbol="b", digits=4),
    "max_pressure": Q(label="maximum Hertz pressure", symbol="p_0", digits=4),
    "approach": Q(label="mutual approach", digits=4),
    "rolling_speed": Q(label="rolling speed", digits=4),
    "spin_roll_ratio": Q(label="pivoting to rolling ratio", digits=4),
    "pressure": Q(label="pressure", symbol="p"),
    "groove_place": Q(label="y across the groove"),
    "creep_spin": Q(label="creep by spin, s", digits=4),
    "creep_curvature": Q(label="creep by curvature, q", digits=4),
    "creep_ratio": Q(label="creep ratio", symbol="xi", unit="%"),
    # Clearances of the cage.
    "pocket_at_rest": Q(label="pocket clearance at rest", digits=4),
    "pocket": Q(label="running pocket clearance", digits=4),
    "pocket_axial_at_rest": Q(label="pocket clearance along the axis at rest", digits=4),
    "pocket_axial": Q(label="running pocket clearance along the axis", digits=4),
    "land_at_rest": Q(label="land clearance at rest", digits=4),
    "land": Q(label="running land clearance", digits=4),
    "temperature": Q(label="temperature", digits=4),
    "cage_speed": Q(label="speed of the cage", digits=4),
    "cage_strain": Q(label="thermal strain of the cage", unit="%"),
    "ball_strain": Q(label="thermal strain of the balls", unit="%"),
    "ring_strain": Q(label="thermal strain of the rings", unit="%"),
    "hoop_strain": Q(label="strain of the cage by rotation", unit="%"),
    "cage_land_growth": Q(label="growth of the cage's land"),
    "ring_land_growth": Q(label="growth of the ring's land"),
    # Traction, restitution, mobility.
    #
    # Stability curves, maps and sweeps.
    #
    # Runs of the cage.
    #
    # Rankings and their verdicts.
    #
    # Uncertain studies.
    #
    # Logs, materials and comparisons.
    "friction": Q(label="friction", digits=4),
    "standard_error": Q(label="standard error", digits=2),
    "standard_deviation": Q(label="scatter", digits=2),
    "degrees_of_freedom": Q(label="degrees of freedom", form=".0f"),
    "effective_count": Q(label="independent values"),
    "steady_rows": Q(label="rows of the steady part", form=".0f"),
    "rows": Q(label="rows", form=".0f"),
    "cycles": Q(label="whole cycles", form=".0f"),
    "slip_speed": Q(label="slip speed", digits=4),
    "normal_force": Q(label="normal force", digits=4),
    "cycle_time": Q(label="time of a cycle", digits=4),
    "wear_depth": Q(label="wear depth"),
    "run_in_end": Q(label="end of running-in", head="running-in ends", digits=4),
    "steady_end": Q(label="end of the steady part", head="steady until", digits=4),
    "stick_slip_amplitude": Q(label="strongest oscillation, peak to peak", head="oscillation", digits=2),
    "stick_slip_frequency": Q(label="its frequency", head="at"),
    "correlation": Q(label="autocorrelation"),
    "row_share": Q(label="share of the rows", unit="%"),
    "between_samples": Q(label="scatter between samples", unit="%", digits=2),
    "between_tests": Q(label="scatter between tests of one sample", unit="%", digits=2),
    "default_scatter": Q(label="assumed scatter", unit="%"),
}
