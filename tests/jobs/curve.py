"""A coach's bogie in steady running through a curve."""

from exudyn_wheelset import WheelsetError, catalogue, steady_curve

coach = catalogue.vehicle("manchester_coach")
curve = steady_curve(coach, radius=300, cant=0.12, speed=18)
assert curve.motion.y.shape == (1, 4)
# To the outside of a curve to the left, where the flange of the leading wheelset runs.
assert curve.motion.y[0, 0] < -4e-3
try:
    steady_curve(coach, radius=0.0, cant=0.12, speed=18)
except WheelsetError as error:
    assert "radius" in str(error)
else:
    raise AssertionError("a curve without a radius was taken")
