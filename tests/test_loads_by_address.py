"""Loads that read Exudyn's memory against loads that copy it: the same bits, whatever happens.

The copying loads ask Exudyn for its coordinates at every call and keep nothing between calls, so
they cannot be stale and know no address of Exudyn's. Both run the same compiled code: sums are in
any order in it, and two compilations of it need not agree in the last bit.
"""

import exudyn as exu
import numpy as np
import pytest

from exudyn_wheelset import Track, Wheelset, create_wheelset, dtu_truck, wheelsets_of
from exudyn_wheelset.addresses import address_of
from exudyn_wheelset.coupling.wheelset_kernel import wrench_at

WHEELSET = Wheelset(mass=1813.0, inertia=(1120.0, 112.0, 1120.0), radius=0.46, wheel="S1002")


def copying_loads(mbs):
    """Replace the loads of all wheelsets by ones that copy the coordinates."""
    for items in wheelsets_of(mbs):
        for part, load in ((0, items.force_load), (1, items.torque_load)):

            def wrench(mbs, t, load, contact=items.contact, node=items.node, part=part):
                data = mbs.systemData
                q, v = np.array(data.GetODE2Coordinates()), np.array(data.GetODE2Coordinates_t())
                first = int(data.GetNodeLTGODE2(node)[0])
                table, state, track = contact.arrays
                contact.forget()
                arrays = (q, v, table, state, track)
                sizes = (len(q), len(table), len(state), len(track))
                block = np.array([*map(address_of, arrays), *sizes, first, part, 0], dtype=np.int64)
                return wrench_at(address_of(block), t)

            mbs.SetLoadParameter(load, "loadVectorUserFunction", wrench)


def truck():
    container, mbs, _ = dtu_truck().build(45.0, sensors=False, show=False, lateral_offset=3e-3)
    return container, mbs


def solve(mbs, solver, step, jacobian=0, steps=40):
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = steps * step
    settings.timeIntegration.computeLoadsJacobian = jacobian
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    kind = exu.DynamicSolverType.__members__[solver]
    assert mbs.SolveDynamic(settings, solverType=kind, showHints=False)
    data = mbs.systemData
    return np.concatenate([data.GetODE2Coordinates(), data.GetODE2Coordinates_t()])


@pytest.mark.parametrize(
    ("solver", "step", "jacobian"),
    [
        ("ExplicitEuler", 2e-5, 0),
        ("RK44", 2e-4, 0),
        ("RK67", 2e-4, 0),
        ("DOPRI5", 2e-4, 0),
        ("TrapezoidalIndex2", 2e-4, 0),
        ("TrapezoidalIndex2", 2e-4, 2),
        ("GeneralizedAlpha", 2e-4, 0),
        ("GeneralizedAlpha", 2e-4, 1),
        ("GeneralizedAlpha", 2e-4, 2),
    ],
)
def test_the_same_bits_in_every_solver(solver, step, jacobian):
    ends = []
    for copying in (False, True):
        _container, mbs = truck()
        if copying:
            copying_loads(mbs)
        mbs.Assemble()
        first = solve(mbs, solver, step, jacobian)
        mbs.Assemble()
        ends.append([first, solve(mbs, solver, step, jacobian)])
        assert np.array_equal(*ends[-1])
    assert np.array_equal(*ends)
    # Contact has done something: the wheelsets were released 3 mm beside the track's middle.
    assert abs(ends[0][0][1]) > 1e-5


def test_items_added_after_a_run_move_the_coordinates():
    """A second Assemble with more bodies moves Exudyn's vectors elsewhere."""
    for more in (1, 3, 40):
        ends = []
        for copying in (False, True):
            container = exu.SystemContainer()
            mbs = container.AddSystem()
            options = {"moving_frame": True, "show": False, "lateral_offset": 2e-3}
            create_wheelset(mbs, WHEELSET, Track("UIC60"), **options)
            mbs.Assemble()
            solve(mbs, "RK44", 2e-4)
            for _ in range(more):
                create_wheelset(mbs, WHEELSET, Track("UIC60"), **options)
            if copying:
                copying_loads(mbs)
            mbs.Assemble()
            ends.append(solve(mbs, "RK44", 2e-4))
        assert np.array_equal(*ends)
        assert len(ends[0]) == 12 * (1 + more)


def test_states_set_from_outside_are_seen():
    _container, mbs = truck()
    mbs.Assemble()
    items = wheelsets_of(mbs)[0]
    data = mbs.systemData
    solve(mbs, "RK44", 2e-4)
    q = data.GetODE2Coordinates()
    forces = []
    for shift in (0.0, 1e-3, 0.0):
        moved = np.array(q)
        moved[int(data.GetNodeLTGODE2(items.node)[0]) + 1] += shift
        data.SetODE2Coordinates(moved)
        forces.append(np.array(mbs.GetLoadValues(items.force_load)))
    assert np.array_equal(forces[0], forces[2])
    assert np.abs(forces[0] - forces[1]).max() > 100.0
    system = data.GetSystemState()
    data.SetODE2Coordinates(np.array(q) + 1e-3)
    data.SetSystemState(system)
    assert np.array_equal(np.array(mbs.GetLoadValues(items.force_load)), forces[0])
