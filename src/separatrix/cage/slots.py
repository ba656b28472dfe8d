"""Names of the slots of the arrays that the kernels fill."""

from __future__ import annotations

# State: centre of mass and its velocity in the turning frame, rotation against the ball set and its rate,
# time in units of the unit step.
X, Y, VX, VY, THETA, SPIN, STEP = range(7)
STATE = 7

# Ledger: work done on the cage since the start by each source (a sink is negative), the sum of the magnitudes
# of all of them, and the energy that the pockets' springs hold [J].
POCKET_FRICTION, RACE_DAMPERS, LAND, GRAVITY, MOVING_FRAME, UNBALANCE, GROSS, STORED = range(8)
SOURCES = 6
LEDGER = 8

# Tally of a window: time integrals of kinetic energy, offset, |v|^2 times the turning of the velocity, and
# |v|^2; largest squared offset, force of a pocket and force of the land.
KINETIC, OFFSET_X, OFFSET_Y, TURNING, SPEED_SQUARED, OFFSET_MAX, FORCE_MAX, LAND_MAX = range(8)
TALLY = 8

# Evidence of a run.
OUTCOME, GROWTH, OFFSET, DRIFT_RATE, WHIRL, DIRECTION, FORCE, IMBALANCE, ROWS = range(9)
EVIDENCE = 9

# A row of a history: state (with time in place of the step), ledger, force of the land, then lead and load of
# every ball.
LAND_FORCE = STATE + LEDGER
BALLS = LAND_FORCE + 1
