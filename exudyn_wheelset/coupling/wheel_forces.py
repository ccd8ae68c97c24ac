"""Forces of the rails on single wheels and values of their contacts, from one contact evaluation.

Q is the vertical force of the rail on the wheel, upwards, Y the lateral one, to the left; sensors,
motions, statics and elastic rails take both from here. Of several patches on a wheel forces are
summed, and so are their wear numbers |F_x xi_x| + |F_y xi_y| + |M_z phi|, the energy that creep
takes a metre of way; the other values are means weighted with the normal force. flange_Q and
flange_Y are the parts of patches on the flange. Track frame, SI.
"""

from __future__ import annotations

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.layout import RESULT

# Names and units of what `wheel_values` fills.
WHEEL_VALUES = (
    ("normal_force", "N"),
    ("fx", "N"),
    ("fy", "N"),
    ("creep_x", "-"),
    ("creep_y", "-"),
    ("spin", "1/m"),
    ("wheel_y", "m"),
    ("rail_y", "m"),
    ("angle", "rad"),
    ("radius", "m"),
    ("penetration", "m"),
    ("patches", "-"),
    ("Q", "N"),
    ("Y", "N"),
    ("wear_number", "N"),
    ("flange_Q", "N"),
    ("flange_Y", "N"),
)
# A patch whose plane is steeper than this [rad] is on the flange: treads and their throats run up
# to some 20 degrees where a wheel is guided by its tread, flanges have 60 to 75.
FLANGE_ANGLE = 0.5


@compiled
def wheel_force(result, hand):
    """Return Y and Q [N] of one wheel: hand 0 is left, 1 right."""
    record = result.view(RESULT)[0]
    lateral = 0.0
    vertical = 0.0
    for k in range(record.count[hand]):
        patch = record.patches[hand, k]
        ny, nz = patch.normal[1], patch.normal[2]
        lateral += nz * patch.fy + ny * patch.normal_force
        vertical += nz * patch.normal_force - ny * patch.fy
    return lateral, vertical


@compiled
def wheel_values(result, hand, values):
    """Fill values (17) of one wheel in the order of WHEEL_VALUES."""
    record = result.view(RESULT)[0]
    values[:] = 0.0
    total = 0.0
    for k in range(record.count[hand]):
        total += record.patches[hand, k].normal_force
    for k in range(record.count[hand]):
        patch = record.patches[hand, k]
        weight = patch.normal_force / total if total > 0.0 else 0.0
        values[1] += patch.fx
        values[2] += patch.fy
        values[3] += weight * patch.creep_x
        values[4] += weight * patch.creep_y
        values[5] += weight * patch.spin
        values[6] += weight * patch.wheel_y
        values[7] += weight * patch.rail_y
        values[8] += weight * patch.angle
        values[9] += weight * patch.radius
        values[10] += weight * patch.penetration
        values[14] += abs(patch.fx * patch.creep_x) + abs(patch.fy * patch.creep_y)
        values[14] += abs(patch.mz * patch.spin)
        if abs(patch.angle) > FLANGE_ANGLE:
            ny, nz = patch.normal[1], patch.normal[2]
            values[15] += nz * patch.normal_force - ny * patch.fy
            values[16] += nz * patch.fy + ny * patch.normal_force
    values[0] = total
    values[11] = record.count[hand]
    values[13], values[12] = wheel_force(result, hand)
