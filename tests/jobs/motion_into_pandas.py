"""A motion into a table of pandas and back from a file."""

from exudyn_wheelset import Motion, WheelsetError, dtu_truck, simulate

motion = simulate(dtu_truck(), speed=20.0, duration=0.2)
table = motion.to_pandas()
assert len(table) == len(motion.time)
motion.save("motion.npz")
assert (Motion.load("motion.npz").time == motion.time).all()
try:
    simulate(dtu_truck(), speed=float("nan"), duration=0.2)
except WheelsetError as error:
    assert "speed" in str(error)
else:
    raise AssertionError("a speed that is no number was taken")
