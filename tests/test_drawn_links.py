"""What is drawn of a vehicle's connections lies between the places that it connects."""

from dataclasses import replace

import numpy as np
import pytest

from exudyn_wheelset import catalogue
from exudyn_wheelset.vehicles.links import Link, _shape, links_of


def test_a_side_bearer_stands_upright_below_the_body():
    car = catalogue.vehicle("freight_car")
    bearers = {one.at for one in car.connections if type(one.element).__name__ == "SideBearer"}
    drawn = [link for link in links_of(car) if link.kind == "block" and link.lower == link.upper]
    assert len(drawn) == len(bearers) > 0
    for link in drawn:
        assert np.array_equal(link.places[0, :2], link.places[1, :2])
        assert tuple(link.places[1]) in bearers and link.places[0, 2] < link.places[1, 2]


def test_a_telescope_reaches_from_the_one_mount_to_the_other():
    """Its case begins at the lower mount, its rod ends at the upper one, and they overlap."""
    start, end = np.array([1.0, 2.0, 3.0]), np.array([1.0, 2.6, 3.8])
    link = Link("damper", "lower", "upper", np.array([start, end]), 0.05)
    along = (end - start) / np.linalg.norm(end - start)
    reaches = []
    for part in _shape(link, start, end):
        ways = (np.reshape(part["points"], (-1, 3)) - start) @ along
        reaches.append((ways.min(), ways.max()))
    (case_begin, case_end), (rod_begin, rod_end) = reaches
    # Points of drawings are single precision at most.
    assert case_begin == pytest.approx(0.0, abs=1e-6)
    assert rod_end == pytest.approx(1.0, abs=1e-6)
    assert case_begin < rod_begin < case_end < rod_end
    assert not _shape(replace(link, places=np.array([start, start])), start, start)
