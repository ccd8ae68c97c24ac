"""Draw the figures of docs/profiles.md: what smoothing does to a profile's curvature and conicity.

profile_smoothing.png: S1002 sampled every 0.2 mm, its points 10 micrometres (standard deviation,
seeded) off the true line, and the curvature of the curve at several smoothing tolerances and at
"auto" beside that of the formula. profile_noise.png: equivalent conicity of such points, as they
are and smoothed automatically, with its error over noise and spacing. Prints the errors that the
page quotes; those of measured wheels where they lie beside the repository.
"""

import warnings
from collections.abc import Callable
from pathlib import Path

import matplotlib
import numpy as np
from numpy.typing import NDArray
from scipy.special import erf

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from exudyn_wheelset import Track, Wheelset, WheelsetWarning, equivalent_conicity
from exudyn_wheelset.geometry.rolling_radius import rolling_radius_curve
from exudyn_wheelset.profiles import Profile, load_profile, mean_profile

HERE = Path(__file__).resolve().parent
MEASURED = HERE.parents[2] / "shared" / "reference" / "profiles"
AMPLITUDES = 1e-3 * np.array([1.0, 3.0])
SEEDS = range(8)
SAMPLES = 40
LIMITS = np.array([0.02, 0.01])
NOISE = 1e-5
SPACING = 2e-4
BUMP_WIDTH = 3e-3
TOLERANCES = (0.0, 0.95e-5, 1.0e-5, 1.05e-5, 1.2e-5, 2e-5, 5e-5)
SHOWN = (0.95e-5, 1.05e-5, 2e-5, 5e-5)


def with_noise(clean: Profile, deviation: float, spacing: float, seed: int) -> Profile:
    """A profile as an instrument with normally distributed errors across it sees it."""
    points = clean.resampled(spacing)
    error = np.random.default_rng(seed).normal(0.0, deviation, len(points.y))
    angle = np.arctan(clean.slope(np.clip(points.y, *clean.span)))
    y, z = points.y - np.sin(angle) * error, points.z + np.cos(angle) * error
    keep = np.concatenate(([True], y[1:] > np.maximum.accumulate(y)[:-1] + 1e-7))
    return Profile(f"{clean.name} with noise", clean.kind, y[keep], z[keep])


def conicity(
    wheel: Profile, track: Track, amplitudes: NDArray[np.float64] = AMPLITUDES
) -> NDArray[np.float64]:
    wheelset = Wheelset(1000.0, (600.0, 100.0, 600.0), 0.46, wheel)
    curve = rolling_radius_curve(wheelset, track, 9e-3, 2.5e-5)
    forward = np.concatenate(([True], np.diff(np.maximum.accumulate(curve.y)) > 0.0))
    return equivalent_conicity(
        curve.y[forward], curve.rolling_radius_difference[forward], amplitudes
    )


def rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2)))


