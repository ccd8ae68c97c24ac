"""Draw docs/figures/profile_smoothing.png: what smoothing does to a profile's curvature.

S1002 sampled every 0.2 mm, its points 10 micrometres (standard deviation, seeded) off the true
line, and the curvature of the curve at several smoothing tolerances beside that of the formula.
Prints the errors that docs/profiles.md quotes.
"""

from pathlib import Path

import matplotlib
import numpy as np
from numpy.typing import NDArray

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from exudyn_wheelset.profiles import Profile, load_profile

NOISE = 1e-5
SPACING = 2e-4
TOLERANCES = (0.0, 0.95e-5, 1.0e-5, 1.05e-5, 1.2e-5, 2e-5, 5e-5)
SHOWN = (0.95e-5, 1.05e-5, 2e-5, 5e-5)


def noisy_s1002(seed: int = 0) -> Profile:
    """S1002 as an instrument with normally distributed errors across the profile sees it."""
    clean = load_profile("S1002").resampled(SPACING)
    error = np.random.default_rng(seed).normal(0.0, NOISE, len(clean.y))
    angle = np.arctan(clean.slope(clean.y))
    y, z = clean.y - np.sin(angle) * error, clean.z + np.cos(angle) * error
    keep = np.concatenate(([True], y[1:] > np.maximum.accumulate(y)[:-1] + 1e-7))
    return Profile("S1002 with noise", "wheel", y[keep], z[keep])


def rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2)))


def main() -> None:
    exact, noisy = load_profile("S1002"), noisy_s1002()
    tread, throat = np.linspace(-0.02, 0.03, 600), np.linspace(-0.038, -0.030, 300)
    print("smoothing | tread: height, slope, curvature | throat: curvature (rms errors)")
    for tolerance in TOLERANCES:
        curve = noisy.smoothed(tolerance)
        height = rms(curve.height(tread) - exact.height(tread))
        slope = rms(curve.slope(tread) - exact.slope(tread))
        tread_error = rms(curve.curvature(tread) - exact.curvature(tread))
        throat_error = rms(curve.curvature(throat) - exact.curvature(throat))
        print(
            f"{1e6 * tolerance:5.1f} um | {1e6 * height:6.2f} um, {1e3 * slope:8.3f} mrad, "
            f"{tread_error:9.2f} 1/m | {throat_error:9.2f} 1/m"
        )

    figure, axes = plt.subplots(2, 1, figsize=(8.0, 7.0), constrained_layout=True)
    views = (
        (axes[0], np.linspace(-0.024, 0.04, 1500), (-12.0, 12.0), "tread"),
        (axes[1], np.linspace(-0.0445, -0.024, 1500), (-110.0, 90.0), "flange throat and flange"),
    )
    for axis, y, limits, title in views:
        for tolerance in SHOWN:
            label = f"smoothing {1e6 * tolerance:g} µm"
            axis.plot(1e3 * y, noisy.smoothed(tolerance).curvature(y), linewidth=1.0, label=label)
        axis.plot(1e3 * y, exact.curvature(y), "k--", linewidth=1.4, label="formula")
        axis.set(ylim=limits, ylabel="curvature [1/m]", title=f"S1002, {title}")
        axis.grid(alpha=0.3)
    axes[0].legend(loc="upper left", ncols=2, fontsize="small")
    axes[1].set_xlabel("y, towards the field side [mm]")
    figure.suptitle("Curvature from points with 10 µm noise, 0.2 mm apart")
    path = Path(__file__).resolve().parent / "profile_smoothing.png"
    figure.savefig(path, dpi=110)
    print(path.name)


if __name__ == "__main__":
    main()
