"""Forces on rails whose profile changes along the track: which shapes a wheelset stands on.

Blends, levels and weights: contact/changing_rails.py. What a kernel needs stands in one array, told
by its address: the number of blends, first station and length of each, then address and length of
the table of each level, at the end those of room for a second result. SI, track frame.
"""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.addresses import address_of, numbers_at
from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact import layout as kernel
from exudyn_wheelset.contact.changing_rails import LEVELS, rail_levels
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.contact.forces_apart import wheelset_forces
from exudyn_wheelset.contact.layout import MOST_PATCHES, RESULT_SIZE
from exudyn_wheelset.contact.tables import contact_tables


class ChangingRails:
    """The tables of a wheelset on rails that change, and the array that tells of them."""

    def __init__(self, wheelset: Wheelset, track: Track) -> None:
        blends, tracks = rail_levels(track)
        # Alive as long as their addresses are used; tables are kept by the identity of both.
        self.tracks = tracks
        self.tables = [contact_tables(wheelset, one) for one in tracks]
        self.room = kernel.new_result()
        arrays = [*self.tables, self.room]
        places = [(float(address_of(one)), float(len(one))) for one in arrays]
        self.array = np.concatenate([[float(len(blends))], np.ravel([*blends, *places])])

    def numbers(self) -> tuple[float, float]:
        """Address and length of the array."""
        return float(address_of(self.array)), float(len(self.array))


@compiled
def rails_at(rails, station):
    """Number of the level that a station stands on, and the weight of the next one."""
    blends = int(rails[0])
    level = 0
    for k in range(blends):
        x = (station - rails[1 + 2 * k]) / rails[2 + 2 * k]
        if x <= 0.0:
            return level, 0.0
        if x < 1.0:
            t = LEVELS * x * x * (3.0 - 2.0 * x)
            j = min(int(t), LEVELS - 1)
            return level + j, t - j
        level += LEVELS
    return level, 0.0


@compiled
def _table(rails, level):
    at = 1 + 2 * int(rails[0]) + 2 * level
    return numbers_at(int(rails[at]), int(rails[at + 1]))


@compiled
def mix_results(result, other, weight):
    """Let `result` be the forces on both: 1 - weight of its own, weight of the other's."""
    out = result.view(kernel.RESULT)[0]
    more = other.view(kernel.RESULT)[0]
    for k in range(3):
        out.force[k] += weight * (more.force[k] - out.force[k])
        out.moment[k] += weight * (more.moment[k] - out.moment[k])
    for hand in range(2):
        patches = out.patches[hand]
        count = out.count[hand]
        for k in range(count):
            _scale(patches[k], 1.0 - weight)
        for k in range(more.count[hand]):
            if count == MOST_PATCHES:
                break
            patches[count] = more.patches[hand, k]
            _scale(patches[count], weight)
            count += 1
        out.count[hand] = count


@compiled
def _scale(patch, factor):
    patch.normal_force *= factor
    patch.fx *= factor
    patch.fy *= factor
    patch.mz *= factor
    patch.energy *= factor
    patch.twist *= factor


@compiled
def changing_forces(sections, station, axle, velocity, motion, parameters, result):
    """As `wheelset_forces`, on the rails of a station [m]; sections: address and length (2).

    Within a blend a wheel has the patches of both shapes, each with its part of the forces.
    """
    rails = numbers_at(int(sections[0]), int(sections[1]))
    level, weight = rails_at(rails, station)
    wheelset_forces(_table(rails, level), axle, velocity, motion, parameters, result)
    if weight > 0.0:
        end = len(rails)
        room = numbers_at(int(rails[end - 2]), RESULT_SIZE)
        wheelset_forces(_table(rails, level + 1), axle, velocity, motion, parameters, room)
        mix_results(result, room, weight)
