"""The rails' forces on a wheelset, as compiled code calls them."""

from exudyn_wheelset.apart import Apart
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.forces import forces_at

FORCES = Apart(forces_at, "iiiii" + "fffff" + "ffffff")
_call = FORCES.call


@compiled
def wheelset_forces(table, axle, velocity, rail_motion, parameters, result):
    """Fill `result` with the wrench on the wheelset and its patches; return nothing.

    table: contact_tables(). axle (Axle): y, z [m] of the centre, z from `radius` above the rail
    tops, and the axle's unit vector; velocity (Velocity) of the centre over the ground and
    angular, track frame. rail_motion (12): lateral and vertical shift of the left and the right
    rail [m], their velocities if they move [m/s], their slopes [-]. parameters:
    contact_parameters(); result: new_result().
    Patches come back in the axes that follow their rail, on the right side too with y to the
    left; positions and angles count towards the field side.
    """
    _call((
        table.ctypes.data, table.size, rail_motion.ctypes.data, parameters.ctypes.data,
        result.ctypes.data, axle.y, axle.z, axle.lx, axle.ly, axle.lz, velocity.x, velocity.y,
        velocity.z, velocity.about_x, velocity.about_y, velocity.about_z,
    ))  # fmt: skip
