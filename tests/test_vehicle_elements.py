"""Each connection alone: forces are derivatives of its potential, dampers take their power, and
each law against its formula.

The compiled laws are asked at random poses of two bodies; virtual displacements, virtual work and
the closed forms are written here anew.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from exudyn_wheelset import (
    AirSpring,
    AntiRollBar,
    AxleBox,
    BumpStop,
    Bushing,
    CentrePlate,
    CoilNest,
    CoilSpring,
    Damper,
    FrictionWedge,
    LeafSpring,
    LinkSuspension,
    MaxwellDamper,
    SideBearer,
    Spring,
    Track,
    TractionRod,
    VehicleBuilder,
    Wheelset,
)
from exudyn_wheelset.vehicles import kernel, layout
from exudyn_wheelset.vehicles.struts import block_of, strokes_at, struts_of

AXLE = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
STIFF = (3.0e6, 2.0e6, 1.0e6)
DAMPED = (3.0e4, 2.0e4, 1.0e4)
FULL = np.array(Rotation.from_rotvec([0.3, 0.2, 0.1]).as_matrix())
MATRIX = np.zeros((6, 6))
MATRIX[:3, :3] = FULL @ np.diag(STIFF) @ FULL.T
MATRIX[3:, 3:] = FULL @ np.diag([3e5, 2e5, 1e5]) @ FULL.T
MATRIX[0, 4] = MATRIX[4, 0] = 2e5
STOP = ((0, 0), (0.01, 0), (0.02, 2e4), (0.03, 9e4))
BLOW_OFF = ((0, 0), (0.1, 1.0e4), (0.3, 1.4e4), (0.6, 1.6e4))

ELEMENTS = {
    "spring": Spring(STIFF, DAMPED),
    "bushing": Bushing((*STIFF, 3e5, 2e5, 1e5), (*DAMPED, 3e3, 2e3, 1e3)),
    "matrix": Spring(MATRIX, 0.01 * MATRIX),
    "anti-roll bar": AntiRollBar(940e3, 5e3),
    "rod": TractionRod(5e6, 25e3, length=0.8),
    "inclined rod": TractionRod(5e6, 25e3, length=0.8, direction=(1, 0.2, -0.3)),
    "coil": CoilSpring(STIFF, bending=1e5, torsion=1e4, damping=DAMPED),
    "maxwell": MaxwellDamper((0, 1, 0.2), 6e6, 32e3),
    "blow-off": Damper((0, 1, 0), table=BLOW_OFF),
    "blow-off in series": Damper((0, 1, 0), table=BLOW_OFF, series_stiffness=5e6),
    "bump stop": BumpStop((0, 1, 0), table=STOP, play=0.005),
    "air spring": AirSpring(STIFF, 1e6, 1e4, DAMPED),
    "axle box": AxleBox(STIFF, DAMPED, spacing=0.3),
    "centre plate": CentrePlate(0.3, friction=0.0, stiffness=4e6, play=0.005, stop=2e6),
    "side bearer": SideBearer(0.0, 3e6, friction=0.0, force=60e3),
    "leaf spring": LeafSpring(STIFF, friction=0.0, damping=DAMPED),
    "links": LinkSuspension(3e6, (0.4, 0.3), (0.0, 0.0), leaf_friction=0.0, damping=DAMPED),
    "wedge": FrictionWedge(32.0, 0.0, 96e3, spring=2e6),
    "coil nest": CoilNest(STIFF, FrictionWedge(32.0, 0.0, 50e3, spring=2e6), damping=DAMPED),
}
# They push only under a load, carry no moment or are not stiff at rest in all directions.
PRESSING = ("centre plate", "side bearer", "leaf spring", "wedge", "coil nest")
WITHOUT_MOMENT = ("leaf spring", "links")
AT = {"axle": (0.0, 0.9, 0.46), "frame": (0.3, 0.9, 0.8)}
PRELOAD = np.array([2e3, -3e3, 60e3, 500.0, -300.0, 200.0])


class Joined:
    """One element between the wheelset or the frame below and the body or the ground above."""

    def __init__(self, element, lower="frame", upper="body", at=None, preload=PRELOAD):
        made = VehicleBuilder("vehicle", track=Track("UIC60"))
        made.wheelset("axle", AXLE, x=0.0)
        frame = made.body("frame", 2000, (1500, 1400, 2000), (0.1, 0.05, 0.6))
        body = made.body("body", 20e3, (20e3, 80e3, 80e3), (0.2, -0.1, 1.6))
        made.connect(Spring(STIFF), frame, body, at=(0, 0, 1))
        made.connect(element, lower, upper, at=at or AT[lower], name="tested")
        self.vehicle = made.finish()
        self.centres = np.array([part.centre for part in self.vehicle.parts])
        struts = struts_of(self.vehicle, self.centres)
        self.struts = [strut for strut in struts if strut.connection.name == "tested"]
        share = np.array(preload) / len(self.struts)
        preloads = np.array([share for _ in self.struts])
        rest = np.zeros((3, 6))
        self.block, _ = block_of(self.vehicle, self.struts, preloads, rest, self.centres)
        self.states = int(self.block[layout.H_STATES])
        self.strokes = np.zeros(max(self.states, 1))

    def evaluate(self, q, v=None, strokes=None):
        """Generalised forces (3, 6), rates of the strokes, stored energy, power taken."""
        v = np.zeros(18) if v is None else v
        strokes = self.strokes if strokes is None else strokes
        kernel.connection_forces(np.asarray(q).ravel(), v, strokes, self.block)
        block = self.block
        start, rates = int(block[layout.H_FORCES]), int(block[layout.H_RATES])
        forces = block[start : start + 18].reshape(3, 6).copy()
        strokes = block[rates : rates + int(block[layout.H_STATES])].copy()
        return forces, strokes, block[layout.H_ENERGY], block[layout.H_POWER]


def preload_of(name):
    """Force and moment on the upper body; no moment of what hangs or stands by its load."""
    return PRELOAD * ([1, 1, 1, 0, 0, 0] if name in WITHOUT_MOMENT else np.ones(6))


def turned(q, body, entry, step):
    """Coordinates after a small virtual displacement: rotations in the body's own axes."""
    moved = np.array(q, dtype=float)
    if entry < 3:
        moved[body, entry] += step
        return moved
    small = np.zeros(3)
    small[entry - 3] = step
    new = Rotation.from_rotvec(moved[body, 3:]) * Rotation.from_rotvec(small)
    moved[body, 3:] = new.as_rotvec()
    return moved


