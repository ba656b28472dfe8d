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
    "restitution_factor": Q(label="restitution factor", symbol="eta", form=".3f"),
    "restitution_factor_free_spin": Q(label="restitution factor of a ball that may spin", form=".3f"),
    "ball_cage_friction": Q(label="ball/cage friction", symbol="f_BC", head="pocket friction"),
    "critical_friction": Q(label="critical friction", ends=("scatter_low", "scatter_high")),
    "critical_friction_low": Q(
        label="lower end of the band", head="band low", ends=("low_scatter_low", "low_scatter_high")
    ),
    "critical_friction_high": Q(
        label="upper end of the band", head="band high", ends=("high_scatter_low", "high_scatter_high")
    ),
    "kicks": Q(label="initial disturbances", unit="m/s", form=".3g"),
    "middle_kick": Q(label="reference disturbance", unit="m/s", form=".3g"),
    "searched_friction": Q(label="highest friction that was searched"),
    "kick_low": Q(label="friction at which few runs whirl", head="few whirl at"),
    "kick_critical_friction": Q(label="friction at which half of the runs whirl", head="half whirl at"),
    "kick_high": Q(label="friction at which most runs whirl", head="most whirl at"),
    "band_few": Q(label="share of runs that whirl at the lower end of the band", unit="%"),
    "band_most": Q(label="share of runs that whirl at the upper end of the band", unit="%"),
    "runs": Q(label="runs", digits=7),
    "duration": Q(label="length of a run"),
    "drift_rate_law": Q(label="drift rate by the linear law"),
    "slope": Q(label="slope of the traction curve", digits=4),
    "race_damping": Q(label="race damping", symbol="C_mu", head="race damping", digits=4),
    "restitution_factor_hertz": Q(label="restitution factor with a Hertzian pocket", form=".3f"),
    "ball_cage_stiffness": Q(label="ball/cage stiffness", head="stiffness", digits=4),
    "lead_amplitude": Q(label="lead of the balls"),
    "half_play": Q(label="clearance of a pocket each way"),
    "orbital_share": Q(label="share of the speed variance", unit="%", digits=4),
    "kick": Q(label="initial disturbance", unit="m/s", form=".3g"),
    "most_runs": Q(label="most runs of a point", digits=7),
    "agreeing_runs": Q(label="runs that agree", digits=7),
    "wrong_side_probability": Q(label="risk of the wrong side", unit="%", digits=2),
    "other_decision_probability": Q(label="risk of another decision", unit="%", digits=2),
    "error_low": Q(label="least share of wrong decisions", unit="%", digits=2),
    "error_high": Q(label="largest share of wrong decisions", unit="%", digits=2),
    "ball_scatter": Q(label="scatter of the balls"),
    "probability_whirl": Q(
        label="share of the runs that whirl", digits=2, ends=("probability_low", "probability_high")
    ),
    "whirling": Q(label="runs that whirl", digits=7),
    "growth_rate": Q(label="growth rate"),
    "drift_rate": Q(label="drift rate"),
    "largest_offset": Q(label="largest offset of the cage centre", head="largest offset"),
    "largest_contact_force": Q(label="largest force in a pocket", head="pocket force"),
    "largest_land_force": Q(label="largest force on the land", head="land force"),
    "margin": Q(label="margin", form="+.3f"),
    "probability_stable": Q(label="P(stable)", digits=2, ends=("probability_low", "probability_high")),
    "restitution_threshold": Q(label="restitution threshold", head="threshold", form=".3f"),
    "time_share": Q(label="share of the time", head="time", unit="%"),
    "damping_ratio": Q(label="damping ratio", symbol="zeta"),
    "max_pressure_inner": Q(label="pressure at the inner race", head="pressure in", digits=4),
    "max_pressure_outer": Q(label="pressure at the outer race", head="pressure out", digits=4),
    "slope_inner": Q(label="traction slope at the inner race", head="slope in"),
    "slope_outer": Q(label="traction slope at the outer race", head="slope out"),
    "pocket_clearance": Q(label="pocket clearance"),
    "land_clearance": Q(label="land clearance"),
    "frequency": Q(label="frequency", unit="Hz"),
    "shaft_frequency": Q(label="shaft, 1x", unit="Hz"),
    "cage_frequency": Q(label="cage and ball set, 1x", unit="Hz"),
    "outer_pass_frequency": Q(label="balls past the outer ring", unit="Hz"),
    "inner_pass_frequency": Q(label="balls past the inner ring", unit="Hz"),
    "linear_whirl_frequency": Q(label="whirl without clearance", unit="Hz"),
    "orbit_frequency": Q(label="orbit of whirling runs", unit="Hz"),
    "below_margin": Q(label="with a margin below 0", unit="%"),
    "stable": Q(label="STABLE", unit="%"),
    "unstable": Q(label="UNSTABLE", unit="%"),
    "undecided": Q(label="UNDECIDED", unit="%"),
    "refused": Q(label="without an answer", unit="%"),
    # Runs of the cage.
    #
    # Rankings and their verdicts.
    #
    # Uncertain studies.
    #
    # Logs, materials and comparisons.
}
