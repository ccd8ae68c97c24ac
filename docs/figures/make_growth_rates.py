"""Table of docs/hunting.md: growth by eigenvalue against growth of simulated small motion.

Every vehicle of the catalogue with profiles starts in its hunting mode, 0.03 mm large, at three
speeds around its linear critical one, and is simulated for four periods; a two-term recursion
fitted to the displacement that moves most gives growth rate and frequency. Told is the largest
difference of the growth rates, in parts of the (angular) frequency.

    python docs/figures/make_growth_rates.py [vehicle ...]
"""

from __future__ import annotations

import sys
import warnings

import numpy as np

from exudyn_wheelset import WheelsetError, WheelsetWarning, linear_critical_speed, linearise
from exudyn_wheelset.catalogue.by_name import entry, vehicle_system

VEHICLES = (
    "paper-lateral-1",
    "paper-1",
    "s1002",
    "cooperrider_bogie_3d",
    "truck",
    "three_axle_truck",
    "dtu_car",
    "manchester_coach",
)
LAWS = ("shen-hedrick-elkins", "polach-kalker", "exact-table", "fastsim", "vermeulen-johnson")
RATIOS = (0.9, 1.0, 1.1)
# Exudyn's rotation vectors lose digits below some 1e-6 rad; above 0.1 mm curvature of S1002 shows.
START, PERIODS, SAMPLES = 3.0e-5, 4, 40


def root_of_oscillation(times: np.ndarray, signal: np.ndarray) -> complex:
    """Growth rate [1/s] and angular frequency [rad/s] of samples of one oscillation."""
    design = np.column_stack([signal[1:-1], signal[:-2]])
    (b, minus_c), *_ = np.linalg.lstsq(design, signal[2:])
    root = np.log(complex(np.roots([1.0, -b, -minus_c])[0])) / (times[1] - times[0])
    return complex(root.real, abs(root.imag))


def difference(system, speed: float, frequency: float) -> tuple[complex, complex]:
    """Root near a frequency [Hz] at a speed [m/s], and that of simulated small motion."""
    linear = linearise(system, speed)
    row = int(np.argmin(np.abs(linear.eigenvalues - 2j * np.pi * frequency)))
    root, mode = complex(linear.eigenvalues[row]), linear.eigenvectors[:, row]
    shown = list(system.displacement_indices)
    leading = shown[int(np.argmax(np.abs(mode[shown]) / system.scales[shown]))]
    start = linear.state + (mode * (START / mode[leading])).real
    times = np.linspace(0.0, PERIODS * 2.0 * np.pi / root.imag, SAMPLES * PERIODS + 1)
    motion = (system.simulate(start, speed, times) - linear.state)[:, leading]
    return root, root_of_oscillation(times[SAMPLES // 2 :], motion[SAMPLES // 2 :])


def main(names: list[str]) -> None:
    warnings.simplefilter("ignore", WheelsetWarning)
    print("| vehicle | " + " | ".join(LAWS) + " |")
    print("|---|" + "---:|" * len(LAWS), flush=True)
    for name in names or VEHICLES:
        cells = []
        for law in LAWS:
            system = vehicle_system(name, creep=law)
            try:
                point = linear_critical_speed(system, *entry(name).searched)
                apart = []
                for ratio in RATIOS:
                    root, measured = difference(
                        system, ratio * point.speed, ratio * point.frequency
                    )
                    apart.append(abs(measured.real - root.real) / root.imag)
                cells.append(f"{point.speed:.1f}: {100 * max(apart):.3f} %")
            except WheelsetError as error:
                cells.append(f"none ({str(error)[:60]})")
            print(name, law, cells[-1], file=sys.stderr, flush=True)
        print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