def curvature_figure() -> None:
    exact = load_profile("S1002")
    noisy = with_noise(exact, NOISE, SPACING, 0)
    tread, throat = np.linspace(-0.02, 0.03, 600), np.linspace(-0.038, -0.030, 300)
    print("smoothing | tread: height, slope, curvature | throat: curvature (rms errors)")
    for tolerance in (*TOLERANCES, "auto"):
        curve = noisy.smoothed(tolerance)
        height = rms(curve.height(tread) - exact.height(tread))
        slope = rms(curve.slope(tread) - exact.slope(tread))
        tread_error = rms(curve.curvature(tread) - exact.curvature(tread))
        throat_error = rms(curve.curvature(throat) - exact.curvature(throat))
        label = "auto, " if tolerance == "auto" else ""
        print(
            f"{label}{1e6 * float(curve.smoothing):5.1f} um | {1e6 * height:6.2f} um, "
            f"{1e3 * slope:8.3f} mrad, {tread_error:9.2f} 1/m | {throat_error:9.2f} 1/m"
        )

    figure, axes = plt.subplots(2, 1, figsize=(8.0, 7.0), constrained_layout=True)
    views = (
        (axes[0], np.linspace(-0.024, 0.04, 1500), (-12.0, 12.0), "tread"),
        (axes[1], np.linspace(-0.0445, -0.024, 1500), (-110.0, 90.0), "flange throat and flange"),
    )
    for axis, y, limits, title in views:
        for tolerance in SHOWN:
            label = f"smoothing {1e6 * tolerance:g} µm"
            axis.plot(1e3 * y, noisy.smoothed(tolerance).curvature(y), linewidth=0.8, label=label)
        automatic = noisy.smoothed("auto")
        axis.plot(1e3 * y, automatic.curvature(y), "r", linewidth=2.0, label="automatic")
        axis.plot(1e3 * y, exact.curvature(y), "k--", linewidth=1.4, label="formula")
        axis.set(ylim=limits, ylabel="curvature [1/m]", title=f"S1002, {title}")
        axis.grid(alpha=0.3)
    axes[0].legend(loc="upper left", ncols=2, fontsize="small")
    axes[1].set_xlabel("y, towards the field side [mm]")
    figure.suptitle("Curvature from points with 10 µm noise, 0.2 mm apart")
    path = HERE / "profile_smoothing.png"
    figure.savefig(path, dpi=110)
    print(path.name)


def conicity_figure() -> None:
    """Conicity over amplitude, raw and automatic; its error over noise and spacing."""
    exact, track = load_profile("S1002"), Track("UIC60")
    amplitudes = 1e-4 * np.arange(5, 71)
    figure, (over_amplitude, over_noise) = plt.subplots(
        1, 2, figsize=(10.0, 4.2), constrained_layout=True
    )
    for seed in range(6):
        noisy = with_noise(exact, NOISE, SPACING, seed)
        for curve, colour, label in (
            (noisy, "0.65", "10 µm of noise, as it is"),
            (noisy.smoothed("auto"), "tab:red", "smoothing='auto'"),
        ):
            values = conicity(curve, track, amplitudes)
            over_amplitude.plot(
                1e3 * amplitudes,
                values,
                color=colour,
                linewidth=0.8,
                label=label if not seed else None,
            )
    clean = conicity(exact, track, amplitudes)
    over_amplitude.plot(1e3 * amplitudes, clean, "k--", linewidth=1.4, label="formula")
    over_amplitude.set(
        xlabel="amplitude [mm]",
        ylabel="equivalent conicity",
        title="S1002 on UIC60 1:40, points every 0.2 mm",
        ylim=(0.0, 0.5),
    )
    over_amplitude.legend()
    deviations = 1e-6 * np.array([2.0, 5.0, 10.0, 20.0])
    for spacing, marker in ((1e-4, "o"), (2.5e-4, "s"), (5e-4, "^")):
        worst = errors(exact, track, deviations, spacing)
        for k, colour in ((0, "tab:blue"), (1, "tab:green")):
            over_noise.plot(
                1e6 * deviations,
                worst[:, k],
                color=colour,
                marker=marker,
                label=f"{1e3 * AMPLITUDES[k]:g} mm, points every {1e3 * spacing:g} mm",
            )
    for limit, colour in ((0.02, "tab:blue"), (0.01, "tab:green")):
        over_noise.axhline(limit, color=colour, linestyle=":")
    over_noise.set(
        xlabel="noise [µm]", ylabel="worst error of conicity, 8 samples", title="smoothing='auto'"
    )
    over_noise.legend(fontsize="small")
    for axis in (over_amplitude, over_noise):
        axis.grid(alpha=0.3)
    path = HERE / "profile_noise.png"
    figure.savefig(path, dpi=110)
    print(path.name)


