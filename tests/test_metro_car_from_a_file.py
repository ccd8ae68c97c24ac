"""A metro car of a user's own, as a file: it stands, curves as hand calculation says, and runs."""

import math
from dataclasses import replace

import metro_car as metro
import numpy as np
import pytest
from metro_car import write_metro_car

from exudyn_wheelset import (
    Curve,
    Irregularity,
    Layout,
    Straight,
    Transition,
    load_vehicle,
    simulate,
    static_equilibrium,
    steady_curve,
)
from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.results.en14363 import low_pass

SPEED, RADIUS, CANT = 60.0 / 3.6, 300.0, 0.1


@pytest.fixture(scope="module")
def car(tmp_path_factory):
    return load_vehicle(write_metro_car(tmp_path_factory.mktemp("metro")))


@pytest.fixture(scope="module")
def curve(car):
    return steady_curve(car, RADIUS, CANT, SPEED)


def test_every_wheel_carries_an_eighth_at_rest(car):
    rest = static_equilibrium(car)
    for loads in rest.wheel_loads.values():
        assert loads.left == pytest.approx(metro.MASS * GRAVITY / 8.0, rel=1e-4)
        assert loads.right == pytest.approx(loads.left, rel=1e-9)


def lean(axles):
    """Lateral place of the body's and the frames' centres [m] by hand; axles: mean of theirs.

    Outwards positive; n, a: accelerations across and along the canted plane. Primary springs stand
    on the axle line in effect, for arms turn about it; K1, K2 roll stiffness of all primaries and
    secondaries with anti-roll bars.
    """
    sine = CANT / 1.5
    cosine = math.sqrt(1.0 - sine**2)
    a = SPEED**2 / RADIUS * cosine - GRAVITY * sine
    n = GRAVITY * cosine + SPEED**2 / RADIUS * sine
    body, frames = metro.BODY, 2.0 * metro.FRAME
    k1 = 8.0 * metro.PRIMARY * metro.PRIMARY_SPACING**2
    k2 = 4.0 * metro.SECONDARY * metro.SECONDARY_SPACING**2 + 2.0 * metro.ANTI_ROLL
    shear1 = (body + frames) * a / (8.0 * 5.1e6)
    shear2 = body * a / (4.0 * metro.SECONDARY_LATERAL)
    low, middle = metro.RADIUS, metro.SECONDARY_HEIGHT
    first = second = 0.0
    for _ in range(30):
        frame = axles + shear1 + first * (metro.FRAME_HEIGHT - low)
        joint = axles + shear1 + first * (middle - low)
        y = joint + shear2 + (first + second) * (metro.BODY_HEIGHT - middle)
        couple = a * (body * (metro.BODY_HEIGHT - low) + frames * (metro.FRAME_HEIGHT - low))
        couple += n * (body * (y - axles) + frames * (frame - axles))
        first = couple / k1
        second = body * (a * (metro.BODY_HEIGHT - middle) + n * (y - joint)) / k2
    return y, frame, a, n


def test_the_steady_curve_is_that_of_hand_calculation(car, curve):
    """Forces add up; the rails' couple about the track's middle is that of inertia, of the weight
    of what has moved outwards and of the wheelsets' spin, by springs in series, to 3 %.
    """
    axles = -float(curve.y.mean())
    body, frame, a, n = lean(axles)
    assert curve.Q.sum() == pytest.approx(metro.MASS * n, rel=2e-3)
    assert curve.Y.sum() == pytest.approx(metro.MASS * a, rel=1e-2)
    # The vehicle's frame touches the curve in its middle, the trucks stand on the curve.
    chord = (metro.HALF_PIVOT**2 + metro.HALF_WHEELBASE**2) / (2.0 * RADIUS)
    assert chord - curve["body: y"] == pytest.approx(body, abs=2e-3)
    unsprung = 4.0 * metro.AXLE + 8.0 * metro.ARM
    known = a * (
        metro.BODY * metro.BODY_HEIGHT
        + 2.0 * metro.FRAME * metro.FRAME_HEIGHT
        + unsprung * metro.RADIUS
    )
    known += n * (metro.BODY * body + 2.0 * metro.FRAME * frame + unsprung * axles)
    known += 4.0 * 90.0 * SPEED / metro.RADIUS * SPEED / RADIUS
    found = 0.0
    for k, name in enumerate(curve.wheelsets):
        for side in ("left", "right"):
            for patch in curve.patches[name, side]:
                _, ny, nz = patch.normal
                lateral = nz * patch.fy + ny * patch.normal_force
                vertical = nz * patch.normal_force - ny * patch.fy
                y = curve.y[k] + patch.position[1]
                z = metro.RADIUS + patch.position[2]
                found -= y * vertical - z * lateral
    assert found == pytest.approx(known, rel=0.03)
    leading = curve.patches["front leading", "right"]
    assert max(patch.angle for patch in leading) > 1.0
    assert curve.guiding_quotient()[0, 1] < 0.8


@pytest.mark.slow
def test_the_end_of_a_simulated_curve_is_the_steady_one(car, curve):
    """Positions to 0.01 mm, loads to 0.2 %."""
    layout = Layout([Straight(30.0), Transition(40.0), Curve(RADIUS, 150.0, CANT)])
    motion = simulate(car.on(replace(car.track, layout=layout)), SPEED, 9.6)
    assert motion.y[-1] == pytest.approx(curve.y, abs=1e-5)
    assert motion.Q[-1] == pytest.approx(curve.Q, rel=2e-3)


@pytest.mark.slow
def test_halving_the_step_on_rough_track_leaves_what_is_below_20_hz(car):
    """To 1 % of Y and Q, and y and yaw of every wheelset to 1 % of their root mean square."""
    rough = Irregularity.from_psd("ERRI B176 low", 3, length=150.0)
    run = car.on(replace(car.track, irregularity=rough))
    one, half = (simulate(run, SPEED, 5.0, step=step) for step in (5e-4, 2.5e-4))
    for name in ("Q", "Y"):
        slow, finer = (low_pass(motion.time, getattr(motion, name)) for motion in (one, half))
        assert np.abs(slow - finer).max() < 0.01 * np.ptp(finer)
    for name in ("y", "yaw"):
        difference = getattr(one, name) - getattr(half, name)
        assert np.all(difference.std(axis=0) < 0.01 * getattr(half, name).std(axis=0))
    assert np.all(half.y.std(axis=0) > 5e-4)
