"""The DTU car on straight cones against its linear lateral equations, written out by hand.

21 coordinates, y to the left, yaw psi, roll phi (right-handed) of four wheelsets, two frames and
the body; 4 constraints, phi = sigma y, by which a wheelset's roll follows the rails; 17 degrees of
freedom are left. Nothing of the package is used for the equations: geometry, Hertz, statics and
suspension are here anew; of Kalker's theory his coefficients come from the package's table.

Wheels: cones of slope lambda, r - lambda s; rails: circles of radius R. Contact at the half
distance l, where the rail has the wheel's slope; r the rolling radius; W the axle load.
- sigma = lambda/(l - lambda r), a line rolling on two circles (to the order lambda^2);
- rolling radius of the left wheel r + lambda_e y, lambda_e = lambda (1 + (R + r) sigma);
- height of the centre: n.(C - rail centre) of both lines gives exactly
  z = (A + y sin phi)/cos phi + const, so z_yy = 2 sigma + A sigma^2 with A = r + R + lambda Y; over
  yaw the wheel's outline rises by lambda (l - lambda r) psi^2/2: the stiffnesses W z_yy and
  -W lambda (l - lambda r);
- creepages: xi_x = -+(l psi'/V + lambda_e y/r), tangential xi_y = (y' + (r + lambda l) phi')/V -
  (1 + lambda^2) psi over sqrt(1 + lambda^2), spin = -+lambda/r + psi'/V; the lead of the contact
  points and the spin force that stands at rest, F_0, give the yaw stiffness 2 F_0 (l - lambda r);
- Shen-Hedrick-Elkins about the spin of the cone: u = F_lin/(mu N); slopes 1 - u/3 + u^2/27 times
  Kalker's along, (1 - u/3)^2 across;
- load goes from wheel to wheel (the constraint's moment over 2 (l - lambda r)), and F_0 with it;
- gyroscope: I_y V/r couples roll and yaw of each wheelset;
- preloads keep the vertical: a load P up on a point h above a body's centre adds P h to its roll
  stiffness, one that acts down, as on a lower body, -P h.
"""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from exudyn_wheelset import Profile, Track, catalogue, linear_critical_speed, linearise
from exudyn_wheelset.creep import kalker_coefficients

GRAVITY = 9.81
SLOPE, RAIL_RADIUS = 0.05, 0.08
TAPE, RAIL_TOP = 0.75, 0.754
BODY_MASS, FRAME_MASS, WHEELSET_MASS = 44388.0, 2918.9, 1022.0
WHEELSET_INERTIA = (678.0, 80.0, 678.0)
NOMINAL_RADIUS, FRICTION, SHEAR_MODULUS, POISSON = 0.425, 0.15, 8.27e10, 0.27
K1, K2, K3, K4, K5, K6 = 1.823e6, 3.646e6, 3.646e6, 182.3e3, 333.3e3, 903350.0
D1, D2, D6 = 20e3, 29.2e3, 166669.0
PRIMARY, SECONDARY, YAW = 0.620, 0.680, 1.5
HALF_WHEELBASE, HALF_PIVOTS = 1.074, 7.5
DROP, RISE, BODY_RISE = 0.0762, 0.6584, 1.5584
SPEEDS = (30.0, 60.0, 80.0, 100.0)


def hertz_semi_axes(load, across_x, across_y, modulus, poisson):
    """Semi-axes (along x, along y) of the contact ellipse for curvatures 1/R along x and y."""

    def ratio(m):
        # (B/A) of an ellipse of modulus m = 1 - (short/long)^2 (Johnson, Contact Mechanics, 4.26).
        k, e = ellipk(m), ellipe(m)
        return (e / (1.0 - m) - k) / (k - e)

    small, large = sorted((0.5 * across_x, 0.5 * across_y))
    m = brentq(lambda m: ratio(m) - large / small, 1e-9, 1.0 - 1e-9)
    shape, e = 1.0 - m, ellipe(m)
    young_star = modulus * 2.0 * (1.0 + poisson) / (2.0 * (1.0 - poisson**2))
    long = (3.0 * load * e / (2.0 * np.pi * young_star * (small + large) * shape)) ** (1.0 / 3.0)
    short = long * np.sqrt(shape)
    return (long, short) if across_x < across_y else (short, long)


