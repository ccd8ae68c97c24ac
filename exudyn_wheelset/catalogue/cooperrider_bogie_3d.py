"""The bogie of Cooperrider with Kaas-Petersen's parameters, in full three dimensions.

The lateral model of cooperrider_bogie.py takes the wheelsets' heights and rolls, gravity and
gyroscope out and has formulas for creep; here two profiled wheelsets roll on profiled rails.
Cones that, with the roll they cause on UIC60 heads, have the source's conicity 0.05; contact points
at its half distance 0.7163 m; creep by the cubic of Vermeulen and Johnson, which knows no spin; a
shear modulus that gives the mean of the source's creep coefficients f11, f22 = 6.563e6/(0.60252,
0.54219) N (tests/test_catalogue_vehicles.py). The inertia of the spin, which the source lacks, is
that of the DTU car's wheelsets. C. Kaas-Petersen, Acta Mechanica 61 (1986) 89-107. SI units.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from exudyn_wheelset.catalogue.changes import Changes
from exudyn_wheelset.catalogue.cooperrider_bogie import CooperriderBogie
from exudyn_wheelset.constants import GRAVITY
from exudyn_wheelset.vehicles.builder import VehicleBuilder
from exudyn_wheelset.vehicles.description import Vehicle
from exudyn_wheelset.vehicles.elements import Spring
from exudyn_wheelset.vehicles.rail_support import rest_on_rails

BODY_MASS = 44388.0
SPIN_INERTIA = 80.0
YAW_HALF_DISTANCE = 1.0
SHEAR_MODULUS = 1.5158e11


def cooperrider_bogie_3d(**changes: Any) -> Vehicle:
    """The bogie under a car body that runs straight; `changes` are those of `Changes`.

    Raises WheelsetError for an unknown change and for impossible values.
    """
    asked = Changes.of("cooperrider_bogie_3d", **changes)
    given = CooperriderBogie()
    yaw_inertia = given.wheelset_yaw_inertia
    wheelset = asked.wheelset(
        mass=given.wheelset_mass,
        inertia=(yaw_inertia, SPIN_INERTIA, yaw_inertia),
        radius=given.wheel_radius,
        wheel="cone_0.0482",
        tape_half_distance=0.727,
    )
    track = asked.track(rail="UIC60", inclination=0.0, datum_half_distance=0.7283)
    contact = asked.contact(
        creep="vermeulen-johnson",
        friction=0.15,
        shear_modulus=SHEAR_MODULUS,
        poisson=0.27,
    )
    car_load = 0.5 * BODY_MASS * GRAVITY
    own = (given.frame_mass + 2.0 * given.wheelset_mass) * GRAVITY
    wheel_load = 0.25 * (car_load + own)
    standing = rest_on_rails(wheelset, track, contact, np.array([wheel_load, wheel_load]))
    height = wheelset.radius + standing.height + given.primary_height
    bogie = VehicleBuilder("Cooperrider bogie in 3-D", track, contact)
    inertia = (given.frame_roll_inertia, given.frame_roll_inertia, given.frame_yaw_inertia)
    frame = bogie.body("frame", given.frame_mass, inertia, (0.0, 0.0, height))
    primary = Spring(
        (
            given.primary_longitudinal_stiffness,
            given.primary_lateral_stiffness,
            given.primary_vertical_stiffness,
        )
    )
    secondary = Spring(
        (0.0, given.secondary_lateral_stiffness, given.secondary_vertical_stiffness),
        (0.0, given.secondary_lateral_damping, given.secondary_vertical_damping),
    )
    yaw = Spring((0.5 * given.secondary_yaw_stiffness / YAW_HALF_DISTANCE**2, 0.0, 0.0))
    for which, x in (("leading", given.half_wheelbase), ("trailing", -given.half_wheelbase)):
        axle = bogie.wheelset(which, wheelset, x=x)
        for side, sign in (("left", 1.0), ("right", -1.0)):
            at = (x, sign * given.primary_half_distance, axle.z)
            bogie.connect(primary, axle, frame, at=at, name=f"{which} {side} primary")
    for side, sign in (("left", 1.0), ("right", -1.0)):
        at = (0.0, sign * given.secondary_half_distance, height + given.secondary_height)
        bogie.connect(
            secondary,
            frame,
            bogie.ground,
            at=at,
            name=f"{side} secondary",
            preload=(0.0, 0.0, 0.5 * car_load),
        )
        at = (0.0, sign * YAW_HALF_DISTANCE, height)
        name = f"{side} yaw spring"
        bogie.connect(yaw, frame, bogie.ground, at=at, name=name, preload=(0.0, 0.0, 0.0))
    return bogie.finish()