def pose(seed, angle=0.05, spin=0.0):
    """Displacements of some millimetres and rotations of `angle` [rad]; the wheelset spins."""
    random = np.random.default_rng(seed)
    q = np.hstack([random.uniform(-0.02, 0.02, (3, 3)), random.uniform(-angle, angle, (3, 3))])
    frame = Rotation.from_euler("ZXY", [*random.uniform(-angle, angle, 2), spin])
    q[0, 3:] = frame.as_rotvec()
    return q


@pytest.mark.parametrize("name", ELEMENTS)
@pytest.mark.parametrize("ends", [("frame", "body"), ("axle", "frame"), ("frame", "ground")])
def test_forces_are_the_derivatives_of_the_potential(name, ends):
    """Virtual work: F = -dU/dq for each of 18 virtual displacements, at angles of 50 mrad.

    Axes half way between two bodies follow from half the relative rotation, to the square of
    that rotation over 12: 1e-3 of the coil's forces. The spring table of a wheelset's spin does no
    work: its moment about the axle is zero.
    """
    if name == "axle box" and ends[0] != "axle":
        pytest.skip("stands on a wheelset")
    if "rod" in name and ends[0] == "axle":
        pytest.skip("its end is off the axle")
    joined = Joined(ELEMENTS[name], *ends, preload=preload_of(name))
    q = pose(3, spin=0.7)
    strokes = np.full(joined.strokes.size, 4e-4)
    step = 1e-6
    forces = joined.evaluate(q, strokes=strokes)[0]
    work = np.zeros((3, 6))
    for body in range(3):
        for entry in range(6):
            ahead = joined.evaluate(turned(q, body, entry, step), strokes=strokes)[2]
            behind = joined.evaluate(turned(q, body, entry, -step), strokes=strokes)[2]
            work[body, entry] = -(ahead - behind) / (2.0 * step)
    size = np.abs(forces).max()
    assert size > 1e3
    # Differences of an energy of some 1e3 J over 1e-6: rounding of 1e-7 of the forces.
    assert forces == pytest.approx(work, abs=(1e-3 if name == "coil" else 2e-6) * size)
    assert forces[0, 4] == pytest.approx(0.0, abs=1e-9 * size)


