"""Numbers beside an eigenvalue, of motions that are written down instead of simulated."""

from types import SimpleNamespace

import numpy as np
import pytest

from exudyn_wheelset.results.endings import Ending
from exudyn_wheelset.stability.linear.simulated_growth import _numbers


class Written:
    """y = offset + amplitude exp(sigma t) cos(w t) of one wheelset, two wheels on 60 and 70 kN."""

    def __init__(self, root, duration):
        self.time = np.linspace(0.0, duration, 4001)
        self.speed = 30.0
        self.y = 1e-4 + 1e-3 * np.exp(root.real * self.time) * np.cos(root.imag * self.time)
        self.wheels = [("axle", "left"), ("axle", "right")]
        self.outcome = SimpleNamespace(ending=Ending.FINISHED)

    def __getitem__(self, name):
        assert name == "axle: y"
        return self.y

    def wheel(self, name, side):
        most = {"left": 6e4, "right": 7e4}[side]
        return {"normal_force [N]": np.linspace(0.5 * most, most, 5)}


@pytest.mark.parametrize("sigma", [-1.5, 0.8])
def test_growth_and_amplitudes_of_a_written_motion(sigma):
    """Growth is that of its logarithm; the last amplitude lies in the last period."""
    root, duration = complex(sigma, 12.0), 4.0
    motion = Written(root, duration)
    system = SimpleNamespace(wheelsets=[SimpleNamespace(name="axle")], lateral_indices=[1])
    linear = SimpleNamespace(state=np.array([9.0, 1e-4]))
    found = _numbers(system, linear, root, motion, 1e-3)
    period = 2.0 * np.pi / root.imag
    ends = sorted(1e-3 * np.exp(sigma * np.array([duration - period, duration])))
    # The greatest of a period: at most one of its ends, at least half a period from it.
    assert ends[0] * np.exp(-abs(sigma) * period) < found["final_amplitude"] <= ends[1] * (1 + 1e-9)
    assert found["maximum_y"] == pytest.approx(np.abs(motion.y).max())
    assert found["largest_normal_force"] == 7e4
    assert (found["simulated_time"], found["speed"]) == (duration, 30.0)
    assert (found["ending"], found["event"]) == ("FINISHED", None)
