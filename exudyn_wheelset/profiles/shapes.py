"""Profiles from formulas: S1002, UIC60, a reconstructed AAR 1:20 wheel, cone, knife edge.

Sources:
- S1002: EN 13715 (flange of 28 mm), sections A to H, radius r0 + F(s), s to the field side [mm];
- UIC60: head of the rail 60E1, arcs R300, R80 and R13 with a flank of 1:20, not inclined;
- AAR 1:20: a reconstruction, see `aar_1_20`.
The frames are those of `exudyn_wheelset.profiles.profile`; results are in metres.

The sampling step is a compromise: a cubic spline through points h apart represents a curvature k
with an error of about h^2 k'', but turns a rounding error e of the points (files hold 1e-11 m)
into a curvature error of about 10 e/h^2. At h = 0.1 mm both stay below 0.01 1/m.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from exudyn_wheelset.errors import ProfileError
from exudyn_wheelset.profiles.profile import Profile

FloatArray = NDArray[np.float64]

INCH = 0.0254
_SAMPLING = 1e-4

_S1002_JUNCTIONS = (
    -70.0,
    -62.764705882,
    -49.662510381,
    -39.764473993,
    -38.426669071,
    -35.0,
    -26.0,
    32.15796,
    60.0,
)
_S1002_B = (
    0.0,
    -3.358537058e-2,
    1.565681624e-3,
    -2.810427944e-5,
    5.844240864e-8,
    -1.562379023e-8,
    5.309217349e-15,
    -5.957839843e-12,
    2.646656573e-13,
)
_S1002_C = (
    -4.320221063e3,
    -1.038384026e3,
    -1.065501873e2,
    -6.051367875,
    -2.054332446e-1,
    -4.169739389e-3,
    -4.687195829e-5,
    -2.252755540e-7,
)


def s1002_height(y: FloatArray) -> FloatArray:
    """Height of the S1002 profile by its formula [m] at y [m] from -0.07 to 0.06, any shape.

    The rounded coefficients of EN 13715 leave steps of 3.7e-8 m at y = -26 mm and 1.2e-7 m at
    y = -35 mm. Outside the range the result is NaN.
    """
    s = 1e3 * np.asarray(y, dtype=np.float64)

    def arc(centre_s: float, centre_f: float, radius: float, sign: float) -> FloatArray:
        return centre_f + sign * np.sqrt(np.maximum(radius**2 - (s - centre_s) ** 2, 0.0))

    sections = [
        arc(-49.5, 9.519259302, 20.5, 1.0),
        arc(-55.0, 16.0, 12.0, 1.0),
        arc(-58.558326413, 8.834924130, 20.0, 1.0),
        -93.576667419 - 2.747477419 * s,
        arc(-26.210665, 16.446, 13.0, -1.0),
        np.polynomial.polynomial.polyval(s, _S1002_C),
        np.polynomial.polynomial.polyval(s, _S1002_B),
        1.364323640 - 0.066666667 * s,
    ]
    j = _S1002_JUNCTIONS
    conditions = [(s >= j[i]) & (s <= j[i + 1]) for i in range(len(sections))]
    return -1e-3 * np.select(conditions, sections, default=np.nan)


def s1002() -> Profile:
    """The wheel profile S1002 of EN 13715, flange 28 mm, from its formula.

    y from -70 mm (flange back) to 60 mm. Points lie on the formula to rounding, 0.1 mm apart in
    arc length and at each junction. Half a millimetre on both sides of y = -26 and -35 mm is left
    without points, so that the spline bridges the formula's small steps there instead of
    turning them into false curvature.
    """
    fine = np.linspace(0.0, math.pi / 2, 2001)
    # Where the flange back is steep, equal steps of the angle keep the points close together.
    steep = 1e-3 * (-49.5 - 20.5 * np.cos(fine[fine <= math.acos(13.264705882 / 20.5)]))
    y_fine = np.unique(
        np.concatenate((steep, np.arange(-62764, 60001) * 1e-6, 1e-3 * np.array(_S1002_JUNCTIONS)))
    )
    y_fine = y_fine[(y_fine >= -0.07) & (y_fine <= 0.06)]
    length = np.concatenate(
        ([0.0], np.cumsum(np.hypot(np.diff(y_fine), np.diff(s1002_height(y_fine)))))
    )
    samples = []
    edges = np.array(_S1002_JUNCTIONS) * 1e-3
    for low, high in itertools.pairwise(edges):
        ends = np.interp([low, high], y_fine, length)
        count = max(2, round((ends[1] - ends[0]) / _SAMPLING))
        part = np.interp(np.linspace(ends[0], ends[1], count + 1), length, y_fine)
        part[0], part[-1] = low, high
        samples.append(part)
    y = np.unique(np.concatenate(samples))
    for gap in (-0.026, -0.035):
        y = y[np.abs(y - gap) > 0.5e-3]
    return Profile(
        "S1002",
        "wheel",
        y,
        s1002_height(y),
        source="EN 13715, S1002, flange thickness 28 mm; from the formula, sections A to H",
    )


def uic60(flank_depth: float = 0.035) -> Profile:
    """The head of the rail UIC60 (60E1), not inclined, from its arcs.

    R300 to |y| = 10.5 mm, R80 to 25.988 mm, R13 until the flank's slope of 20:1 is reached, then
    the flank down to z = -flank_depth [m]. The centres of R80 and R13 follow from tangency
    (given rounded as (7.7, 80.1348) and (23.01622, 14.90893) mm below the top).
    """
    flank = math.atan2(20.0, 1.0)
    path = _Path(0.0, 0.0, 0.0)
    path.arc_to(0.3, math.asin(10.5 / 300.0))
    centre = 10.5e-3 * (1.0 - 80.0 / 300.0)
    path.arc_to(0.08, math.asin((25.988e-3 - centre) / 0.08))
    path.arc_to(0.013, flank)
    path.line_down(flank_depth)
    y, z = path.points()
    return Profile(
        "UIC60",
        "rail",
        np.concatenate((-y[:0:-1], y)),
        np.concatenate((z[:0:-1], z)),
        source="UIC 861-3 / EN 13674-1, head of 60E1 (UIC60): R300, R80, R13, flank 1:20; "
        "not inclined",
    )


def aar_1_20(
    *,
    taper: float = 1.0 / 20.0,
    throat_radius: float = 11.0 / 16.0 * INCH,
    flange_angle: float = math.radians(75.0),
    flange_height: float = 1.0 * INCH,
    flange_thickness: float = 37.0 / 32.0 * INCH,
    thickness_depth: float = 3.0 / 8.0 * INCH,
    tape_from_flange_back: float = (2.0 + 27.0 / 32.0) * INCH,
    minimum_face: float = 0.1 * INCH,
    field_end: float = 0.06,
) -> Profile:
    """A reconstruction of the AAR wheel with 1:20 tread; lengths in metres, the angle in radians.

    There is no exact drawing behind it. The chain is tread line, throat fillet, straight flange
    face, arc, crest, arc of the flange back, all tangent. The choices and their reasons:
    taper 1:20 and throat_radius 11/16 in: as the wheel is named and cut in North America;
    flange_angle 75 degrees: the AAR-1B value; older wheels had less, down to 68 degrees;
    flange_height 1 in: tip below the tape line, freight and passenger wheels alike;
    flange_thickness 1 5/32 in (narrow flange; wide: 1 3/8 in), measured from the flange back at
    thickness_depth 3/8 in below the tape line, which is North America's gauge point;
    tape_from_flange_back 2 27/32 in (narrow flange; wide: 3 1/16 in): the tape line of American
    wheels in vehicle dynamics programs. The gauge side then lies 42.9 mm from the tape line with
    both flanges, since both distances differ by 7/32 in;
    minimum_face 0.1 in: least length over which APTA SS-M-015-06 wants the flange angle kept;
    the tip's radius is not chosen: it is the greatest that leaves this face and touches the
    flange's back plane, its greatest depth and its face, 11.6 mm with these values. Where the
    tip is not one arc, a level crest joins two of the same radius (3.8 mm);
    field_end: the tread is straight up to there; the chamfer is left out.

    Raises ProfileError where the pieces do not fit together.
    """
    tread_angle = math.atan(taper)
    if not 0.0 <= tread_angle < flange_angle < math.radians(89.0):
        raise ProfileError(
            f"flange_angle = {flange_angle:g} rad and taper = {taper:g} leave no throat; "
            "use an angle between atan(taper) and 1.55 rad"
        )
    back = -tape_from_flange_back
    gauge_point = back + flange_thickness
    # The fillet's tangent point on the tread, throat_start, is found from the gauge point.
    sin_t, cos_t = math.sin(tread_angle), math.cos(tread_angle)
    sin_f, cos_f = math.sin(flange_angle), math.cos(flange_angle)

    def depth_at_gauge_point(throat_start: float) -> float:
        centre_y = throat_start + throat_radius * sin_t
        centre_z = throat_start * taper - throat_radius * cos_t
        face_y, face_z = centre_y - throat_radius * sin_f, centre_z + throat_radius * cos_f
        if gauge_point <= face_y:
            return -(face_z + (gauge_point - face_y) * math.tan(flange_angle))
        if gauge_point >= throat_start:
            return -gauge_point * taper
        return -(centre_z + math.sqrt(throat_radius**2 - (gauge_point - centre_y) ** 2))

    low, high = gauge_point, gauge_point + 2.0 * throat_radius
    if not depth_at_gauge_point(low) < thickness_depth < depth_at_gauge_point(high):
        raise ProfileError(
            f"thickness_depth = {thickness_depth:g} m is not on the flange; "
            "use 5 to 15 mm and a flange_thickness of 25 to 36 mm"
        )
    throat_start = float(
        brentq(lambda y: depth_at_gauge_point(y) - thickness_depth, low, high, xtol=1e-14)
    )
    centre_y = throat_start + throat_radius * sin_t
    centre_z = throat_start * taper - throat_radius * cos_t
    face_y, face_z = centre_y - throat_radius * sin_f, centre_z + throat_radius * cos_f

    # A circle that touches the back plane and the depth has its centre (back + R, R - height); it
    # touches the face's line too where (face_z - z) cos_f - (face_y - y) sin_f = -R.
    inscribed = ((face_y - back) * sin_f - (face_z + flange_height) * cos_f) / (1.0 + sin_f - cos_f)
    below_face = (face_z - minimum_face * sin_f + flange_height) / (1.0 - cos_f)
    tip_radius = min(inscribed, below_face)
    tip_z = tip_radius - flange_height
    tip_end_z = tip_z - tip_radius * cos_f
    tip_end_y = face_y - (face_z - tip_end_z) * cos_f / sin_f
    front_y, back_y = tip_end_y - tip_radius * sin_f, back + tip_radius
    if not (tip_radius > 1e-3 and tip_end_z < face_z and front_y > back_y - 1e-12):
        raise ProfileError(
            f"the flange tip (radius {1e3 * tip_radius:.2f} mm) and the throat overlap; "
            "make the flange higher or thicker, or the throat radius or minimum_face smaller"
        )

    # The arc stops 5 degrees short of the vertical flange back, where z(y) would end.
    back_angle = math.radians(-85.0)
    back_arc = _angles(back_angle, 0.0, tip_radius)
    crest = _steps(front_y - back_y)[1:-1] if front_y > back_y + 1e-6 else np.empty(0)
    front_arc = _angles(0.0, flange_angle, tip_radius)[(0 if len(crest) else 1) :]
    throat = _angles(flange_angle, tread_angle, throat_radius)
    face = _steps(math.hypot(face_y - tip_end_y, face_z - tip_end_z))[1:-1]
    tread = throat_start + (field_end - throat_start) * _steps(field_end - throat_start)[1:]
    y = np.concatenate(
        (
            back_y + tip_radius * np.sin(back_arc),
            back_y + crest * (front_y - back_y),
            front_y + tip_radius * np.sin(front_arc),
            tip_end_y + face * (face_y - tip_end_y),
            centre_y - throat_radius * np.sin(throat),
            tread,
        )
    )
    z = np.concatenate(
        (
            tip_z - tip_radius * np.cos(back_arc),
            np.full(len(crest), -flange_height),
            tip_z - tip_radius * np.cos(front_arc),
            tip_end_z + face * (face_z - tip_end_z),
            centre_z + throat_radius * np.cos(throat),
            tread * taper,
        )
    )
    return Profile(
        "AAR_1_20",
        "wheel",
        y,
        z,
        source="reconstruction, not a drawing: AAR 1:20 tread, "
        f"throat {1e3 * throat_radius:.4f} mm, flange angle {math.degrees(flange_angle):.1f} deg, "
        f"height {1e3 * flange_height:.2f} mm, thickness {1e3 * flange_thickness:.3f} mm "
        f"at {1e3 * thickness_depth:.3f} mm below the tape line, tip {1e3 * tip_radius:.3f} mm",
    )


def cone(conicity: float) -> Profile:
    """A conical wheel z = conicity * y, straight from y = -70 to 60 mm; the radius grows with -y.

    conicity: tangent of the cone's angle [-], 0 to 1.
    """
    if not 0.0 <= conicity <= 1.0:
        raise ProfileError(f"conicity = {conicity:g}; use 0 to 1 (the usual 1:20 is 0.05)")
    y = np.linspace(-0.07, 0.06, 1301)
    return Profile(
        f"cone_{conicity:g}", "wheel", y, conicity * y, source=f"straight cone z = {conicity:g} y"
    )


def knife_edge(radius: float = 1e-3, depth: float = 0.035) -> Profile:
    """A rail that is a narrow ridge: an arc of `radius` [m] with flanks of 20:1 down to -depth.

    radius: 0.2 mm to 10 mm. With 1 mm, the contact point of a cone of 1:20 lies 0.05 mm beside
    the middle.
    """
    if not 2e-4 <= radius <= 1e-2:
        raise ProfileError(f"radius = {radius:g} m; use 2e-4 to 1e-2 m")
    path = _Path(0.0, 0.0, 0.0, sampling=min(_SAMPLING, 0.02 * radius))
    path.arc_to(radius, math.atan2(20.0, 1.0))
    path.line_down(depth)
    y, z = path.points()
    return Profile(
        "knife_edge",
        "rail",
        np.concatenate((-y[:0:-1], y)),
        np.concatenate((z[:0:-1], z)),
        source=f"ridge of radius {1e3 * radius:g} mm with flanks 20:1",
    )


class _Path:
    """A tangent chain of arcs and a line from (y, z), turning downwards as y grows [m, rad]."""

    def __init__(self, y: float, z: float, angle: float, sampling: float = _SAMPLING) -> None:
        self._y, self._z, self._angle, self._sampling = y, z, angle, sampling
        self._pieces: list[tuple[FloatArray, FloatArray]] = [(np.array([y]), np.array([z]))]

    def arc_to(self, radius: float, angle: float) -> None:
        angles = _angles(self._angle, angle, radius, self._sampling)[1:]
        centre_y = self._y - radius * math.sin(self._angle)
        centre_z = self._z - radius * math.cos(self._angle)
        self._add(centre_y + radius * np.sin(angles), centre_z + radius * np.cos(angles))
        self._angle = angle

    def line_down(self, depth: float) -> None:
        length = (self._z + depth) / math.sin(self._angle)
        along = length * _steps(length, self._sampling)[1:]
        self._add(self._y + along * math.cos(self._angle), self._z - along * math.sin(self._angle))

    def points(self) -> tuple[FloatArray, FloatArray]:
        y = np.concatenate([piece[0] for piece in self._pieces])
        z = np.concatenate([piece[1] for piece in self._pieces])
        return y, z

    def _add(self, y: FloatArray, z: FloatArray) -> None:
        self._pieces.append((y, z))
        self._y, self._z = float(y[-1]), float(z[-1])


def _steps(length: float, sampling: float = _SAMPLING) -> FloatArray:
    """Equal fractions 0..1 of a length [m], at most `sampling` apart."""
    return np.linspace(0.0, 1.0, max(2, math.ceil(length / sampling)) + 1)


def _angles(start: float, end: float, radius: float, sampling: float = _SAMPLING) -> FloatArray:
    """Equal steps of an angle [rad] along an arc of `radius` [m]."""
    return start + (end - start) * _steps(abs(end - start) * radius, sampling)
