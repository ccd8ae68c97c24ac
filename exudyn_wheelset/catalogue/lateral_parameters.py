"""Parameters of the lateral wheelset: Table 1 of the paper, with its three sets of springs."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace

from exudyn_wheelset.checking import number, positive
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt, spelt_class

# Unit and largest value of each parameter.
_BOUNDS = {
    "mass": ("kg", 1e5),
    "roll_inertia": ("kg m^2", 1e5),
    "spin_inertia": ("kg m^2", 1e5),
    "yaw_inertia": ("kg m^2", 1e5),
    "radius": ("m", 2.0),
    "contact_half_distance": ("m", 2.0),
    "spring_half_distance": ("m", 3.0),
    "longitudinal_stiffness": ("N/m", 1e10),
    "lateral_stiffness": ("N/m", 1e10),
    "longitudinal_damping": ("N s/m", 1e8),
    "lateral_damping": ("N s/m", 1e8),
    "conicity": ("-", 1.0),
    "axle_load": ("N", 1e6),
    "friction": ("-", 5.0),
    "shear_modulus": ("Pa", 1e13),
    "poisson": ("-", 0.5),
    "rail_head_radius": ("m", 10.0),
}


@spelt_class
@dataclass(frozen=True)
class LateralParameters:
    """Parameters of the lateral model; the defaults are Table 1, set 1, and docs/table2.md.

    mass [kg]; roll_inertia, spin_inertia, yaw_inertia [kg m^2] about x, y, z; radius r0 [m];
    contact_half_distance g_a [m] (knife-edge codes); spring_half_distance b [m];
    longitudinal_stiffness k_x, lateral_stiffness k_y [N/m] and longitudinal_damping,
    lateral_damping [N s/m] of one side; conicity [-]; axle_load W_a [N] with the wheelset's
    weight; friction [-]; shear_modulus [Pa]; poisson [-]; rail_head_radius [m], which gives the
    knife-edge codes their contact ellipse.

    Examples
    --------
    >>> from exudyn_wheelset import LateralParameters
    >>> LateralParameters(mass=1800).radius
    0.3556
    """

    mass: float = 1751.0
    roll_inertia: float = 761.0
    spin_inertia: float = 130.0
    yaw_inertia: float = 761.0
    radius: float = 0.3556
    contact_half_distance: float = 0.716
    spring_half_distance: float = 0.610
    longitudinal_stiffness: float = 2.85e5
    lateral_stiffness: float = 1.84e5
    longitudinal_damping: float = 0.0
    lateral_damping: float = 0.0
    conicity: float = 0.05
    axle_load: float = 150.0e3
    friction: float = 0.3
    shear_modulus: float = 80.0e9
    poisson: float = 0.27
    rail_head_radius: float = 0.3

    def __post_init__(self) -> None:
        for name, value in asdict(self).items():
            unit, high = _BOUNDS[name]
            if name.endswith("damping") or name == "poisson":
                number(name, value, unit, 0.0, high)
            else:
                positive(name, value, unit, high)


# k_x, k_y [N/m] of Table 1.
PAPER_SPRINGS = ((2.85e5, 1.84e5), (2.85e6, 1.84e6), (9.12e6, 5.84e6))


@spelt
def paper_parameters(spring_set: int, **changes: float) -> LateralParameters:
    """Parameters of Table 1 with spring set 1, 2 or 3, SI; changes: of LateralParameters, by name.

    Raises WheelsetError for another set and for impossible values.

    Examples
    --------
    >>> from exudyn_wheelset import paper_parameters
    >>> paper_parameters(2).lateral_stiffness > paper_parameters(1).lateral_stiffness
    True
    """
    if isinstance(spring_set, bool) or spring_set not in (1, 2, 3):
        raise WheelsetError(f"spring_set = {spring_set!r}: Table 1 has the sets 1, 2 and 3")
    k_x, k_y = PAPER_SPRINGS[spring_set - 1]
    return replace(
        LateralParameters(), longitudinal_stiffness=k_x, lateral_stiffness=k_y, **changes
    )
