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
    "drift_rate": Q(label="drift rate"),
    "drift_rate_law": Q(label="drift rate by the linear law"),
    "energy_imbalance": Q(label="open part of the energy balance", digits=1),
    "ball_cage_friction": Q(label="pocket friction"),
    "race_damping": Q(label="race damping", symbol="C_mu", digits=4),
    "given_restitution_factor": Q(label="restitution factor in place of the study's", symbol="eta", digits=4),
    "largest_offset": Q(label="largest offset of the centre", head="offset", digits=4),
    "mean_offset": Q(label="mean offset of the centre", digits=4),
    "offset_spread": Q(label="standard deviation of the offset"),
    "largest_tilt": Q(label="largest tilt", unit="mrad"),
    "tilt_phase": Q(label="phase of the tilt before the offset", form=".0f"),
    "axial_low": Q(label="least axial place"),
    "axial_high": Q(label="largest axial place"),
    "whirl_frequency": Q(label="whirl frequency", digits=4),
    "whirl_speed": Q(label="speed of the whirling centre"),
    "orbit_speed": Q(label="orbit of the centre", unit="rad/s", digits=4),
    "cone_speed": Q(label="orbit of the tilt", unit="rad/s", digits=4),
    "cage_slip": Q(label="slip of the cage", unit="%"),
    "land_clearance": Q(label="clearance of the land in diameter", digits=4),
    "half_play": Q(label="pocket clearance each way", head="clearance", digits=4),
    "axial_half_play": Q(label="pocket clearance along the axis each way", digits=4),
    "largest_contact_force": Q(label="largest force in a pocket", head="pocket force"),
    "largest_land_force": Q(label="largest force of the land", head="land force"),
    "force_limit": Q(label="force whose friction is all that the races hold of a ball"),
    "pocket_power": Q(label="power of the friction in the pockets into the motion"),
    "land_power": Q(label="power of the land's friction into the motion"),
    "rubbing_force": Q(label="force of rubbing on the land"),
    "rubbing_speed": Q(label="speed of rubbing on the land"),
    "rubbing_power": Q(label="heat of rubbing on the land"),
    "pocket_angle": Q(label="place of the pocket", head="place", digits=4),
    "pocket_impacts": Q(label="impacts", form=".0f"),
    "impact_rate": Q(label="impact rate"),
    "impacts_per_turn": Q(label="impacts per turn of the cage", form=".2f"),
    "pocket_rubbing_power": Q(label="heat of rubbing", head="heat of rubbing"),
    "front_share": Q(label="share of the impulse in front of the ball", unit="%"),
    "rear_share": Q(label="share of the impulse behind the ball", unit="%"),
    "axial_share": Q(label="share of the impulse at the axial sides", unit="%"),
    #
    # Rankings and their verdicts.
    #
    # Uncertain studies.
    #
    # Logs, materials and comparisons.
}
