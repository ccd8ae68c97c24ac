"""The exact law, as compiled code calls it: apart, for it takes long to compile."""

from exudyn_wheelset.addresses import numbers_at
from exudyn_wheelset.apart import Apart
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.exact import exact


def exact_at(
    creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson, along, across,
    forces,
):  # fmt: skip
    """Write (F_x, F_y, M_z) on a grid of along x across cells to an address."""
    given = numbers_at(forces, 3)
    given[0], given[1], given[2] = exact(
        creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson,
        (along, across),
    )  # fmt: skip


EXACT_LAW = Apart(exact_at, 11 * "f", results=3)
_call = EXACT_LAW.call


@compiled
def exact_law(
    creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson, parameters
):  # fmt: skip
    """As `exact`."""
    return _call((
        creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson,
        parameters[0], parameters[1],
    ))  # fmt: skip
