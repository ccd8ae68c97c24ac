"""One compiled entry for all creep laws; compiled code calls it by kernel_apart.py.

A chain over whole numbers, because compiled code that calls functions by reference cannot be kept
on disk; a law of one's own is called by its address (exudyn_wheelset.creep.own).
"""

from __future__ import annotations

from exudyn_wheelset.addresses import numbers_at
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.creep.exact import LAW as EXACT
from exudyn_wheelset.creep.exact_apart import exact_law
from exudyn_wheelset.creep.exact_table import LAW as EXACT_TABLE
from exudyn_wheelset.creep.exact_table import exact_table
from exudyn_wheelset.creep.fastsim_rows import fastsim_rows
from exudyn_wheelset.creep.linear import LAW as LINEAR
from exudyn_wheelset.creep.linear import linear
from exudyn_wheelset.creep.own import OWN_LAW, call_law
from exudyn_wheelset.creep.polach import LAW as POLACH
from exudyn_wheelset.creep.polach import polach
from exudyn_wheelset.creep.polach_2005 import LAW as POLACH_2005
from exudyn_wheelset.creep.polach_2005 import polach_2005
from exudyn_wheelset.creep.polach_kalker import LAW as POLACH_KALKER
from exudyn_wheelset.creep.polach_kalker import polach_kalker
from exudyn_wheelset.creep.shen_hedrick_elkins import LAW as SHEN_HEDRICK_ELKINS
from exudyn_wheelset.creep.shen_hedrick_elkins import shen_hedrick_elkins
from exudyn_wheelset.creep.vermeulen_johnson import LAW as VERMEULEN_JOHNSON
from exudyn_wheelset.creep.vermeulen_johnson import vermeulen_johnson

_LINEAR = LINEAR.number
_VERMEULEN_JOHNSON = VERMEULEN_JOHNSON.number
_SHEN_HEDRICK_ELKINS = SHEN_HEDRICK_ELKINS.number
_POLACH = POLACH.number
_POLACH_2005 = POLACH_2005.number
_POLACH_KALKER = POLACH_KALKER.number
_EXACT = EXACT.number
_EXACT_TABLE = EXACT_TABLE.number


@compiled
def law_force(law_number, state):
    """(F_x, F_y, M_z) by the law of a number; state: what `creep_kernel` takes after it."""
    if law_number == _POLACH:
        return polach(*state)
    if law_number == _LINEAR:
        return linear(*state)
    if law_number == _VERMEULEN_JOHNSON:
        return vermeulen_johnson(*state)
    if law_number == _SHEN_HEDRICK_ELKINS:
        return shen_hedrick_elkins(*state)
    if law_number == _POLACH_2005:
        return polach_2005(*state)
    if law_number == _EXACT_TABLE:
        return exact_table(*state)
    if law_number == _EXACT:
        return exact_law(*state)
    if law_number == _POLACH_KALKER:
        return polach_kalker(*state)
    if law_number == OWN_LAW:
        return call_law(*state)  # type: ignore[call-arg]
    return fastsim_rows(*state)


def force_at(
    law_number, creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson,
    parameters, count, forces,
):  # fmt: skip
    """Write (F_x, F_y, M_z) to an address; parameters: address of `count` numbers."""
    given = numbers_at(forces, 3)
    given[0], given[1], given[2] = law_force(law_number, (
        creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson,
        numbers_at(parameters, count),
    ))  # fmt: skip
