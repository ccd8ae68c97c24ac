"""Elastic rails against statics and against rails that do not give way."""

import numpy as np
import pytest

from exudyn_wheelset import ExudynSystem, WheelsetError, linear_critical_speed
from exudyn_wheelset.catalogue.paper_wheelset import paper_wheelset
from exudyn_wheelset.coupling.elastic_rails import RailElasticity, side_forces


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
    forces = np.zeros(4)
    side_forces(items.contact.evaluate(mbs), forces)
    stiffness = np.tile([elasticity.lateral_stiffness, elasticity.vertical_stiffness], 2)
    damping = np.tile([elasticity.lateral_damping, elasticity.vertical_damping], 2)
    # The rates are the root of c d' + k d + F = 0, F of some 1e4 N; Newton leaves its last step.
    np.testing.assert_allclose(damping * rates + stiffness * state[-4:] + forces, 0.0, atol=1e-2)


def test_stiff_rails_are_rigid_rails():
    model, _, _, system = build(RailElasticity(2e9, 6e9, 2e6, 6e6))
    rigid = linear_critical_speed(model, 20.0, 60.0)
    # Compliance changes the lateral stiffness of 4e5 N/m by 1e-4 of itself.
    assert linear_critical_speed(system, 20.0, 60.0) == pytest.approx(rigid, rel=1e-3)


def test_impossible_elasticity_names_the_mend():
    with pytest.raises(WheelsetError, match="lateral_stiffness = 0"):
        RailElasticity(lateral_stiffness=0.0)
