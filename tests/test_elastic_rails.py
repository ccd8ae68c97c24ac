"""Elastic rails against statics and against rails that do not give way."""

from dataclasses import fields

import exudyn as exu
import numpy as np
import pytest

from exudyn_wheelset import (
    ExudynSystem,
    Track,
    WheelsetError,
    catalogue,
    linear_critical_speed,
    simulate,
    static_equilibrium,
)
from exudyn_wheelset.catalogue.paper_wheelset import paper_wheelset
from exudyn_wheelset.contact.forces_apart import wheelset_forces
from exudyn_wheelset.contact.layout import PARAMETERS, Axle, Velocity, new_result
from exudyn_wheelset.contact.tables import contact_tables
from exudyn_wheelset.contact.wheelset_contact import contact_parameters, read_result
from exudyn_wheelset.coupling.elastic_apart import ELASTIC, elastic_forces
from exudyn_wheelset.coupling.elastic_rails import RailElasticity
from exudyn_wheelset.coupling.wheel_forces import wheel_force
from exudyn_wheelset.geometry.rigid import contact_geometry
from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.vehicles.assemble import add_vehicle


def build(elasticity):
    model = paper_wheelset(1, driven=False)
    container, mbs, items = model.build(20.0, sensors=False, show=False, rail_elasticity=elasticity)
    system = ExudynSystem(
        mbs,
        container,
        set_speed=lambda _, speed: items.contact.set_speed(speed),
        spinning_nodes={items.node: 0.3559},
    )
    return model, mbs, items, system


def test_static_deflection_is_load_over_stiffness():
    elasticity = RailElasticity()
    model, _, _, system = build(elasticity)
    state = system.equilibrium(30.0)
    left_y, left_z, right_y, right_z = state[-4:]
    # Vertical equilibrium of the wheelset fixes the load of each wheel; Newton's tolerance is
    # 1e-9 of a millimetre.
    expected = -0.5 * model.axle_load / elasticity.vertical_stiffness
    assert left_z == pytest.approx(expected, rel=1e-6)
    assert right_z == pytest.approx(expected, rel=1e-6)
    assert left_y == pytest.approx(-right_y, rel=1e-6)
    # The wheels press the rails apart: the contact planes fall towards the track centre, and the
    # spin creep force does not outweigh that.
    assert left_y > 0.0


def test_rates_satisfy_the_equation_of_the_massless_rail():
    elasticity = RailElasticity()
    _, mbs, items, system = build(elasticity)
    state = system.equilibrium(30.0)
    state[1] += 1e-3
    state[6] += 5e-3
    rates = system.derivative(state, 30.0)[-4:]
    found = items.contact.evaluate(mbs)
    forces = np.ravel([wheel_force(found, hand) for hand in range(2)])
    stiffness = np.tile([elasticity.lateral_stiffness, elasticity.vertical_stiffness], 2)
    damping = np.tile([elasticity.lateral_damping, elasticity.vertical_damping], 2)
    # The rates are the root of c d' + k d + F = 0, F of some 1e4 N, to rounding of F.
    np.testing.assert_allclose(damping * rates + stiffness * state[-4:] + forces, 0.0, atol=1e-5)


def test_stiff_rails_are_rigid_rails():
    model, _, _, system = build(RailElasticity(2e9, 6e9, 2e6, 6e6))
    rigid = linear_critical_speed(model, 20.0, 60.0)
    # Compliance changes the lateral stiffness of 4e5 N/m by 1e-4 of itself.
    assert linear_critical_speed(system, 20.0, 60.0) == pytest.approx(rigid, rel=1e-3)


def test_impossible_elasticity_names_the_mend():
    with pytest.raises(WheelsetError, match="lateral_stiffness = 0"):
        RailElasticity(lateral_stiffness=0.0)


@pytest.mark.parametrize("slopes", [(0.0,) * 4, (1e-3, -5e-4, -2e-3, 1e-3)])
@pytest.mark.parametrize("law", ["polach", "fastsim"])
def test_forces_are_those_of_rails_that_move_with_the_rates(law, slopes):
    """The same wheelset on rails that are led as the elastic ones move: one wrench."""
    wheelset, track = paper_wheelset(1).wheelset, Track("UIC60")
    table, parameters = contact_tables(wheelset, track), contact_parameters(creep=law)
    parameters.view(PARAMETERS)["rail_speed"] = 30.0
    height = float(contact_geometry(wheelset, track, [4e-3]).z[0])
    axle = Axle(4e-3, height - 3e-4, -2e-3, 1.0, 1e-4)
    velocity = Velocity(0.01, 0.02, -0.005, 0.01, 30.0 / wheelset.radius, 0.02)
    motion = np.zeros(12)
    motion[:2] = 2e-4, -1e-4
    motion[8:] = slopes
    elasticity = RailElasticity().numbers()
    shifts = np.array([1e-4, -8e-4, -1e-4, -7e-4])
    rates, slope, result = np.zeros(4), np.zeros(8), new_result()
    ELASTIC.ready()
    elastic_forces(
        table, axle, velocity, motion, parameters, result, elasticity, shifts, rates, slope
    )
    led, compared = motion.copy(), new_result()
    led[:4] += shifts
    led[4:8] += rates
    wheelset_forces(table, axle, velocity, led, parameters, compared)
    found, expected = read_result(result), read_result(compared)
    # Equal but for the order of sums.
    np.testing.assert_allclose(result[:6], compared[:6], rtol=1e-9, atol=1e-5)
    for one, other in zip(found.left + found.right, expected.left + expected.right, strict=True):
        for field in fields(one):
            values = getattr(one, field.name), getattr(other, field.name)
            np.testing.assert_allclose(*values, rtol=1e-9, atol=1e-9, err_msg=field.name)
    assert np.max(np.abs(rates)) > 1e-4


def test_a_coach_sinks_into_elastic_rails_and_stays():
    """A massless rail goes after its contact faster than steps of 0.5 ms hold."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    coach = catalogue.vehicle("manchester_coach")
    add_vehicle(mbs, coach, 18.0, show=False, sensors=False, rail_elasticity=RailElasticity())
    motion = simulate(mbs, 18.0, 0.5)
    assert motion.outcome.ending is Ending.FINISHED
    loads = motion.Q[-1]
    np.testing.assert_allclose(loads, static_equilibrium_loads(coach), rtol=5e-3)
    shift = motion["front leading rails: left z"][-1]
    assert shift == pytest.approx(-loads[0, 0] / RailElasticity().vertical_stiffness, rel=1e-2)


def static_equilibrium_loads(vehicle):
    rest = static_equilibrium(vehicle)
    return [[loads.left, loads.right] for loads in rest.wheel_loads.values()]