@pytest.mark.parametrize("name", ELEMENTS)
def test_dampers_take_their_power_from_the_motion(name):
    """Work of all forces at a velocity = -(rate of the stored energy) - power taken, power >= 0."""
    ends = ("axle", "frame") if name == "axle box" else ()
    joined = Joined(ELEMENTS[name], *ends, preload=preload_of(name))
    q = pose(5, angle=0.02, spin=1.1)
    velocity = np.random.default_rng(6).uniform(-0.3, 0.3, 18)
    strokes = np.full(joined.strokes.size, 3e-4)
    forces, rates, _, power = joined.evaluate(q, velocity, strokes)
    h = 1e-6

    def at(time):
        moved = q + 0.0
        moved[:, :3] += time * velocity.reshape(3, 6)[:, :3]
        for body in range(3):
            spin = Rotation.from_rotvec(time * velocity.reshape(3, 6)[body, 3:])
            moved[body, 3:] = (Rotation.from_rotvec(q[body, 3:]) * spin).as_rotvec()
        # Holds of sliding friction give no force here; a Maxwell damper's one state moves.
        stroke = strokes + time * (rates if len(rates) else 0.0)
        return joined.evaluate(moved, strokes=stroke)[2]

    stored = (at(h) - at(-h)) / (2.0 * h)
    assert power >= 0.0
    tolerance = 1e-3 if name == "coil" else 1e-6
    size = np.abs(forces.ravel() * velocity).sum()
    assert forces.ravel() @ velocity == pytest.approx(-stored - power, abs=tolerance * size)


@pytest.mark.parametrize("name", ["spring", "bushing", "coil", "maxwell", "bump stop", "rod"])
def test_axes_turn_with_the_bodies(name):
    """A vehicle turned as a whole about the vertical, as in a curve, feels the turned forces."""
    joined = Joined(ELEMENTS[name], preload=np.array([0.0, 0.0, 60e3, 0.0, 0.0, 0.0]))
    q = pose(8, angle=0.01)
    turn = Rotation.from_rotvec([0.0, 0.0, 0.4])
    before = joined.evaluate(q, strokes=np.full(1, 3e-4))[0]
    moved = q.copy()
    for body in range(3):
        place = joined.centres[body] + q[body, :3]
        moved[body, :3] = turn.apply(place) - joined.centres[body]
        moved[body, 3:] = (turn * Rotation.from_rotvec(q[body, 3:])).as_rotvec()
    after = joined.evaluate(moved, strokes=np.full(1, 3e-4))[0]
    size = np.abs(before).max()
    assert after[:, :3] == pytest.approx(turn.apply(before[:, :3]), abs=1e-9 * size)
    assert after[:, 3:] == pytest.approx(before[:, 3:], abs=1e-9 * size)


@pytest.mark.parametrize("frequency", [0.5, 3.0, 30.0, 100.0, 400.0])
def test_maxwell_damper_has_its_complex_stiffness(frequency):
    """k i w c/(k + i w c) from a simulated sinusoid, after the first transient has died out."""
    k, c = 6.0e6, 32.0e3
    joined = Joined(MaxwellDamper((0, 1, 0), k, c), preload=np.zeros(6))
    w = 2.0 * np.pi * frequency
    period = 1.0 / frequency
    steps = 2000 * max(1, int(np.ceil(10 * (c / k) / period)))
    h = period / 2000
    amplitude = 1e-3

    def rate(time, stroke):
        q = np.zeros((3, 6))
        q[2, 1] = amplitude * np.sin(w * time)
        forces, rates, _, _ = joined.evaluate(q, strokes=np.array([stroke]))
        return rates[0], -forces[2, 1]

    time, stroke = 0.0, 0.0
    forces = []
    for step in range(steps + 2000):
        r1, force = rate(time, stroke)
        r2, _ = rate(time + h / 2, stroke + h / 2 * r1)
        r3, _ = rate(time + h / 2, stroke + h / 2 * r2)
        r4, _ = rate(time + h, stroke + h * r3)
        if step >= steps:
            forces.append(force)
        stroke += h / 6 * (r1 + 2 * r2 + 2 * r3 + r4)
        time += h
    times = (steps + np.arange(2000)) * h
    measured = 2j * np.mean(np.array(forces) * np.exp(-1j * w * times)) / amplitude
    assert measured == pytest.approx(k * 1j * w * c / (k + 1j * w * c), rel=1e-3)


