"""States from which a motion begins."""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import number
from exudyn_wheelset.coupling.registration import WheelsetItems
from exudyn_wheelset.coupling.wheel_forces import WHEEL_VALUES
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.geometry.rigid import contact_geometry
from exudyn_wheelset.systems.exudyn_system import ExudynSystem
from exudyn_wheelset.systems.system import DynamicSystem

# Differences [m] of a wheel's height: a fiftieth of the static penetration.
_STEP = 2.0e-6
_LOAD = [name for name, _ in WHEEL_VALUES].index("Q")


def shifted_state(system: DynamicSystem, speed: float, shift: float) -> Array:
    """Steady running (n,) at a speed [m/s], all wheelsets moved to the left by `shift` [m].

    Height and roll of each follow its rails, so that its wheels carry what they carry in steady
    running. A system that knows no wheelsets is moved in its first displacement. Raises
    WheelsetError for a shift off the rails.
    """
    steady = np.array(system.equilibrium(speed))
    state = steady.copy()
    if not isinstance(system, ExudynSystem) or not system.wheelsets:
        if not system.displacement_indices:
            raise AnalysisError(f"{system.name} has no displacement to begin with: give a state")
        state[system.displacement_indices[0]] += shift
        return state
    for items, (lateral, vertical, roll) in zip(system.wheelsets, system.pose_indices, strict=True):
        if min(lateral, vertical, roll) < 0:
            # Cyclic, or held by a joint to what is moved.
            continue
        contact = items.contact
        limit = min(contact.guidance.shift)
        number(f"shift of {items.name}", shift, "m", -limit, limit, "is it given in metres?")
        here = steady[lateral] + items.reference[1]
        geometry = contact_geometry(contact.wheelset, contact.track, [here, here + shift])
        state[lateral] += shift
        state[vertical] += geometry.z[1] - geometry.z[0]
        state[roll] += geometry.roll[1] - geometry.roll[0]
        _carry(system, items, state, wheel_loads(system, items, steady), vertical, roll)
    return state


def wheel_loads(system: ExudynSystem, items: WheelsetItems, state: Array) -> Array:
    """Vertical forces [N] of the rails on the left and the right wheel at a state."""
    rows = [values[None, :] for values in system.layout.expand(state)]
    return items.contact.history(system.mbs, np.zeros(1), *rows)[0][0, :, _LOAD]


def steady_wheel_loads(system: ExudynSystem, speed: float) -> dict[tuple[str, str], float]:
    """Vertical forces [N] of the rails in steady running, by wheelset and side."""
    state = system.equilibrium(speed)
    return {
        (items.name, side): float(load)
        for items in system.wheelsets
        for side, load in zip(("left", "right"), wheel_loads(system, items, state), strict=True)
    }


def _carry(
    system: ExudynSystem,
    items: WheelsetItems,
    state: Array,
    loads: Array,
    vertical: int,
    roll: int,
) -> None:
    """Newton's method for height and roll at which the wheels carry the loads [N], in place."""
    half = items.contact.wheelset.tape_half_distance
    scales = {vertical: _STEP, roll: _STEP / half}
    for _ in range(30):
        miss = wheel_loads(system, items, state) - loads
        if np.abs(miss).max() < 1e-6 * max(1.0, np.abs(loads).max()):
            return
        columns = []
        for index, step in scales.items():
            moved = state.copy()
            moved[index] -= step
            columns.append((wheel_loads(system, items, moved) - loads - miss) / -step)
        matrix = np.column_stack(columns)
        # A wheel in the air has no stiffness: it is lowered by the least step.
        correction = np.linalg.lstsq(matrix, -miss, rcond=1e-6)[0]
        for (index, step), change in zip(scales.items(), correction, strict=True):
            state[index] += float(np.clip(change, -25.0 * step, 25.0 * step))
