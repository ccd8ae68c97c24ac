"""The page docs/your-own-vehicle.md: its code runs and its truck behaves like one."""

import contextlib
import io
import re
import warnings
from pathlib import Path

import numpy as np
import pytest

from exudyn_wheelset import WheelsetWarning, linearise, simulate

PAGE = Path(__file__).parents[1] / "docs" / "your-own-vehicle.md"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Names that the page's code has made, what it printed, and the folder it wrote into."""
    folder = tmp_path_factory.mktemp("page")
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.S)
    names: dict = {}
    with (
        contextlib.chdir(folder) if hasattr(contextlib, "chdir") else _within(folder),
        contextlib.redirect_stdout(io.StringIO()) as printed,
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("ignore", WheelsetWarning)
        for block in blocks:
            exec(block, names)
    return names, printed.getvalue(), folder


@contextlib.contextmanager
def _within(folder):
    """contextlib.chdir of Python 3.11."""
    import os

    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def test_the_model_takes_at_most_forty_lines():
    (block, *_) = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.S)
    assert len([line for line in block.splitlines() if line.strip()]) <= 40


def test_the_page_says_what_its_code_prints(page):
    names, printed, _ = page
    text = PAGE.read_text(encoding="utf-8")
    assert printed.splitlines()[0] in text
    assert f"Hopf point at {names['critical'].speed:.1f} m/s" in text


def test_the_loads_are_the_weight(page):
    """Six wheels carry 30 t of the car, 5 t of the frame and three wheelsets of 1.4 t."""
    truck = page[0]["truck"]
    motion = simulate(truck, 30.0, 0.05)
    loads = [motion.wheel(*wheel)["Q [N]"] for wheel in motion.wheels]
    assert len(loads) == 6
    # The car, which does not move, presses a little more where the contacts yield less than drawn:
    # 8e5 N/m times some hundredths of a millimetre.
    assert sum(loads) == pytest.approx((30e3 + 5000 + 3 * 1400) * 9.81, rel=2e-4)
    # A steady run: nothing changes.
    assert sum(loads) == pytest.approx(sum(loads)[0], rel=1e-9)
    # The middle axle is as far from one end as from the other; creep moments tip the frame little.
    assert np.array(loads[:2]) == pytest.approx(np.array(loads[4:]), rel=1e-3)


def test_the_critical_speed_parts_decay_from_growth(page):
    names, _, _ = page
    truck, critical = names["truck"], names["critical"]
    for factor, sign in ((0.97, -1.0), (1.03, 1.0)):
        linear = linearise(truck, factor * critical.speed)
        frequency = 2.0 * np.pi * critical.frequency
        near = linear.eigenvalues[np.argmin(np.abs(linear.eigenvalues.imag - frequency))]
        assert sign * near.real > 0.0


def test_simulation_hunts_on_the_branch(page):
    """Amplitude of the simulated hunting against the branch of periodic orbits at that speed."""
    names, _, _ = page
    branch, motion = names["branch"], names["motion"]
    y = motion.after(motion.time[-1] - 1.0)["first axle: y"]
    column = branch.amplitude["first axle: y [m]"]
    upper = np.argsort(branch.speed)
    there = np.interp(motion.speed, branch.speed[upper], column[upper])
    # After five seconds the motion has come within some per cent of its limit.
    assert 0.5 * np.ptp(y) == pytest.approx(there, rel=0.05)
    assert names["lowest"] <= names["critical"].speed
    assert 0.0 < names["largest"] < 400e3


def test_pictures_and_film_are_there(page):
    folder = page[2]
    assert {file.name for file in folder.iterdir()} == {
        "root_locus.png",
        "motion.csv",
        "bifurcation.png",
        "hunting.gif",
    }
    assert (folder / "hunting.gif").read_bytes().startswith(b"GIF8")
