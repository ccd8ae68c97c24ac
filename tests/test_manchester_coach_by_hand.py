"""The Manchester coach against masses and springs put together here, and its dampers' limits.

Walking slowly, the wheelsets are held by their creep forces in y and yaw (their kinematic wave
takes tens of seconds there) and by the rails in z and roll; along x they roll, with the mass
m + I_y/r^2. So the body's bounce, pitch, roll, sway and yaw are those of body and frames on
springs: 22 coordinates and a stroke for each damper in series, put together by stiffnesses at
points. A load keeps its direction: pressing up on a point h above a centre, it adds P h to the
stiffness in roll and pitch (the point falls by h phi^2/2), pressing down -P h.
"""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from exudyn_wheelset import (
    AntiRollBar,
    Contact,
    MaxwellDamper,
    Spring,
    Track,
    TractionRod,
    VehicleBuilder,
    Wheelset,
    catalogue,
    linear_critical_speed,
    linearise,
    static_equilibrium,
)

GRAVITY = 9.81
BODY, FRAME, AXLE = 32000.0, 2615.0, 1813.0
# (name, centre, mass and inertia) of the three bodies.
SOLIDS = (
    ((0.0, 0.0, 1.8), (BODY, BODY, BODY, 56.8e3, 1.97e6, 1.97e6)),
    ((9.5, 0.0, 0.6), (FRAME, FRAME, FRAME, 1722.0, 1476.0, 3067.0)),
    ((-9.5, 0.0, 0.6), (FRAME, FRAME, FRAME, 1722.0, 1476.0, 3067.0)),
)
AXLE_HEIGHT = 0.46


def lever(solid, point):
    """(6, 22) displacement and rotation of a point of a body by the coordinates."""
    row = np.zeros((6, 22))
    x, y, z = np.array(point) - SOLIDS[solid][0]
    start = 6 * solid
    row[:3, start : start + 3] = np.eye(3)
    row[:3, start + 3 : start + 6] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
    row[3:, start + 3 : start + 6] = np.eye(3)
    return row


