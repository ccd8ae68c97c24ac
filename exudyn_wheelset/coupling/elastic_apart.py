"""The forces of elastic rails on a wheelset, as compiled code calls them: compiled where used."""

from exudyn_wheelset.apart import Apart
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.coupling.elastic_forces import elastic_at

ELASTIC = Apart(elastic_at, "i" * 9 + "f" * 11)
_call = ELASTIC.call


@compiled
def elastic_forces(
    table, axle, velocity, rail_motion, parameters, result, elasticity, shifts, rates, slopes
):  # fmt: skip
    """As `wheelset_forces`, on rails shifted by `shifts` (4) [m] against their springs.

    elasticity: (k_y, k_z, c_y, c_z); rates (4) [m/s]: set to those of the shifts, left y, z, right
    y, z, from a guess; slopes (8) [N s/m]: of the left and the right rail's equation, from a guess,
    0 for none. rail_motion (12): of the track, to which shifts and rates are added.
    """
    _call((
        table.ctypes.data, table.size, rail_motion.ctypes.data, parameters.ctypes.data,
        result.ctypes.data, elasticity.ctypes.data, shifts.ctypes.data, rates.ctypes.data,
        slopes.ctypes.data, axle.y, axle.z, axle.lx, axle.ly, axle.lz, velocity.x, velocity.y,
        velocity.z, velocity.about_x, velocity.about_y, velocity.about_z,
    ))  # fmt: skip
