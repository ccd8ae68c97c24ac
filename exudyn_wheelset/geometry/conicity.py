"""Equivalent conicity of a wheelset on its track, from the rolling-radius difference.

Physical idea: without slip a wheelset follows y'' = -Delta_r(y)/(e r0) over the distance run. The
equivalent conicity tan(gamma_e) is the conicity of the coned wheelset whose oscillation of the same
amplitude has the same wavelength lambda. Cone: Delta_r = 2 gamma y, Klingel's wavelength
lambda = 2 pi sqrt(e r0/(2 gamma)); hence tan(gamma_e) = 2 e r0 (pi/lambda)^2.

Source: EN 15302, integration of the wheelset's equation of motion. One integration gives
(y')^2/2 = (S(y_max) - S(y))/(e r0), S = integral of Delta_r; the turning points y_min and y_max are
where S is equal, y_max - y_min = 2 amplitude. They need not lie at equal distances from the
position of rest, so unlike wheels and rails and unlike radii need no special case.
e and r0 cancel: they set the wavelength, not the conicity.

Between the given points Delta_r is taken as straight. Then every stretch of the oscillation is one
with constant stiffness s = d(Delta_r)/dy and takes, with speeds v at its ends (dy by distance),

    sqrt(s) length/2 = atan(sqrt(s) dy/(v_1 + v_2)),      sqrt(-s) and atanh where s < 0,

which is exact, at turning points (v = 0) and across jumps too. What is left is the error of the
straight line, of second order in the spacing of y.

Track frame, SI: y [m] the wheelset's shift, positive to the left; Delta_r = r_left - r_right [m].
The y of the equation is the path of the wheels on the rails, y + r0 roll of a wheelset that rolls
about its axle's centre (rolling_radius.py).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from exudyn_wheelset.checking import finite_array, positive
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt

FloatArray = NDArray[np.float64]

METHODS = ("integration", "linear-regression", "harmonic")
# Delta_r below 10 nm is rounding of the profile's points. On a dead band (cylinder on rail) its
# sign is arbitrary; a barrier no higher than this over the amplitude stops no oscillation.
_RADIUS_RESOLUTION = 1.0e-8
# The contact search ends within 1e-12 m on the profile; radii differ by less.
_SEARCH_ROUNDING = 1.0e-12


@dataclass(frozen=True)
class KinematicOscillation:
    """One period of the wheelset's motion without slip.

    amplitude [m] half of peak to peak; lowest, highest [m] turning points y_min and y_max;
    wavelength [m], inf on a dead band; conicity [-] equivalent conicity tan(gamma_e).
    """

    amplitude: float
    lowest: float
    highest: float
    wavelength: float
    conicity: float


@spelt
def equivalent_conicity(
    y: ArrayLike,
    rolling_radius_difference: ArrayLike,
    amplitudes: ArrayLike,
    contact_spacing: float = 1.5,
    radius: float = 0.46,
    method: str = "integration",
) -> FloatArray:
    """Return the equivalent conicity tan(gamma_e) [-] for oscillations of given amplitudes.

    y: shape (n,) [m], increasing, shift to the left, to be taken at rail level
    (`rolling_radius_curve` gives both); rolling_radius_difference: shape (n,) [m],
    r_left - r_right; amplitudes: any shape [m], half of peak to peak, positive; contact_spacing
    and radius [m]: e and r0 (they cancel in the conicity). The result has amplitudes' shape.
    method: "integration" (EN 15302's reference); "linear-regression": half the slope of the
    straight line fitted to Delta_r, every y alike; "harmonic": the same weighted as a sine dwells
    (describing function). All three use the stretch of y over which Delta_r has the mean zero; the
    latter two may be negative.

    With "integration", NaN marks an amplitude at which no oscillation exists: a hump in S, made by
    a Delta_r that falls with y, parts the turning points.
    Raises WheelsetError for data that are no such function (order, NaN, shape), without a position
    of rest, where no such position is stable ("integration"), or short of the amplitude.
    Source: EN 15302; the module's header has the equations.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_wheelset import equivalent_conicity
    >>> y = np.linspace(-0.01, 0.01, 201)
    >>> float(equivalent_conicity(y, 2 * 0.05 * y, 3e-3).round(4))  # a cone of 1:20
    0.05
    """
    if method not in METHODS:
        raise WheelsetError(f"method {method!r} is unknown: use one of {', '.join(METHODS)}")
    _check_length("contact_spacing", contact_spacing)
    _check_length("radius", radius)
    curve = _RadiusDifference(y, rolling_radius_difference)
    wanted = _numbers("amplitudes", amplitudes)
    result = np.empty(wanted.size)
    for k, amplitude in enumerate(wanted.ravel()):
        if method == "integration":
            lowest, highest = curve.turning_points(float(amplitude))
            period = curve.period(lowest, highest)
            result[k] = 2.0 * (math.pi / period) ** 2
        else:
            centre = curve.mean_zero_centre(float(amplitude))
            slope = curve.regression_slope if method == "linear-regression" else curve.sine_slope
            result[k] = 0.5 * slope(centre, float(amplitude))
    return result.reshape(wanted.shape)


def kinematic_oscillation(
    y: ArrayLike,
    rolling_radius_difference: ArrayLike,
    amplitude: float,
    contact_spacing: float = 1.5,
    radius: float = 0.46,
) -> KinematicOscillation:
    """Return turning points, wavelength and conicity of one oscillation.

    Arguments and errors as in `equivalent_conicity` with one amplitude [m]; radius [m] is the mean
    of both wheels. All but the amplitude is NaN where no oscillation exists.
    """
    _check_length("contact_spacing", contact_spacing)
    _check_length("radius", radius)
    curve = _RadiusDifference(y, rolling_radius_difference)
    amplitude = float(_numbers("amplitude", amplitude))
    lowest, highest = curve.turning_points(amplitude)
    period = curve.period(lowest, highest)
    return KinematicOscillation(
        amplitude=amplitude,
        lowest=lowest,
        highest=highest,
        wavelength=period * math.sqrt(contact_spacing * radius),
        conicity=2.0 * (math.pi / period) ** 2,
    )


class _RadiusDifference:
    """Delta_r as a polygon over y, with its integral S; every zero is a corner."""

    def __init__(self, y: ArrayLike, difference: ArrayLike) -> None:
        self.y, self.height = _with_zeros(*_checked(y, difference))
        step = np.diff(self.y)
        self.slope = np.diff(self.height) / step
        areas = 0.5 * (self.height[1:] + self.height[:-1]) * step
        self.area = np.concatenate(([0.0], np.cumsum(areas)))
        self.stable_rests, self.rests = _rests(self.y, self.height)

    def at(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Delta_r [m] and S [m^2] at y."""
        piece = np.clip(np.searchsorted(self.y, y, side="right") - 1, 0, len(self.slope) - 1)
        beyond = y - self.y[piece]
        height = self.height[piece] + self.slope[piece] * beyond
        return height, self.area[piece] + 0.5 * (self.height[piece] + height) * beyond

    def between(self, low: float, high: float) -> tuple[FloatArray, FloatArray]:
        """Corners from low to high with both ends: y and Delta_r."""
        first = int(np.searchsorted(self.y, low, side="right"))
        last = int(np.searchsorted(self.y, high, side="left"))
        ends, _ = self.at(np.array([low, high]))
        return (
            np.concatenate(([low], self.y[first:last], [high])),
            np.concatenate((ends[:1], self.height[first:last], ends[1:])),
        )

    def turning_points(self, amplitude: float) -> tuple[float, float]:
        """y_min and y_max [m] of the oscillation nearest to the position of rest, or NaN."""
        if self.stable_rests.size == 0:
            raise WheelsetError(
                "rolling_radius_difference falls through zero and never rises through it: such a "
                "wheelset runs away from its position of rest and has no wavelength; check that it "
                "is r_left - r_right with y positive to the left, or use method "
                "'linear-regression', which gives the negative conicity"
            )
        rest = self.stable_rests[np.argmin(np.abs(self.stable_rests))]
        centres = self._mean_zero_centres(amplitude)
        for centre in centres[np.argsort(np.abs(centres - rest), kind="stable")]:
            lowest, highest = self._window(centre, amplitude)
            depth = _depth(*self.between(lowest, highest))
            if np.all(depth >= -_RADIUS_RESOLUTION * amplitude):
                return lowest, highest
        return math.nan, math.nan

    def period(self, lowest: float, highest: float) -> float:
        """Wavelength [m] for e r0 = 1 m^2."""
        if math.isnan(lowest):
            return math.nan
        y, height = self.between(lowest, highest)
        step = np.diff(y)
        speed = np.sqrt(2.0 * np.maximum(_depth(y, height), 0.0))
        sums = speed[1:] + speed[:-1]
        stiffness = np.diff(height) / step
        root = np.sqrt(np.abs(stiffness))
        with np.errstate(divide="ignore", invalid="ignore"):
            argument = root * step / sums
            angle = np.where(
                stiffness > 0.0, np.arctan(argument), np.arctanh(np.minimum(argument, 1.0))
            )
            times = np.where(root > 0.0, 2.0 * angle / root, 2.0 * step / sums)
            times[sums == 0.0] = np.inf
        return 2.0 * float(np.sum(times))

    def mean_zero_centre(self, amplitude: float) -> float:
        """Middle of the stretch with mean zero that is nearest to a position of rest."""
        rests = self.stable_rests if self.stable_rests.size else self.rests
        rest = rests[np.argmin(np.abs(rests))]
        centres = self._mean_zero_centres(amplitude)
        return float(centres[np.argmin(np.abs(centres - rest))])

    def regression_slope(self, centre: float, amplitude: float) -> float:
        """Slope [-] of the least-squares line through Delta_r, every y alike."""
        y, height = self.between(*self._window(centre, amplitude))
        u = y - centre
        middle = 0.25 * (u[1:] + u[:-1]) * (height[1:] + height[:-1])
        ends = u[1:] * height[1:] + u[:-1] * height[:-1]
        # Simpson's rule is exact for the product of two straight lines.
        moment = np.sum(np.diff(y) * (ends + 4.0 * middle)) / 6.0
        return float(1.5 * moment / amplitude**3)

    def sine_slope(self, centre: float, amplitude: float) -> float:
        """Slope [-] of the first harmonic of Delta_r(centre + amplitude sin(angle))."""
        y, height = self.between(*self._window(centre, amplitude))
        u = (y - centre) / amplitude
        # The arc sine would make 1e-8 of a rounding error at its ends.
        u[[0, -1]] = -1.0, 1.0
        slope = np.diff(height) / np.diff(u)
        start = height[:-1] - slope * u[:-1]
        cosine, angle = np.sqrt(1.0 - u * u), np.arcsin(u)
        parts = -start * np.diff(cosine) + 0.5 * slope * np.diff(angle - u * cosine)
        return float(2.0 / (math.pi * amplitude) * np.sum(parts))

    def _window(self, centre: float, amplitude: float) -> tuple[float, float]:
        return (
            max(float(centre) - amplitude, float(self.y[0])),
            min(float(centre) + amplitude, float(self.y[-1])),
        )

    def _mean_zero_centres(self, amplitude: float) -> FloatArray:
        """All c for which the integral of Delta_r over c +- amplitude vanishes.

        That integral is S(c + amplitude) - S(c - amplitude): a polynomial of second degree in c
        between the corners.
        """
        if not math.isfinite(amplitude) or amplitude <= 0.0:
            raise WheelsetError(f"amplitude = {amplitude!r} m: give a positive number in m")
        low, high = self.y[0] + amplitude, self.y[-1] - amplitude
        # The data may end exactly at the turning points; rounding must not cut them off.
        slack = 1.0e-12 * (self.y[-1] - self.y[0])
        if low > high + slack:
            raise WheelsetError(
                f"amplitude {amplitude * 1e3:.4g} mm is beyond the data, y = "
                f"{self.y[0] * 1e3:.4g} to {self.y[-1] * 1e3:.4g} mm: give y over a wider range "
                "or smaller amplitudes"
            )
        low, high = min(low, high), max(low, high)
        corners = np.concatenate(([low, high], self.y - amplitude, self.y + amplitude))
        c = np.unique(corners[(corners >= low) & (corners <= high)])
        height_high, area_high = self.at(np.minimum(c + amplitude, self.y[-1]))
        height_low, area_low = self.at(np.maximum(c - amplitude, self.y[0]))
        mean = area_high - area_low
        # Symmetric data that end at the turning points: the mean is zero but for rounding.
        rounding = _SEARCH_ROUNDING + 1.0e-12 * np.abs(self.height).max()
        mean[np.abs(mean) < rounding * amplitude] = 0.0
        rate = height_high - height_low
        found = [c[mean == 0.0]]
        k = np.flatnonzero(mean[:-1] * mean[1:] < 0.0)
        if k.size:
            # Slopes from the ends' values alone: a jump in Delta_r may sit on a corner.
            step = c[k + 1] - c[k]
            bend = (rate[k + 1] - rate[k]) / step
            start = (mean[k + 1] - mean[k]) / step - 0.5 * bend * step
            root = np.sqrt(np.maximum(start * start - 2.0 * bend * mean[k], 0.0))
            root = np.where(mean[k] < 0.0, root, -root)
            found.append(c[k] + np.clip(-2.0 * mean[k] / (start + root), 0.0, step))
        centres = np.concatenate(found)
        if centres.size == 0:
            side = "right" if mean[0] > 0.0 else "left"
            raise WheelsetError(
                f"amplitude {amplitude * 1e3:.4g} mm is beyond the data: the oscillation would "
                f"reach farther to the {side} than y = {self.y[0] * 1e3:.4g} to "
                f"{self.y[-1] * 1e3:.4g} mm; give y over a wider range or smaller amplitudes"
            )
        return centres


def _depth(y: FloatArray, height: FloatArray) -> FloatArray:
    """S at the turning points less S at the corners between them [m^2].

    Summed from the nearer turning point: a difference of S loses the digits that count there.
    """
    areas = 0.5 * (height[1:] + height[:-1]) * np.diff(y)
    from_left = np.concatenate(([0.0], -np.cumsum(areas)))
    from_right = np.concatenate((np.cumsum(areas[::-1])[::-1], [0.0]))
    middle = len(y) // 2
    return np.concatenate((from_left[:middle], from_right[middle:]))


def _with_zeros(y: FloatArray, height: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The polygon with its zeros added as corners."""
    k = np.flatnonzero(height[:-1] * height[1:] < 0.0)
    share = height[k] / (height[k] - height[k + 1])
    zeros = y[k] + share * (y[k + 1] - y[k])
    between = (zeros > y[k]) & (zeros < y[k + 1])
    where = k[between] + 1
    return np.insert(y, where, zeros[between]), np.insert(height, where, 0.0)


def _rests(y: FloatArray, height: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Positions of rest [m], the stable ones and all; a dead band counts by its middle."""
    sign = np.sign(height)
    moving = np.flatnonzero(sign)
    if moving.size == 0:
        middle = np.array([0.5 * (y[0] + y[-1])])
        return middle, middle
    turns = np.flatnonzero(sign[moving[:-1]] * sign[moving[1:]] < 0.0)
    before, after = moving[turns], moving[turns + 1]
    places = 0.5 * (y[np.minimum(before + 1, after)] + y[np.maximum(after - 1, before)])
    if places.size == 0 and np.any(sign == 0.0):
        places = y[sign == 0.0]
        return places, places
    if places.size == 0:
        side = "left" if height[0] > 0.0 else "right"
        raise WheelsetError(
            f"rolling_radius_difference is never zero for y = {y[0] * 1e3:.4g} to "
            f"{y[-1] * 1e3:.4g} mm (the {side} wheel is always the larger): give y over a range "
            "that holds the position of rest, or check radius and right_radius"
        )
    return places[sign[before] < 0.0], places


def _checked(y: ArrayLike, difference: ArrayLike) -> tuple[FloatArray, FloatArray]:
    mend = "leave out shifts without contact"
    shifts = finite_array("y", y, "m", mend)
    heights = finite_array("rolling_radius_difference", difference, "m", mend)
    if shifts.ndim != 1 or shifts.shape != heights.shape or len(shifts) < 3:
        raise WheelsetError(
            f"y has the shape {shifts.shape}, rolling_radius_difference {heights.shape}: give two "
            "arrays of equal length with three values or more"
        )
    bad = np.flatnonzero(np.diff(shifts) <= 0.0)
    if len(bad):
        raise WheelsetError(
            f"y[{bad[0] + 1}] = {shifts[bad[0] + 1]:g} m does not exceed y[{bad[0]}] = "
            f"{shifts[bad[0]]:g} m: sort the pairs by y and remove double ones"
        )
    if max(np.abs(shifts).max(), np.abs(heights).max()) > 0.5:
        raise WheelsetError(
            f"y up to {np.abs(shifts).max():g} m, rolling_radius_difference up to "
            f"{np.abs(heights).max():g} m are out of proportion: are they given in m?"
        )
    return shifts, heights


def _numbers(what: str, values: ArrayLike) -> FloatArray:
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise WheelsetError(f"{what} = {values!r}: give numbers in m") from None


def _check_length(what: str, value: float) -> None:
    positive(what, value, "m", 3.0)
