"""Names of the rows and slots of the arrays that the kernels fill."""

from __future__ import annotations

# Columns of the series of a step (first index: power of time). Centre of mass and its velocity in the
# turning frame, rotation slip S = R theta and its rate; what a yielding ball feels of the motion (the
# speeds filtered by its yielding) and the share that is left of a penetration; geometric centre.
X, Y, VX, VY, S, W, EX, EY, ES, KEPT, GX, GY = range(12)
BODY = 12
# Forces over the mass and torque over M R; what frame and gravity add; cosine and sine of theta.
FX, FY, TORQUE, FRAME_X, FRAME_Y, FRAME_S, COS, SIN = range(12, 20)
# Land: distance of the centre, its direction, depth, normal and tangential force over the mass, sliding,
# cosine and sine of the lobes, that sine over the distance, and three in between.
DISTANCE, NX, NY, DEPTH, NORMAL, TANGENT, SLIDING = range(20, 27)
LOBE_COS, LOBE_SIN, TILT, TURN_COS, TURN_SIN, PUSHED = range(27, 33)
# Cosine and sine of the turning of the frame and of its multiples; what balls in touch and free balls have
# gone by a free speed of that form.
HARMONICS = 4
FRAME, FELT, GONE = 33, 33 + 2 * HARMONICS, 33 + 4 * HARMONICS
# Then for each ball, with Hertz springs, penetration and force over the mass; then the powers of the lobes.
BALLS = 33 + 6 * HARMONICS

# Rows by ball: direction of its pocket, half the play, lead of a ball that does not touch, penetration of one
# that does, and the free speed's cosines and sines of each harmonic. Of whole numbers: the side on which the
# pocket touches its ball (1, -1; 0 not; 2 both), and the list of those that touch.
COSINE, SINE, PLAY, LEAD, PENETRATION, DRIVE = range(6)
SIDE, LIST = range(2)

# State of a run: the first six above, then the clock.
CLOCK = 6
STATE = 7

# Ledger: work done on the cage by each source (a sink is negative), and the sum of the magnitudes.
SOURCES = (
    "pocket_friction",
    "race_dampers",
    "ball_drive",
    "land_friction",
    "land_damping",
    "gravity",
    "moving_frame",
    "unbalance",
)
POCKET_FRICTION, RACE_DAMPERS, BALL_DRIVE, LAND_FRICTION = range(4)
LAND_DAMPING, GRAVITY, MOVING_FRAME, UNBALANCE = range(4, 8)
WORKS = 8
GROSS = 8
LEDGER = 9

# Modes of the land.
CLEAR, RELEASED, STICK, FORWARD, BACKWARD = range(5)

# Tally of a look: integrals over time of the kinetic energy, the offset and its square, of r x v, of
# |v|^2 times the turning of the velocity and of |v|^2, of x and y; largest squared offset and forces; steps
# taken and touches of the land; integrals of the land's force and of that times the sliding on it; work of
# both frictions, of balls that lead and lag, of gravity, and of the frame on a cage without play or land.
KINETIC, OFFSET, OFFSET_SQUARED, SWEPT, TURNING, SPEED_SQUARED, MEAN_X, MEAN_Y = range(8)
OFFSET_MAX, FORCE_MAX, LAND_MAX, STEPS, LAND_HITS, PRESSED, RUBBED = range(8, 15)
POCKET_WORK, LAND_WORK, BALL_WORK, GRAVITY_WORK, FRAME_WORK = range(15, 20)
TALLY = 20

# Evidence of a run.
OUTCOME, CAUSE, END_ENERGY, GROWTH_RATE, LARGEST_OFFSET, DRIFT_RATE, WHIRL, DIRECTION, FORCE = range(9)
LAND_FORCE, IMBALANCE, MEAN_OFFSET, OFFSET_SPREAD, ORBIT_SPEED, LAND_IMPACTS, ROWS, FOLLOWED = range(9, 17)
JUDGED, POCKET_POWER, LAND_POWER, RUBBING_FORCE, RUBBING_SPEED = range(17, 22)
EVIDENCE = 22

# A row of a history: geometric centre, velocity, rotation slip and its rate, time, work, energies of
# pockets and land, force of the land, then lead and force of every ball.
ROW_WORK = 7
ROW_POCKET_ENERGY, ROW_LAND_ENERGY, ROW_LAND_FORCE, ROW_BALLS = 15, 16, 17, 18
