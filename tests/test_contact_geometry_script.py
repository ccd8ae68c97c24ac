"""models/contact_geometry.py against rigid contact solved by CONTACT (S1002 on UIC60), the paper
(section 2.2) and the closed form of a cone on a round rail head."""

import csv

import numpy as np
import pytest
from model_scripts import ROOT, call, load, printed_numbers, table_of


def test_contact_geometry_against_CONTACT(tmp_path, capsys):
    """The script's CSV at the rows of CONTACT, which are exact to 2e-6 (4e-6 m at y = 0)."""
    assert call("contact_geometry", "--wheel=S1002", "--json", f"--out={tmp_path}") == 0
    numbers = printed_numbers(capsys)["S1002 on UIC60"]
    table = table_of(tmp_path / "contact_geometry_S1002_UIC60.csv")
    reference = ROOT / "tests" / "reference" / "contact_geometry_S1002_UIC60.csv"
    compared = 0
    with reference.open(encoding="utf-8") as lines:
        for row in csv.DictReader(lines):
            y = float(row["y_m"])
            at = int(np.argmin(np.abs(table["y"] - y)))
            if abs(table["y"][at] - y) > 1e-9:
                continue
            compared += 1
            side, position = row["side"], 1e-4 if y == 0.0 else 2e-5
            assert table["roll"][at] == pytest.approx(float(row["roll_rad"]), abs=2e-6)
            assert table["z"][at] == pytest.approx(float(row["z_m"]), abs=2e-6)
            assert table[f"{side}_wheel_y"][at] == pytest.approx(
                float(row["wheel_y_m"]), abs=position
            )
            assert table[f"{side}_rail_y"][at] == pytest.approx(
                float(row["rail_y_m"]), abs=position
            )
            assert table[f"{side}_radius"][at] == pytest.approx(
                float(row["rolling_radius_m"]), abs=4e-5
            )
    assert compared >= 10
    assert numbers["height_at_rest"] == pytest.approx(-1.821662e-4, abs=2e-6)
    # The two methods look for the same root; Nelder-Mead stops at 1e-12 rad.
    assert numbers["methods"]["largest_roll_difference"] < 1e-9
    # The polynomials keep the tolerance they were asked for: 2e-6 m and rad, and a hundred times
    # that for angles and places.
    residuals = numbers["polynomials"]["residuals"]
    for name in ("roll", "z", "left_radius", "right_radius"):
        assert max(residuals[name]) <= 2e-6
    assert max(residuals["left_angle"] + residuals["right_angle"]) <= 2e-4
    names = {file.name for file in tmp_path.iterdir()}
    assert names == {
        "contact_geometry.json",
        "contact_geometry_S1002_UIC60.csv",
        "contact_geometry_S1002_UIC60.png",
        "contact_geometry_S1002_UIC60_profiles.png",
    }


def test_contact_geometry_of_the_papers_pair():
    """AAR 1:20 on UIC60 at 1432 mm: a cone on a round head until the flange, as in Figure 3."""
    script = load("contact_geometry")
    pair = script.default_pairs()[0]
    numbers = script.examine(pair).numbers
    cone, head = 0.05, 0.3
    assert numbers["contact_angle_at_rest"] == pytest.approx(np.arctan(cone), abs=1e-5)
    # Effective conicity of a cone with the roll it causes: d (g + R d)/(g - r0 d).
    half_distance = pair.wheelset.tape_half_distance + numbers["wheel_contact_at_rest"]
    radius = pair.wheelset.radius
    effective = cone * (half_distance + head * cone) / (half_distance - radius * cone)
    assert numbers["half_slope_of_radius_difference_at_rest"] == pytest.approx(effective, rel=2e-3)
    # "No double-point contact ... tread as well as flange regimes": one jump on either side.
    jumps = np.array(numbers["jumps"])
    assert len(jumps) >= 2 and np.all(np.abs(jumps) > 5e-3)
    assert jumps == pytest.approx(-jumps[::-1], abs=1e-6)
