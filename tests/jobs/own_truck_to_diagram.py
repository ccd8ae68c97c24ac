"""An own truck of three axles, by names, to its critical speed and its limit cycles."""

from exudyn_wheelset import (
    Contact,
    Spring,
    Track,
    VehicleBuilder,
    Wheelset,
    WheelsetError,
    limit_cycles,
    linear_critical_speed,
)

truck = VehicleBuilder("mine", Track("UIC60"), Contact(creep="shen-hedrick-elkins", friction=0.3))
axle = Wheelset(mass=1500, inertia=(900, 110, 900), radius=0.46, wheel="S1002")
frame = truck.body("frame", mass=30e3, inertia=(20e3, 60e3, 70e3), centre=(0, 0, 1.0))
spring = Spring(stiffness=(2e6, 0.8e6, 1e6), damping=(5e3, 8e3, 20e3))
for name, x in (("leading", 1.9), ("middle", 0.0), ("trailing", -1.9)):
    one = truck.wheelset(name, axle, x=x)
    for side, at in (("left", 1.0), ("right", -1.0)):
        truck.connect(spring, one, frame, at=(x, at, one.z), name=f"{name} {side} spring")
vehicle = truck.finish()
critical = linear_critical_speed(vehicle, 10, 120)
branch = limit_cycles(vehicle, critical, (0.8 * critical.speed, 1.2 * critical.speed))
assert 10 < critical.speed < 120 and len(branch) > 3
try:
    vehicle.replace("wheelsets.leading.mas", 1.0)
except WheelsetError as error:
    assert "mass" in str(error)
else:
    raise AssertionError("a misspelt path was taken")
