"""Equivalent conicity against the reference values and limits of EN 15302, cases E1 to E4.

The reference files are not part of the project: EXUDYN_WHEELSET_REFERENCE names their directory,
or they lie in shared/reference beside the repository or above it. Wheel and rail origins both at
750 mm, r0 = 460 mm, rail profile already inclined. The reference neglects the wheelset's roll; with
roll, shifts at rail level compare with it. test_conicity_of_unlike_pairs.py needs no file.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared_reference import reference_folder

from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.geometry.conicity import equivalent_conicity
from exudyn_wheelset.geometry.rolling_radius import (
    rolling_radius_curve,
    rolling_radius_difference,
)
from exudyn_wheelset.profiles import load_profile

REPOSITORY = Path(__file__).resolve().parents[1]
REFERENCE = reference_folder() / "en15302"
SCRIPT = REPOSITORY / "models" / "conicity.py"
CASES = {"E1": "A", "E2": "B", "E3": "H", "E4": "I"}
RADIUS = 0.46

pytestmark = pytest.mark.skipif(
    not (REFERENCE / "SUIC519A.dat").is_file(),
    reason="EN 15302 reference files not found: set EXUDYN_WHEELSET_REFERENCE to the directory "
    "that holds en15302/",
)


@pytest.fixture(scope="module")
def track() -> Track:
    rail = load_profile(REFERENCE / "SUIC519A.dat", kind="rail", unit="mm")
    return Track(rail, origin_half_distance=0.75, inclination=0.0)


def wheelset(wheel: str, **right: Any) -> Wheelset:
    profile = load_profile(REFERENCE / f"RUIC519{wheel}.dat", kind="wheel", unit="mm")
    return Wheelset(1000.0, (600.0, 100.0, 600.0), RADIUS, profile, **right)


def reference(case: str) -> tuple[np.ndarray, ...]:
    """Amplitude [m], tan(gamma_e), upper and lower, widened upper and lower limit."""
    table = np.loadtxt(REFERENCE / f"ben_{case}.dat")
    return (table[:, 0] * 1e-3, *table[:, 1:].T)


def shifts(spacing: float, reach: float = 9.0e-3) -> np.ndarray:
    half = round(reach / spacing)
    return spacing * np.arange(-half, half + 1)


@pytest.mark.parametrize("spacing", [1.0e-4, 2.0e-5])
@pytest.mark.parametrize("case", CASES)
def test_level_axle_inside_widened_limits(case: str, spacing: float, track: Track) -> None:
    amplitudes, _, _, _, upper, lower = reference(case)
    y = shifts(spacing)
    difference = rolling_radius_difference(wheelset(CASES[case]), track, y, neglect_roll=True)
    conicity = equivalent_conicity(y, difference, amplitudes, 1.5, RADIUS)
    assert np.all(conicity <= upper)
    assert np.all(conicity >= lower)


@pytest.mark.parametrize("case", CASES)
def test_level_axle_inside_narrow_limits_away_from_jumps(case: str, track: Track) -> None:
    """The narrow limits leave no room for where a jump is sampled: 2 of 66 amplitudes may miss."""
    amplitudes, _, upper, lower, _, _ = reference(case)
    y = shifts(2.0e-5)
    difference = rolling_radius_difference(wheelset(CASES[case]), track, y, neglect_roll=True)
    conicity = equivalent_conicity(y, difference, amplitudes, 1.5, RADIUS)
    outside = (conicity > upper) | (conicity < lower)
    assert np.count_nonzero(outside) <= 2


@pytest.mark.parametrize("case", CASES)
def test_rolling_wheelset_inside_limits_over_its_shift_at_rail_level(
    case: str, track: Track
) -> None:
    """What roll changes is where the wheels stand: y + r0 roll compares with a level axle's y."""
    amplitudes, _, _, _, upper, lower = reference(case)
    curve = rolling_radius_curve(wheelset(CASES[case]), track, 8.5e-3)
    conicity = equivalent_conicity(curve.y, curve.rolling_radius_difference, amplitudes)
    assert np.all(conicity <= upper)
    assert np.all(conicity >= lower)


@pytest.mark.parametrize("neglect_roll", [True, False])
def test_unlike_wheels_change_sides(neglect_roll: bool, track: Track) -> None:
    """Wheels A and B exchanged: the mirror image, Delta_r(y) = -Delta_r(-y), equal conicity."""
    one, other = wheelset("A"), wheelset("B")
    y = shifts(5.0e-5)
    amplitudes = np.array([1.0, 3.0, 5.0]) * 1e-3
    straight, exchanged = (
        rolling_radius_difference(
            Wheelset(1000.0, (600.0, 100.0, 600.0), RADIUS, left, right_wheel=right),
            track,
            y,
            neglect_roll,
        )
        for left, right in ((one.wheel, other.wheel), (other.wheel, one.wheel))
    )
    # Rounding alone parts mirror images, but a jump may fall to either side of a sample.
    differing = np.abs(straight + exchanged[::-1]) > 1e-9
    assert np.count_nonzero(differing) <= 4
    np.testing.assert_allclose(
        equivalent_conicity(y, straight, amplitudes),
        equivalent_conicity(y, exchanged, amplitudes),
        rtol=2e-2,
    )


def test_larger_right_wheel_shifts_the_position_of_rest(track: Track) -> None:
    """A right radius larger by d: Delta_r falls by d, so the wheelset runs further left."""
    y = shifts(5.0e-5)
    equal = rolling_radius_difference(wheelset("A"), track, y, neglect_roll=True)
    unlike = rolling_radius_difference(
        wheelset("A", right_radius=RADIUS + 2.0e-4), track, y, neglect_roll=True
    )
    # The larger wheel touches the same point with a level axle.
    np.testing.assert_allclose(unlike, equal - 2.0e-4, atol=1e-9)
    assert np.all(np.isfinite(equivalent_conicity(y, unlike, [1e-3, 3e-3, 6e-3])))


def script():
    specification = importlib.util.spec_from_file_location("conicity_script", SCRIPT)
    assert specification is not None and specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@pytest.mark.parametrize("case", CASES)
def test_script_with_profile_files(case: str, tmp_path: Path) -> None:
    """As it comes: with roll, at rail level."""
    amplitudes, _, _, _, upper, lower = reference(case)
    numbers = script().run(
        wheel=REFERENCE / f"RUIC519{CASES[case]}.dat",
        rail=REFERENCE / "SUIC519A.dat",
        origin_half_distance=0.75,
        inclination=0.0,
        amplitudes_mm=1e3 * amplitudes,
        out=tmp_path if case == "E2" else None,
    )
    assert numbers["shift"] == "rail"
    conicity = np.array(list(numbers["conicity"].values()))
    assert np.all((conicity >= lower) & (conicity <= upper))
    assert all(Path(path).stat().st_size > 1000 for path in numbers.get("files", ()))
