"""The paper's wheelset as lateral model and as full Exudyn model, with one set of parameters."""

from __future__ import annotations

from typing import Any

from exudyn_wheelset.catalogue.lateral_parameters import paper_parameters
from exudyn_wheelset.catalogue.lateral_wheelset import LateralWheelset
from exudyn_wheelset.catalogue.wheelset_on_frame import Suspension, WheelsetOnFrame
from exudyn_wheelset.contact.descriptions import Track, Wheelset

# What the paper leaves out, the same in every cell of Table 2; docs/table2.md gives the reasons.
WHEEL = "AAR_1_20"
RAIL = "UIC60"
GAUGE = 1.432
INCLINATION = 1.0 / 40.0
TAPE_HALF_DISTANCE = 0.75


def paper_lateral_wheelset(code: str, spring_set: int, **options: Any) -> LateralWheelset:
    """The lateral model in one of the paper's codes with spring set 1, 2 or 3."""
    return LateralWheelset(
        code,
        options.pop("parameters", None) or paper_parameters(spring_set),
        **{
            "wheel": WHEEL,
            "rail": RAIL,
            "gauge": GAUGE,
            "inclination": INCLINATION,
            "tape_half_distance": TAPE_HALF_DISTANCE,
            **options,
        },
    )


def paper_wheelset(
    spring_set: int, driven: bool = True, wheel: Any = WHEEL, rail: Any = RAIL, **contact: Any
) -> WheelsetOnFrame:
    """The full six-degree-of-freedom model of the paper's wheelset on real profiles.

    driven: the spin is held at V/r0, as in the paper's equations; False lets the wheelset find
    its own spin. contact: changes to the arguments of `contact_parameters`; the creep law is
    Polach's of 1999, as in the paper.
    """
    given = paper_parameters(spring_set)
    return WheelsetOnFrame(
        wheelset=Wheelset(
            mass=given.mass,
            inertia=(given.roll_inertia, given.spin_inertia, given.yaw_inertia),
            radius=given.radius,
            wheel=wheel,
            tape_half_distance=TAPE_HALF_DISTANCE,
        ),
        track=Track(rail, gauge=GAUGE, inclination=INCLINATION),
        suspension=Suspension(
            half_distance=given.spring_half_distance,
            stiffness=(given.longitudinal_stiffness, given.lateral_stiffness, 0.0),
        ),
        axle_load=given.axle_load,
        contact={
            "creep": "polach",
            "friction": given.friction,
            "shear_modulus": given.shear_modulus,
            "poisson": given.poisson,
            **contact,
        },
        driven=driven,
        name=f"the paper's wheelset, set {spring_set}" + ("" if driven else ", free spin"),
    )
