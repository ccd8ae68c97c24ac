"""Patches of one wheel by strips and FASTSIM over them, called by address (sides_apart.py)."""

from exudyn_wheelset.addresses import numbers_at
from exudyn_wheelset.contact.layout import (
    PARAMETER_COUNT,
    PARAMETERS,
    RESULT,
    RESULT_SIZE,
    Axle,
    Slip,
    side_of,
)
from exudyn_wheelset.contact.strip_creep import strip_traction
from exudyn_wheelset.contact.strip_patches import strip_patches


def strips_at(table, size, hand, parameters, result, y, z, lx, ly, lz):
    """Fill the patches of side `hand` in a result and their count; arrays by their addresses."""
    numbers = numbers_at(table, size)
    options = numbers_at(parameters, PARAMETER_COUNT).view(PARAMETERS)[0]
    out = numbers_at(result, RESULT_SIZE).view(RESULT)[0]
    out.count[hand] = strip_patches(
        numbers, side_of(numbers, hand), Axle(y, z, lx, ly, lz), options, out.work,
        out.patches[hand],
    )  # fmt: skip


def strip_traction_at(
    parameters, result, hand, k, x, y, z, about_x, about_y, about_z, speed, traction
):  # fmt: skip
    """Write the creep force (Traction) of patch k of a side over its strips to an address."""
    options = numbers_at(parameters, PARAMETER_COUNT).view(PARAMETERS)[0]
    out = numbers_at(result, RESULT_SIZE).view(RESULT)[0]
    slip = Slip(x, y, z, about_x, about_y, about_z, speed)
    found = strip_traction(out.work.strips, out.work.shares[k], out.patches[hand][k], slip, options)
    given = numbers_at(traction, 6)
    for i in range(6):
        given[i] = found[i]