def by_hand(in_series: bool):
    """Eigenvalues of body and frames on held wheelsets."""
    mass, stiffness, damping = np.zeros((22, 22)), np.zeros((22, 22)), np.zeros((22, 22))
    branches = []
    for k, (_, inertia) in enumerate(SOLIDS):
        mass[6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = np.diag(inertia)

    def join(strain, springs, dampers=(0, 0, 0, 0, 0, 0), series=0.0):
        for k, c, row in zip(springs, dampers, strain, strict=True):
            stiffness[:] += k * np.outer(row, row)
            if in_series and series and c:
                branches.append((series, c, row))
            else:
                damping[:] += c * np.outer(row, row)

    def load(solid, height, force):
        """A force up that keeps its direction, at a height above the body's centre."""
        for entry in (3, 4):
            stiffness[6 * solid + entry, 6 * solid + entry] += force * height

    body_side, box = BODY * GRAVITY / 4.0, (BODY / 2.0 + FRAME) * GRAVITY / 4.0
    for k, x in ((1, 9.5), (2, -9.5)):
        for w, ahead in enumerate((1.28, -1.28)):
            wheelset = 18 + 2 * (k - 1) + w
            mass[wheelset, wheelset] = AXLE + 112.0 / AXLE_HEIGHT**2
            for y in (1.0, -1.0):
                strain = lever(k, (x + ahead, y, AXLE_HEIGHT))
                strain[0, wheelset] -= 1.0
                join(strain, (31.391e6, 3.884e6, 1.22e6, 0, 0, 0), (15e3, 2e3, 0, 0, 0, 0))
                join(strain, np.zeros(6), (0, 0, 4e3, 0, 0, 0), series=1e6)
                load(k, AXLE_HEIGHT - 0.6, box)
        for y in (1.0, -1.0):
            strain = lever(0, (x, y, 1.1)) - lever(k, (x, y, 1.1))
            join(strain, (0.16e6, 0.16e6, 0.43e6, 10.5e3, 10.5e3, 0))
            join(strain, np.zeros(6), (0, 32e3, 20e3, 0, 0, 0), series=6e6)
            load(0, 1.1 - 1.8, body_side)
            load(k, 1.1 - 0.6, -body_side)
        middle = lever(0, (x, 0, 1.1)) - lever(k, (x, 0, 1.1))
        join(middle[3:4], (940e3,), (0,))
        rod = lever(0, (x + 0.4, 0, 0.6)) - lever(k, (x - 0.4, 0, 0.6))
        join(rod[:1], (5e6,), (25e3,))
    states = len(branches)
    matrix = np.zeros((44 + states, 44 + states))
    matrix[:22, 22:44] = np.eye(22)
    for place, (series, c, row) in enumerate(branches, start=44):
        # F = k (e - s), s' = F/c.
        stiffness += series * np.outer(row, row)
        matrix[22:44, place] = np.linalg.solve(mass, series * row)
        matrix[place, :22] = series * row / c
        matrix[place, place] = -series / c
    matrix[22:44, :22] = -np.linalg.solve(mass, stiffness)
    matrix[22:44, 22:44] = -np.linalg.solve(mass, damping)
    return np.linalg.eigvals(matrix)


@pytest.mark.parametrize("in_series", [True, False])
def test_bounce_pitch_roll_sway_and_yaw(in_series):
    values = by_hand(in_series)
    # Below 3 Hz only the body moves on its springs: bounce, pitch, lower and upper sway, yaw.
    of_body = values[(values.imag > 1.0) & (np.abs(values) < 2 * np.pi * 3.0)]
    assert len(of_body) == 5
    found = linearise(catalogue.manchester_coach(series_stiffness=in_series), 1.0).eigenvalues
    for root in of_body:
        # The lateral slip V F/(2 f22 v) of the wheelsets: 1e-3 of the sway at 1 m/s.
        assert np.abs(found - root).min() < 0.002 * abs(root)


def test_infinite_series_stiffness_is_the_plain_damper():
    plain = linearise(catalogue.manchester_coach(series_stiffness=False), 40.0).eigenvalues
    stiff = catalogue.manchester_coach(series_stiffness=True)
    stiff = stiff.replace("connections.damper.stiffness", 1e11)
    found = linearise(stiff, 40.0).eigenvalues
    below = plain[(np.abs(plain) < 2 * np.pi * 20.0) & (plain.imag > 0.1)]
    assert len(below) > 10
    for root in below:
        # A stroke beside the spring of F/k: c w/k = 4e-5 at 20 Hz.
        assert np.abs(found - root).min() < 1e-4 * abs(root)


def test_wheel_loads_are_weight_and_geometry():
    # A law without spin moment: those of tapered wheels brake the coach and pitch it by a newton.
    coach = catalogue.manchester_coach(creep="polach-kalker")
    even = (BODY + 2 * FRAME + 4 * AXLE) * GRAVITY / 8.0
    for loads in static_equilibrium(coach).wheel_loads.values():
        assert loads == pytest.approx((even, even), rel=1e-6)
    # The body's centre 0.6 m ahead: each truck carries its share by the levers to the trucks.
    # Without bending, and with the rods alone to pull and push, the trucks take no moment.
    ahead = coach.replace("bodies.body.centre.x", 0.6)
    ahead = ahead.replace("connections.secondary.stiffness", (0, 0.16e6, 0.43e6, 0, 0, 0))
    found = static_equilibrium(ahead).wheel_loads
    own = (2 * FRAME + 4 * AXLE) * GRAVITY / 8.0
    for truck, share in (("front", 0.5 + 0.6 / 19.0), ("rear", 0.5 - 0.6 / 19.0)):
        for which in ("leading", "trailing"):
            each = own + share * BODY * GRAVITY / 4.0
            assert found[f"{truck} {which}"] == pytest.approx((each, each), rel=1e-6)


def test_the_coach_of_the_docs_runs():
    coach = VehicleBuilder(
        "coach", track=Track("UIC60"), contact=Contact(creep="shen-hedrick-elkins", friction=0.4)
    )
    axle = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
    body = coach.body("body", mass=32e3, inertia=(56.8e3, 1.97e6, 1.97e6), centre=(0, 0, 1.8))
    for truck, x in (("front", 9.5), ("rear", -9.5)):
        frame = coach.body(
            f"{truck} frame", mass=2615, inertia=(1722, 1476, 3067), centre=(x, 0, 0.6)
        )
        for which, d in (("leading", 1.28), ("trailing", -1.28)):
            one = coach.wheelset(f"{truck} {which}", axle, x=x + d)
            for y in (1.0, -1.0):
                spring = Spring(stiffness=(31.391e6, 3.884e6, 1.22e6), damping=(15e3, 2e3, 0))
                coach.connect(spring, one, frame, at=(one.x, y, one.z))
                damper = MaxwellDamper(direction=(0, 0, 1), stiffness=1e6, damping=4e3)
                coach.connect(damper, one, frame, at=(one.x, y, one.z))
        for y in (1.0, -1.0):
            spring = Spring(stiffness=(0.16e6, 0.16e6, 0.43e6))
            coach.connect(spring, frame, body, at=(x, y, 1.1))
            damper = MaxwellDamper(direction=(0, 1, 0), stiffness=6e6, damping=32e3)
            coach.connect(damper, frame, body, at=(x, y, 1.1))
        coach.connect(AntiRollBar(stiffness=940e3), frame, body, at=(x, 0, 1.1))
        rod = TractionRod(stiffness=5e6, damping=25e3, length=0.8)
        coach.connect(rod, frame, body, at=(x, 0, 0.6))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        critical = linear_critical_speed(coach.finish(), 20.0, 150.0)
    assert "hunting" in critical.mode_name
    assert 40.0 < critical.speed < 120.0
