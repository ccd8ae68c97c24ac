"""Figures of contact geometry: what shows at a glance how a wheel profile fits a rail.

Rolling-radius difference, contact angle and contact positions over the lateral shift; equivalent
conicity over the amplitude; the connection plot, in which lines join the points of wheel and rail
that touch at each shift. Each function draws into given axes; `contact_figure` puts all together.

Inputs SI, track frame; axes in mm and degrees. Connection plots look in the direction of travel,
the left rail to the left.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from exudyn_wheelset.contact.descriptions import RailPlacement, Track, Wheelset
from exudyn_wheelset.front.output import file_stem, write_figure
from exudyn_wheelset.front.plots import LEFT_COLOUR, RIGHT_COLOUR, new_figure, tidy
from exudyn_wheelset.geometry.rigid import ContactGeometry, ContactSide
from exudyn_wheelset.geometry.rolling_pair import RollingPair, flange_contact
from exudyn_wheelset.profiles import Profile
from exudyn_wheelset.results.files import write_columns

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DRAWN_AMPLITUDES = 1e-4 * np.arange(5, 101)
_WHEEL_LIFT = 16.0
_BODY = "0.93"
SHIFT_TEXTS = {
    "rail": "shift at rail level",
    "axle": "shift of the axle's centre",
    "level": "axle held level",
}


def describe(wheelset: Wheelset, track: Track) -> str:
    """One line of what is in contact: profiles, gauge, inclination, radii."""
    wheel, rail = wheelset.wheel.name, track.rail.name
    if wheelset.right_wheel is not None:
        wheel = f"{wheel} (left), {wheelset.right_wheel.name} (right)"
    if track.right_rail is not None:
        rail = f"{rail} (left), {track.right_rail.name} (right)"
    if track.origin_half_distance is not None:
        place = f"rail origins at ±{1e3 * track.origin_half_distance:g} mm"
    elif track.datum_half_distance is not None:
        place = f"rail tops at ±{1e3 * track.datum_half_distance:g} mm"
    else:
        place = f"gauge {1e3 * track.gauge:g} mm"
    inclination = (
        f"inclination 1:{1 / track.inclination:g}" if track.inclination else "rails not turned"
    )
    radius = f"$r_0$ = {1e3 * wheelset.radius:g} mm"
    if wheelset.right_radius is not None:
        radius += f" (left), {1e3 * wheelset.right_radius:g} mm (right)"
    return f"{wheel} on {rail}\n{place}, {inclination}, {radius}"


def plot_rolling_radius_difference(axes: Axes, geometry: ContactGeometry) -> None:
    """Draw r_left - r_right over the shift, scaled to the treads: flanges may leave the frame."""
    shifts, heights = 1e3 * geometry.y, 1e3 * geometry.rolling_radius_difference
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    axes.plot(shifts, heights, color="k")
    tread = np.abs(heights[~flange_contact(geometry)])
    if tread.size:
        limit = 1.6 * max(float(tread.max()), 0.5)
        if limit < np.abs(heights).max():
            axes.set_ylim(-limit, limit)
    axes.set_ylabel(r"$r_\mathrm{left} - r_\mathrm{right}$ [mm]")
    axes.set_title("Rolling-radius difference")
    _over_shift(axes, shifts)


def plot_conicity(
    axes: Axes, amplitudes: ArrayLike, conicity: ArrayLike, marked_amplitude: float = 3.0e-3
) -> None:
    """Draw tan(gamma_e) over the amplitude, shape (n,) [m]; NaN leaves a gap.

    The value at marked_amplitude [m] is marked and stands in the legend.
    """
    at, values = np.asarray(amplitudes, dtype=float), np.asarray(conicity, dtype=float)
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    axes.plot(1e3 * at, values, color="k")
    known = np.isfinite(values)
    if np.any(known) and at[known][0] <= marked_amplitude <= at[known][-1]:
        value = float(np.interp(marked_amplitude, at[known], values[known]))
        label = f"{value:.3f} at {1e3 * marked_amplitude:g} mm"
        axes.plot(1e3 * marked_amplitude, value, "o", color="tab:orange", label=label)
        axes.legend()
    axes.set_xlabel("amplitude [mm]")
    axes.set_ylabel(r"$\tan\gamma_e$ [-]")
    axes.set_title("Equivalent conicity")
    axes.set_xlim(0.0, 1e3 * at.max())
    axes.set_ylim(bottom=min(0.0, 1.1 * float(np.nanmin(values))) if np.any(known) else 0.0)
    tidy(axes)


def plot_contact_angle(axes: Axes, geometry: ContactGeometry) -> None:
    """Draw the contact angles of both wheels over the shift."""
    shifts = 1e3 * geometry.y
    for side, name, colour in _sides(geometry):
        axes.plot(shifts, np.degrees(side.angle), color=colour, label=name)
    axes.set_ylabel("contact angle [°]")
    axes.set_title("Contact angle, positive towards the track centre")
    axes.legend(loc="upper center")
    _over_shift(axes, shifts)


def plot_contact_positions(axes: Axes, geometry: ContactGeometry) -> None:
    """Draw where wheel and rail are touched, positive to the field side, over the shift."""
    shifts = 1e3 * geometry.y
    for side, name, colour in _sides(geometry):
        axes.plot(shifts, 1e3 * side.wheel_y, color=colour, label=f"{name} wheel")
        axes.plot(shifts, 1e3 * side.rail_y, color=colour, linestyle="--", label=f"{name} rail")
    axes.set_ylabel("from tape circle, rail's top [mm]")
    axes.set_title("Contact positions, positive to the field side")
    axes.legend(loc="lower center", ncols=2, fontsize="small")
    _over_shift(axes, shifts)


def plot_contact_points(
    axes: Axes,
    wheelset: Wheelset,
    track: Track,
    geometry: ContactGeometry,
    side: str,
    step: float = 1.0e-3,
) -> None:
    """Draw one side's profiles and join the points that touch, one line per `step` [m] of shift.

    side: "left" or "right". Shifts up to 2 mm beyond the first flange contact. The wheel stands at
    y = 0, lifted by 16 mm; numbers are shifts in mm.
    """
    left = side == "left"
    hand = 1.0 if left else -1.0
    wheel = wheelset.wheel if left or wheelset.right_wheel is None else wheelset.right_wheel
    rail = track.left_placement if left else track.right_placement
    points = geometry.left if left else geometry.right
    tape = 1e3 * wheelset.tape_half_distance
    wheel_y, wheel_z = 1e3 * _curve_of(wheel)
    rail_y, rail_z = 1e3 * _curve_of(rail)
    head = rail_z > -22.0
    bottom, top = -20.0, _WHEEL_LIFT + 14.0
    axes.fill_between(hand * rail_y[head], rail_z[head], bottom, color=_BODY, linewidth=0.0)
    axes.fill_between(hand * (tape + wheel_y), wheel_z + _WHEEL_LIFT, top, color=_BODY, lw=0.0)
    axes.plot(hand * rail_y[head], rail_z[head], color="k")
    axes.plot(hand * (tape + wheel_y), wheel_z + _WHEEL_LIFT, color="k")

    low, high = _shown_range(geometry.y, flange_contact(geometry))
    marked = _nearest_multiples(geometry.y, step)
    marked = marked[(1e3 * geometry.y[marked] >= low) & (1e3 * geometry.y[marked] <= high)]
    on_wheel = tape + 1e3 * points.wheel_y[marked]
    on_rail = 1e3 * (rail.datum_y + points.rail_y[marked])
    on_wheel_z = np.interp(on_wheel - tape, wheel_y, wheel_z) + _WHEEL_LIFT
    on_rail_z = np.interp(on_rail, rail_y, rail_z)
    colour = LEFT_COLOUR if left else RIGHT_COLOUR
    ends_y, ends_z = hand * np.array([on_wheel, on_rail]), np.array([on_wheel_z, on_rail_z])
    axes.plot(ends_y, ends_z, color=colour, linewidth=0.7)
    axes.plot(ends_y.ravel(), ends_z.ravel(), ".", color=colour, markersize=4)
    # Into the wheel, along its normal.
    slope = np.interp(on_wheel - tape, wheel_y, np.gradient(wheel_z, wheel_y))
    inwards = 2.2 / np.hypot(slope, 1.0) * np.array([-hand * slope, np.ones_like(slope)])
    _number(axes, ends_y[0] + inwards[0], ends_z[0] + inwards[1], 1e3 * geometry.y[marked])

    axes.set_aspect("equal")
    # Field side first: left of the picture on the left, right of it on the right.
    ends = (tape + 50.0, tape - 62.0)
    axes.set_xlim(*(ends if left else (-ends[1], -ends[0])))
    axes.set_ylim(bottom, top)
    axes.set_xlabel("y [mm]")
    axes.set_ylabel("z [mm]")
    axes.set_title(f"Contact points, {side} (wheel lifted, at the shifts y in mm)")
    tidy(axes)


def contact_figure(
    wheelset: Wheelset,
    track: Track,
    geometry: ContactGeometry,
    amplitudes: ArrayLike,
    conicity: ArrayLike,
    shift: str = "axle",
) -> Figure:
    """Return a figure with rolling radii, conicity, contact angles, positions and points.

    geometry: rigid contact over shifts y; amplitudes [m], conicity [-]: shape (n,); shift: what y
    is the shift of, "rail", "axle" or "level" (geometry/rolling_radius.py).
    """
    figure, axes = new_figure(12.0, 12.0, 3, 2)
    flange = flange_contact(geometry)
    plot_rolling_radius_difference(axes[0, 0], geometry)
    plot_conicity(axes[0, 1], amplitudes, conicity)
    plot_contact_angle(axes[1, 0], geometry)
    plot_contact_positions(axes[1, 1], geometry)
    shown = _shown_range(geometry.y, flange)
    for panel in (axes[0, 0], axes[1, 0], axes[1, 1]):
        _shade(panel, geometry.y, flange)
        panel.set_xlim(*shown)
    plot_contact_points(axes[2, 0], wheelset, track, geometry, "left")
    plot_contact_points(axes[2, 1], wheelset, track, geometry, "right")
    figure.suptitle(describe(wheelset, track) + ", " + SHIFT_TEXTS[shift])
    return figure


def keep_conicity(out: Path, pair: RollingPair, method: str = "integration") -> list[Path]:
    """Keep the figure of a pair, its contact by shift and its conicity by amplitude; the files.

    conicity_<wheel>_<rail>.png, ..._shifts.csv, ..._amplitudes.csv; lengths in mm, angles in
    degrees.
    """
    geometry, amplitudes = pair.geometry, DRAWN_AMPLITUDES
    conicity = pair.conicity(amplitudes, method)
    stem = file_stem("conicity", pair.wheelset, pair.track)
    columns = {
        "y_mm": 1e3 * geometry.y,
        "rolling_radius_difference_mm": 1e3 * geometry.rolling_radius_difference,
        "roll_mrad": 1e3 * geometry.roll,
        "z_mm": 1e3 * geometry.z,
    }
    for side, name, _ in _sides(geometry):
        columns[f"{name}_wheel_y_mm"] = 1e3 * side.wheel_y
        columns[f"{name}_rail_y_mm"] = 1e3 * side.rail_y
        columns[f"{name}_angle_deg"] = np.degrees(side.angle)
        columns[f"{name}_radius_mm"] = 1e3 * side.radius
    by_amplitude = {"amplitude_mm": 1e3 * amplitudes, "conicity": conicity}
    figure = contact_figure(pair.wheelset, pair.track, geometry, amplitudes, conicity, pair.shift)
    return [
        write_figure(out / f"{stem}.png", figure),
        write_columns(out / f"{stem}_shifts.csv", columns),
        write_columns(out / f"{stem}_amplitudes.csv", by_amplitude),
    ]


def _sides(geometry: ContactGeometry) -> tuple[tuple[ContactSide, str, str], ...]:
    return (
        (geometry.left, "left", LEFT_COLOUR),
        (geometry.right, "right", RIGHT_COLOUR),
    )


def _over_shift(axes: Axes, shifts: np.ndarray) -> None:
    axes.set_xlabel("lateral shift y [mm], positive to the left")
    axes.set_xlim(shifts.min(), shifts.max())
    tidy(axes)


def _shade(axes: Axes, y: np.ndarray, flange: np.ndarray) -> None:
    """Grey where a flange touches."""
    low, high = axes.get_ylim()
    axes.fill_between(
        1e3 * y, low, high, where=list(flange), color="0.9", linewidth=0.0, zorder=0, step="mid"
    )
    axes.set_ylim(low, high)


def _shown_range(y: np.ndarray, flange: np.ndarray) -> tuple[float, float]:
    """Shifts [mm] from 2 mm beyond the first flange contact on the right to the left."""
    right, left = y[flange & (y < 0.0)], y[flange & (y > 0.0)]
    low = max(y[0], right.max() - 2e-3) if right.size else y[0]
    high = min(y[-1], left.min() + 2e-3) if left.size else y[-1]
    return 1e3 * float(low), 1e3 * float(high)


def _curve_of(curve: Profile | RailPlacement) -> np.ndarray:
    """Points (2, n) of a profile or a placed rail [m]."""
    table = curve.arc_table() if isinstance(curve, Profile) else curve
    return np.array([table.coefficients[:, 0], table.coefficients[:, 4]])


def _nearest_multiples(y: np.ndarray, step: float) -> np.ndarray:
    """Indices of the shifts nearest to the multiples of step."""
    wanted = step * np.arange(np.ceil(y[0] / step - 1e-6), np.floor(y[-1] / step + 1e-6) + 1)
    return np.unique(np.abs(y[:, None] - wanted).argmin(axis=0))


def _number(axes: Axes, across: np.ndarray, up: np.ndarray, shifts: np.ndarray) -> None:
    """Write shifts at places, small ones first, leaving out what would overlap."""
    taken: list[tuple[float, float]] = []
    for k in np.argsort(np.abs(shifts), kind="stable"):
        place = (float(across[k]), float(up[k]))
        if any(abs(place[0] - x) < 3.6 and abs(place[1] - z) < 3.2 for x, z in taken):
            continue
        taken.append(place)
        axes.text(*place, f"{round(shifts[k]):d}", ha="center", va="center", fontsize=8)