def errors(
    clean: Profile, track: Track, deviations: NDArray[np.float64], spacing: float
) -> NDArray[np.float64]:
    """Worst error of conicity at AMPLITUDES over SEEDS, shape (deviations, 2); printed."""
    exact = conicity(clean, track)
    rows = []
    for deviation in deviations:
        samples = [
            conicity(with_noise(clean, deviation, spacing, seed).smoothed("auto"), track) - exact
            for seed in SEEDS
        ]
        rows.append(np.max(np.abs(samples), axis=0))
        print(
            f"{clean.name} on {track.rail.name}, {1e3 * spacing:g} mm, {1e6 * deviation:4.1f} um: "
            f"rms {np.round(np.sqrt(np.mean(np.square(samples), axis=0)), 4)}, "
            f"worst {np.round(rows[-1], 4)} of {np.round(exact, 4)}"
        )
    return np.array(rows)


def noisy_rails() -> None:
    """Errors of conicity from noise on the rail: S1002 on UIC60, whose curvature has steps."""
    wheel, rail = load_profile("S1002"), load_profile("UIC60")
    exact = conicity(wheel, Track(rail))
    for spacing in (1e-4, 2.5e-4):
        for deviation in 1e-6 * np.array([5.0, 10.0, 20.0]):
            samples = [
                conicity(wheel, Track(with_noise(rail, deviation, spacing, seed).smoothed("auto")))
                for seed in SEEDS
            ]
            print(
                f"noise on UIC60, {1e3 * spacing:g} mm, {1e6 * deviation:4.1f} um: worst "
                f"{np.round(np.max(np.abs(np.array(samples) - exact), axis=0), 4)}"
            )


def least_deviation(
    clean: Profile,
    of_pair: Callable[[Profile], NDArray[np.float64]],
    deviation: float,
    spacing: float,
) -> NDArray[np.float64]:
    """Standard deviation of conicity that no unbiased smoother beats (Cramer-Rao), shape (2,).

    For one that knows the clean shape but for the heights of bumps exp(-(y - y_k)^2/(2 WIDTH^2)),
    WIDTH apart, over the tread: sqrt(D F^-1 D), D the conicity's derivatives over the heights, F
    the sum of products of bumps over points, over the noise squared.
    """
    y = np.arange(-0.036, 0.0361, spacing)
    centres = np.arange(-0.03, 0.0301, BUMP_WIDTH)
    bumps = np.exp(-0.5 * ((y - centres[:, None]) / BUMP_WIDTH) ** 2)
    information = bumps @ bumps.T / deviation**2
    angle = np.arctan(clean.slope(np.clip(clean.y, *clean.span)))

    def bumped(centre: float, height: float) -> NDArray[np.float64]:
        offset = height * np.exp(-0.5 * ((clean.y - centre) / BUMP_WIDTH) ** 2)
        y, z = clean.y - np.sin(angle) * offset, clean.z + np.cos(angle) * offset
        keep = np.concatenate(([True], y[1:] > np.maximum.accumulate(y)[:-1] + 1e-7))
        return of_pair(Profile("with a bump", clean.kind, y[keep], z[keep]))

    # as large as what the noise leaves undecided
    height = deviation / np.sqrt(np.sqrt(np.pi) * BUMP_WIDTH / spacing)
    slopes = [(bumped(y, height) - bumped(y, -height)) / (2 * height) for y in centres]
    return np.sqrt(np.sum(np.array(slopes) * np.linalg.solve(information, slopes), axis=0))


