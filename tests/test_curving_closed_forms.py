"""Steady curves against closed forms: loads, balance, rolling lines, a two-axle truck by hand.

Wheels are cones on knife edges where a form asks for one conicity, with Kalker's linear law. Left
curves have positive radii; the outer rail is the right one there.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from exudyn_wheelset import (
    AnalysisError,
    Contact,
    Curve,
    Irregularity,
    Layout,
    Spring,
    Straight,
    Suspension,
    Track,
    Transition,
    VehicleBuilder,
    Wheelset,
    WheelsetOnFrame,
    catalogue,
    contact_forces,
    simulate,
    steady_curve,
)
from exudyn_wheelset.creep.kalker import kalker_coefficients
from exudyn_wheelset.profiles.shapes import cone, knife_edge
from exudyn_wheelset.results.en14363 import low_pass
from exudyn_wheelset.vehicles.layout import ROD
from exudyn_wheelset.vehicles.rest import find_rest

GRAVITY = 9.81
LAMBDA, HALF, RADIUS = 0.05, 0.75, 0.46
CONE = Wheelset(1250.0, (700.0, 100.0, 700.0), RADIUS, cone(LAMBDA))
EDGES = Track(knife_edge(1e-2), inclination=0.0, datum_half_distance=HALF)
LINEAR = Contact(creep="linear", damping=1.0)
COACH = catalogue.vehicle("manchester_coach")


def wagon(track, contact, mass=20e3, height=1.8, stiffness=1.0e9, **axle):
    """A body on two axles and stiff springs."""
    made = VehicleBuilder("wagon", track=track, contact=contact)
    body = made.body("body", mass=mass, inertia=(20e3, 80e3, 80e3), centre=(0, 0, height))
    wheelset = axle.get("wheelset", CONE)
    for name, x in (("leading", 2.5), ("trailing", -2.5)):
        own = made.wheelset(name, wheelset, x=x)
        for side, y in (("left", 1.0), ("right", -1.0)):
            spring = Spring(np.broadcast_to(stiffness, 3).tolist(), (1e4, 1e4, 1e5))
            made.connect(spring, own, body, at=(x, y, own.z), name=f"{name} {side} spring")
    return made.finish()


def test_at_the_equilibrium_cant_both_rails_carry_alike():
    """V^2 = R g tan(cant angle)."""
    radius, cant, base = 20000.0, 0.06, 2.0 * HALF
    speed = math.sqrt(radius * GRAVITY * math.tan(math.asin(cant / 1.5)))
    # On knife edges: on a rail's head the contacts move along with the wheelset's own shift.
    curve = steady_curve(wagon(EDGES, LINEAR, stiffness=1e8), radius, cant, speed)
    weight = 22500.0 * GRAVITY
    aside = np.array([20e3, 1250.0, 1250.0]) @ [curve["body: y"], *curve.y] / 22500.0
    # What is left is the shift of the wheelsets on the track and the couple of their spin.
    couple = 2.0 * CONE.inertia[1] * speed**2 / (RADIUS * radius)
    left, right = curve.Q.sum(axis=0)
    known = 2.0 * (couple / weight - aside) / base
    assert (right - left) / (right + left) == pytest.approx(known, abs=1e-3)


@pytest.mark.parametrize(("speed", "cant"), [(50.0, 0.0), (50.0, 0.05), (10.0, 0.05)])
def test_a_stiff_vehicle_shifts_its_load_by_the_couple_of_inertia_and_weight(speed, cant):
    """dQ/Q0 = 2 h (V^2/(R g) - u/e)/e, and 2 y/e for a centre of gravity beside the track's.

    The wheels' gyroscopic couple comes to it, 1 % here.
    """
    radius, base = 4000.0, 2.0 * HALF
    vehicle = wagon(EDGES, LINEAR, stiffness=1e8)
    curve = steady_curve(vehicle, radius, cant, speed)
    masses = np.array([20e3, 1250.0, 1250.0])
    height = masses @ [1.8, RADIUS, RADIUS] / masses.sum()
    # Between its axles the body stands on the chord.
    aside = masses @ [curve["body: y"] - 2.5**2 / (2.0 * radius), *curve.y] / masses.sum()
    uncompensated = speed**2 / (radius * GRAVITY) - cant / base
    # Outwards is to the right.
    expected = 2.0 * (height * uncompensated - aside) / base
    # The wheels' spin is carried round the curve: I V^2/(r0 R) of either axle.
    couple = 2.0 * CONE.inertia[1] * speed**2 / (RADIUS * radius)
    expected += 2.0 * couple / (base * masses.sum() * GRAVITY)
    left, right = curve.Q.sum(axis=0)
    assert (right - left) / (right + left) == pytest.approx(expected, rel=5e-3)


def test_forces_and_moments_balance():
    """Rails, drawbar and weight are what masses on circles need: m w x (w x r) about the centre.

    With "hertz", which has an equilibrium here; with stored energy the leading flange stands on a
    jump of its creep force, and the mean of a second is no equilibrium.
    """
    radius, cant, speed = 300.0, 0.12, 18.0
    coach = COACH.replace("contact.normal", "hertz")
    curve = steady_curve(coach, radius, cant, speed)
    system, state = curve.system, curve.state
    coordinates, velocities, _ = system.layout.expand(state)
    roll = -math.asin(cant / 1.5)
    up = np.array([0.0, math.sin(roll), math.cos(roll)])
    inwards = np.array([0.0, math.cos(roll), -math.sin(roll)])
    turning = speed / radius * up
    data = system.mbs.systemData
    data.SetODE2Coordinates(coordinates)
    data.SetODE2Coordinates_t(velocities)
    force, moment, weight = np.zeros(3), np.zeros(3), coach.mass * GRAVITY
    centres, turns = [], []
    solids = [getattr(part, "wheelset", part) for part in coach.parts]
    for k, (solid, centre) in enumerate(zip(solids, system.centres, strict=True)):
        place = centre + coordinates[6 * k : 6 * k + 3]
        own = -solid.mass * GRAVITY * up
        from_axis = place - radius * inwards
        own -= solid.mass * np.cross(turning, np.cross(turning, from_axis))
        centres.append(place)
        turns.append(Rotation.from_rotvec(coordinates[6 * k + 3 : 6 * k + 6]))
        force += own
        moment += np.cross(place, own)
        if k < len(system.wheelsets):
            rails = system.wheelsets[k].contact.current(system.mbs)
            force += rails.force
            moment += rails.moment + np.cross(place, rails.force)
            # The wheelset's spin is carried round the curve.
            spin = velocities[6 * k + 3 : 6 * k + 6] @ [0.0, 1.0, 0.0]
            axle = np.array([-curve_yaw(coordinates, k), 1.0, curve_roll(coordinates, k)])
            moment -= solid.inertia[1] * spin * np.cross(turning, axle)
    bar = system.vehicle_items.drawbar
    place = system.centres[bar.part] + coordinates[6 * bar.part : 6 * bar.part + 3]
    pull = bar.pull - bar.stiffness * coordinates[6 * bar.part]
    force[0] += pull
    moment += np.cross(place, [pull, 0.0, 0.0])
    # Preloads keep their direction in the track and act each at its own end: sheared springs put a
    # couple on the vehicle (docs/decisions/connections-in-one-compiled-call.md).
    for strut, preload in zip(find_rest(coach).struts, find_rest(coach).preloads, strict=True):
        if strut.law.middle or strut.law.kind == ROD:
            continue
        ends = [
            centres[body] + turns[body].apply(point - system.centres[body])
            for body, point in zip((strut.lower, strut.upper), strut.points, strict=True)
        ]
        moment += np.cross(ends[1] - ends[0], preload[:3])
    assert np.abs(force).max() < 1e-6 * weight
    # Products of inertia of slightly turned bodies are 1e-5 of the moment of the weight.
    assert np.abs(moment).max() < 1e-5 * weight


def curve_yaw(coordinates, k):
    return coordinates[6 * k + 5]


def curve_roll(coordinates, k):
    return coordinates[6 * k + 3]


@pytest.mark.parametrize("radius", [2000.0, -5000.0, 20000.0])
def test_a_free_wheelset_takes_the_rolling_line(radius):
    """y = -r0 e/(2 lambda R), with the roll that makes the radii differ by (1 + lambda r0/g) more.

    g = e/2 - lambda r0: roll lambda y/g moves the wheels' rims aside by r0 times as much.
    """
    free = WheelsetOnFrame(
        CONE, EDGES, Suspension(1.0, (1.0, 1.0, 1.0)), 1.0e5, {"creep": "linear", "damping": 1.0}
    ).vehicle()
    # As slow as that centrifugal force is 1e-5 of the weight.
    curve = steady_curve(free, radius, 0.0, 1.0)
    more = 1.0 + LAMBDA * RADIUS / (HALF - LAMBDA * RADIUS)
    assert curve.y[0] == pytest.approx(-RADIUS * HALF / (LAMBDA * radius * more), rel=1e-2)
    creepages = curve.motion.of_wheels("creep_x [-]")[0]
    # It rolls: the rest is 1 % of what both wheels would slip in the middle of the track.
    assert np.abs(creepages).max() < 1e-2 * HALF / abs(radius)


def coefficients(load):
    """f11, f22, f23 of a wheel under a load [N]."""
    depth = 6e-5
    for _ in range(40):
        pose = (0, 0, -depth, 0, 0, 0)
        patch = contact_forces(CONE, EDGES, pose, (1, 0, 0, 0, 1 / RADIUS, 0)).left[0]
        depth *= (load / patch.normal_force) ** (2.0 / 3.0)
    c11, c22, c23, _ = kalker_coefficients(patch.a, patch.b, LINEAR.poisson)
    area = LINEAR.shear_modulus * patch.a * patch.b
    return area * c11, area * c22, area * math.sqrt(patch.a * patch.b) * c23


def truck_by_hand(radius, base, lateral, yaw_stiffness, load):
    """Shift and yaw (2), (2) of the wheelsets of a truck, each against its own track.

    Half wheelbase `base`: the track at +-base lies base^2/(2 R) aside of the frame's tangent and is
    turned by +-base/R. The normal forces push back by 2 N phi as their planes roll, and by
    2 N lambda y/b as the wheelset's weight stands beside the track's middle. Frame free but for the
    springs; unknowns y1, y2, psi1, psi2, y_f, psi_f.
    """
    f11, f22, f23 = coefficients(load)
    roll = LAMBDA / (HALF - LAMBDA * RADIUS)
    more = 1.0 + LAMBDA * RADIUS / HALF
    rim = LAMBDA * (1.0 + RADIUS * roll) / RADIUS

    def residual(unknown, curvature):
        y, psi, (y_f, psi_f) = unknown[:2], unknown[2:4], unknown[4:]
        sign = np.array([1.0, -1.0])
        force = lateral * (y_f + sign * base * psi_f - 0.5 * base**2 * curvature - y)
        couple = yaw_stiffness * (psi_f - sign * base * curvature - psi)
        # Between a cone and its own axle the angle stays: of spin only the curve's is left, and
        # +-lambda/r0 under unlike loads, N_l - N_r = (2 N y - r0 F)/b, for f23 goes with N.
        creep = 2.0 * f22 * psi - 2.0 * f23 * (curvature - LAMBDA / RADIUS * y / HALF)
        creep /= 1.0 + f23 * LAMBDA / (load * HALF)
        about = -2.0 * HALF * f11 * (rim * y + HALF * curvature) - 2.0 * f23 * psi
        return np.concatenate(
            [
                force + more * creep - 2.0 * load * (roll + LAMBDA / HALF) * y,
                couple + about,
                [force.sum(), base * (force[0] - force[1]) + couple.sum()],
            ]
        )

    matrix = np.column_stack([residual(column, 0.0) for column in np.eye(6)])
    found = np.linalg.solve(matrix, -residual(np.zeros(6), 1.0 / radius))
    return found[:2], found[2:4]


@pytest.mark.parametrize("radius", [500.0, 2000.0, -20000.0])
def test_two_wheelsets_in_a_frame_by_hand(radius):
    # Soft upwards: the couple of the vertical springs on a rolled wheelset is left out by hand.
    base, stiffness, arm = 1.25, (2.0e6, 4.0e6, 1.0e5), 1.0
    made = VehicleBuilder("truck", track=EDGES, contact=LINEAR)
    mass = 20.0e3
    frame = made.body("frame", mass=mass, inertia=(8e3, 8e3, 16e3), centre=(0, 0, RADIUS))
    for name, x in (("leading", base), ("trailing", -base)):
        axle = made.wheelset(name, CONE, x=x)
        for side, y in (("left", arm), ("right", -arm)):
            made.connect(
                Spring(stiffness, (1e4, 1e4, 1e4)), axle, frame, at=(x, y, axle.z),
                name=f"{name} {side} spring",
            )  # fmt: skip
    load = (0.5 * mass + CONE.mass) * GRAVITY / 2.0
    # Slow: centrifugal forces are 1e-4 of the weight and less.
    curve = steady_curve(made.finish(), radius, 0.0, 0.5)
    y, psi = truck_by_hand(radius, base, 2 * stiffness[1], 2 * stiffness[0] * arm**2, load)
    # One per cent of the larger of both wheelsets.
    assert curve.y == pytest.approx(y, abs=1e-2 * np.abs(y).max())
    assert curve.yaw == pytest.approx(psi, abs=1e-2 * np.abs(psi).max())


def test_a_coach_in_a_narrow_curve_runs_on_its_leading_outer_flange():
    curve = steady_curve(COACH, 300.0, 0.12, 18.0)
    # The leading wheelset of either truck is at the outer rail, turned away from the curve; the
    # trailing one stands radially near the middle.
    for truck in ("front", "rear"):
        leading, trailing = (
            curve.wheelsets.index(f"{truck} {name}") for name in ("leading", "trailing")
        )
        assert curve.y[leading] < -5e-3 and curve.yaw[leading] < -5e-3
        assert abs(curve.y[trailing]) < 4e-3 and abs(curve.yaw[trailing]) < 1.5e-3
        assert max(abs(p.angle) for p in curve.patches[f"{truck} leading", "right"]) > math.radians(
            30
        )
    mirrored = steady_curve(COACH, -300.0, 0.12, 18.0)
    # Newton's tolerance.
    assert mirrored.y == pytest.approx(-curve.y, abs=1e-9)
    assert pytest.approx(curve.Q[:, ::-1], rel=1e-6) == mirrored.Q


def test_the_end_of_a_simulated_curve_is_the_steady_one():
    radius, cant, speed = 300.0, 0.12, 18.0
    layout = Layout([Straight(30), Transition(50, "bloss"), Curve(radius, 220, cant)])
    motion = simulate(COACH.on(replace(COACH.track, layout=layout)), speed, 300.0 / speed)
    curve = steady_curve(COACH, radius, cant, speed)
    assert motion.distance[-1] == pytest.approx(300.0)
    assert motion.y[-1] == pytest.approx(curve.y, abs=1e-5)
    assert motion.Q[-1] == pytest.approx(curve.Q, rel=2e-3)


def test_a_straight_layout_gives_the_bits_of_no_layout():
    plain = simulate(COACH, 30.0, 0.3, initial=2e-3)
    laid = simulate(
        COACH.on(replace(COACH.track, layout=Layout([Straight(500)]))), 30.0, 0.3, initial=2e-3
    )
    for name, values in plain.columns.items():
        assert np.array_equal(values, laid.columns[name]) or name.endswith("station [m]")


def test_the_moving_frame_s_own_solver_is_exudyn_s():
    """Exudyn's RK44 on its items, with the frame's loads as an object, and the compiled motion."""
    layout = Layout(
        [Straight(10), Transition(30), Curve(400, 60, 0.1)], gradient=[(0, 0), (60, 0.01)]
    )
    coach = COACH.on(replace(COACH.track, layout=layout))
    ours, exudyn = (simulate(coach, 20.0, 2.0, solver_type=kind) for kind in (None, "RK44"))
    assert ours.y == pytest.approx(exudyn.y, abs=2e-6)
    assert pytest.approx(exudyn.Q, rel=2e-3) == ours.Q


def test_runs_that_do_not_go_with_the_irregularity_are_refused():
    rough = Irregularity.from_psd("FRA class 5", 1, length=100.0)
    coach = COACH.on(replace(COACH.track, irregularity=rough))
    with pytest.raises(AnalysisError, match="ends at 100 m, front leading runs to 130"):
        simulate(coach, 20.0, 6.0)
    fine = Irregularity.from_psd("FRA class 5", 1, length=60.0, spacing=0.01)
    with pytest.raises(AnalysisError, match=r"a step of 0.0005 s goes 0.02 m.*give step=0.00025"):
        simulate(COACH.on(replace(COACH.track, irregularity=fine)), 40.0, 0.1)


def test_where_newtons_method_ends_the_vehicle_is_driven_in_or_it_says_why_not():
    """Near 160 m the trailing wheelsets go over to their inner flanges; at 30 m/s none holds it."""
    beyond = steady_curve(COACH, 100.0, 0.0, 10.0)
    assert beyond.y[1] > 5e-3 and beyond.y[0] < -5e-3
    with pytest.raises(
        AnalysisError, match=r"beyond 0\.\d+ of .* driven into it over a transition"
    ):
        steady_curve(COACH, 100.0, 0.0, 30.0)


def test_mirrored_vehicles_on_mirrored_track():
    layout = Layout([Straight(10), Transition(30), Curve(400, 60, 0.1, widening=0.005)])
    rough = Irregularity.from_psd("ERRI B176 low", 5, length=120.0, fade_in=20.0)
    coach = COACH.on(replace(COACH.track, layout=layout, irregularity=rough))
    one, other = (simulate(vehicle, 20.0, 2.0) for vehicle in (coach, coach.mirrored()))
    # Rounding is 2e-16 m and 4e-12 of the forces of "hertz"; loads of stored energy are stationary
    # to some 1e-9.
    assert one.y == pytest.approx(-other.y, abs=1e-9 * np.abs(one.y).max())
    assert pytest.approx(other.Q[:, :, ::-1], abs=2e-8 * np.abs(one.Q).max()) == one.Q


def test_a_suspended_body_leans_as_its_springs_say():
    """k_phi (phi - phi_w) = m a h + m g h phi, phi_w the axles' roll, h over the springs."""
    radius, speed, mass, height, vertical = 4000.0, 40.0, 20.0e3, 1.8, 1.0e6
    soft = wagon(EDGES, LINEAR, mass=mass, height=height, stiffness=(1e8, 1e8, vertical))
    curve = steady_curve(soft, radius, 0.0, speed)
    arm = height - RADIUS
    axles = np.mean([curve[f"{name}: track roll"] for name in curve.wheelsets])
    # Springs at +-1 m, four of them.
    moment = mass * arm * (speed**2 / radius + GRAVITY * axles)
    known = moment / (4.0 * vertical - mass * GRAVITY * arm)
    assert curve["body: roll"] - axles == pytest.approx(known, rel=5e-3)


