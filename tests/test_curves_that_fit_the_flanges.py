"""Play of the flanges against drawings, and curves and gauges that are too narrow for them."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from exudyn_wheelset import (
    AnalysisError,
    Curve,
    Irregularity,
    Layout,
    Track,
    VehicleBuilder,
    Wheelset,
    WheelsetWarning,
    catalogue,
    simulate,
    steady_curve,
)
from exudyn_wheelset.systems.fitting import check_curves, play, radial_steering_index
from exudyn_wheelset.systems.vehicle_system import vehicle_system

WHEELSET = Wheelset(mass=1500.0, inertia=(900.0, 100.0, 900.0), radius=0.46, wheel="S1002")
TRACK = Track("UIC60")


def test_play_is_that_of_the_drawings():
    """S1002 is 32.5 mm thick 10 mm below the tape circle, back to back 1360: (1435 - 1425)/2 = 5 mm
    to the gauge face; its throat meets the gauge corner on the way, and the contact is steeper than
    0.5 rad before the 7 mm at which it comes to the flank. A gauge 10 mm wider leaves 5 mm more.
    """
    shift = play(WHEELSET, TRACK)
    assert 5.0e-3 < shift < 7.2e-3
    assert play(WHEELSET, Track("UIC60", gauge=1.445)) - shift == pytest.approx(5.0e-3, abs=5e-4)
    assert play(replace(WHEELSET, wheel="cone_1_20"), TRACK) == math.inf


def test_radial_steering_index_of_a_cone_and_of_a_flanged_wheel():
    """A cone of l has dr = 2 l y: e r0/(2 l y R), over the 20 mm that count without a flange.

    To 5 %: at 20 mm the wheelset has rolled, and stands 0.3 mm beside on the arcs of its rails.
    """
    cone = replace(WHEELSET, wheel="cone_1_20")
    known = 1.5 * 0.46 / 500.0 / (2.0 * 0.05 * 0.02)
    assert radial_steering_index(cone, TRACK, -500.0) == pytest.approx(known, rel=0.05)
    # S1002 has a few millimetres of difference in its throat, enough for some hundreds of metres.
    wide, narrow = (radial_steering_index(WHEELSET, TRACK, radius) for radius in (2000.0, 200.0))
    assert narrow == pytest.approx(10.0 * wide, rel=1e-12)
    assert wide < 1.0


def wagon(*places):
    builder = VehicleBuilder("wagon", TRACK)
    for k, x in enumerate(places):
        builder.wheelset(f"axle {k}", WHEELSET, x)
    return builder.finish()


def warned(vehicle, radius, **curve):
    layout = Layout([Curve(radius, 10.0, **curve)])
    system = vehicle_system(vehicle.on(replace(TRACK, layout=layout)))
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", WheelsetWarning)
        check_curves(system.name, system.wheelsets)
    return [str(one.message) for one in found]


def test_the_middle_axle_of_three_does_not_reach_round():
    """Sagitta 3^2/(2 R), half of which the outer axles take over."""
    least = 0.25 * 9.0 / play(WHEELSET, TRACK)
    assert not warned(wagon(3.0, 0.0, -3.0), 1.1 * least)
    (message,) = warned(wagon(3.0, 0.0, -3.0), 0.9 * least)
    assert "'axle 0' to 'axle 2'" in message
    # Askew by 9 mrad the flanges leave a little less.
    asked = float(message.split("give R = ")[1].split(" m")[0])
    assert least * 0.99 < asked < 1.1 * least
    assert not warned(wagon(3.0, -3.0), 0.9 * least)
    assert not warned(wagon(3.0, 0.0, -3.0), 0.9 * least, widening=0.005)


def test_a_vehicle_across_its_track_is_refused_and_warned_of_by_every_run():
    coach = catalogue.vehicle("manchester_coach")
    with pytest.raises(AnalysisError, match=r"up to 10\.78 m .* R = 25 m: give at least 30\.8 m"):
        steady_curve(coach, 25.0, 0.0, 3.0)
    layout = Layout([Curve(25.0, 10.0)])
    with pytest.raises(AnalysisError, match="R = 25 m"):
        simulate(coach.on(replace(coach.track, layout=layout)), 3.0, 0.1)


def test_rails_closer_than_the_flanges_are_refused_with_their_place():
    distance = np.arange(0.0, 80.0, 0.5)
    narrow = np.where(np.abs(distance - 40.0) < 1.0, -0.02, 0.0)
    coach = catalogue.vehicle("manchester_coach")
    rough = Irregularity.from_points(distance, gauge=narrow)
    run = coach.on(replace(coach.track, irregularity=rough))
    with pytest.raises(AnalysisError, match=r"narrows the gauge by 20 mm at 39\.5 m, the flanges"):
        simulate(run, 10.0, 4.0, start=10.0)
    motion = simulate(run, 10.0, 0.1, start=10.0)
    assert math.isfinite(motion.y[-1, 0])


def test_running_back_before_the_first_point_is_refused():
    coach = catalogue.vehicle("manchester_coach")
    rough = Irregularity.from_points([0.0, 200.0], vertical=0.0)
    run = coach.on(replace(coach.track, irregularity=rough))
    with pytest.raises(AnalysisError, match="begins at 0 m, front trailing runs back to -1"):
        simulate(run, -20.0, 1.0, start=10.0)
