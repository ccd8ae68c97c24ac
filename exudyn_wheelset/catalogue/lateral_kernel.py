"""Right-hand side of the paper's lateral model, equations (1) to (6), with two coordinates.

State (y, yaw, y', yaw'). Roll phi(y) and height z(y) follow from the rigid contact geometry. In
the track frame (x forward, y left, z up; spin positive about +y) with H the angular momentum of
the axle, I_wy V/r0 along it:

    m y''    = sum(F_y + N n_y) + F_Sy                                                     (1)
    I_z yaw'' = -I_wy (V/r0) phi' + sum(R_x (F_y + N_y) - R_y F_x) + sum(M_z) + M_Sz       (2)
    F_d = m z'' + W_a - sum(F_z)                                                           (3)
    M_d = I_x phi'' - I_wy (V/r0) yaw' - sum(R_y F_z - R_z F_y) - sum(M_x)                 (4)
    sum(N n_z) = F_d,   sum(N (R_y n_z - R_z n_y)) = M_d                                   (5, 6)

with z'' = z_y y'' + z_yy y'^2 and phi'' alike. The paper takes y'' in (3) and (4) from the step
before; here y'' and both normal forces are solved together (they are linear in each other), and
the creep forces, which depend on the normal forces, are iterated: the equations are then a true
right-hand side with nothing of the past in it. W_a is the axle load with the wheelset's weight.

Large angles: contact points by the contact locus at the actual yaw, velocities of the particles
exact. Small angles (`mohan`): knife-edge, linear kinematics, the inertial terms of (3) and (4)
left out, as section 3 of the paper says.
"""

import math

import numpy as np

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.hertz import hertz_from_load
from exudyn_wheelset.contact.locus import locus_point
from exudyn_wheelset.creep.kernel_apart import creep_kernel

(
    MASS,
    ROLL_INERTIA,
    SPIN_INERTIA,
    YAW_INERTIA,
    NOMINAL_RADIUS,
    TAPE_HALF_DISTANCE,
    AXLE_LOAD,
    LATERAL_STIFFNESS,
    YAW_STIFFNESS,
    LATERAL_DAMPING,
    YAW_DAMPING,
    FRICTION,
    SHEAR_MODULUS,
    POISSON,
    LAW,
    GYROSCOPIC,
    INERTIAL,
    CONICITY,
    FIXED_LATERAL_CURVATURE,
) = range(19)
LAW_PARAMETERS = 20
PARAMETER_COUNT = 28
# Columns of the geometry table: roll, z, then per side wheel_y, radius, dr/dy, lateral half
# curvature B.
SIDE_COLUMNS = 4
COLUMN_COUNT = 2 + 2 * SIDE_COLUMNS


@compiled
def piecewise_values(breaks, coefficients, y, values):
    """Fill values (columns, 3): value, first and second derivative over y; straight beyond."""
    cell = np.searchsorted(breaks, y) - 1
    cell = min(max(cell, 0), len(breaks) - 2)
    u = y - breaks[cell]
    beyond = 0.0
    if y > breaks[-1]:
        beyond = y - breaks[-1]
    elif y < breaks[0]:
        beyond = y - breaks[0]
    u -= beyond
    degree = coefficients.shape[0]
    for column in range(coefficients.shape[2]):
        f = f1 = f2 = 0.0
        for k in range(degree):
            f2 = f2 * u + 2.0 * f1
            f1 = f1 * u + f
            f = f * u + coefficients[k, cell, column]
        values[column, 0] = f + beyond * f1
        values[column, 1] = f1
        values[column, 2] = f2 if beyond == 0.0 else 0.0


