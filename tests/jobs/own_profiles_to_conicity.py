"""An own pair of profiles, given as columns, to its equivalent conicity and a figure."""

import matplotlib.pyplot as plt
import numpy as np

from exudyn_wheelset import (
    ProfileError,
    Track,
    Wheelset,
    contact_geometry,
    equivalent_conicity,
    load_profile,
)

y = np.linspace(-60e-3, 60e-3, 241)
np.savetxt("wheel.txt", np.column_stack((y, 0.05 * y)))
rail_y = np.linspace(-36e-3, 36e-3, 289)
rail_z = np.sqrt(0.05**2 - rail_y**2) - 0.05
np.savetxt("rail.txt", np.column_stack((rail_y, rail_z)))
wheel, rail = load_profile("wheel.txt", kind="wheel"), load_profile("rail.txt", kind="rail")
wheelset = Wheelset(mass=1500, inertia=(800, 110, 800), radius=0.46, wheel=wheel)
found = contact_geometry(wheelset, Track(rail=rail, inclination=0.0), np.linspace(-9e-3, 9e-3, 61))
conicity = equivalent_conicity(found.y, found.rolling_radius_difference, [3e-3])[0]
# Wickens: a cone of slope g on rails of radius R has g (b + R g)/(b - r g); b [m] to a percent.
expected = 0.05 * (0.75 + 0.05 * 0.05) / (0.75 - 0.46 * 0.05)
assert abs(conicity / expected - 1.0) < 0.01, conicity
plt.plot(found.y, found.rolling_radius_difference)
plt.savefig("conicity.png")
try:
    load_profile("no_such_file.txt")
except ProfileError as error:
    assert "no_such_file.txt" in str(error)
else:
    raise AssertionError("a file that is not there was read")