def test_tables_are_met_and_have_no_jumps():
    """The Manchester coach's bump stop: its points to rounding, slope and force without a jump."""
    points = [(0.0, 0.0), (0.025, 0.0), (0.030, 600.0), (0.035, 1760.0), (0.040, 3730.0),
              (0.045, 6870.0), (0.050, 11580.0), (0.055, 17170.0), (0.060, 29200.0),
              (0.065, 230000.0)]  # fmt: skip
    joined = Joined(BumpStop((0, 1, 0), table=points), preload=np.zeros(6))

    def force(y):
        q = np.zeros((3, 6))
        q[2, 1] = y
        return -joined.evaluate(q)[0][2, 1]

    for y, value in points:
        assert force(y) == pytest.approx(value, abs=1e-6)
        assert force(-y) == pytest.approx(-value, abs=1e-6)
    assert force(0.0125) == 0.0
    y = np.linspace(-0.07, 0.07, 140001)
    slopes = np.diff([force(one) for one in y]) / (y[1] - y[0])
    assert np.all(slopes >= -1e-3)
    # The slope rises from 0 to 7e7 N/m within 5 mm; over a micrometre by less than 1e-3 of that.
    assert np.abs(np.diff(slopes)).max() < 1e-3 * slopes.max()
    # Straight on beyond the last point.
    assert force(0.080) - force(0.075) == pytest.approx(force(0.075) - force(0.070), rel=1e-9)


def test_a_damper_blows_off_by_its_table():
    joined = Joined(Damper((0, 1, 0), table=BLOW_OFF), preload=np.zeros(6))
    for speed, value in BLOW_OFF:
        velocity = np.zeros(18)
        velocity[13] = speed
        forces, _, _, power = joined.evaluate(np.zeros((3, 6)), velocity)
        assert -forces[2, 1] == pytest.approx(value, abs=1e-9)
        assert power == pytest.approx(value * speed, abs=1e-9)


def coil_stiffness(joined, coil_height, entries):
    """Stiffness against displacements of the upper end at the top and bottom plates' middles.

    entries: (u, tip of the upper plate, tip of the lower plate): lateral force and both moments
    about the plates by central differences; the body turns about its plate.
    """
    step = 1e-7

    def forces(motion):
        u, upper, lower = motion
        q = np.zeros((3, 6))
        for body, shift, tip, plate in ((2, u, upper, 0.5), (1, 0.0, lower, -0.5)):
            place = np.array([0.3, 0.9, 0.8 + plate * coil_height])
            turn = Rotation.from_rotvec([0.0, tip, 0.0])
            arm = joined.centres[body] - place
            q[body, :3] = turn.apply(arm) - arm + [shift, 0.0, 0.0]
            q[body, 3:] = turn.as_rotvec()
        found = joined.evaluate(q)[0]
        moments = []
        for body, plate in ((2, 0.5), (1, -0.5)):
            place = np.array([0.3, 0.9, 0.8 + plate * coil_height])
            turn = Rotation.from_rotvec(q[body, 3:])
            at_plate = place + ([u, 0.0, 0.0] if body == 2 else [0.0, 0.0, 0.0])
            arm = joined.centres[body] + q[body, :3] - at_plate
            moments.append((turn.apply(found[body, 3:]) + np.cross(arm, found[body, :3]))[1])
        return np.array([found[2, 0], *moments])

    columns = []
    for entry in entries:
        motion = np.zeros(3)
        motion[entry] = step
        columns.append(-(forces(motion) - forces(-motion)) / (2.0 * step))
    return np.array(columns).T


def test_a_coil_under_load_is_a_preloaded_strut():
    """Shear stiffness k, bending b, height h, load P; upper end moved by u, plates tipped t1, t0.

    Potential by hand, to second order: the shear d = u - h t, t = (t1 + t0)/2, the tipped axis and
    the load's way along it h (t1^2 + t0^2)/4 + t (u - h t), so

        2 U = k d^2 + b (t1 - t0)^2 - 2 P (h (t1^2 + t0^2)/4 + t (u - h t)).

    Between parallel plates that is k, with the moments (k h + P) u/2; free to tip at both ends
    -P/h, downhill whatever the shear stiffness; free to tip above k - (k h + P)^2/(k h^2 + 4 b).
    """
    k, b, h, load = 4.0e5, 3.0e4, 0.3, 50e3
    coil = CoilSpring((k, k, 5e5), bending=b)
    # The load presses the upper body up and the lower one down.
    joined = Joined(coil, preload=np.array([0.0, 0.0, load, 0.0, 0.0, 0.0]))
    found = coil_stiffness(joined, h, [0, 1, 2])
    across, tip = -0.5 * (k * h + load), 0.25 * k * h * h
    by_hand = np.array(
        [
            [k, across, across],
            [across, tip + b, tip - b + 0.5 * load * h],
            [across, tip - b + 0.5 * load * h, tip + b],
        ]
    )
    # Differences over 0.1 micrometre of forces of 50 kN: rounding of 1e-5 of the stiffness.
    assert found == pytest.approx(by_hand, rel=3e-5)
    pinned = found[0, 0] - found[0, 1:] @ np.linalg.solve(found[1:, 1:], found[1:, 0])
    assert pinned == pytest.approx(-load / h, rel=1e-4)
    free_above = found[0, 0] - found[0, 1] ** 2 / found[1, 1]
    assert free_above == pytest.approx(k - (k * h + load) ** 2 / (k * h * h + 4.0 * b), rel=1e-4)


