"""Growth rates fitted to motions that are known: sinusoids that grow by a given rate."""

import numpy as np
import pytest

from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.growth import measure_growth


@pytest.mark.parametrize("rate", [-0.9, -0.05, 0.0, 0.4, 3.0])
@pytest.mark.parametrize("size", [1e-7, 1.0])
def test_measured_growth_of_a_known_motion(rate, size):
    """A sinusoid that grows by a known rate about a known centre, of any size."""
    t = np.linspace(1.0, 4.0, 1501)
    y = size * (np.exp(rate * t) * np.cos(2.0 * np.pi * 3.1 * t + 0.7) + 0.3)
    growth = measure_growth(t, y)
    assert growth.rate == pytest.approx(rate, abs=1e-5)
    assert growth.frequency == pytest.approx(3.1, rel=1e-6)
    assert growth.residual < 1e-5


@pytest.mark.parametrize("samples", [0, 1, 5, 400])
def test_growth_needs_two_periods(samples):
    t = np.linspace(0.0, 0.2, samples)
    with pytest.raises(AnalysisError, match="two periods"):
        measure_growth(t, np.cos(2.0 * np.pi * 3.0 * t))