@compiled
def lateral_accelerations(state, speed, p, breaks, coefficients, sides):
    """Return (y'', yaw'') [m/s^2, rad/s^2]; fills sides (2, 12) with the forces of either wheel.

    sides: normal_force, fx, f_lateral, mz, creep_x, creep_y, spin, a, b, angle, radius, wheel_y.
    """
    y, yaw, y_rate, yaw_rate = state[0], state[1], state[2], state[3]
    values = np.empty((COLUMN_COUNT, 3))
    piecewise_values(breaks, coefficients, y, values)
    roll, roll_y, roll_yy = values[0]
    _, height_y, height_yy = values[1]
    roll_rate = roll_y * y_rate
    spin_rate = speed / p[NOMINAL_RADIUS]
    gyroscopic = p[GYROSCOPIC] * p[SPIN_INERTIA] * spin_rate
    cr, sr, cp, sp = math.cos(roll), math.sin(roll), math.cos(yaw), math.sin(yaw)
    lx, ly, lz = -sp * cr, cp * cr, sr
    vx, vy, vz = speed, y_rate, height_y * y_rate
    # w = yaw' e_z + phi' Rz e_x + spin l
    wx = roll_rate * cp + spin_rate * lx
    wy = roll_rate * sp + spin_rate * ly
    wz = yaw_rate + spin_rate * lz
    px = np.empty(2)
    py = np.empty(2)
    pz = np.empty(2)
    ny = np.empty(2)
    nz = np.empty(2)
    for hand in range(2):
        mirror = 1.0 - 2.0 * hand
        base = 2 + SIDE_COLUMNS * hand
        wheel_y, radius, slope = values[base, 0], values[base + 1, 0], values[base + 2, 0]
        x, lateral, vertical, normal_y, normal_z = locus_point(
            p[TAPE_HALF_DISTANCE] + wheel_y, radius, slope, 0.0, 0.0, 0.0,
            mirror * lx, ly, mirror * lz,
        )  # fmt: skip
        px[hand], py[hand], pz[hand] = x, mirror * lateral, vertical
        ny[hand], nz[hand] = -mirror * normal_y, -normal_z
        slip_x = vx + wy * vertical - wz * py[hand]
        slip_y = vy + wz * x - wx * vertical
        slip_z = vz + wx * py[hand] - wy * x
        sides[hand, 4] = slip_x / speed
        sides[hand, 5] = (nz[hand] * slip_y - ny[hand] * slip_z) / speed
        sides[hand, 6] = (ny[hand] * wy + nz[hand] * wz) / speed
        sides[hand, 9] = math.atan2(-mirror * ny[hand], nz[hand])
        sides[hand, 10] = radius
        sides[hand, 11] = wheel_y
        if sides[hand, 0] <= 0.0:
            sides[hand, 0] = 0.5 * p[AXLE_LOAD]
    suspension_y = -p[LATERAL_STIFFNESS] * y - p[LATERAL_DAMPING] * y_rate
    suspension_yaw = -p[YAW_STIFFNESS] * yaw - p[YAW_DAMPING] * yaw_rate
    inertial = p[INERTIAL]
    y_acceleration = 0.0
    yaw_acceleration = 0.0
    for _ in range(40):
        force_x = force_y = force_z = 0.0
        moment_x = moment_z = 0.0
        for hand in range(2):
            base = 2 + SIDE_COLUMNS * hand
            normal_force = sides[hand, 0]
            lateral = values[base + 3, 0]
            if p[FIXED_LATERAL_CURVATURE] > 0.0:
                lateral = p[FIXED_LATERAL_CURVATURE]
            a, b, _, _ = hertz_from_load(
                0.5 * nz[hand] / sides[hand, 10], lateral, normal_force,
                p[SHEAR_MODULUS], p[POISSON],
            )  # fmt: skip
            fx, ft, mz = creep_kernel(
                int(p[LAW]), sides[hand, 4], sides[hand, 5], sides[hand, 6], a, b, normal_force,
                p[FRICTION], p[SHEAR_MODULUS], p[POISSON], p[LAW_PARAMETERS:],
            )  # fmt: skip
            sides[hand, 1] = fx
            sides[hand, 2] = ft
            sides[hand, 3] = mz
            sides[hand, 7] = a
            sides[hand, 8] = b
            fy = nz[hand] * ft
            fz = -ny[hand] * ft
            force_x += fx
            force_y += fy
            force_z += fz
            moment_x += py[hand] * fz - pz[hand] * fy
            moment_z += px[hand] * fy - py[hand] * fx + mz * nz[hand]
        # y'' = free + sum(N n_y)/m goes into (3) and (4), which leaves two equations for N.
        free = (force_y + suspension_y) / p[MASS]
        load = p[AXLE_LOAD] - force_z
        moment = -gyroscopic * yaw_rate - moment_x
        if inertial > 0.0:
            load += p[MASS] * (height_y * free + height_yy * y_rate * y_rate)
            moment += p[ROLL_INERTIA] * (roll_y * free + roll_yy * y_rate * y_rate)
        m00 = nz[0] - inertial * height_y * ny[0]
        m01 = nz[1] - inertial * height_y * ny[1]
        lever = inertial * p[ROLL_INERTIA] * roll_y / p[MASS]
        m10 = py[0] * nz[0] - pz[0] * ny[0] - lever * ny[0]
        m11 = py[1] * nz[1] - pz[1] * ny[1] - lever * ny[1]
        determinant = m00 * m11 - m01 * m10
        left = (load * m11 - m01 * moment) / determinant
        right = (m00 * moment - m10 * load) / determinant
        # A wheel that would have to be pulled down has lifted: the model does not hold there.
        left = max(left, 1.0e-3 * p[AXLE_LOAD])
        right = max(right, 1.0e-3 * p[AXLE_LOAD])
        change = abs(left - sides[0, 0]) + abs(right - sides[1, 0])
        sides[0, 0] = left
        sides[1, 0] = right
        y_acceleration = free + (left * ny[0] + right * ny[1]) / p[MASS]
        yaw_acceleration = (
            -gyroscopic * roll_rate
            + moment_z
            + px[0] * left * ny[0]
            + px[1] * right * ny[1]
            + suspension_yaw
        ) / p[YAW_INERTIA]
        if change < 1.0e-11 * p[AXLE_LOAD]:
            break
    return y_acceleration, yaw_acceleration


