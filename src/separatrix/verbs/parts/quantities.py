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
    "slope": Q(label="slope of the traction curve", symbol="alpha", digits=4),
    "slope_error": Q(label="error of the slope", digits=2),
    "ball_cage_stiffness": Q(label="stiffness of ball and pocket", symbol="k_BC", digits=4),
    "cage_mass": Q(label="cage mass", symbol="M_C", digits=4),
    "inner_damping": Q(label="damping of the inner race", digits=4),
    "outer_damping": Q(label="damping of the outer race", digits=4),
    "race_damping": Q(label="race damping", symbol="C_mu", digits=4),
    "race_damping_free_spin": Q(label="race damping if the ball may spin", digits=4),
    "damping_ratio": Q(label="damping ratio", symbol="zeta", form=".3f"),
    "damping_ratio_free_spin": Q(label="damping ratio if the ball may spin", form=".3f"),
    "restitution_factor": Q(label="restitution factor", symbol="eta", form=".3f"),
    "restitution_factor_free_spin": Q(label="restitution factor if the ball may spin", form=".3f"),
    "restitution_factor_hertz": Q(label="restitution factor of a Hertzian pocket", form=".3f"),
    #
    # Stability curves, maps and sweeps.
    #
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
    # Runs of the cage.
    "kick": Q(label="initial disturbance"),
    "time": Q(label="time"),
    "judged_from": Q(label="start of the judged part", digits=4),
    "followed": Q(label="end of the judged part", digits=4),
    "run_length": Q(label="length of the run", digits=4),
    "left_time": Q(label="time at which a ball reaches the edge of its pocket's wall"),
    "position": Q(label="place of the centre"),
    "axial_place": Q(label="axial place"),
    "lean": Q(label="lean", unit="mrad"),
    "contact_force": Q(label="force of a pocket"),
    "land_force": Q(label="force of the land"),
    "kinetic_energy": Q(label="kinetic energy"),
    "stored_energy": Q(label="energy of the pockets' springs"),
    "work": Q(label="work since the start"),
    "given_restitution_factor": Q(label="restitution factor in place of the study's", symbol="eta", digits=4),
    "offset_spread": Q(label="standard deviation of the offset"),
    "tilt_phase": Q(label="phase of the tilt before the offset", form=".0f"),
    "axial_low": Q(label="least axial place"),
    "axial_high": Q(label="largest axial place"),
    "whirl_speed": Q(label="speed of the whirling centre"),
    "orbit_speed": Q(label="orbit of the centre", unit="rad/s", digits=4),
    "cone_speed": Q(label="orbit of the tilt", unit="rad/s", digits=4),
    "cage_slip": Q(label="slip of the cage", unit="%"),
    "half_play": Q(label="pocket clearance each way", head="clearance", digits=4),
    "axial_half_play": Q(label="pocket clearance along the axis each way", digits=4),
    "pocket_angle": Q(label="place of the pocket", head="place", digits=4),
    "pocket_impacts": Q(label="impacts", form=".0f"),
    "impacts_per_turn": Q(label="impacts per turn of the cage", form=".2f"),
    "pocket_rubbing_power": Q(label="heat of rubbing", head="heat of rubbing"),
    "front_share": Q(label="share of the impulse in front of the ball", unit="%"),
    "rear_share": Q(label="share of the impulse behind the ball", unit="%"),
    "axial_share": Q(label="share of the impulse at the axial sides", unit="%"),
    #
    # Rankings and their verdicts.
    "friction": Q(label="pocket friction", head="friction", symbol="f_BC", form=".3f"),
    "restitution_threshold": Q(
        label="restitution threshold",
        head="threshold",
        form=".2f",
        meaning="largest restitution factor eta at which the cage is stable from the reference disturbance",
    ),
    "margin": Q(label="margin", form="+.2f", meaning="threshold less the bearing's own eta"),
    "probability_stable": Q(
        label="P(stable)",
        form=".2f",
        ends=("probability_low", "probability_high"),
        meaning="share of runs that settle, or roll in their pockets, from the worst disturbance",
    ),
    "uncertain_probability_stable": Q(
        label="P(stable) with the uncertain inputs drawn",
        form=".2f",
        ends=("uncertain_probability_low", "uncertain_probability_high"),
    ),
    "probability_lowest_friction": Q(label="probability of the lowest mean friction", form=".2f"),
    "solid_lubrication_limit": Q(label="the paper's limit of solid lubrication"),
    "friction_scatter": Q(label="assumed scatter of friction", unit="%"),
    "friction_error": Q(label="standard error of the mean friction", digits=2),
    "friction_deviation": Q(label="standard deviation of friction", digits=2),
    "worst_kick": Q(label="worst initial disturbance"),
    "longest_run": Q(label="longest run"),
    "largest_offset": Q(label="largest offset of the cage centre", head="largest offset"),
    "mean_offset": Q(label="mean offset of the cage centre", head="mean offset", meaning="median at the end"),
    "orbit_evenness": Q(label="spread of the offset over its mean", digits=2),
    "largest_tilt": Q(label="largest tilt of the cage", head="tilt", unit="mrad"),
    "axial_travel": Q(label="axial motion from end to end", head="axial travel"),
    "cone_ratio": Q(
        label="cone ratio",
        form=".2f",
        meaning="speed at which the lean of the cage's axis goes round over that of the ball set",
    ),
    "drift_rate": Q(label="drift rate", head="drift", digits=2),
    "growth_rate": Q(
        label="growth rate", meaning="of the amplitude, mean over all runs from the worst disturbance"
    ),
    "largest_contact_force": Q(label="largest force at a pocket", head="force at a pocket"),
    "largest_land_force": Q(label="largest force on the land", head="force on the land"),
    "force_limit": Q(label="force beyond which the ball slides"),
    "rubbing_force": Q(label="force of rubbing on the land"),
    "rubbing_speed": Q(label="speed of rubbing on the land"),
    "rubbing_power": Q(label="power of rubbing on the land", head="rubs with", digits=2),
    "whirl_frequency": Q(
        label="whirl frequency", head="whirl", meaning="median of the runs that end so, seen from the balls"
    ),
    "whirl_ratio": Q(
        label="whirl ratio",
        form=".2f",
        meaning="speed at which the centre orbits the axis over that of the ball set",
    ),
    "end_energy": Q(label="energy at the end"),
    "drive_energy": Q(label="energy that frame and loads can give"),
    "pocket_power": Q(label="power that pocket friction feeds into the cage"),
    "land_power": Q(label="power that land friction feeds into the cage"),
    "impact_rate": Q(label="impacts at pockets"),
    "pocket_impact_share": Q(label="share of the impacts at pockets", unit="%", digits=2),
    "land_impact_share": Q(label="share of the land in all impacts", unit="%", digits=2),
    "energy_imbalance": Q(label="energy imbalance", digits=2),
    "pocket_clearance": Q(label="pocket clearance as it runs", digits=4),
    "land_clearance": Q(label="land clearance as it runs", digits=4),
    "slip_speed": Q(label="sliding speed of ball on pocket"),
    "impact_force": Q(label="force of an impact at that speed"),
    "contact_radius": Q(label="contact radius"),
    #
    # Uncertain studies.
    #
    # Logs, materials and comparisons.
}