def test_the_pull_through_a_curve_is_what_creep_takes():
    """Work of the drawbar over the way is that of all creep forces on creepage, the wear numbers.

    To 0.5 %, with normal forces that are a gradient and do no work of their own; at a place that is
    averaged over a patch, as that of "hertz", they do (5 N here, 0.6 %).
    """
    curve = steady_curve(COACH.replace("contact.normal", "energy"), 300.0, 0.12, 18.0)
    bar = curve.system.vehicle_items.drawbar
    part = COACH.parts[bar.part].name
    pull = bar.pull - bar.stiffness * curve[f"{part}: x"]
    assert curve.wear_number().sum() == pytest.approx(pull, rel=5e-3)


def test_halving_the_step_leaves_what_is_below_20_hz():
    rough = Irregularity.from_psd("ERRI B176 low", 2, length=150.0)
    coach = COACH.on(replace(COACH.track, irregularity=rough))
    one, half = (simulate(coach, 40.0, 2.0, step=step) for step in (5e-4, 2.5e-4))
    for name in ("Q", "Y"):
        slow, finer = (low_pass(motion.time, getattr(motion, name)) for motion in (one, half))
        assert np.abs(slow - finer).max() < 0.01 * np.ptp(finer)


@pytest.mark.parametrize("normal", ["hertz", "energy"])
def test_a_curve_of_150_m_with_a_wider_gauge_balances(normal):
    """With 15 mm more, as such curves are laid, the trailing wheelsets come off their flanges."""
    coach = COACH.replace("contact.normal", normal)
    curve = steady_curve(coach, 150.0, 0.1, 10.0, widening=0.015)
    assert curve.system.unsteadiness == 0.0
    assert curve.y[0] < -6e-3 and curve.y[1] > 14e-3
    layout = Layout([Curve(150.0, 100.0, 0.1, widening=0.015)])
    motion = simulate(coach.on(replace(coach.track, layout=layout)), 10.0, 1.0, initial=curve.state)
    np.testing.assert_allclose(motion.y[-1], curve.y, atol=1e-5)
    np.testing.assert_allclose(motion.Q[-1], curve.Q, rtol=2e-3)


def test_friction_stays_where_a_drive_into_the_curve_leaves_it():
    """Faces that rub hold whatever they have come to; what is given must not move from there."""
    wagon = catalogue.vehicle("two_axle_wagon")
    curve = steady_curve(wagon, 250.0, 0.08, 12.0)
    layout = Layout([Curve(250.0, 100.0, 0.08)])
    motion = simulate(wagon.on(replace(wagon.track, layout=layout)), 12.0, 3.0, initial=curve.state)
    np.testing.assert_allclose(motion.y[-1], curve.y, atol=1e-5)
    np.testing.assert_allclose(motion.Q[-1], curve.Q, rtol=2e-3)


@pytest.mark.parametrize("law", ["polach", "fastsim"])
def test_the_work_of_creep_forces_is_the_wear_numbers_times_the_way(law):
    """Each creep force opposes its creepage, so both sums are one, but for spin beside creepage."""
    curve = steady_curve(COACH.replace("contact.creep", law), 300.0, 0.1, 15.0)
    patches = [patch for wheel in curve.patches.values() for patch in wheel]
    work = -sum(one.fx * one.creep_x + one.fy * one.creep_y + one.mz * one.spin for one in patches)
    assert curve.wear_number().sum() == pytest.approx(work, rel=5e-3)