def test_a_rod_under_tension_is_stiffer_across_its_line():
    tension, length = 40e3, 0.8
    joined = Joined(TractionRod(5e6, length=length), preload=np.array([-tension, 0, 0, 0, 0, 0.0]))
    q = np.zeros((3, 6))
    q[2, 1] = 1e-5
    force = joined.evaluate(q)[0][2, 1]
    assert -force / 1e-5 == pytest.approx(tension / length, rel=1e-6)


def test_an_axle_box_does_not_feel_the_spin():
    """Any angle and speed of the spin: the same forces, none about the axle; tipping is held."""
    joined = Joined(AxleBox((2e8, 2e8, 2e8), (2e4, 2e4, 2e4), spacing=0.2), "axle", "frame")
    still = joined.evaluate(pose(1, spin=0.0))[0]
    spun = joined.evaluate(pose(1, spin=2.0))[0]
    turned_back = Rotation.from_rotvec(pose(1, spin=2.0)[0, 3:]).apply(spun[0, 3:])
    assert spun[1:] == pytest.approx(still[1:], rel=1e-9)
    assert turned_back == pytest.approx(
        Rotation.from_rotvec(pose(1, spin=0.0)[0, 3:]).apply(still[0, 3:]), abs=1e-6 * 2e7
    )
    velocity = np.zeros(18)
    velocity[4] = 50.0
    assert joined.evaluate(np.zeros((3, 6)), velocity)[3] == pytest.approx(0.0, abs=1e-12)
    tip = 1e-6
    arm = joined.centres[1] - np.array(AT["axle"])
    for axis, stiffness in ((0, 2.0 * 2e8 * 0.1**2), (1, 0.0), (2, 2.0 * 2e8 * 0.1**2)):
        moments = []
        for sign in (1.0, -1.0):
            q = np.zeros((3, 6))
            turn = np.zeros(3)
            turn[axis] = sign * tip
            q[1, :3] = np.cross(turn, arm)
            q[1, 3:] = turn
            forces = joined.evaluate(q)[0]
            moments.append((forces[1, 3:] + np.cross(arm, forces[1, :3]))[axis])
        assert -(moments[0] - moments[1]) / (2 * tip) == pytest.approx(stiffness, abs=1e-2 * 4e6)


@pytest.mark.parametrize("name", ELEMENTS)
def test_static_stiffness_is_the_slope_of_the_force(name):
    """What statics shares loads by, against differences of the kernel's forces at rest.

    Displacements and turns of the upper end about the connection's place, no preload but what
    presses faces together; strokes follow so that dampers in series do not pull.
    """
    if name == "links":
        pytest.skip("pendulums: their stiffness is that of their load")
    element = ELEMENTS[name]
    # So little that its own moments, as the body turns, stay below the rounding asked.
    load = np.array([0.0, 0.0, 15.0 if name in PRESSING else 0.0, 0.0, 0.0, 0.0])
    ends = ("axle", "frame") if name == "axle box" else ("frame", "body")
    joined = Joined(element, *ends, preload=load)
    upper = 1 if name == "axle box" else 2
    place = np.array(element.places(AT[ends[0]])[1])
    arm = joined.centres[upper] - place
    step = 1e-6
    found = np.zeros((6, 6))
    for entry in range(6):
        sides = []
        for sign in (1.0, -1.0):
            small = np.zeros(6)
            small[entry] = sign * step
            q = np.zeros((3, 6))
            q[upper, :3] = small[:3] + np.cross(small[3:], arm)
            q[upper, 3:] = small[3:]
            strokes = strokes_at(joined.block, q.ravel()) if joined.states else None
            forces = joined.evaluate(q, strokes=strokes)[0][upper]
            sides.append(np.concatenate([forces[:3], forces[3:] + np.cross(arm, forces[:3])]))
        found[:, entry] = -(sides[0] - sides[1]) / (2.0 * step)
    stiffness = element.static_stiffness()
    # Turning by a micrometre per metre: rounding of 1e-5 of the largest stiffness.
    assert found == pytest.approx(stiffness, abs=1e-5 * max(1e3, np.abs(stiffness).max()))
