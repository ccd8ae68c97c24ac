"""Linear critical speed: the lowest speed at which hunting begins to grow by itself.

Creep feeds energy into lateral motion only, so hunting is the lateral oscillation that turns
unstable first (see `modes`); other oscillations that happen to be weakly damped, longitudinal
motion, bounce on the contacts, are told from it and named in the remarks. Speeds are scanned
upward; an unstable window between two of them shows as a peak of the least damping near zero and
is looked into.

Speeds in m/s, eigenvalues in 1/s, frequencies in Hz.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.linear.crossings import (
    CriticalPoint,
    check_range,
    crossing,
    hopf_point,
    polish,
)
from exudyn_wheelset.stability.linear.law_checks import warn_of_law
from exudyn_wheelset.stability.linear.modes import is_lateral, mode_name
from exudyn_wheelset.stability.linear.spectra import (
    NEUTRAL_FRACTION,
    Spectra,
)
from exudyn_wheelset.stability.subject import as_system
from exudyn_wheelset.systems.speeds import checked_speed

# A window of instability between two speeds of the scan is looked for where the peak of the least
# damping through three speeds comes this near to zero, as a share of the damping beside it.
NEAR_ZERO = 0.5
# Roots of trucks that are polished one after the other before the scan has to look for the first.
MOST_TRUCKS = 4


@spelt
def linear_critical_speed(
    vehicle: Any,
    low: float,
    high: float,
    *,
    guess: float | None = None,
    points: int = 40,
    tolerance: float = 1e-6,
) -> CriticalPoint:
    """Lowest speed in [low, high] m/s at which hunting turns unstable.

    Hunting means an oscillation in which bodies move sideways, yaw and roll; `mode_name` of the
    result says which. Scans upward at `points` speeds, looks into peaks of the least damping
    between them, and brackets the root to `tolerance` [m/s]. `remarks` of the result name what is
    worse than the answer: a divergence below it, an oscillation that grows already at `low`, or
    one that is not hunting. With `guess` (a speed or an earlier CriticalPoint of a slightly
    different vehicle) a secant starts there, and the scan is only made if it fails.

    Warns (WheelsetWarning) where the creep law is not linear about the equilibrium or has another
    slope there than the exact law; `additivity` and `slope_ratio` of the result are the numbers
    (see `law_checks`).

    Raises AnalysisError if hunting does not turn unstable in [low, high]; the message gives the
    growth rates at both ends.

    Examples
    --------
    >>> from exudyn_wheelset import linear_critical_speed
    >>> critical = linear_critical_speed("cooperrider", 20, 120)
    >>> round(critical.speed, 2), round(critical.frequency, 2)  # [m/s], [Hz]
    (68.64, 4.0)
    """
    spectra = Spectra(as_system(vehicle))
    check_range(spectra.system, low, high, points, tolerance)
    if guess is not None:
        checked_speed(spectra.system, "guess", guess)
        found = _critical_speed_near(spectra, low, high, guess, tolerance)
        if found is not None:
            _warn(spectra, found)
            return found
    speeds = np.linspace(low, high, points)
    scanned = [float(speeds[0])]
    stable_below = not _hunts(spectra, scanned[0])
    for right in speeds[1:]:
        for speed in (*_peak_before(spectra, scanned, float(right)), float(right)):
            stable_above = not _hunts(spectra, speed)
            if stable_below and not stable_above:
                found = _first_hunting(spectra, scanned[-1], speed, tolerance)
                if found is not None:
                    _warn(spectra, found)
                    worse = _remarks(spectra, scanned, found)
                    return replace(found, remarks=worse + found.remarks)
            stable_below = stable_above
            scanned.append(speed)
    raise AnalysisError(_no_critical_speed(spectra, speeds))


def _warn(spectra: Spectra, found: CriticalPoint) -> None:
    if found.law is not None:
        warn_of_law(spectra.system.name, [(found.speed, found.law)])


def _first_hunting(
    spectra: Spectra, left: float, right: float, tolerance: float
) -> CriticalPoint | None:
    """The lowest speed between two at which a lateral oscillation begins to grow."""
    before, after = spectra.unstable("hopf", left), spectra.unstable("hopf", right)
    points = [
        crossing(spectra, "hopf", index, left, right, tolerance) for index in range(before, after)
    ]
    hunting = [
        point
        for point in points
        if point is not None and point.slope > 0.0 and is_lateral(spectra.system, point.mode)
    ]
    return min(hunting) if hunting else None


def _peak_before(spectra: Spectra, scanned: list[float], following: float) -> tuple[float, ...]:
    """Speed in the last interval at which the least damped pair has its peak, if that grows.

    The peak is guessed by the parabola through the last two speeds and the next one, and looked
    for only where it comes near zero while both ends of the interval are stable.
    """
    if len(scanned) < 2:
        return ()
    speeds = np.array([*scanned[-2:], following])
    least = np.array([spectra.lateral_excess(float(speed)) for speed in speeds])
    if not np.all(np.isfinite(least)) or np.any(least > 0.0):
        return ()
    if not least[1] >= max(least[0], least[2]):
        return ()
    parabola = np.polyfit(speeds - speeds[1], least, 2)
    top = least[1] - 0.25 * parabola[1] ** 2 / parabola[0] if parabola[0] < 0.0 else least[1]
    if top < -NEAR_ZERO * max(-least[0], -least[2]):
        return ()
    found = minimize_scalar(
        lambda speed: -spectra.lateral_excess(float(speed)),
        bounds=(speeds[0], speeds[2]),
        method="bounded",
        options={"xatol": 1e-2 * (speeds[2] - speeds[0]), "maxiter": 12},
    )
    peak = float(found.x)
    if found.fun < 0.0 and peak > scanned[-1]:
        return (peak,)
    if found.fun < 0.0:
        # the peak lies before the last speed: step back to before it
        scanned.pop()
        return (peak, float(speeds[1]))
    return ()


def _hunts(spectra: Spectra, speed: float) -> bool:
    return spectra.lateral_excess(speed) > 0.0


def _remarks(spectra: Spectra, scanned: list[float], found: CriticalPoint) -> tuple[str, ...]:
    """What is worse than the answer: other roots that are unstable below it."""
    remarks = []
    below = [speed for speed in scanned if speed < found.speed]
    divergent = [speed for speed in below if spectra.unstable("divergence", speed)]
    if divergent:
        remarks.append(
            f"a bare real root diverges from {min(divergent):.4g} m/s on, below the critical "
            "speed: see divergence_points"
        )
    growing: dict[str, tuple[float, float]] = {}
    for speed in below:
        values, modes = spectra.pairs(speed)
        for value, mode in zip(values, modes.T, strict=True):
            if value.real <= NEUTRAL_FRACTION * abs(value):
                break
            frequency = value.imag / (2.0 * np.pi)
            growing.setdefault(mode_name(spectra.system, mode, frequency), (speed, frequency))
    for name, (speed, frequency) in growing.items():
        since = "at the lower end" if speed == below[0] else f"from {speed:.4g} m/s on"
        remarks.append(f"{name} ({frequency:.3g} Hz) grows already {since}")
    return tuple(remarks)


def _critical_speed_near(
    spectra: Spectra, low: float, high: float, guess: float, tolerance: float
) -> CriticalPoint | None:
    """The critical speed by a secant from a guess; None if the scan has to look for it."""
    try:
        if isinstance(guess, CriticalPoint) and len(guess.state) == spectra.system.size:
            spectra.start_from(guess.speed, guess.state)
            eigenvalue = guess.eigenvalue
        else:
            eigenvalue = complex(spectra.lateral_pairs(float(guess))[0])
        speed = float(guess)
        # Trucks of a car lose stability close together: the first is sought from the other's speed.
        for _ in range(MOST_TRUCKS):
            polished = polish(spectra, speed, eigenvalue, tolerance)
            if polished is None or not low <= polished[0] <= high:
                return None
            speed, eigenvalue = polished
            others = spectra.lateral_pairs(speed)
            others = others[np.abs(others - eigenvalue) > 1e-6 * abs(eigenvalue)]
            growing = others[others.real > NEUTRAL_FRACTION * np.abs(others)]
            if not len(growing):
                point = hopf_point(spectra, speed, eigenvalue)
                return point if point.slope > 0.0 else None
            eigenvalue = complex(growing[np.argmax(growing.real)])
    except (AnalysisError, IndexError):
        return None
    return None


def _no_critical_speed(spectra: Spectra, speeds: Array) -> str:
    """Why no pair loses stability over a scan of speeds."""

    def worst(speed: float) -> str:
        pairs = spectra.lateral_pairs(speed)
        if not len(pairs):
            return f"nothing oscillates sideways at {speed:g} m/s"
        root = pairs[0]
        return f"{root.real:+.4g} 1/s at {speed:g} m/s ({root.imag / (2.0 * np.pi):.3g} Hz)"

    counts = [int(_hunts(spectra, speed)) for speed in speeds]
    low, high = float(speeds[0]), float(speeds[-1])
    if not any(counts):
        what = "every lateral oscillation is damped; raise the upper speed"
    elif all(counts):
        what = "an oscillation grows at every speed; lower the lower speed"
    else:
        first_stable = speeds[counts.index(0)]
        what = f"an oscillation grows from the start and is damped from about {first_stable:g} m/s"
    divergent = [speed for speed in speeds if spectra.unstable("divergence", speed)]
    if divergent:
        what += f"; a bare real root diverges at {divergent[0]:g} m/s (see divergence_points)"
    return (
        f"{spectra.system.name}: no linear critical speed between {low:g} and {high:g} m/s: "
        f"{what}. Growth rate of the least damped lateral pair: {worst(low)}, {worst(high)}"
    )
