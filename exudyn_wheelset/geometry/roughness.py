"""Why the contact of a pair is rough: curvature that is the noise of measured points.

Physical idea: a curve through points that are off by sigma, h apart, has a curvature that is off by
sqrt(6) sigma/h^2: 600 1/m for 10 micrometres at 0.2 mm, where a wheel's tread has 3 1/m. Contact
then jumps from crest to crest of the noise, some twenty times within the flange clearance where a
smooth pair has four jumps, and radii and angles between the jumps are those of the crests.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.checking import warn
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.profiles import Profile

# Ten times a tread's curvature; measured profiles as instruments write them have up to 4 1/m
# where the instrument smooths, and 24 to 120 1/m where it rounds to 0.01 mm.
ROUGH_CURVATURE = 30.0
_JUMP = 1.0e-3


def rough_profiles(wheelset: Wheelset, track: Track) -> list[Profile]:
    """The pair's profiles whose curvature is noise, each once."""
    pair = (wheelset.wheel, wheelset.right_wheel, track.rail, track.right_rail)
    different = {id(profile): profile for profile in pair if profile is not None}
    return [p for p in different.values() if p.curvature_noise > ROUGH_CURVATURE]


def warn_if_rough(
    wheelset: Wheelset,
    track: Track,
    y: NDArray[np.float64],
    places: NDArray[np.float64],
) -> None:
    """WheelsetWarning with the jumps of the contact and their cause, where a profile is noise.

    y: shape (n,) [m]; places: shape (n, k), lateral positions of contact points [m].
    """
    rough = rough_profiles(wheelset, track)
    if not rough or len(y) < 3:
        return
    moves = np.abs(np.diff(places[np.argsort(y, kind="stable")], axis=0))
    jumps = int(np.count_nonzero(np.max(moves, axis=1) > _JUMP))
    causes = "; ".join(
        f"{p.name!r}: points off by {1e6 * p.noise:.2g} micrometres, curvature by "
        f"{p.curvature_noise:.3g} 1/m"
        for p in rough
    )
    warn(
        f"contact jumps {jumps} times between y = {1e3 * np.min(y):.3g} and "
        f"{1e3 * np.max(y):.3g} mm, from crest to crest of measurement noise ({causes}): radii, "
        "angles and conicity are not to be trusted; load the profile with smoothing='auto'"
    )