def least_deviations() -> None:
    """What the points' noise leaves open, beside the errors that the automatic curve has."""
    wheel, rail = load_profile("S1002"), load_profile("UIC60")
    pairs = {"S1002 on UIC60": (wheel, lambda p: conicity(p, Track(rail)), (1e-4, 2.5e-4, 5e-4))}
    pairs["noise on UIC60"] = (rail, lambda p: conicity(wheel, Track(p)), (1e-4, 2.5e-4))
    if MEASURED.is_dir():
        own = Track(load_profile(MEASURED / "siteb.prr"), inclination=0.0)
        for name in ("worn7216.prw", "worn7813.prw"):
            worn = load_profile(MEASURED / name)
            pairs[f"{name} on its rail"] = (worn, lambda p: conicity(p, own), (2.5e-4,))
            pairs[f"{name} on UIC60"] = (worn, lambda p: conicity(p, Track(rail)), (2.5e-4,))
    for label, (clean, of_pair, spacings) in pairs.items():
        for spacing in spacings:
            for deviation in 1e-6 * np.array([5.0, 10.0, 20.0]):
                least = least_deviation(clean, of_pair, deviation, spacing)
                print(
                    f"{label}, {1e3 * spacing:g} mm, {1e6 * deviation:4.1f} um: least standard "
                    f"deviation {np.round(least, 4)}",
                    flush=True,
                )


def shares_within() -> None:
    """How many samples lie within 0.02 at 1 mm, where the worst of eight does not.

    Beside what an unbiased, normally distributed conicity at the Cramer-Rao bound gives.
    """
    wheel, rail = load_profile("S1002"), load_profile("UIC60")
    cells = [("S1002", wheel, lambda p: conicity(p, Track(rail)), 5e-4, (20.0,))]
    cells += [("noise on UIC60", rail, lambda p: conicity(wheel, Track(p)), 1e-4, (20.0,))]
    cells += [("noise on UIC60", rail, cells[1][2], 2.5e-4, (5.0, 10.0, 20.0))]
    if MEASURED.is_dir():
        worn = load_profile(MEASURED / "worn7216.prw")
        cells += [("worn7216 on UIC60", worn, cells[0][2], 2.5e-4, (5.0, 10.0, 20.0))]
    for label, clean, of_pair, spacing, deviations in cells:
        exact = of_pair(clean)
        for deviation in 1e-6 * np.array(deviations):
            bound = least_deviation(clean, of_pair, deviation, spacing)
            found = [
                of_pair(with_noise(clean, deviation, spacing, seed).smoothed("auto")) - exact
                for seed in range(SAMPLES)
            ]
            nine = of_pair(
                mean_profile([with_noise(clean, deviation, spacing, seed) for seed in range(9)])
            )
            within = np.mean(np.abs(found) <= LIMITS, axis=0)
            print(
                f"{label}, {1e3 * spacing:g} mm, {1e6 * deviation:4.1f} um: rms "
                f"{np.round(np.sqrt(np.mean(np.square(found), axis=0)), 4)}, share within "
                f"{np.round(within, 2)}; bound {np.round(bound, 4)}, share "
                f"{np.round(erf(LIMITS / bound / np.sqrt(2.0)), 2)}; mean of nine sections "
                f"{np.round(nine - exact, 4)}",
                flush=True,
            )


def measured_pairs() -> None:
    """Worn wheels with noise put on, and a measured one as it is, smoothed here and by others."""
    rail = Track(load_profile(MEASURED / "siteb.prr"), inclination=0.0)
    deviations = 1e-6 * np.array([5.0, 10.0, 20.0])
    for name in ("worn7216.prw", "worn7813.prw"):
        for track in (rail, Track("UIC60")):
            errors(load_profile(MEASURED / name), track, deviations, 2.5e-4)
    for label, wheel in (
        ("as measured", load_profile(MEASURED / "Car7216_0001r.whl")),
        ("auto", load_profile(MEASURED / "Car7216_0001r.whl", smoothing="auto")),
        ("smoothed by others", load_profile(MEASURED / "worn7216.prw")),
    ):
        print(f"Car7216 on siteb, {label}: {np.round(conicity(wheel, rail), 4)}")


def main() -> None:
    warnings.simplefilter("ignore", WheelsetWarning)
    curvature_figure()
    conicity_figure()
    noisy_rails()
    least_deviations()
    shares_within()
    if MEASURED.is_dir():
        measured_pairs()


if __name__ == "__main__":
    main()
