"""What a profile's points are worth: points, curve, residuals, curvature, equivalent conicity.

The profile is drawn with the curve that it has and with that of smoothing "auto" beside it. What
noise means for conicity is found twice: as the difference between the two curves, and as the spread
over other errors, put on the automatic curve and smoothed away again. These are the residuals
themselves, moved along the curve by chance, so that errors of neighbours stay as alike as they are
(bootstrap of residuals by blocks: H. R. Kuensch, Annals of Statistics 17, 1989, 1217-1241).
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from exudyn_wheelset.checking import number, positive
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.errors import WheelsetError, WheelsetWarning
from exudyn_wheelset.front.plots import new_figure
from exudyn_wheelset.geometry.conicity import equivalent_conicity
from exudyn_wheelset.geometry.rolling_radius import rolling_radius_curve
from exudyn_wheelset.profiles import Profile, load_profile
from exudyn_wheelset.profiles.noise import noise_by_spacing
from exudyn_wheelset.spelling import spelt

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]

_AMPLITUDES = 1e-4 * np.arange(5, 61)
_REACH, _SPACING = 9e-3, 5e-5
_RADIUS = 0.46
_GIVEN, _AUTOMATIC, _POINTS = "tab:red", "tab:blue", "0.5"
# A flange or a rail's corner has 80 1/m; what noise adds may be a thousand.
_SHOWN_CURVATURE = 120.0


class ProfileReport(NamedTuple):
    """figure: matplotlib Figure; numbers: SI values by name; text: what they mean, in words."""

    figure: Figure
    numbers: dict[str, float | None]
    text: str


@spelt
def profile_report(
    profile: Profile | str,
    partner: Profile | str | None = None,
    *,
    gauge: float = 1.435,
    gauge_depth: float = 0.014,
    inclination: float = 1.0 / 40.0,
    samples: int = 4,
) -> ProfileReport:
    """Draw points, curve, residuals and curvature of a profile and say what it means for conicity.

    profile, partner: each a Profile, a name or a path.
    partner: the other profile of the pair; UIC60 for a wheel, S1002 for a rail by default. gauge,
    gauge_depth [m] and inclination [-]: of the track; 0 for rails measured in the track.
    samples: of other errors for the spread of conicity, 0 for none.
    Numbers: points; spacing, noise, smoothing, automatic_smoothing, residual_rms, residual_largest
    [m] (points to the automatic curve); noise_every_second, noise_every_fourth [m], larger where
    the errors of neighbours are alike; curvature_noise [1/m]; conicity_1mm, conicity_3mm,
    automatic_conicity_1mm, automatic_conicity_3mm, spread_1mm, spread_3mm [-] (None without
    contact). Raises WheelsetError where profile and partner are both wheels or both rails.

    Examples
    --------
    >>> from exudyn_wheelset import load_profile, profile_report
    >>> report = profile_report(load_profile("S1002"), samples=0)
    >>> round(report.numbers["conicity_3mm"], 2)
    0.18
    """
    positive("gauge", gauge, "m", 3.0)
    positive("gauge_depth", gauge_depth, "m", 0.05)
    number("inclination", inclination, "-", -0.2, 0.2, "a slope such as 1/40")
    if isinstance(samples, bool) or not isinstance(samples, int | np.integer) or samples < 0:
        raise WheelsetError(f"samples = {samples!r}: give a whole number, 0 for no spread")
    profile = load_profile(profile)
    if partner is None:
        partner = "UIC60" if profile.kind == "wheel" else "S1002"
    other = load_profile(partner)
    if other.kind == profile.kind:
        raise WheelsetError(f"{other.name} is a {other.kind} as {profile.name} is: give a pair")
    automatic = profile.smoothed("auto")
    points = np.column_stack((profile.y, profile.z))
    residual = _residuals(profile, automatic)
    by_spacing = noise_by_spacing(points)

    def conicity(one: Profile) -> FloatArray | None:
        wheel, rail = (one, other) if one.kind == "wheel" else (other, one)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", WheelsetWarning)
            try:
                track = Track(rail, gauge, gauge_depth, inclination)
                wheelset = Wheelset(1000.0, (600.0, 100.0, 600.0), _RADIUS, wheel)
                curve = rolling_radius_curve(wheelset, track, _REACH, _SPACING)
                y, difference = curve.y, curve.rolling_radius_difference
                forward = np.concatenate(([True], np.diff(np.maximum.accumulate(y)) > 0.0))
                return equivalent_conicity(y[forward], difference[forward], _AMPLITUDES)
            except WheelsetError:
                return None

    given, smooth = conicity(profile), conicity(automatic)
    drawn = [conicity(sample) for sample in _samples(automatic, residual, samples)]
    others = [curve for curve in drawn if curve is not None]
    spread = np.std(others, axis=0) if len(others) > 1 else None
    at = {"1mm": int(np.argmin(np.abs(_AMPLITUDES - 1e-3)))}
    at["3mm"] = int(np.argmin(np.abs(_AMPLITUDES - 3e-3)))
    numbers: dict[str, float | None] = {
        "points": len(profile.y),
        "spacing": float(np.median(np.hypot(*np.diff(points, axis=0).T))),
        "noise": profile.noise,
        "noise_every_second": by_spacing.get(2),
        "noise_every_fourth": by_spacing.get(4),
        "smoothing": float(profile.smoothing),
        "automatic_smoothing": float(automatic.smoothing),
        "residual_rms": float(np.sqrt(np.mean(residual**2))),
        "residual_largest": float(np.max(np.abs(residual))),
        "curvature_noise": profile.curvature_noise,
    }
    for name, curve in (("conicity", given), ("automatic_conicity", smooth), ("spread", spread)):
        for amplitude, k in at.items():
            value = None if curve is None or not np.isfinite(curve[k]) else float(curve[k])
            numbers[f"{name}_{amplitude}"] = value
    figure = _draw(profile, automatic, residual, given, smooth, spread, other.name)
    return ProfileReport(figure, numbers, _in_words(profile, numbers, other.name))


def _residuals(profile: Profile, automatic: Profile) -> FloatArray:
    """Distances of the points normal to the automatic curve [m], positive above it."""
    y = np.clip(profile.y, *automatic.span)
    slope = automatic.slope(y)
    return (profile.z - automatic.height(y)) / np.hypot(1.0, slope)


def _samples(automatic: Profile, residual: FloatArray, count: int) -> list[Profile]:
    """The automatic curve at its own points with other errors, smoothed again."""
    if automatic.smoothing == 0.0:
        return []
    y = np.clip(automatic.y, *automatic.span)
    z, slope = automatic.height(y), automatic.slope(y)
    stretch = np.hypot(1.0, slope)
    # A flange's tip or a step between two sweeps may be off by far more than the rest.
    usual = 1.4826 * float(np.median(np.abs(residual)))
    clipped = np.clip(residual, -3.0 * usual, 3.0 * usual)
    found = []
    for seed in range(count):
        chance = np.random.default_rng(seed)
        error = np.roll(clipped, int(chance.integers(len(y)))) * chance.choice((-1.0, 1.0))
        moved = y - error * slope / stretch
        keep = np.concatenate(([True], moved[1:] > np.maximum.accumulate(moved)[:-1] + 1e-9))
        raised = (z + error / stretch)[keep]
        try:
            sample = replace(
                automatic, y=moved[keep], z=raised, smoothing="auto", is_automatic=False
            )
        except WheelsetError:
            continue
        found.append(sample)
    return found


def _draw(
    profile: Profile,
    automatic: Profile,
    residual: FloatArray,
    given: FloatArray | None,
    smooth: FloatArray | None,
    spread: FloatArray | None,
    partner: str,
) -> Figure:
    figure, panels = new_figure(11.0, 8.0, 2, 2)
    shape, rest, bend, conicity = panels.ravel()
    y = np.linspace(*automatic.span, 2000)
    shape.plot(1e3 * profile.y, 1e3 * profile.z, ".", color=_POINTS, markersize=3, label="points")
    shape.plot(1e3 * y, 1e3 * automatic.height(y), color=_AUTOMATIC, linewidth=1.0, label="auto")
    shape.set_aspect("equal", adjustable="datalim")
    shape.set(xlabel="y, to the field side [mm]", ylabel="z [mm]")
    rest.plot(1e3 * profile.y, 1e6 * residual, ".-", color=_POINTS, markersize=3, linewidth=0.4)
    for level in (-profile.noise, profile.noise):
        rest.axhline(1e6 * level, color=_AUTOMATIC, linewidth=0.8, linestyle="--")
    rest.set(xlabel="y [mm]", ylabel="points to the automatic curve [µm]")
    own = np.linspace(*profile.span, 2000)
    label = f"as given, smoothing {1e6 * float(profile.smoothing):.3g} µm"
    bend.plot(1e3 * own, profile.curvature(own), color=_GIVEN, linewidth=0.6, label=label)
    label = f"auto, {1e6 * float(automatic.smoothing):.3g} µm"
    bend.plot(1e3 * y, automatic.curvature(y), color=_AUTOMATIC, linewidth=1.2, label=label)
    bend.set_ylim(-_SHOWN_CURVATURE, _SHOWN_CURVATURE)
    bend.set(xlabel="y [mm]", ylabel="curvature [1/m]")
    bend.legend(fontsize="small")
    for curve, colour, name in ((given, _GIVEN, "as given"), (smooth, _AUTOMATIC, "auto")):
        if curve is not None:
            conicity.plot(1e3 * _AMPLITUDES, curve, color=colour, label=name)
    if smooth is not None and spread is not None:
        conicity.fill_between(
            1e3 * _AMPLITUDES, smooth - spread, smooth + spread, color=_AUTOMATIC, alpha=0.2
        )
    conicity.set_ylim(bottom=0.0)
    conicity.set(xlabel="amplitude [mm]", ylabel=f"equivalent conicity on {partner}")
    if given is not None or smooth is not None:
        conicity.legend(fontsize="small")
    figure.suptitle(f"{profile.name}: {len(profile.y)} points, noise {1e6 * profile.noise:.2g} µm")
    return figure


def _in_words(profile: Profile, numbers: dict[str, float | None], partner: str) -> str:
    spacing, noise = numbers["spacing"] or 0.0, profile.noise
    said = [
        f"{profile.name}: {len(profile.y)} points {1e3 * spacing:.2f} mm apart, "
        f"{1e6 * noise:.2g} micrometres off (white noise)."
    ]
    fourth = numbers["noise_every_fourth"] or numbers["noise_every_second"]
    if fourth is not None and fourth > 2.0 * noise and fourth > 2e-7:
        said.append(
            f"Every few points they are {1e6 * fourth:.2g} micrometres off: errors of neighbours "
            "are alike, or the surface has short waves."
        )
    if profile.curvature_noise > 0.1:
        said.append(f"The curve's curvature is off by {profile.curvature_noise:.3g} 1/m.")
    before, after = numbers["conicity_3mm"], numbers["automatic_conicity_3mm"]
    if after is None:
        said.append(f"On {partner} it has no conicity at 3 mm: check gauge and inclination.")
        return " ".join(said)
    words = "none" if before is None else f"{before:.4f}"
    said.append(
        f"Conicity on {partner} at 3 mm: {words} as given, {after:.4f} with smoothing='auto'"
        + (f" +- {numbers['spread_3mm']:.4f}." if numbers["spread_3mm"] is not None else ".")
    )
    return " ".join(said + [f"Note: {remark}." for remark in profile.remarks])
