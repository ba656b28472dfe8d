"""One run of the cage: where its motion ends, and the largest forces on the way."""

from separatrix.cage import RunOutcome, simulate
from separatrix.chain import cage_state
from separatrix.study_file import read_study

study = read_study("momentum-wheel")
cage = cage_state(study, friction=0.30).cage  # dry phenolic
history = simulate(cage, kick=0.5, duration=study.stability.duration)

outcome = RunOutcome(history.outcome).name
print(f"{outcome}: offset up to {1e6 * (history.position**2).sum(axis=1).max() ** 0.5:.0f} um")
pocket, land = abs(history.contact_force).max(), history.land_force.max()
print(f"force at a pocket up to {pocket:.0f} N, on the land {land:.0f} N")
