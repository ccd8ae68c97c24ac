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
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles import curve as curves
from exudyn_wheelset.profiles.curve import ArcTable, distance_to_neighbours
from exudyn_wheelset.profiles.noise import curvature_noise, normal_noise
from exudyn_wheelset.profiles.penalised import fit_penalised
from exudyn_wheelset.profiles.plausible import (
    MINIMUM_POINTS,
    advancing_part,
    check_kind,
    check_points,
)
from exudyn_wheelset.spelling import spelt_class

FloatArray = NDArray[np.float64]

KINDS = ("wheel", "rail")
# Noise that moves the curvature by less than a thirtieth of a flat tread's needs no smoothing.
_HARMLESS_CURVATURE = 0.1


@spelt_class
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

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_wheelset import Profile
    >>> y = np.linspace(-0.07, 0.06, 131)
    >>> wheel = Profile("taper", "wheel", y, 0.05 * y)
    >>> round(float(wheel.slope(0.01)), 4)
    0.05
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
        smoothing = self.smoothing
        is_number = isinstance(smoothing, Real) and not isinstance(smoothing, bool)
        if not is_number or not 0.0 <= float(smoothing) <= 1e-3:
            raise ProfileError(
                f"{self.name}: smoothing = {smoothing!r} m; give the rms distance of the points "
                "to the curve in metres, 0 to 1e-3 (10 micrometres is 1e-5)"
            )
        object.__setattr__(self, "smoothing", float(smoothing))
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
        return np.asarray(self._curve(t)[:, 1].reshape(shape))

    def slope(self, y: ArrayLike) -> FloatArray:
        """Slope dz/dy of the curve [-] at y [m], any shape.

        The contact angle of an unturned profile is atan(slope). Raises as `height` does.
        """
        shape, t = self._parameter(y)
        first = self._derivative(t)
        return np.asarray((first[:, 1] / first[:, 0]).reshape(shape))

    def curvature(self, y: ArrayLike) -> FloatArray:
        """Signed curvature z''/(1 + z'^2)^(3/2) of the curve [1/m] at y [m], any shape.

        Raises as `height` does.
        """
        shape, t = self._parameter(y)
        first, second = self._derivative(t), self._second_derivative(t)
        cross = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        return np.asarray((cross / np.hypot(first[:, 0], first[:, 1]) ** 3).reshape(shape))

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
            if 5 * len(dropped) > len(self.y) or len(keep) < MINIMUM_POINTS:
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
    def curvature_noise(self) -> float:
        """Deviation that noise leaves in the curve's curvature [1/m]; 0 where it is smoothed.

        sqrt(6) noise/spacing^2, for a smoothing below half of the noise.
        """
        if float(self.smoothing) > 0.5 * self.noise or self.is_automatic:
            return 0.0
        return curvature_noise(self.noise, self._points)

    @property
    def _points(self) -> FloatArray:
        return np.column_stack((self.y, self.z))

    def _smooth_automatically(self) -> None:
        """Replace smoothing "auto" by the distance of the penalised curve; 0 without noise."""
        if curvature_noise(self.noise, self._points) < _HARMLESS_CURVATURE:
            object.__setattr__(self, "smoothing", 0.0)
            return
        fit = fit_penalised(self._points, self.kind)
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
                self._cache["curve"] = fit_penalised(self._points, self.kind).curve
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