class Wheelset:
    """Geometry and creep coefficients of one wheelset under its load."""

    def __init__(self):
        angle = np.arctan(SLOPE)
        self.half = RAIL_TOP - RAIL_RADIUS * np.sin(angle)
        self.radius = NOMINAL_RADIUS - SLOPE * (self.half - TAPE)
        self.sigma = SLOPE / (self.half - SLOPE * self.radius)
        self.conicity = SLOPE * (1.0 + (RAIL_RADIUS + self.radius) * self.sigma)
        mass = BODY_MASS + 2 * FRAME_MASS + 4 * WHEELSET_MASS
        self.load = mass * GRAVITY / 4.0
        normal = 0.5 * self.load / np.cos(angle)
        self.f11, self.f22, self.f23, self.spin_force = self.creep(normal)
        step = 1e-4 * normal
        ahead, behind = self.creep(normal + step), self.creep(normal - step)
        self.spin_force_slope = (ahead[3] - behind[3]) / (2.0 * step)

    def creep(self, normal):
        """Slopes f11, f22 [N], f23 [N m] of one wheel about the cone's spin, and F_0 [N]."""
        cosine = np.cos(np.arctan(SLOPE))
        a, b = hertz_semi_axes(
            normal, cosine / self.radius, 1.0 / RAIL_RADIUS, SHEAR_MODULUS, POISSON
        )
        c11, c22, c23, *_ = kalker_coefficients(a, b, POISSON)
        spin = SLOPE * cosine / self.radius
        force = SHEAR_MODULUS * (a * b) ** 1.5 * c23 * spin
        u = force / (FRICTION * normal)
        along, across = 1.0 - u / 3.0 + u * u / 27.0, (1.0 - u / 3.0) ** 2
        size = SHEAR_MODULUS * a * b
        return (
            along * size * c11,
            across * size * c22,
            across * size * np.sqrt(a * b) * c23,
            along * force,
        )


def matrices(speed):
    """M, D, K (21, 21) and the constraints G (4, 21), with the forces H (21, 4) of the loads."""
    wheel = Wheelset()
    half, radius, sigma = wheel.half, wheel.radius, wheel.sigma
    mass, damping, stiffness = np.zeros((21, 21)), np.zeros((21, 21)), np.zeros((21, 21))
    constraint, feedback = np.zeros((4, 21)), np.zeros((21, 4))
    frame, body = (12, 15), 18
    places = [(0, HALF_WHEELBASE), (0, -HALF_WHEELBASE), (1, HALF_WHEELBASE), (1, -HALF_WHEELBASE)]

    def spring(k, c, *entries):
        row = np.zeros(21)
        for place, value in entries:
            row[place] += value
        stiffness[:] += k * np.outer(row, row)
        damping[:] += c * np.outer(row, row)

    for w, (truck, x) in enumerate(places):
        y, psi, phi = 3 * w, 3 * w + 1, 3 * w + 2
        f = frame[truck]
        mass[[y, psi, phi], [y, psi, phi]] = (
            WHEELSET_MASS,
            WHEELSET_INERTIA[2],
            WHEELSET_INERTIA[0],
        )
        spring(2 * K1, 0, (y, 1), (f, -1), (f + 1, -x), (f + 2, -DROP))
        spring(2 * K2 * PRIMARY**2, 0, (psi, 1), (f + 1, -1))
        spring(2 * K3 * PRIMARY**2, 0, (phi, 1), (f + 2, -1))
        momentum = WHEELSET_INERTIA[1] * speed / radius
        damping[phi, psi] -= momentum
        damping[psi, phi] += momentum
        rise = radius + RAIL_RADIUS + SLOPE * RAIL_TOP
        stiffness[y, y] += wheel.load * (2 * sigma + rise * sigma**2)
        stiffness[psi, psi] -= wheel.load * SLOPE * (half - SLOPE * radius)
        stiffness[psi, psi] += 2 * wheel.spin_force * (half - SLOPE * radius)
        stiffness[psi, y] += 2 * half * wheel.f11 * wheel.conicity / radius
        damping[psi, psi] += 2 * half**2 * wheel.f11 / speed
        lateral = np.zeros(21)
        lateral[y], lateral[phi] = 1.0, radius + SLOPE * half
        lateral /= np.sqrt(1.0 + SLOPE**2)
        damping += 2 * wheel.f22 / speed * np.outer(lateral, lateral)
        damping[:, psi] += 2 * wheel.f23 / speed * lateral
        stiffness[:, psi] -= 2 * wheel.f22 * np.sqrt(1.0 + SLOPE**2) * lateral
        constraint[w, phi], constraint[w, y] = 1.0, -sigma
        # The multiplier is the rails' moment; a share of it is load moved from right to left.
        feedback[:, w] = wheel.spin_force_slope / (half - SLOPE * radius) * lateral
    box_load = (FRAME_MASS + 0.5 * BODY_MASS) * GRAVITY / 4.0
    side_load = 0.25 * BODY_MASS * GRAVITY
    under = BODY_RISE - RISE
    for f, x in zip(frame, (HALF_PIVOTS, -HALF_PIVOTS), strict=True):
        mass[[f, f + 1, f + 2], [f, f + 1, f + 2]] = FRAME_MASS, 6780.0, 6780.0
        spring(
            2 * K4, 2 * D2, (f, 1), (f + 2, -RISE), (body, -1), (body + 1, -x), (body + 2, -under)
        )
        spring(2 * K5 * SECONDARY**2, 2 * D1 * SECONDARY**2, (f + 2, 1), (body + 2, -1))
        spring(2 * K6 * YAW**2, 2 * D6 * YAW**2, (f + 1, 1), (body + 1, -1))
        stiffness[f + 2, f + 2] -= 4 * box_load * DROP + 2 * side_load * RISE
        stiffness[body + 2, body + 2] -= 2 * side_load * under
    mass[[18, 19, 20], [18, 19, 20]] = BODY_MASS, 5.0e5, 2.80e5
    return mass, damping, stiffness, constraint, feedback


