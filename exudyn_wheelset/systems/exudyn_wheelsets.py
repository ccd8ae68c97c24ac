"""What an Exudyn system takes over from the wheelsets that are registered in its model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from exudyn_wheelset.contact import layout as kernel
from exudyn_wheelset.coupling.registration import WheelsetItems
from exudyn_wheelset.creep import law_of_kernel
from exudyn_wheelset.creep.slopes import CreepPatch
from exudyn_wheelset.errors import AnalysisError, ContactError
from exudyn_wheelset.geometry.rigid import contact_geometry


def check_speed_is_a_parameter(name: str, wheelsets: Sequence[WheelsetItems]) -> None:
    """Raise AnalysisError, which begins with `name`, where no contact carries the speed."""
    if not wheelsets:
        raise AnalysisError(
            f"{name}: the model has no wheelset of create_wheelset, so nothing in it is known to "
            "depend on the speed: pass set_speed(mbs, speed)"
        )
    over_ground = [items.name for items in wheelsets if not items.moving_frame]
    if over_ground:
        raise AnalysisError(
            f"{name}: {', '.join(over_ground)} run over the ground, where the speed is a motion "
            "and no parameter: create them with moving_frame=True (springs to the ground are then "
            "springs to a frame that moves at the speed), or pass set_speed"
        )


def rolling_radii(wheelsets: Sequence[WheelsetItems]) -> dict[int, float]:
    """Radius [m] on which each wheelset rolls straight, by its node.

    The mean of both wheels in rigid contact at y = 0; the nominal radius where the wheelset does
    not stand on both rails there.
    """
    radii = {}
    for items in wheelsets:
        contact = items.contact
        try:
            geometry = contact_geometry(contact.wheelset, contact.track, [0.0])
            radius = 0.5 * (geometry.left.radius[0] + geometry.right.radius[0])
        except ContactError:
            radius = contact.wheelset.radius
        radii[items.node] = float(radius)
    return radii


def patches_of(mbs: Any, items: WheelsetItems) -> tuple[CreepPatch, ...]:
    """Contact patches of a wheelset with its creep law, at the current state of `mbs`."""
    contact = items.contact
    parameters = contact.parameters.view(kernel.PARAMETERS)[0]
    law, values = law_of_kernel(parameters["law"], parameters["law_parameters"])
    forces = contact.current(mbs)
    return tuple(
        CreepPatch(
            law=law,
            creep_x=patch.creep_x,
            creep_y=patch.creep_y,
            spin=patch.spin,
            a=patch.a,
            b=patch.b,
            normal_force=patch.normal_force,
            friction=patch.friction,
            shear_modulus=float(parameters["shear_modulus"]),
            poisson=float(parameters["poisson"]),
            parameters=values,
            where=f"{items.name}, {side} wheel",
        )
        for side, patches in (("left", forces.left), ("right", forces.right))
        for patch in patches
        if patch.normal_force > 0.0
    )
