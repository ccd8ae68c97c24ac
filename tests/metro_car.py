"""A four-wheelset metro car as a vehicle file: axle boxes on trailing arms, yaw dampers that
saturate, anti-roll bars, a wheel profile given by points, the gauge at a depth of its own.

Numbers are round ones of such cars, SI units.
"""

import math

import numpy as np

RADIUS, HALF_PIVOT, HALF_WHEELBASE = 0.42, 5.75, 1.1
BODY, FRAME, AXLE, ARM = 26000.0, 2600.0, 1200.0, 90.0
BODY_HEIGHT, FRAME_HEIGHT, SECONDARY_HEIGHT = 1.65, 0.55, 0.85
ARM_LENGTH, PRIMARY_SPACING, SECONDARY_SPACING = 0.45, 1.0, 0.9
PRIMARY, SECONDARY, SECONDARY_LATERAL = 0.9e6, 0.32e6, 0.12e6
ANTI_ROLL = 1.0e6
MASS = BODY + 2 * FRAME + 4 * AXLE + 8 * ARM


def wheel_points():
    """Tread 1:40, throat of 14 mm, flank of 68 degrees 32.5 mm thick, tip of 12 mm: y, z [m]."""
    slope = math.atan(1.0 / 40.0)
    flank = math.radians(68.0)
    tread = np.linspace(0.06, -0.0245, 60)
    y, z = list(tread), list(tread * math.tan(slope))
    y0, z0 = y[-1], z[-1]
    for angle in np.linspace(slope, flank, 40)[1:]:
        y.append(y0 - 0.014 * (math.sin(angle) - math.sin(slope)))
        z.append(z0 - 0.014 * (math.cos(slope) - math.cos(angle)))
    y0, z0 = y[-1], z[-1]
    for way in np.linspace(0.0, 0.010, 15)[1:]:
        y.append(y0 - way * math.cos(flank))
        z.append(z0 - way * math.sin(flank))
    y0, z0 = y[-1], z[-1]
    for angle in np.linspace(flank, -math.radians(40.0), 40)[1:]:
        y.append(y0 - 0.012 * (math.sin(flank) - math.sin(angle)))
        z.append(z0 - 0.012 * (math.cos(angle) - math.cos(flank)))
    return np.column_stack([y, z])[::-1]


def _table(kind, **entries):
    lines = [f"[[{kind}]]"]
    for key, value in entries.items():
        written = f'"{value}"' if isinstance(value, str) else value
        if isinstance(value, tuple):
            written = repr(value).replace("(", "[").replace(")", "]")
        lines.append(f"{key} = {written}")
    return "\n".join(lines) + "\n"


def write_metro_car(folder, contact=""):
    """Write the car and its wheel into a folder; returns the path of the vehicle file."""
    points = 1e3 * wheel_points()
    np.savetxt(folder / "metro_wheel.csv", points, delimiter=",", header="y [mm],z [mm]")
    parts = [
        'name = "metro car"\n\n[track]\nrail = "UIC60"\ngauge = 1.435\ngauge_depth = 0.016\n'
        'inclination = 0.025\n\n[contact]\ncreep = "fastsim"\nfriction = 0.35\ndamping = 0.5\n'
        + contact,
        _table(
            "body", name="body", mass=BODY, inertia=(45.0e3, 1.1e6, 1.08e6),
            centre=(0.0, 0.0, BODY_HEIGHT),
        ),
    ]  # fmt: skip
    first = True
    for truck, x in (("front", HALF_PIVOT), ("rear", -HALF_PIVOT)):
        frame = f"{truck} frame"
        parts.append(
            _table("body", name=frame, mass=FRAME, inertia=(1900.0, 1400.0, 3000.0),
                   centre=(x, 0.0, FRAME_HEIGHT))
        )  # fmt: skip
        for which, hand in (("leading", 1.0), ("trailing", -1.0)):
            axle, at = f"{truck} {which}", x + hand * HALF_WHEELBASE
            if first:
                parts.append(
                    _table("wheelset", name=axle, x=at, mass=AXLE, inertia=(700.0, 90.0, 700.0),
                           radius=RADIUS).rstrip() + '\nwheel = {file = "metro_wheel.csv", '
                    'kind = "wheel"}\n'
                )  # fmt: skip
                first = False
            else:
                parts.append(_table("wheelset", name=axle, like="front leading", x=at))
            for side, sign in (("left", 1.0), ("right", -1.0)):
                arm = f"{axle} {side} arm"
                y = sign * PRIMARY_SPACING
                pivot = at - hand * ARM_LENGTH
                parts += [
                    _table("body", name=arm, mass=ARM, inertia=(3.0, 8.0, 7.0),
                           centre=(at - 0.3 * hand * ARM_LENGTH, y, RADIUS)),
                    _table("connection", type="axle_box", between=(axle, arm),
                           at=(at, y, RADIUS)),
                    _table("connection", type="bushing", between=(arm, frame),
                           at=(pivot, y, RADIUS), stiffness=(8e6, 5e6, 8e6, 2e4, 2e3, 2e4),
                           damping=(8e3, 5e3, 8e3, 20.0, 2.0, 20.0)),
                    _table("connection", type="spring", between=(arm, frame), at=(at, y, 0.55),
                           stiffness=(0.1e6, 0.1e6, PRIMARY), damping=(0.0, 0.0, 9e3)),
                ]  # fmt: skip
        for sign in (1.0, -1.0):
            at = (x, sign * SECONDARY_SPACING, SECONDARY_HEIGHT)
            parts += [
                _table("connection", type="coil_spring", between=(frame, "body"), at=at,
                       stiffness=(SECONDARY_LATERAL, SECONDARY_LATERAL, SECONDARY)),
                _table("connection", type="damper", between=(frame, "body"), at=at,
                       direction=(0.0, 1.0, 0.0), damping=25e3, series_stiffness=6e6),
                _table("connection", type="damper", between=(frame, "body"), at=at,
                       direction=(0.0, 0.0, 1.0), damping=15e3, series_stiffness=6e6),
                _table("connection", type="damper", between=(frame, "body"),
                       at=(x, sign * 1.25, FRAME_HEIGHT), direction=(1.0, 0.0, 0.0),
                       table=((0.0, 0.0), (0.01, 6000.0), (0.02, 8000.0), (0.2, 9000.0)),
                       series_stiffness=5e6),
            ]  # fmt: skip
        middle = (x, 0.0, SECONDARY_HEIGHT)
        parts += [
            _table("connection", type="anti_roll_bar", between=(frame, "body"), at=middle,
                   stiffness=ANTI_ROLL),
            _table("connection", type="bump_stop", between=(frame, "body"), at=middle,
                   direction=(0.0, 1.0, 0.0),
                   table=((0.0, 0.0), (0.03, 0.0), (0.05, 10e3), (0.06, 60e3))),
            _table("connection", type="traction_rod", between=(frame, "body"),
                   at=(x, 0.0, FRAME_HEIGHT), stiffness=4e6, damping=2e4, length=0.8),
        ]  # fmt: skip
    path = folder / "metro.toml"
    path.write_text("\n".join(parts))
    return path
