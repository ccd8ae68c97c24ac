"""Energy of a hunting freight car: what it loses is the work of friction, creep and dampers.

Counted over rails at rest: kinetic energy with the forward speed, weight, springs, what the patches
store; friction, dampers and creep take, the drawbar gives. Without damping of the normal contact,
and with normal forces that are the gradient of what the patches store, nothing is left.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import cumulative_simpson

from exudyn_wheelset import catalogue
from exudyn_wheelset.systems.starts import shifted_state
from exudyn_wheelset.systems.system import as_system
from exudyn_wheelset.vehicles.description import Axle

GRAVITY = 9.81


class Ledger:
    """Energy of a vehicle at a state, and the powers that change it."""

    def __init__(self, vehicle, system, speed):
        self.system, self.speed = system, speed
        self.items, self.data = system.vehicle_items, system.mbs.systemData
        system.use_speed(speed)
        self.parts = [
            (
                np.array(self.data.GetNodeLTGODE2(self.items.node(part.name))),
                part.wheelset if isinstance(part, Axle) else part,
            )
            for part in vehicle.parts
        ]

    def at(self, state):
        """Energy [J]; power [W] taken by connections, taken by creep, given by the drawbar."""
        q, v, holds = self.system.layout.expand(state)
        self.data.SetODE2Coordinates(q)
        self.data.SetODE2Coordinates_t(v)
        self.data.SetODE1Coordinates(holds)
        energy, connections = self.items.connectors.energy(self.system.mbs)
        creep = 0.0
        for contact in self.items.contacts:
            energy += contact.elastic_energy(self.system.mbs)
            forces = contact.current(self.system.mbs)
            for patch in (*forces.left, *forces.right):
                creep -= patch.fx * patch.creep_x + patch.fy * patch.creep_y
                creep -= patch.mz * patch.spin
        for place, solid in self.parts:
            velocity = v[place][:3] + np.array([self.speed, 0.0, 0.0])
            energy += 0.5 * solid.mass * velocity @ velocity
            energy += 0.5 * np.array(solid.inertia) @ v[place][3:] ** 2
            energy += solid.mass * GRAVITY * q[place[2]]
        bar, drawn = self.items.drawbar, 0.0
        if bar is not None:
            first = self.parts[bar.part][0][0]
            pull = bar.pull - bar.stiffness * q[first] - bar.damping * v[first]
            drawn = pull * (v[first] + self.speed)
        return energy, connections, self.speed * creep, drawn


def test_a_cycle_loses_the_work_of_friction_creep_and_dampers():
    """Over a second of hunting, more than a cycle; asked to 1e-3 of what is taken."""
    speed, settling = 45.0, 3.0
    car = catalogue.freight_car(normal="energy", damping=0.0)
    system = as_system(car)
    start = shifted_state(system, speed, 4e-3)
    start = system.simulate(start, speed, np.linspace(0.0, settling, 301))[-1]
    times = np.linspace(0.0, 1.0, 1001)
    ledger = Ledger(car, system, speed)
    rows = np.array([ledger.at(x) for x in system.simulate(start, speed, times)])
    energy, connections, creep, drawn = rows.T
    taken = cumulative_simpson(connections + creep, x=times, initial=0.0)
    given = cumulative_simpson(drawn, x=times, initial=0.0)
    assert cumulative_simpson(connections, x=times, initial=0.0)[-1] > 0.02 * taken[-1]
    left = energy - energy[0] + taken - given
    assert np.abs(left).max() < 1e-3 * taken[-1]
