"""Places of numbers in the one block of a vehicle that its kernel works on (kernel.py).

The block is one float64 array: a header with the places of all else, rows of the bodies and of the
laws, what the rows point at, and room for the kernel's results.
"""

from __future__ import annotations

import numpy as np

# Kinds of laws.
SPRING, MATRIX, DIRECTED, ROD, FRICTION = 0, 1, 2, 3, 4
# Whose axes a connection has.
OF_LOWER, OF_UPPER, OF_MIDDLE, OF_TRACK = 0, 1, 2, 3

# Places in the row of a law.
KIND, LOWER, UPPER, AXES = 0, 1, 2, 3
POINT_LOWER, POINT_UPPER = slice(4, 7), slice(7, 10)
FORCE, MOMENT = slice(10, 13), slice(13, 16)
REFERENCE = slice(16, 22)
STATE = 22
STIFFNESS, DAMPING = slice(23, 26), slice(26, 29)
DIRECTION = slice(29, 32)
LENGTH, TENSION = 32, 33
POOL = 34
STOP, BLOW_OFF = 35, 36
ROW = 40

# Places in the row of a body: first coordinate in the system, whether it spins, reference position.
FIRST, SPINS, POSITION = 0, 1, slice(2, 5)
BODY = 5

# Places in the row of a frame: axes (row by row), centre, velocity, angular velocity of the axes,
# tan(roll), the axes that spin, then force and moment on the body.
F_AXES, F_CENTRE, F_VELOCITY, F_OMEGA = slice(0, 9), slice(9, 12), slice(12, 15), slice(15, 18)
F_TAN, F_SPINNING, F_FORCE, F_MOMENT = 18, slice(19, 28), slice(28, 31), slice(31, 34)
FRAME = 34

# Header of a vehicle's block, which holds everything.
(
    H_BODIES,
    H_LAWS,
    H_STATES,
    H_FIRST_STATE,
    H_BODY_ROWS,
    H_LAW_ROWS,
    H_POOL,
    H_FRAMES,
    H_MEMORY,
    H_FORCES,
    H_RATES,
    H_ENERGY,
    H_POWER,
) = range(13)
HEADER = 16


def new_block(bodies: np.ndarray, laws: np.ndarray, pool: np.ndarray, states: int) -> np.ndarray:
    """Return the block of a vehicle: header, tables and room for the kernel's results.

    bodies (n, BODY); laws (m, ROW); pool: what the rows point at; states: number of first-order
    coordinates, whose place in the system is put in as H_FIRST_STATE later.
    """
    count = len(bodies)
    sizes = {
        H_BODY_ROWS: bodies.size,
        H_LAW_ROWS: laws.size,
        H_POOL: len(pool),
        H_FRAMES: FRAME * (count + 1),
        H_MEMORY: 12 * count + states + 1,
        H_FORCES: 6 * count,
        H_RATES: states,
    }
    block = np.zeros(HEADER + sum(sizes.values()))
    block[[H_BODIES, H_LAWS, H_STATES]] = count, len(laws), states
    start = HEADER
    for place, size in sizes.items():
        block[place] = start
        start += size
    for place, content in ((H_BODY_ROWS, bodies), (H_LAW_ROWS, laws), (H_POOL, pool)):
        first = int(block[place])
        block[first : first + content.size] = content.ravel()
    forget(block)
    return block


def forget(block: np.ndarray) -> None:
    """Drop the kept evaluation, after a number of the block has changed."""
    block[int(block[H_MEMORY])] = np.nan
