"""One element between a frame that stands still and a body that is led along a given motion."""

from __future__ import annotations

import itertools

import numpy as np

from exudyn_wheelset import Spring, Track, VehicleBuilder, Wheelset
from exudyn_wheelset.vehicles import kernel, layout
from exudyn_wheelset.vehicles.struts import block_of, strokes_at, struts_of

AXLE = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
HEIGHT = 0.8


class DrivenElement:
    """Forces of an element in the middle of a vehicle, over (x, y, z, rotation vector) of its body.

    The element, its two ends and the body's centre are at one place, so the six displacements of
    the body are those of the element. preload (6): force [N] and moment [N m] on the body at rest.
    """

    def __init__(self, element, preload=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)):
        made = VehicleBuilder("vehicle", track=Track("UIC60"))
        made.wheelset("axle", AXLE, x=0.0)
        frame = made.body("frame", 2000, (1500, 1400, 2000), (0.0, 0.0, HEIGHT))
        body = made.body("body", 20e3, (20e3, 80e3, 80e3), (0.0, 0.0, HEIGHT))
        made.connect(Spring((1e6, 1e6, 1e6)), frame, body, at=(0, 0, HEIGHT))
        made.connect(element, frame, body, at=(0, 0, HEIGHT), name="tested")
        vehicle = made.finish()
        centres = np.array([part.centre for part in vehicle.parts])
        struts = [s for s in struts_of(vehicle, centres) if s.connection.name == "tested"]
        preloads = np.array(
            [np.zeros(6) if s.known is None else [*s.known, 0, 0, 0] for s in struts]
        )
        preloads[0] += preload
        self.block, states = block_of(vehicle, struts, preloads, np.zeros((3, 6)), centres)
        self.holds = np.zeros(len(states))
        self.power = self.energy = 0.0

    def force(self, place, rate, holds=None):
        """Force and moment (6) on the body; rates of the holds."""
        q, v = np.zeros(18), np.zeros(18)
        q[12:], v[12:] = place, rate
        holds = self.holds if holds is None else holds
        kernel.connection_forces(q, v, holds, self.block)
        start, rates = int(self.block[layout.H_FORCES]), int(self.block[layout.H_RATES])
        self.energy, self.power = self.block[layout.H_ENERGY], self.block[layout.H_POWER]
        found = self.block[start + 12 : start + 18].copy()
        return found, self.block[rates : rates + len(self.holds)].copy()

    def drive(self, motion, times):
        """Forces (m, 6) along motion(t) -> (place (6), rate (6)), the holds by RK4 over `times`."""
        found = [self.force(*motion(times[0]))[0]]
        for t, after in itertools.pairwise(times):
            h = after - t
            k1 = self.force(*motion(t))[1]
            k2 = self.force(*motion(t + h / 2), self.holds + h / 2 * k1)[1]
            k3 = self.force(*motion(t + h / 2), self.holds + h / 2 * k2)[1]
            k4 = self.force(*motion(after), self.holds + h * k3)[1]
            self.holds = self.holds + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            found.append(self.force(*motion(after))[0])
        return np.array(found)

    def held_after(self, place):
        """Holds after a straight way to a place (6), by the closed form of statics."""
        pose = np.zeros(18)
        pose[12:] = place
        return strokes_at(self.block, pose)


def along(axis, value, rate):
    """Displacements and rates (6) along or about one axis."""
    place, speed = np.zeros(6), np.zeros(6)
    place[axis], speed[axis] = value, rate
    return place, speed


def oscillation(axis, amplitude, frequency):
    """Motion of an amplitude [m, rad] at a frequency [Hz]."""
    w = 2.0 * np.pi * frequency

    def motion(t):
        return along(axis, amplitude * np.sin(w * t), amplitude * w * np.cos(w * t))

    return motion


def ramp(axis, speed, start=0.0):
    """Motion at a constant speed [m/s, rad/s]."""
    return lambda t: along(axis, start + speed * t, speed)