@compiled
def small_angle_accelerations(state, speed, p, sides):
    """The same for small angles on knife-edge rails, conicity lambda and half distance g_a.

    phi = lambda y/g_a, r = r0 +- lambda y; creepages
        creep_x = -+(lambda y/r0 + g_a yaw'/V),  creep_y = (1 + lambda r0/g_a) y'/V - yaw,
        spin = yaw'/V -+ lambda/r0,
    and R_x = -+g_a yaw in (2): the normal forces' lateral parts turn the axle further.
    """
    y, yaw, y_rate, yaw_rate = state[0], state[1], state[2], state[3]
    conicity, r0, half = p[CONICITY], p[NOMINAL_RADIUS], p[TAPE_HALF_DISTANCE]
    gyroscopic = p[GYROSCOPIC] * p[SPIN_INERTIA] * speed / r0
    roll = conicity * y / half
    roll_rate = conicity * y_rate / half
    for hand in range(2):
        if sides[hand, 0] <= 0.0:
            sides[hand, 0] = 0.5 * p[AXLE_LOAD]
    y_acceleration = 0.0
    yaw_acceleration = 0.0
    for _ in range(40):
        force_y = moment_x = moment_z = force_z = 0.0
        for hand in range(2):
            mirror = 1.0 - 2.0 * hand
            creep_x = -mirror * (conicity * y / r0 + half * yaw_rate / speed)
            creep_y = (1.0 + conicity * r0 / half) * y_rate / speed - yaw
            spin = yaw_rate / speed - mirror * conicity / r0
            normal_force = sides[hand, 0]
            a, b, _, _ = hertz_from_load(
                0.5 / r0, p[FIXED_LATERAL_CURVATURE], normal_force, p[SHEAR_MODULUS], p[POISSON]
            )
            fx, fy, mz = creep_kernel(
                int(p[LAW]), creep_x, creep_y, spin, a, b, normal_force, p[FRICTION],
                p[SHEAR_MODULUS], p[POISSON], p[LAW_PARAMETERS:],
            )  # fmt: skip
            # The contact plane is tangent to the cone, which rolls with the axle.
            tilt = mirror * conicity + roll
            force_y += fy
            force_z += tilt * fy
            moment_x += r0 * fy + mirror * half * tilt * fy
            moment_z += mz - mirror * half * fx
            sides[hand, 1] = fx
            sides[hand, 2] = fy
            sides[hand, 3] = mz
            sides[hand, 4] = creep_x
            sides[hand, 5] = creep_y
            sides[hand, 6] = spin
            sides[hand, 7] = a
            sides[hand, 8] = b
            sides[hand, 9] = mirror * tilt
            sides[hand, 10] = r0 + mirror * conicity * y
        load = p[AXLE_LOAD] - force_z
        moment = -gyroscopic * yaw_rate - moment_x
        tilt_left = conicity + roll
        tilt_right = -conicity + roll
        arm_left = half - r0 * tilt_left
        arm_right = -half - r0 * tilt_right
        left = (load * arm_right - moment) / (arm_right - arm_left)
        right = load - left
        left = max(left, 1.0e-3 * p[AXLE_LOAD])
        right = max(right, 1.0e-3 * p[AXLE_LOAD])
        change = abs(left - sides[0, 0]) + abs(right - sides[1, 0])
        sides[0, 0] = left
        sides[1, 0] = right
        suspension_y = -p[LATERAL_STIFFNESS] * y - p[LATERAL_DAMPING] * y_rate
        suspension_yaw = -p[YAW_STIFFNESS] * yaw - p[YAW_DAMPING] * yaw_rate
        y_acceleration = (force_y - left * tilt_left - right * tilt_right + suspension_y) / p[MASS]
        yaw_acceleration = (
            -gyroscopic * roll_rate
            + moment_z
            + half * yaw * (left * tilt_left - right * tilt_right)
            + suspension_yaw
        ) / p[YAW_INERTIA]
        if change < 1.0e-11 * p[AXLE_LOAD]:
            break
    return y_acceleration, yaw_acceleration
