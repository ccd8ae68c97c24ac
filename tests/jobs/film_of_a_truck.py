"""A film of a running truck, without a display."""

from pathlib import Path

from exudyn_wheelset import WheelsetError, dtu_truck, film, simulate

truck = dtu_truck()
motion = simulate(truck, 25, 0.2)
written = film(truck, motion, "truck.gif", rate=10, size=(160, 120))
assert Path(written).stat().st_size > 1000
try:
    film(truck, motion, "truck.gif", view="nowhere")
except WheelsetError as error:
    assert "nowhere" in str(error)
else:
    raise AssertionError("an unknown view was taken")
