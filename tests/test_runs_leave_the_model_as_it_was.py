"""A run from other coordinates leaves a model's own initial values, and keeps every step.

An oscillator and a first-order decay in Exudyn: closed forms cos(w t), exp(-t/T).
"""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import (
    NodeGenericODE1,
    NodeGenericODE2,
    ObjectGenericODE1,
    ObjectGenericODE2,
)

from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.systems.exudyn_running import Runner

OMEGA, DECAY = 20.0, 3.0


@pytest.fixture
def model():
    mbs = exu.SystemContainer().AddSystem()
    node = mbs.AddNode(
        NodeGenericODE2(
            numberOfODE2Coordinates=1, referenceCoordinates=[0.0], initialCoordinates=[0.7],
            initialCoordinates_t=[-0.3],
        )
    )  # fmt: skip
    mbs.AddObject(
        ObjectGenericODE2(
            nodeNumbers=[node], massMatrix=np.eye(1), stiffnessMatrix=OMEGA**2 * np.eye(1)
        )
    )
    fading = mbs.AddNode(
        NodeGenericODE1(
            numberOfODE1Coordinates=1, referenceCoordinates=[0.0], initialCoordinates=[0.9]
        )
    )
    mbs.AddObject(ObjectGenericODE1(nodeNumbers=[fading], systemMatrix=-DECAY * np.eye(1)))
    return mbs


def initial_values(mbs):
    data, kind = mbs.systemData, exu.ConfigurationType.Initial
    return [
        np.array(values(kind))
        for values in (data.GetODE2Coordinates, data.GetODE2Coordinates_t, data.GetODE1Coordinates)
    ]


def test_a_run_from_elsewhere(model):
    runner = Runner(model, "oscillator", None, None, None)
    model.Assemble()
    before = initial_values(model)
    np.testing.assert_allclose(np.concatenate(before), [0.7, -0.3, 0.9])
    start = (np.array([0.2]), np.array([1.0]), np.array([0.5]))
    steps, duration = 400, 0.2
    outcome = runner.run(start, steps, duration)
    assert outcome.ending is Ending.FINISHED
    for now, then in zip(initial_values(model), before, strict=True):
        np.testing.assert_array_equal(now, then)
    times, (q, v, fading) = runner.recorded()
    np.testing.assert_allclose(times, np.linspace(0.0, duration, steps + 1), atol=1e-12)
    expected = 0.2 * np.cos(OMEGA * times) + np.sin(OMEGA * times) / OMEGA
    # RK44: (w h)^5/120 a step.
    np.testing.assert_allclose(q[:, 0], expected, atol=1e-8)
    rates = np.cos(OMEGA * times) - 0.2 * OMEGA * np.sin(OMEGA * times)
    np.testing.assert_allclose(v[:, 0], rates, atol=1e-7)
    np.testing.assert_allclose(fading[:, 0], 0.5 * np.exp(-DECAY * times), atol=1e-10)
    runner.run(start, steps, duration)
    np.testing.assert_array_equal(runner.recorded()[1][0], q)
