"""Patches of one wheel by Ritz's method, called by address (sides_apart.py)."""

from exudyn_wheelset.addresses import numbers_at
from exudyn_wheelset.contact.layout import (
    PARAMETER_COUNT,
    PARAMETERS,
    RESULT,
    RESULT_SIZE,
    Axle,
    Material,
    side_of,
)
from exudyn_wheelset.contact.load_patches import load_patches
from exudyn_wheelset.contact.search import find_lobes


def ritz_at(table, size, hand, parameters, result, y, z, lx, ly, lz):
    """Fill the patches of side `hand` in a result and their count; arrays by their addresses."""
    numbers = numbers_at(table, size)
    options = numbers_at(parameters, PARAMETER_COUNT).view(PARAMETERS)[0]
    out = numbers_at(result, RESULT_SIZE).view(RESULT)[0]
    side = side_of(numbers, hand)
    axle = Axle(y, z, lx, ly, lz)
    material = Material(options.shear_modulus, options.poisson)
    found = find_lobes(numbers, side, axle, out.work)
    out.count[hand] = load_patches(
        numbers, side, found, axle, material, out.work, out.patches[hand]
    )
