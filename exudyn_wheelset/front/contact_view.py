"""An interactive look at a contact: both wheels over their rails, sliders for shift and yaw.

    view = contact_view(wheelset, track)
    view.show()

Drawn as `geometry_plots.draw_wheels_on_rails` draws it; Matplotlib's own widgets. Shift in mm and
yaw in mrad on the sliders, positive to the left and nose to the left.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.widgets import Slider

from exudyn_wheelset.checking import number
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.errors import ContactError
from exudyn_wheelset.front.geometry_plots import draw_wheels_on_rails
from exudyn_wheelset.front.plots import pair_name, tidy
from exudyn_wheelset.geometry.rigid import ContactGeometry, contact_geometry
from exudyn_wheelset.spelling import spelt


@dataclass
class ContactView:
    """A figure of a pair in contact with its sliders, which live as long as this object.

    figure; shift [mm], yaw [mrad]: sliders; geometry: the contact shown, None where a wheel has
    left its rail.
    """

    wheelset: Wheelset
    track: Track
    figure: Any
    panels: tuple[Axes, Axes]
    shift: Slider
    yaw: Slider
    geometry: ContactGeometry | None = None

    def draw(self, _: float = 0.0) -> None:
        """Draw the contact at the sliders' values."""
        y, yaw = 1e-3 * self.shift.val, 1e-3 * self.yaw.val
        try:
            self.geometry = contact_geometry(self.wheelset, self.track, y, yaw)
        except ContactError as error:
            self.geometry = None
            self.figure.suptitle(str(error), fontsize=9, color="crimson")
            self.figure.canvas.draw_idle()
            return
        for panel in self.panels:
            panel.clear()
            tidy(panel)
        draw_wheels_on_rails(self.panels, self.wheelset, self.track, self.geometry, 0)
        difference = 1e3 * self.geometry.rolling_radius_difference[0]
        roll = 1e3 * self.geometry.roll[0]
        self.figure.suptitle(
            f"{pair_name(self.wheelset, self.track)}: radii differ by {difference:+.2f} mm, "
            f"roll {roll:+.2f} mrad",
            fontsize=10,
            color="black",
        )
        self.figure.canvas.draw_idle()

    def show(self) -> None:
        """Open a window; returns when it is closed."""
        import matplotlib.pyplot as plt

        plt.show()


@spelt
def contact_view(
    wheelset: Wheelset,
    track: Track,
    largest_shift: float = 0.012,
    largest_yaw: float = 0.05,
    figure: Figure | None = None,
) -> ContactView:
    """Both wheels over their rails, with sliders for lateral shift and yaw.

    largest_shift [m], largest_yaw [rad]: ends of the sliders; figure: to draw into, a new one of
    pyplot if left out. Keep what is returned: sliders without a reference stop to answer.
    Raises WheelsetError for ends out of range.

    Examples
    --------
    >>> from exudyn_wheelset import Track, Wheelset, contact_view
    >>> axle = Wheelset(1500, (800, 110, 800), 0.46, "S1002")
    >>> view = contact_view(axle, Track("UIC60"))
    >>> view.shift.set_val(3.0)  # what the mouse does
    >>> round(1e3 * float(view.geometry.rolling_radius_difference[0]), 2)  # [mm]
    0.99
    """
    largest_shift = number("largest_shift", largest_shift, "m", 1e-4, 0.1, "in metres")
    largest_yaw = number("largest_yaw", largest_yaw, "rad", 1e-4, 0.3, "in radians")
    if figure is None:
        import matplotlib.pyplot as plt

        figure = plt.figure(figsize=(10.0, 5.6))
    # Seen from behind: the left wheel on the left.
    left = figure.add_axes((0.07, 0.27, 0.42, 0.6))
    right = figure.add_axes((0.55, 0.27, 0.42, 0.6))
    places = [figure.add_axes((0.2, height, 0.6, 0.04)) for height in (0.12, 0.05)]
    ends = (1e3 * largest_shift, 1e3 * largest_yaw)
    shift = Slider(places[0], "shift [mm]", -ends[0], ends[0], valinit=0.0)
    yaw = Slider(places[1], "yaw [mrad]", -ends[1], ends[1], valinit=0.0)
    view = ContactView(wheelset, track, figure, (left, right), shift, yaw)
    shift.on_changed(view.draw)
    yaw.on_changed(view.draw)
    view.draw()
    return view
