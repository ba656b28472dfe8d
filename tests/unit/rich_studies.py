"""Two studies with nearly every key: a cage in space, and one in the plane."""

SPACE = """\
[bearing]
ball_diameter = "7.144 mm"
pitch_diameter = "36 mm"
ball_count = 12
radial_clearance = "12 um +- 10 %"
inner_conformity = 0.53
outer_conformity = 0.54
ball_material = { elastic_modulus = "205 GPa", poisson_ratio = 0.285, density = "7650 kg/m3", name = "ours" }
ring_material = "440C"
[operation]
inner_speed = "6000 rpm"
axial_load = "40 N"
radial_load = "5 N"
moment = "0 N m"
temperature = "20 degC"
fluid = "vacuum"
ramp_time = "50 ms"
ramp_start = 0.2
[film]
race_friction = { between = [0.05, 0.1] }
elastic_modulus = "4 GPa"
poisson_ratio = 0.38
thickness = ["0.4 um", "0.5 um", "0.7 um"]
wear = { width = "0.05 mm", friction = 0.3, thickness = "0.1 um", races = "inner" }
[traction]
model = "exact"
pressure_slip = "included"
[cage]
mass = "3.5 g"
motion = "space"
ball = "traction"
inner_diameter = "33 mm"
outer_diameter = "39 mm"
width = "10 mm"
material = "Vespel SP-3"
pocket_clearance = "0.3 mm"
pocket_shape = "elongated"
pocket_axial_clearance = "0.2 mm"
pocket_axial_offset = "0.02 mm"
guidance = "outer"
land_clearance = "0.3 mm"
land_friction = 0.15
land_count = 2
land_spacing = "8 mm"
land_width = "1 mm"
transverse_inertia = "0.6 kg mm2"
dynamic_unbalance = "0.1 mrad"
gravity = "1 g0"
added_mass = "0.1 g"
[stability]
kicks = ["0.1 m/s", "2 m/s"]
reference_kick = "0.5 m/s"
runs = 32
axial_kick = 0.1
restitution_factors = [0.1, 0.5, 0.9]
[[ranking.candidates]]
name = "Vespel SP-3"
friction = { "vacuum" = { mean = 0.08, standard_deviation = "20 %", count = 4 }, "air, 440C" = "0.2 +- 30 %" }
material = { elastic_modulus = "3.3 GPa", poisson_ratio = 0.4, density = "1.4 g/cm3" }
[[ranking.candidates]]
name = "Phenolic, dry"
friction = { "vacuum" = 0.30 }
material = { elastic_modulus = "7 GPa", poisson_ratio = 0.35 }
"""
_BEFORE, _, _AFTER = SPACE.partition("[cage]\n")
PLANE = f"""{_BEFORE}\
[cage]
mass = "3.5 g +- 10 %"
ball = "traction"
inner_diameter = "33 mm"
outer_diameter = "39 mm"
width = "10 mm"
material = "Vespel SP-3"
pocket_clearance = "0.3 mm"
pocket_shape = "cylindrical"
pocket_axial_offset = "0.02 mm"
guidance = "outer"
land_clearance = "0.3 mm"
land_friction = 0.15
land_count = 1
land_out_of_round = "8 um"
land_lobes = 3
pocket_angles = ["0 deg", "31 deg", "60 deg", "91 deg", "120 deg", "151 deg",
  "180 deg", "211 deg", "240 deg", "271 deg", "300 deg", "331 deg"]
pocket_position_scatter = "5 um"
ball_diameter_scatter = "1 um"
gravity = "1 g0"
[stability]{_AFTER.partition("[stability]")[2]}"""
