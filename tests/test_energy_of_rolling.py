"""Energy of a wheelset that rolls and oscillates without friction and damping, over ten seconds.

Total energy: translation, rotation, springs, gravity, the potential of the spare axle load and what
the patches store (0.4 N times penetration, exact for Hertz contact of constant curvatures). Nearly
all of it is the spin's 200 kJ, so it is also measured by the energy of the oscillation itself.

What the model "hertz" leaves open, and by how much: the averaged curvature of a patch changes with
its place, so the normal forces of a wheel whose curvature varies (S1002) are not exactly the
gradient of a potential; those of "energy" are. That shows within each period and cancels over it.
Surfaces of revolution without friction put no torque on their axle; averaging the normal over a
patch leaves a millionth of N r.
"""

import exudyn as exu
import numpy as np
import pytest
from scipy.optimize import fsolve
from scipy.spatial.transform import Rotation

from exudyn_wheelset import (
    Suspension,
    Track,
    Wheelset,
    WheelsetOnFrame,
    contact_forces,
    contact_geometry,
)
from exudyn_wheelset.vehicles.description import GRAVITY

SPEED, RADIUS, AXLE_LOAD = 20.0, 0.3556, 150e3
STIFFNESS, HALF_DISTANCE = (2.85e5, 1.84e5, 0.0), 0.61
ELASTIC = {"friction": 0.0, "damping": 0.0, "shear_modulus": 80e9, "poisson": 0.27}
DURATION, STEP, EVERY = 10.0, 2e-4, 10


class Rolling:
    """The frictionless wheelset, released from rest on its rails at a shift and a yaw angle."""

    def __init__(self, wheel, gauge, normal):
        self.wheelset = Wheelset(
            mass=1751.0, inertia=(761.0, 130.0, 761.0), radius=RADIUS, wheel=wheel
        )
        self.track = Track("UIC60", gauge=gauge)
        self.elastic = {**ELASTIC, "normal": normal}
        model = WheelsetOnFrame(
            self.wheelset, self.track, Suspension(HALF_DISTANCE, STIFFNESS), AXLE_LOAD, self.elastic
        )
        self.container, self.mbs, self.items = model.build(SPEED, show=False, sensors=False)
        self.mbs.Assemble()
        self.reference = self.mbs.GetNodeParameter(self.items.node, "referenceCoordinates")[2]

    def rest(self, shift, yaw):
        """Coordinates where vertical force and roll moment of the rails balance the load."""

        def imbalance(x):
            pose = (0.0, shift, 1e-4 * x[0], 1e-4 * x[1], 0.0, yaw)
            forces = contact_forces(
                self.wheelset, self.track, pose, (SPEED, 0, 0, 0, 0, 0), **self.elastic
            )
            return [forces.force[2] / AXLE_LOAD - 1.0, forces.moment[0] / AXLE_LOAD]

        rigid = contact_geometry(self.wheelset, self.track, [shift], yaw)
        start = [1e4 * (rigid.z[0] - 8e-5), 1e4 * rigid.roll[0]]
        z, roll = 1e-4 * fsolve(imbalance, start, xtol=1e-9)
        turn = Rotation.from_euler("ZXY", [yaw, roll, 0.0])
        return np.array([0.0, shift, RADIUS + z - self.reference, *turn.as_rotvec()])

    def energies(self, q, v):
        """Translation and rocking, spin, springs, weight and load, contact [J]."""
        inertia, spin = np.array(self.wheelset.inertia), v[4]
        motion = 0.5 * self.wheelset.mass * v[:3] @ v[:3] + 0.5 * inertia[[0, 2]] @ v[[3, 5]] ** 2
        turn = Rotation.from_rotvec(q[3:])
        springs = 0.0
        potential = self.wheelset.mass * GRAVITY * q[2]
        for side in (HALF_DISTANCE, -HALF_DISTANCE):
            moved = q[:3] + turn.apply([0.0, side, 0.0]) - [0.0, side, 0.0]
            springs += 0.5 * np.array(STIFFNESS) @ moved**2
            potential += 0.5 * (AXLE_LOAD - self.wheelset.mass * GRAVITY) * moved[2]
        contact = self.items.contact.elastic_energy(self.mbs)
        return [motion, 0.5 * inertia[1] * spin**2, springs, potential, contact]

    def run(self, shift, yaw, step=STEP):
        """Times, energies (n, 5), shifts and axle torques over the simulated motion."""
        data, initial = self.mbs.systemData, exu.ConfigurationType.Initial
        rates = np.array([0.0, 0.0, 0.0, 0.0, SPEED / RADIUS, 0.0])
        rows = []
        centred = self.rest(0.0, 0.0)
        data.SetODE2Coordinates(centred)
        data.SetODE2Coordinates_t(rates)
        base = sum(self.energies(centred, rates))
        data.SetODE2Coordinates(self.rest(shift, yaw), initial)
        data.SetODE2Coordinates_t(rates, initial)

        def note(mbs, t):
            if round(t / step) % round(EVERY * STEP / step) == 0:
                q, v = data.GetODE2Coordinates(), data.GetODE2Coordinates_t()
                axle = Rotation.from_rotvec(q[3:]).apply([0.0, 1.0, 0.0])
                torque = self.items.contact.current(mbs).moment @ axle
                rows.append([t, *self.energies(q, v), q[1], torque])
            return True

        self.mbs.SetPreStepUserFunction(note)
        settings = exu.SimulationSettings()
        settings.timeIntegration.endTime = DURATION
        settings.timeIntegration.numberOfSteps = round(DURATION / step)
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        settings.solution.sensors.active = False
        assert self.mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
        table = np.array(rows)
        return table[:, 0], table[:, 1:6], table[:, 6], table[:, 7], base


@pytest.mark.slow
@pytest.mark.parametrize(
    ("wheel", "gauge", "normal", "within_period", "torque", "step"),
    [
        ("AAR_1_20", 1.432, "hertz", 1e-3, 1e-5, STEP),
        ("S1002", 1.435, "hertz", 3e-2, 1e-5, STEP),
        # The gradient of an energy: what is left is the integrator's, and rounding. Crossing the
        # two lobes of the centre shakes the contact, and Runge-Kutta's steps damp that with h^5.
        ("S1002", 1.435, "energy", 1e-4, 1e-9, 0.5 * STEP),
        ("S1002", 1.435, "ritz", 1e-4, 1e-9, STEP),
    ],
)
def test_total_energy_over_ten_seconds(wheel, gauge, normal, within_period, torque, step):
    times, energies, shifts, torques, base = Rolling(wheel, gauge, normal).run(3e-3, 2e-3, step)
    # It has oscillated, several millimetres to either side, and is still doing so.
    late = times > DURATION - 1.0
    assert shifts[late].max() > 2.5e-3 and shifts[late].min() < -2.5e-3
    total = energies.sum(axis=1)
    drift = total - total[0]
    assert np.abs(drift).max() < 1e-4 * total[0]

    # By the measure of the oscillation. The spin's energy stands by itself: no part of the motion
    # gives or takes it, and a millionth of N r times 56 rad/s is what goes in and out of it.
    oscillation = total[0] - base
    motion = drift - (energies[:, 1] - energies[0, 1])
    assert 1.0 < oscillation < 20.0
    assert np.abs(torques).max() < torque * AXLE_LOAD * RADIUS
    assert np.abs(motion).max() < within_period * oscillation
    # Means over two seconds, several periods, leave what does not cancel.
    early, late = times <= 2.0, times >= DURATION - 2.0
    secular = motion[late].mean() - motion[early].mean()
    assert abs(secular) < 1e-4 * oscillation
