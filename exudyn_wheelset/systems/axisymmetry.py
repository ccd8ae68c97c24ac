"""What a system with cyclic spin angles must be: equations that do not know the angle of spin.

Bodies that spin about their own y axis need Ix = Iz, and forces that act on the axle itself. Both
are asked of the assembled model: its mass matrix, and its forces at two angles of spin.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.systems.exudyn_layout import Layout

# Turns a spinning body far enough for what is fixed beside its axle to be seen [rad].
SPIN_ANGLE = 1.0
# Shifts, in scales, at which the mass matrix is compared with that of the reference configuration.
_SHIFTS = (20.0, -37.0)


def inverse_mass(
    name: str,
    layout: Layout,
    scales: Array,
    state_names: Sequence[str],
    mass_matrix: Callable[[Array], Array],
) -> tuple[Array, bool]:
    """Inverse (nq, nq) of the mass matrix, and whether it is the same at some distance.

    mass_matrix: at second-order coordinates (nq,). Raises AnalysisError where spinning bodies are
    not axisymmetric and where a coordinate has no mass.
    """
    order = len(layout.position_of)
    order1 = len(scales) - layout.positions - order
    at_rest = np.zeros((1, order)), np.zeros((1, order)), np.zeros((1, order1))
    matrices = []
    for factor in (0.0, *_SHIFTS):
        shifted = layout.reduce(*at_rest)[0]
        shifted[: layout.positions] += factor * scales[: layout.positions]
        matrices.append(mass_matrix(layout.expand(shifted)[0]))
    mass = matrices[0]
    _check_axisymmetry(name, layout, mass)
    size = np.abs(mass).max()
    constant = all(
        np.allclose(matrix, mass, rtol=0.0, atol=1e-12 * size) for matrix in matrices[1:]
    )
    try:
        return np.linalg.inv(mass), constant
    except np.linalg.LinAlgError:
        massless = [
            state_names[layout.positions + index]
            for index in np.flatnonzero(np.abs(mass).sum(axis=1) == 0.0).tolist()
        ]
        raise AnalysisError(
            f"{name}: the mass matrix is singular (without mass: "
            f"{', '.join(massless) or 'a combination of coordinates'}); give it a mass"
        ) from None


def _check_axisymmetry(name: str, layout: Layout, mass: Array) -> None:
    """Spinning bodies must look the same at every spin angle; AnalysisError otherwise."""
    for first, _, spins in layout.rotations:
        inertia = mass[first : first + 3, first : first + 3]
        size = abs(inertia[0, 0])
        if spins and max(abs(inertia[0, 0] - inertia[2, 2]), abs(inertia[0, 2])) > 1e-6 * size:
            raise AnalysisError(
                f"{name}: a body that spins about y has the inertia {inertia[0, 0]:g} about x, but "
                f"{inertia[2, 2]:g} kg m^2 about z: its equations then change with the spin angle "
                "and there is no steady run; give it Ix = Iz"
            )


def check_spin(
    name: str,
    layout: Layout,
    scales: Array,
    state_names: Sequence[str],
    force: Callable[[Array, Array, Array], Array],
) -> None:
    """Forces on spinning bodies must not know the spin angle; AnalysisError otherwise.

    At rest, all bodies a little off their places, each spinning body is turned by SPIN_ANGLE: its
    force and, in axes that do not turn, its moment must stay what they were. force: generalised
    forces at coordinates, velocities and first-order states.
    """
    shifted = np.zeros(len(scales))
    shifted[: layout.positions] = 0.1 * scales[: layout.positions]
    for first, yaw, spins in layout.rotations:
        if not spins:
            continue
        shifted[yaw : yaw + 2] = 0.0
        coordinates, velocities, first_order = layout.expand(shifted)
        forces = []
        for angle in (0.0, SPIN_ANGLE):
            coordinates[first + 1] += angle
            found = force(coordinates, velocities, first_order)
            c, s = np.cos(angle), np.sin(angle)
            x, z = found[first], found[first + 2]
            found[first], found[first + 2] = c * x + s * z, c * z - s * x
            forces.append(found)
        change = float(np.abs(forces[1] - forces[0]).max())
        if change > 1e-6 * np.abs(forces[0]).max():
            part = state_names[yaw].rpartition(": ")[0] or name
            raise AnalysisError(
                f"{name}: forces change by {change:.3g} N (or N m) when {part!r}, which spins, is "
                "turned about its axle, so there is no steady run: attach springs and dampers on "
                "the axle itself, at local positions (0, y, 0)"
            )
