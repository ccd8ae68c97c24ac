"""A wheel or rail profile: points, the smooth curve through them, and its derivatives.

Frames (SI, one side stored, the other is its mirror image):
- wheel: y = 0 at the tape (running) circle, y > 0 towards the field side, flange at y < 0; z up,
  z = 0 at the tape circle, so the flange tip has z < 0 and the rolling radius is r0 - z(y);
- rail: y = 0 at the rail-head centre, y > 0 towards the field side, z up, z = 0 at the top of the
  rail that is not inclined.
On the left of the track these are the directions of the track frame (y to the left).

Curvature is signed, z''/(1 + z'^2)^(3/2) [1/m]: negative on a rail head, negative in a wheel's
flange throat, zero on a cone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles import curve as curves
from exudyn_wheelset.profiles.curve import ArcTable
from exudyn_wheelset.profiles.noise import curvature_noise, normal_noise
from exudyn_wheelset.profiles.penalised import fit_penalised

FloatArray = NDArray[np.float64]

KINDS = ("wheel", "rail")
_MINIMUM_POINTS = 8
_MINIMUM_SPAN = 2e-3
_MAXIMUM_SPAN = 0.3
_MAXIMUM_HEIGHT = 0.3
_DATUM_TOLERANCE = 5e-3
RAIL_TOP_RANGE = 0.03
_RAIL_FALL = 4e-3
# Noise that moves the curvature by less than a thirtieth of a flat tread's needs no smoothing.
_HARMLESS_CURVATURE = 0.1


@dataclass(frozen=True, eq=False)
class Profile:
    """One wheel or rail profile as points and a cubic B-spline curve.

    name: any text; kind: "wheel" or "rail".
    y, z: shape (n,), n >= 8 [m], in the frame of the module header, y strictly increasing.
    source: where the points come from. smoothing: rms distance of the points to the curve [m]; 0
    makes the curve pass through the points, "auto" smooths as much as the points' noise calls for
    and leaves the distance that came out in its place. remarks: what a reader changed or noticed.
    is_mirrored: y runs to the other side (flange at y > 0, rail gauge face at y > 0).
    is_automatic: the smoothing came from "auto". ends_at_gauge_face: a rail's gauge face is upright
    or undercut where its points end, so its last point is the one nearest to the track centre.

    Raises ProfileError where the points cannot be such a profile; the message gives the mend.
    """

    name: str
    kind: str
    y: FloatArray
    z: FloatArray
    source: str = ""
    smoothing: float | str = 0.0
    remarks: Sequence[str] = ()
    _: KW_ONLY
    is_mirrored: bool = False
    is_automatic: bool = False
    ends_at_gauge_face: bool = False
    _cache: dict[object, object] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise ProfileError(f"{self.name}: kind is {self.kind!r}; use 'wheel' or 'rail'")
        y, z = _column(self.name, "y", self.y), _column(self.name, "z", self.z)
        object.__setattr__(self, "y", y)
        object.__setattr__(self, "z", z)
        object.__setattr__(self, "remarks", tuple(str(remark) for remark in self.remarks))
        check_points(self.name, y, z)
        if self.smoothing == "auto":
            self._smooth_automatically()
        smoothing = float(self.smoothing)
        if not 0.0 <= smoothing <= 1e-3:
            raise ProfileError(
                f"{self.name}: smoothing = {smoothing:g} m; give the rms distance of the points "
                "to the curve in metres, 0 to 1e-3 (10 micrometres is 1e-5)"
            )
        object.__setattr__(self, "smoothing", smoothing)
        if self.is_mirrored:
            check_kind(self.name, self.kind, -y[::-1], z[::-1])
        else:
            check_kind(self.name, self.kind, y, z)

    def __eq__(self, other: object) -> bool:
        """Whether both have the same kind, curve and name."""
        if not isinstance(other, Profile):
            return NotImplemented
        return self is other or self._identity == other._identity

    def __hash__(self) -> int:
        return hash(self._identity)

    def __getstate__(self) -> dict[str, object]:
        return {**self.__dict__, "_cache": {}}

    @property
    def _identity(self) -> tuple[object, ...]:
        if "identity" not in self._cache:
            points = (self.y.tobytes(), self.z.tobytes())
            self._cache["identity"] = (
                self.kind, self.is_mirrored, self.smoothing, *points, self.name
            )  # fmt: skip
        identity = self._cache["identity"]
        assert isinstance(identity, tuple)
        return identity

    def height(self, y: ArrayLike) -> FloatArray:
        """Height z of the curve [m] at y [m], any shape.

        Raises ProfileError for y outside the profile or not a number.
        """
        shape, t = self._parameter(y)
        return self._curve(t)[:, 1].reshape(shape)

    def slope(self, y: ArrayLike) -> FloatArray:
        """Slope dz/dy of the curve [-] at y [m], any shape.

        The contact angle of an unturned profile is atan(slope). Raises as `height` does.
        """
        shape, t = self._parameter(y)
        first = self._derivative(t)
        return (first[:, 1] / first[:, 0]).reshape(shape)

    def curvature(self, y: ArrayLike) -> FloatArray:
        """Signed curvature z''/(1 + z'^2)^(3/2) of the curve [1/m] at y [m], any shape.

        Raises as `height` does.
        """
        shape, t = self._parameter(y)
        first, second = self._derivative(t), self._second_derivative(t)
        cross = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        return (cross / np.hypot(first[:, 0], first[:, 1]) ** 3).reshape(shape)

    def arc_table(self, spacing: float = 1e-4) -> ArcTable:
        """The curve as cubics over uniform arc length, see `ArcTable`; kept for the next call.

        spacing: greatest length of a piece [m], 1e-6 to 1e-2; ProfileError outside.
        """
        if not 1e-6 <= spacing <= 1e-2:
            raise ProfileError(f"spacing = {spacing:g} m; use 1e-6 to 1e-2 m")
        key = ("arc_table", float(spacing))
        if key not in self._cache:
            self._cache[key] = curves.arc_table(self._curve, float(spacing))
        table = self._cache[key]
        assert isinstance(table, ArcTable)
        return table

    def mirrored(self) -> Profile:
        """The profile with y turned to the other side: the other wheel's or rail's frame."""
        return replace(
            self, y=-self.y[::-1], z=self.z[::-1].copy(), is_mirrored=not self.is_mirrored
        )

    def shifted(self, dy: float = 0.0, dz: float = 0.0) -> Profile:
        """The profile moved by dy to the field side and dz up [m]."""
        return replace(self, y=self.y + dy, z=self.z + dz)

    def rotated(self, angle: float) -> Profile:
        """The profile turned by `angle` [rad] about y = z = 0, positive from y to z.

        So `rail.rotated(math.atan(1 / 40))` inclines a rail towards the track centre by 1:40.
        What then overhangs is cut off, and a remark says so.
        """
        cos, sin = np.cos(angle), np.sin(angle)
        y, z = cos * self.y - sin * self.z, sin * self.y + cos * self.z
        keep = advancing_part(y, z)
        remarks = self.remarks
        if keep.stop - keep.start < len(y):
            lost = len(y) - (keep.stop - keep.start)
            remarks = (*remarks, f"{lost} points cut off that overhang after turning the profile")
        return replace(self, y=y[keep], z=z[keep], remarks=remarks)

    def smoothed(self, tolerance: float | str) -> Profile:
        """The same points with a curve at `tolerance` rms distance [m] to them, or "auto"."""
        return replace(self, smoothing=tolerance, is_automatic=False)

    def with_outliers_removed(self, tolerance: float) -> Profile:
        """The profile without points farther than `tolerance` [m] from the rest; in remarks.

        A point is compared with the cubic through two neighbours on either side, worst first, so
        one bad point does not condemn its neighbours. The two points at each end stay. Raises
        ProfileError when more than a fifth of the points would go.
        """
        if not tolerance > 0.0:
            raise ProfileError(f"tolerance = {tolerance:g} m; use a positive distance")
        keep = np.arange(len(self.y))
        dropped: list[int] = []
        while True:
            distance = distance_to_neighbours(np.column_stack((self.y, self.z))[keep])
            worst = int(np.argmax(distance))
            if distance[worst] <= tolerance:
                break
            dropped.append(int(keep[worst]))
            keep = np.delete(keep, worst)
            if 5 * len(dropped) > len(self.y) or len(keep) < _MINIMUM_POINTS:
                raise ProfileError(
                    f"{self.name}: more than a fifth of the points lie farther than "
                    f"{tolerance:g} m from their neighbours; raise the tolerance"
                )
        if not dropped:
            return self
        listed = ", ".join(f"y = {1e3 * self.y[i]:.3f} mm" for i in sorted(dropped)[:10])
        more = "" if len(dropped) <= 10 else f" and {len(dropped) - 10} more"
        limit = f"{1e6 * tolerance:g} micrometres"
        remark = f"{len(dropped)} outliers beyond {limit} removed: {listed}{more}"
        return replace(self, y=self.y[keep], z=self.z[keep], remarks=(*self.remarks, remark))

    def resampled(self, spacing: float) -> Profile:
        """The profile by points of its curve at equal arc length of at most `spacing` [m]."""
        table = self.arc_table(spacing)
        y = np.append(table.coefficients[:, 0], self._curve_end[0])
        z = np.append(table.coefficients[:, 4], self._curve_end[1])
        keep = advancing_part(y, z)
        return replace(self, y=y[keep], z=z[keep], smoothing=0.0, is_automatic=False)

    @property
    def span(self) -> tuple[float, float]:
        """Smallest and greatest y of the curve [m]."""
        low, high = self._curve(self._breaks[[0, -1]])[:, 0]
        return float(low), float(high)

    @property
    def noise(self) -> float:
        """Standard deviation of the points' noise, normal to the curve [m]; see noise.py.

        White noise only: what varies slowly from point to point is shape to any such estimate.
        """
        if "noise" not in self._cache:
            self._cache["noise"] = normal_noise(self._points)
        noise = self._cache["noise"]
        assert isinstance(noise, float)
        return noise

    @property
    def _points(self) -> FloatArray:
        return np.column_stack((self.y, self.z))

    def _smooth_automatically(self) -> None:
        """Replace smoothing "auto" by the distance of the penalised curve; 0 without noise."""
        if curvature_noise(self.noise, self._points) < _HARMLESS_CURVATURE:
            object.__setattr__(self, "smoothing", 0.0)
            return
        fit = fit_penalised(self._points)
        self._cache["curve"] = fit.curve
        object.__setattr__(self, "smoothing", min(fit.distance, 1e-3))
        object.__setattr__(self, "is_automatic", True)
        remark = f"smoothed automatically, points {1e6 * fit.distance:.2g} micrometres (rms) off"
        if fit.correlation:
            remark += f"; their errors are alike over {1e3 * fit.correlation:.1f} mm"
        object.__setattr__(self, "remarks", (*self.remarks, remark))

    @property
    def _curve(self) -> BSpline:
        if "curve" not in self._cache:
            if self.is_automatic:
                self._cache["curve"] = fit_penalised(self._points).curve
            else:
                self._cache["curve"] = curves.fit_curve(self._points, float(self.smoothing))
        return self._cache["curve"]

    @property
    def _derivative(self) -> BSpline:
        if "derivative" not in self._cache:
            self._cache["derivative"] = self._curve.derivative()
        return self._cache["derivative"]

    @property
    def _second_derivative(self) -> BSpline:
        if "second" not in self._cache:
            self._cache["second"] = self._curve.derivative(2)
        return self._cache["second"]

    @property
    def _breaks(self) -> FloatArray:
        if "breaks" not in self._cache:
            self._cache["breaks"] = curves.breaks_of(self._curve)
        breaks = self._cache["breaks"]
        assert isinstance(breaks, np.ndarray)
        return breaks

    @property
    def _curve_end(self) -> FloatArray:
        return np.asarray(self._curve(self._breaks[-1]))

    def _parameter(self, y: ArrayLike) -> tuple[tuple[int, ...], FloatArray]:
        wanted = np.asarray(y, dtype=np.float64)
        flat = wanted.ravel()
        low, high = self.span
        # A rounding error's reach beyond the ends is forgiven, nothing more.
        slack = 1e-12
        outside = ~((flat >= low - slack) & (flat <= high + slack))
        if np.any(outside):
            value = flat[outside][0]
            raise ProfileError(
                f"{self.name}: y = {value:g} m lies outside the profile, "
                f"which reaches from {low:.6f} to {high:.6f} m"
            )
        flat = np.clip(flat, low, high)
        return wanted.shape, curves.parameter_at(self._curve, self._breaks, flat)


def check_points(name: str, y: FloatArray, z: FloatArray) -> None:
    """Raise ProfileError unless y, z [m] are enough points, finite, in order, of plausible size."""
    if len(y) != len(z):
        raise ProfileError(f"{name}: {len(y)} values of y but {len(z)} of z; give pairs")
    if len(y) < _MINIMUM_POINTS:
        raise ProfileError(f"{name}: {len(y)} points; give at least {_MINIMUM_POINTS}")
    for label, values in (("y", y), ("z", z)):
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            raise ProfileError(
                f"{name}: {label} of point {bad[0] + 1} is {values[bad[0]]}; remove the point"
            )
    steps = np.diff(y)
    bad = np.flatnonzero(steps <= 0.0)
    if len(bad):
        i = int(bad[0])
        fault = "repeats" if steps[i] == 0.0 else "runs back from"
        raise ProfileError(
            f"{name}: y of point {i + 2} ({y[i + 1]:g} m) {fault} that of point {i + 1} "
            f"({y[i]:g} m); sort the points by y and remove double ones"
        )
    span = float(y[-1] - y[0])
    height = float(np.ptp(z))
    if not _MINIMUM_SPAN <= span <= _MAXIMUM_SPAN or height > _MAXIMUM_HEIGHT:
        raise ProfileError(
            f"{name}: the profile is {span:g} m wide and {height:g} m high; "
            f"a profile is 2 to 300 mm wide. {size_hint(max(span, height))}"
        )
    if float(np.min(steps)) < 1e-12:
        i = int(np.argmin(steps))
        raise ProfileError(
            f"{name}: points {i + 1} and {i + 2} are {steps[i]:g} m apart in y; remove one"
        )


def size_hint(span: float) -> str:
    """A guess, in words, which unit was meant when a profile is `span` metres wide."""
    guesses = (("mm", 1e-3), ("inch", 0.0254), ("metres, read as mm", 1e3), ("cm", 1e-2))
    for unit, factor in guesses:
        if 0.03 <= span * factor <= 0.2:
            return f"The numbers look like {unit}: name the unit."
    return "Check the unit."


def check_kind(name: str, kind: str, y: FloatArray, z: FloatArray) -> None:
    """Raise ProfileError unless the points [m] look like a wheel or a rail in its own frame."""
    top = int(np.argmax(z))
    lowest = int(np.argmin(z))
    falls = min(z[top] - z[0], z[top] - z[-1])
    head_like = falls > _RAIL_FALL and 0 < top < len(z) - 1
    if kind == "wheel":
        if head_like and y[0] < y[top] < y[-1] and abs(y[top]) <= 0.6 * max(-y[0], y[-1]):
            raise ProfileError(
                f"{name}: given as a wheel, but it falls by {1e3 * falls:.1f} mm or more to both "
                "sides as a rail head does; say kind='rail'"
            )
        if not y[0] < 0.0 < y[-1]:
            raise ProfileError(
                f"{name}: y reaches from {1e3 * y[0]:.2f} to {1e3 * y[-1]:.2f} mm and leaves out "
                "the tape circle y = 0; shift the profile so that y = 0 lies on the tape circle"
            )
        datum = float(np.interp(0.0, y, z))
        if z[top] - datum > max(0.015, datum - z[lowest]):
            side = "" if y[top] < 0.0 else " and mirror y"
            raise ProfileError(
                f"{name}: the flange points up (z = {1e3 * z[top]:.2f} mm at "
                f"y = {1e3 * y[top]:.2f} mm); z is up and the flange tip below: turn the sign of z"
                + side
            )
        if y[lowest] > 0.0 and z[-1] < z[0] and np.ptp(z) > 1e-6:
            raise ProfileError(
                f"{name}: the lowest point lies at y = {1e3 * y[lowest]:.2f} mm, on the field "
                "side; the flange belongs to y < 0: mirror y"
            )
        if abs(datum) > _DATUM_TOLERANCE:
            raise ProfileError(
                f"{name}: z = {1e3 * datum:.2f} mm at the tape circle y = 0; it is 0 there: shift z"
            )
        return
    if abs(z[top]) > _DATUM_TOLERANCE:
        raise ProfileError(
            f"{name}: the top lies at z = {1e3 * z[top]:.2f} mm; it is z = 0 on a rail: shift z, "
            "or turn its sign if z points down"
        )
    if abs(y[top]) > RAIL_TOP_RANGE or not 0 < top < len(z) - 1:
        raise ProfileError(
            f"{name}: given as a rail, but the highest point lies at y = {1e3 * y[top]:.2f} mm "
            f"in the range {1e3 * y[0]:.2f} to {1e3 * y[-1]:.2f} mm; a rail has it near y = 0 "
            "and falls to both sides: say kind='wheel', shift y, or turn the sign of z"
        )


def advancing_part(y: FloatArray, z: FloatArray) -> slice:
    """The stretch of points around y = 0 over which y advances by 1e-4 of the length or more."""
    steps = np.diff(y)
    good = steps > 1e-4 * np.hypot(steps, np.diff(z))
    start = int(np.argmin(np.abs(y) + np.where(np.append(good, False), 0.0, 1e3)))
    bad = np.flatnonzero(~good)
    before, after = bad[bad < start], bad[bad >= start]
    first = int(before[-1]) + 1 if len(before) else 0
    last = int(after[0]) + 1 if len(after) else len(y)
    return slice(first, last)


def distance_to_neighbours(points: FloatArray) -> FloatArray:
    """Distance of each point to the cubic through two neighbours on either side [m], shape (n,).

    points: shape (n, 2), columns y and z [m]. It is 0 for the two points at each end.
    """
    # The added picometres part points that coincide after others between them were taken out.
    t = curves.chord_length(points) + 1e-12 * np.arange(len(points))
    distance = np.zeros(len(t))
    window = [-2, -1, 1, 2]
    inner = np.arange(2, len(t) - 2)
    predicted = np.zeros((len(inner), 2))
    for i in window:
        weight = np.ones(len(inner))
        for j in window:
            if j != i:
                weight *= (t[inner] - t[inner + j]) / (t[inner + i] - t[inner + j])
        predicted += weight[:, None] * points[inner + i]
    distance[inner] = np.hypot(*(points[inner] - predicted).T)
    return distance


def _column(name: str, label: str, values: ArrayLike) -> FloatArray:
    try:
        column = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ProfileError(f"{name}: {label} is not a row of numbers ({error})") from None
    if column.ndim != 1:
        raise ProfileError(
            f"{name}: {label} has the shape {column.shape}; give one row of numbers in metres"
        )
    column.setflags(write=False)
    return column
