"""Cooperrider's bogie in three dimensions against the lateral model, difference by difference.

Seven coordinates by hand: y, psi of both wheelsets, y, psi, phi of the frame; each wheelset's roll
follows the rails, phi = sigma y. Without anything beyond Kaas-Petersen's equations the Hopf point
is that of his model; with all of the following it is that of the vehicle in Exudyn.
- creep: slopes f11, f22 of the real patch and the conicity of the real profiles in place of his;
- roll: lateral creepage (1 + (r + l tan delta) sigma) y'/V - psi with its force along the same
  motion, the inertia I_x sigma^2, primary springs between frame and rolled wheelset;
- gyroscope: I_y V/r couples psi and sigma y;
- gravity: W z_yy y, -W l tan(delta) psi, and the preloads that keep the vertical on tipped bodies.
Geometry and patch are the package's, tested elsewhere; the equations are written here.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from exudyn_wheelset import catalogue, contact_forces, contact_geometry, linear_critical_speed
from exudyn_wheelset.creep import kalker_coefficients
from exudyn_wheelset.vehicles.statics import static_equilibrium

GRAVITY = 9.81
K1, K2, K3, K4, K5, K6 = 1.823e6, 3.646e6, 3.646e6, 0.1823e6, 0.3333e6, 2.710e6
D1, D2, ARM, BASE, H1, H2, S1, S2 = 20.0e3, 29.2e3, 0.7163, 1.074, 0.0762, 0.6584, 0.620, 0.680
WHEELSET, YAW, FRAME, INERTIA, CAR = 1022.0, 678.0, 2918.0, 6780.0, 44388.0
ALL = ("creep", "roll", "gyroscope", "gravity")


class Rolling:
    """Numbers of one wheelset of the vehicle: geometry over the shift, creep slopes."""

    def __init__(self):
        vehicle = catalogue.cooperrider_bogie_3d()
        self.vehicle = vehicle
        axle = vehicle.wheelsets[0].wheelset
        step = 2e-4
        geometry = contact_geometry(axle, vehicle.track, [-step, 0.0, step])
        self.sigma = (geometry.roll[2] - geometry.roll[0]) / (2 * step)
        self.conicity = geometry.rolling_radius_difference[2] / (2 * step)
        self.rise = (geometry.z[2] - 2 * geometry.z[1] + geometry.z[0]) / step**2
        self.slope = np.tan(geometry.left.angle[1])
        self.half = axle.tape_half_distance + geometry.left.wheel_y[1]
        rest = static_equilibrium(vehicle)
        name = vehicle.wheelsets[0].name
        self.radius = rest.radii[name]
        self.load = sum(rest.wheel_loads[name])
        height = rest.positions[name][2] - axle.radius
        rolling = (10.0, 0, 0, 0, 10.0 / self.radius, 0)
        (patch,) = contact_forces(
            axle, vehicle.track, (0, 0, height, 0, 0, 0), rolling, contact=vehicle.contact
        ).left
        c11, c22, *_ = kalker_coefficients(patch.a, patch.b, vehicle.contact.poisson)
        size = vehicle.contact.shear_modulus * patch.a * patch.b
        self.f11, self.f22 = size * c11, size * c22


def growth(rolling, terms, speed):
    """Real part of the hunting root [1/s]."""
    mass = np.diag([WHEELSET, YAW, WHEELSET, YAW, FRAME, INERTIA, INERTIA])
    damping, stiffness = np.zeros((7, 7)), np.zeros((7, 7))
    f11, f22, conicity, arm, radius = 6.563e6 / 0.60252, 6.563e6 / 0.54219, 0.05, ARM, 0.4572
    if "creep" in terms:
        f11, f22, conicity = rolling.f11, rolling.f22, rolling.conicity
        arm, radius = rolling.half, rolling.radius
    sigma = rolling.sigma if "roll" in terms else 0.0

    def spring(k, c, row):
        stiffness[:] += k * np.outer(row, row)
        damping[:] += c * np.outer(row, row)

    for w, x in ((0, BASE), (2, -BASE)):
        row = np.zeros(7)
        row[[w, 4, 5, 6]] = 1, -1, -x, -H1
        spring(2 * K1, 0, row)
        row = np.zeros(7)
        row[[w + 1, 5]] = 1, -1
        spring(2 * K2 * S1**2, 0, row)
        row = np.zeros(7)
        row[[w, 6]] = sigma, -1
        spring(2 * K3 * S1**2, 0, row)
        along = 1.0 + (rolling.radius + rolling.half * rolling.slope) * sigma
        mass[w, w] += YAW * sigma**2
        damping[w, w] += 2 * f22 * along**2 / speed
        stiffness[w, w + 1] -= 2 * f22 * along
        damping[w + 1, w + 1] += 2 * arm**2 * f11 / speed
        stiffness[w + 1, w] += 2 * arm * f11 * conicity / radius
        if "gyroscope" in terms:
            momentum = 80.0 * speed / rolling.radius * rolling.sigma
            damping[w, w + 1] -= momentum
            damping[w + 1, w] += momentum
        if "gravity" in terms:
            stiffness[w, w] += rolling.load * rolling.rise
            stiffness[w + 1, w + 1] -= rolling.load * rolling.half * rolling.slope
    row = np.zeros(7)
    row[[4, 6]] = 1, -H2
    spring(2 * K4, 2 * D2, row)
    spring(K6, 0, np.eye(7)[5])
    spring(2 * K5 * S2**2, 2 * D1 * S2**2, np.eye(7)[6])
    if "gravity" in terms:
        load = 0.5 * CAR * GRAVITY
        stiffness[6, 6] -= (load + FRAME * GRAVITY) * H1 + load * H2
    matrix = np.block(
        [
            [np.zeros((7, 7)), np.eye(7)],
            [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)],
        ]
    )
    values = np.linalg.eigvals(matrix)
    return values[(values.imag > 15.0) & (values.imag < 40.0)].real.max()


def hopf(rolling, terms):
    return brentq(lambda speed: growth(rolling, terms, speed), 40.0, 110.0, xtol=1e-4)


@pytest.fixture(scope="module")
def rolling():
    return Rolling()


def test_nothing_beyond_his_equations_is_his_hopf_point(rolling):
    """68.64 m/s of Kaas-Petersen."""
    assert hopf(rolling, ()) == pytest.approx(68.644, rel=1e-4)


def test_all_differences_are_the_bogie_in_three_dimensions(rolling):
    found = linear_critical_speed(rolling.vehicle, 40.0, 110.0)
    # 0.2 %: the contact yields, which the equations by hand do not know.
    assert hopf(rolling, ALL) == pytest.approx(found.speed, rel=0.002)


@pytest.mark.parametrize("term", ALL)
def test_no_difference_is_left_out(rolling, term):
    """Each of them moves the Hopf point by more than what is left in the end."""
    others = tuple(one for one in ALL if one != term)
    assert abs(hopf(rolling, others) - hopf(rolling, ALL)) > 0.002 * 68.0
