"""Creep laws: from creepage, spin and contact patch to the forces that friction transmits.

One law a module, all with the same kernel signature; `registry` knows them by name.
"""

from exudyn_wheelset.creep.kalker import kalker_coefficients
from exudyn_wheelset.creep.kernel_apart import creep_kernel
from exudyn_wheelset.creep.law import CreepLaw, CreepParameter
from exudyn_wheelset.creep.registry import (
    CREEP_LAWS,
    creep_force,
    creep_law,
    creep_parameters,
    law_of_kernel,
    register_creep_law,
)

__all__ = [
    "CREEP_LAWS",
    "CreepLaw",
    "CreepParameter",
    "creep_force",
    "creep_kernel",
    "creep_law",
    "creep_parameters",
    "kalker_coefficients",
    "law_of_kernel",
    "register_creep_law",
]