def roots(speed):
    """Eigenvalues of the 17 degrees of freedom."""
    mass, damping, stiffness, constraint, feedback = matrices(speed)
    # M q'' + D q' + K q = (G^T + H) m, G q = 0; with q = N p and rows that no m enters.
    free = scipy.linalg.null_space(constraint)
    rows = scipy.linalg.null_space((constraint.T + feedback).T).T
    m, d, k = (rows @ matrix @ free for matrix in (mass, damping, stiffness))
    zero, one = np.zeros((17, 17)), np.eye(17)
    left = np.block([[zero, one], [-k, -d]])
    right = np.block([[one, zero], [zero, m]])
    return scipy.linalg.eigvals(left, right)


def car_on_cones():
    y = np.linspace(-0.036, 0.036, 721)
    rail = Profile("circle", "rail", y, np.sqrt(RAIL_RADIUS**2 - y**2) - RAIL_RADIUS)
    car = catalogue.dtu_car(wheel=f"cone_{SLOPE}", shear_modulus=SHEAR_MODULUS)
    return car.on(Track(rail, inclination=0.0, datum_half_distance=RAIL_TOP))


def oscillations(values):
    """Those of hunting and body: below 15 Hz, damped to less than 0.7 of critical."""
    chosen = (values.imag > 2.0) & (np.abs(values) < 2 * np.pi * 15.0)
    return values[chosen & (np.abs(values.real) < 0.7 * np.abs(values))]


def test_every_root_below_15_hz_at_four_speeds():
    car = car_on_cones()
    for speed in SPEEDS:
        found = linearise(car, speed).eigenvalues
        by_hand = oscillations(roots(speed))
        assert len(by_hand) >= 4
        for root in by_hand:
            off = np.abs(found - root).min() / abs(root)
            # The contact yields by 0.1 mm under the load, next to primary springs by 18 mm.
            assert off < 0.005, f"{root} at {speed} m/s: off by {off:.3%}"


def test_critical_speed_and_frequency():
    def growth(speed):
        return oscillations(roots(speed)).real.max()

    speed = brentq(growth, 20.0, 200.0, xtol=1e-6)
    values = oscillations(roots(speed))
    frequency = values[np.argmax(values.real)].imag / (2.0 * np.pi)
    found = linear_critical_speed(car_on_cones(), 20.0, 200.0)
    assert found.speed == pytest.approx(speed, rel=0.005)
    assert found.frequency == pytest.approx(frequency, rel=0.005)
