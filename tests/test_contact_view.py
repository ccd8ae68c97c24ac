"""The interactive contact against the still geometry, at slider values as the mouse sets them."""

import pytest
from matplotlib.figure import Figure

from exudyn_wheelset import Track, Wheelset, WheelsetError, contact_geometry, contact_view

AXLE, TRACK = Wheelset(1500, (800, 110, 800), 0.46, "S1002"), Track("UIC60")


def test_sliders_move_the_contact():
    view = contact_view(AXLE, TRACK, figure=Figure())
    view.shift.set_val(4.0)
    view.yaw.set_val(10.0)
    still = contact_geometry(AXLE, TRACK, 4e-3, 10e-3)
    assert view.geometry.left.wheel_y[0] == pytest.approx(still.left.wheel_y[0], abs=1e-12)
    assert "y = 4.0 mm" in view.panels[0].get_title()
    # The wheel is drawn where it touches: a dot on the rail in either panel.
    assert all(panel.lines for panel in view.panels)


def test_a_wheel_that_leaves_its_rail_is_said_and_comes_back():
    view = contact_view(AXLE, TRACK, largest_shift=0.09, figure=Figure())
    view.shift.set_val(89.0)
    assert view.geometry is None
    assert "no rigid contact" in view.figure.get_suptitle()
    view.shift.set_val(0.0)
    assert view.geometry is not None
    assert "radii differ by" in view.figure.get_suptitle()


def test_ends_are_checked():
    with pytest.raises(WheelsetError, match="in metres"):
        contact_view(AXLE, TRACK, largest_shift=12.0, figure=Figure())
