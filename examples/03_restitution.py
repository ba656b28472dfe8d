"""How much of its speed a ball gives back to the cage: from the film, and from a desk formula."""

from dataclasses import replace

from separatrix.chain import restitution_state
from separatrix.restitution import damping_ratio, free_ring_restitution_factor, restitution_factor
from separatrix.study_file import read_study

study = read_study("cryogenic-turbopump")
found = restitution_state(study).restitution
print(f"C_mu = {found.race_damping:.0f} N s/m, eta = {found.restitution_factor:.3f}")
print(f"with free ball spin: eta = {found.restitution_factor_free_spin:.3f}")

# twice the friction on the races: the paper's "insufficient lubrication"
dry = restitution_state(replace(study, film=replace(study.film, race_friction=0.2))).restitution
print(f"race friction 0.2: eta = {dry.restitution_factor:.3f}")

# the same by hand: 0.05 kg on 3e6 N/m with C_mu = 2000 N s/m
eta = restitution_factor(damping_ratio(3e6, 0.05, 2000.0))
print(f"by hand: eta = {eta:.4f}, felt by a ring free to turn: {free_ring_restitution_factor(eta):.4f}")
