"""Kalker's coefficients against the table (Kalker 1990, E.3) and its asymptotes."""

import csv

import numpy as np
import pytest
from creep_reference import FOLDER
from hypothesis import given, settings
from hypothesis import strategies as st

from exudyn_wheelset.creep import kalker_coefficients
from exudyn_wheelset.creep.kalker import ASYMPTOTE_BEGIN, TABLE_END, kalker_asymptotes

with (FOLDER / "kalker_coefficients.csv").open() as _file:
    ROWS = list(csv.DictReader(_file))
NAMES = ("C11", "C22", "C23", "C33")
COLUMNS = {"nu0": 0.0, "nu025": 0.25, "nu05": 0.5}


@pytest.mark.parametrize("row", ROWS, ids=lambda r: r["axis_ratio"])
@pytest.mark.parametrize("column", COLUMNS)
def test_nodes(row, column):
    side, value = row["axis_ratio"].split("=")
    a, b = (float(value), 1.0) if side == "a/b" else (1.0, float(value))
    expected = [float(row[f"{name}_{column}"]) for name in NAMES]
    np.testing.assert_allclose(kalker_coefficients(a, b, COLUMNS[column]), expected, rtol=1e-12)


def test_between_nodes():
    """Linear in the axis ratio for each nu, then parabolic in 1/C over nu; by numpy's polyfit."""
    table = {r["axis_ratio"]: r for r in ROWS}
    for side, low, high, share in [("a/b", "0.3", "0.4", 0.7), ("b/a", "0.8", "0.9", 0.25)]:
        ratio = float(low) + 0.1 * share
        a, b = (ratio, 1.0) if side == "a/b" else (1.0, ratio)
        for i, name in enumerate(NAMES):
            between = [
                (1 - share) * float(table[f"{side}={low}"][f"{name}_{c}"])
                + share * float(table[f"{side}={high}"][f"{name}_{c}"])
                for c in COLUMNS
            ]
            parabola = np.polyfit([0.0, 0.25, 0.5], 1 / np.array(between), 2)
            expected = 1 / np.polyval(parabola, 0.28)
            assert kalker_coefficients(a, b, 0.28)[i] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("poisson", [0.0, 0.25, 0.28, 0.5])
@pytest.mark.parametrize("ratio", [1e-4, 0.02, 0.079, 12.6, 50.0, 1e4])
def test_asymptotes_hold_beyond_the_table(ratio, poisson):
    g = min(ratio, 1 / ratio)
    wide_log, long_log, nu = np.log(16 / g), np.log(16 / g**2), poisson
    if ratio < 1:
        c11 = np.pi**2 / 4 / (1 - nu)
        c22 = np.pi**2 / 4
        c23 = np.pi * np.sqrt(g) / (3 * (1 - nu)) * (1 + nu * (wide_log - 5))
    else:
        c11 = 2 * np.pi / ((long_log - 2 * nu) * g)
        c11 *= 1 + (3 - np.log(4)) / (long_log - 2 * nu)
        d = (1 - nu) * long_log + 2 * nu
        c22 = (2 * np.pi / g) * (1 + (1 - nu) * (3 - np.log(4)) / d) / d
        c23 = 2 * np.pi / (3 * g**1.5 * ((1 - nu) * long_log - 2 + 4 * nu))
    got = kalker_coefficients(ratio, 1.0, poisson)
    np.testing.assert_allclose(got[:3], [c11, c22, c23], rtol=1e-12)
    assert got == kalker_asymptotes(ratio, poisson) or got == pytest.approx(
        kalker_asymptotes(ratio, poisson), rel=1e-12
    )


@pytest.mark.parametrize("poisson", [0.0, 0.28, 0.5])
def test_table_and_asymptotes_agree_where_they_meet(poisson):
    """Both are published; within a tenth they say the same at g = 0.1."""
    for ratio in (0.1, 10.0):
        table = kalker_coefficients(ratio, 1.0, poisson)
        np.testing.assert_allclose(kalker_asymptotes(ratio, poisson), table, rtol=0.10)


@pytest.mark.parametrize("poisson", [0.0, 0.28, 0.5])
def test_continuity_over_the_axis_ratio(poisson):
    ratios = np.exp(np.linspace(np.log(1e-3), np.log(1e3), 200001))
    values = np.log([kalker_coefficients(r, 1.0, poisson) for r in ratios])
    # no coefficient varies faster than about g^-4 anywhere; a jump of 1e-3 would stand out
    assert np.abs(np.diff(values, axis=0)).max() < 4 * np.log(ratios[1] / ratios[0])


@settings(deadline=None)
@given(st.floats(1e-6, 1e6), st.floats(0.0, 0.5), st.floats(1e-6, 1e3))
def test_positive_and_free_of_scale(ratio, poisson, size):
    coefficients = kalker_coefficients(ratio, 1.0, poisson)
    assert all(np.isfinite(coefficients))
    assert min(coefficients) > 0.0
    np.testing.assert_allclose(kalker_coefficients(ratio * size, size, poisson), coefficients, 1e-9)


@pytest.mark.parametrize("poisson", [0.0, 0.28, 0.5])
@pytest.mark.parametrize("wide", [True, False])
def test_asymptotes_are_blended_into_the_table_without_a_corner(wide, poisson):
    """A share of the ratio at the table's end: 0 to 1, symmetric, flat at both of its ends."""

    def ratio(g):
        return g if wide else 1.0 / g

    def over_asymptotes(g):
        exact = kalker_asymptotes(ratio(g), poisson)
        return np.array(kalker_coefficients(ratio(g), 1.0, poisson)) / exact - 1.0

    whole = over_asymptotes(TABLE_END * (1.0 + 1e-12))
    width = TABLE_END - ASYMPTOTE_BEGIN
    shares = [over_asymptotes(ASYMPTOTE_BEGIN + u * width) / whole for u in np.linspace(0, 1, 11)]
    np.testing.assert_allclose(np.add(shares, shares[::-1]), 1.0, atol=1e-6)
    assert np.all(np.diff(shares, axis=0) > 0.0)
    ends = [over_asymptotes(ASYMPTOTE_BEGIN + u * width) / whole for u in (1e-3, 1.0 - 1e-3)]
    np.testing.assert_allclose(ends, [[0.0] * 4, [1.0] * 4], atol=1e-5)


def test_positions_between_three_tables_of_poisson():
    """1/C is a parabola in nu at every place of the table, not at its nodes alone."""
    rng = np.random.default_rng(6)
    for ratio in np.exp(rng.uniform(-2.2, 2.2, 12)):
        inverse = [1.0 / np.array(kalker_coefficients(ratio, 1.0, nu)) for nu in (0.0, 0.25, 0.5)]
        for poisson in (0.1, 0.4):
            parabola = np.polyfit([0.0, 0.25, 0.5], inverse, 2)
            expected = 1.0 / (parabola[0] * poisson**2 + parabola[1] * poisson + parabola[2])
            np.testing.assert_allclose(kalker_coefficients(ratio, 1.0, poisson), expected, 1e-9)
