"""A wheelset on its track as EN 15302 looks at it: rolling radii over the shift, and more.

    pair = rolling_pair(wheelset, track, reach=15e-3)
    pair.conicity([3e-3]), pair.rest(), pair.wavelength(3e-3), pair.flange_contact()

Shifts, amplitudes and radii in m, y positive to the left; conicities are tan(gamma_e).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.geometry.conicity import equivalent_conicity, kinematic_oscillation
from exudyn_wheelset.geometry.rigid import ContactGeometry
from exudyn_wheelset.geometry.rolling_radius import rolling_radius_curve

# Treads stay below 10 degrees, flanks of flanges are made with 60 to 75.
FLANGE_ANGLE = np.radians(30.0)
SHIFT_SPACING = 2.0e-5
# Amplitude [m] at which a position of rest is looked for.
_SMALL = 1.0e-4


@dataclass(frozen=True)
class RollingPair:
    """Rigid contact over the shift, and what follows from it.

    geometry    over the shifts geometry.y (n,) [m], as far as both wheels touch
    difference  (n,) r_left - r_right [m]
    shift       what y is the shift of: "rail", "axle" or "level", see `rolling_radius_curve`
    """

    wheelset: Wheelset
    track: Track
    geometry: ContactGeometry
    difference: Array
    shift: str

    @property
    def spacing(self) -> float:
        """Distance of the tape circles [m]."""
        return 2.0 * self.wheelset.tape_half_distance

    @property
    def radius(self) -> float:
        """Mean radius of both wheels [m]."""
        return 0.5 * (self.wheelset.radius + (self.wheelset.right_radius or self.wheelset.radius))

    def conicity(self, amplitudes: ArrayLike, method: str = "integration") -> Array:
        """Equivalent conicity (k,) at amplitudes (k,) [m].

        NaN where an oscillation of that amplitude does not exist or would leave the rails; method:
        see `equivalent_conicity`. Raises WheelsetError without a position of rest.
        """

        def at(amplitude: float) -> float:
            y, radius = self.geometry.y, self.wheelset.radius
            return float(
                equivalent_conicity(y, self.difference, amplitude, self.spacing, radius, method)
            )

        at(_SMALL)
        values = []
        for amplitude in np.asarray(amplitudes, dtype=float):
            try:
                values.append(at(float(amplitude)))
            except WheelsetError:
                if not amplitude > 0.0:
                    raise
                values.append(np.nan)
        return np.array(values)

    def rest(self) -> float:
        """Shift [m] at which both radii agree, nearest to the middle."""
        motion = kinematic_oscillation(self.geometry.y, self.difference, 0.1 * _SMALL)
        return 0.5 * (motion.lowest + motion.highest)

    def wavelength(self, amplitude: float) -> float | None:
        """Wavelength [m] of the kinematic oscillation of an amplitude [m]; None without one."""
        y, spacing, radius = self.geometry.y, self.spacing, self.radius
        try:
            found = kinematic_oscillation(y, self.difference, amplitude, spacing, radius)
        except WheelsetError:
            return None
        return _number(found.wavelength)

    def flange_contact(self) -> tuple[float | None, float | None]:
        """Shifts [m] to the right and to the left at which a flange begins to carry."""
        touching, y = flange_contact(self.geometry), self.geometry.y
        right, left = y[touching & (y < 0.0)], y[touching & (y > 0.0)]
        return (
            float(right.max()) if right.size else None,
            float(left.min()) if left.size else None,
        )

    def numbers(self, amplitudes_mm: ArrayLike, method: str = "integration") -> dict[str, Any]:
        """Conicity by amplitude [mm], at 3 mm, wavelength, rest and flange contact in mm.

        None in place of what does not exist.
        """
        wanted = [*np.asarray(amplitudes_mm, dtype=float), 3.0]
        conicity = [_number(value) for value in self.conicity(1e-3 * np.array(wanted), method)]
        return {
            "wheel": self.wheelset.wheel.name,
            "rail": self.track.rail.name,
            "shift": self.shift,
            "conicity_3mm": conicity[-1],
            "conicity": {
                f"{at:g}": value for at, value in zip(wanted[:-1], conicity[:-1], strict=True)
            },
            "rest_mm": _number(round(1e3 * self.rest(), 6) + 0.0),
            "flange_contact_mm": [None if at is None else 1e3 * at for at in self.flange_contact()],
            "wavelength_3mm": self.wavelength(3.0e-3),
        }


def rolling_pair(
    wheelset: Wheelset, track: Track, reach: float = 15.0e-3, shift: str = "rail"
) -> RollingPair:
    """The pair's contact every 0.02 mm up to `reach` [m]; shift: see `rolling_radius_curve`."""
    y, difference, geometry = rolling_radius_curve(wheelset, track, reach, SHIFT_SPACING, shift)
    return RollingPair(wheelset, track, replace(geometry, y=y), difference, shift)


def flange_contact(geometry: ContactGeometry) -> Array:
    """True at shifts where a wheel touches at more than 30 degrees, shape of geometry.y."""
    angles = np.abs([geometry.left.angle, geometry.right.angle])
    return np.asarray(np.any(angles > FLANGE_ANGLE, axis=0))


def _number(value: float | None) -> float | None:
    return float(value) if value is not None and np.isfinite(value) else None
