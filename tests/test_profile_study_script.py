"""The study of profile pairs against the analyses of one vehicle with those profiles."""

import json
import sys
from pathlib import Path

import pytest

from exudyn_wheelset import equivalent_conicity, rolling_radius_curve
from exudyn_wheelset.stability.linear.critical_speed import linear_critical_speed
from exudyn_wheelset.stability.subject import description_of

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "models"))
import profile_study  # noqa: E402


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::exudyn_wheelset.WheelsetWarning")
def test_one_pair_is_the_vehicle_itself(tmp_path, capsys):
    for kind, name in (("wheels", "S1002.txt"), ("rails", "UIC60.txt")):
        (tmp_path / kind).mkdir()
        (tmp_path / kind / name).write_bytes((ROOT / "profiles" / name).read_bytes())
    (tmp_path / "rails" / "broken.txt").write_text("no profile\n")
    words = ["--wheels", str(tmp_path / "wheels"), "--rails", str(tmp_path / "rails")]
    words += ["--smoothing", "0", "--processes", "1", "--json", "--out", str(tmp_path)]
    assert profile_study.main(words) == 0
    numbers = json.loads(capsys.readouterr().out)
    good, broken = numbers["ranked"]
    assert numbers["pairs"] == 2 and broken["reason"].startswith("ProfileError")
    wheelset = description_of("s1002")
    # The vehicle's own profiles are these files.
    assert good["linear"] == pytest.approx(linear_critical_speed(wheelset, 30, 80).speed, abs=1e-3)
    # Its fold at the flange, docs/hunting.md.
    assert good["nonlinear"] == pytest.approx(52.04, abs=0.05)
    curve = rolling_radius_curve(wheelset.wheelsets[0].wheelset, wheelset.track)
    conicity = equivalent_conicity(curve.y, curve.rolling_radius_difference, [2e-3, 4e-3])
    assert good["conicity_2mm"] == pytest.approx(conicity[0], rel=1e-3)
    assert good["nonlinearity"] == pytest.approx(0.5 * (conicity[1] - conicity[0]), rel=1e-2)
    names = {path.name for path in tmp_path.glob("profile_study.*")}
    assert names == {"profile_study.jsonl", "profile_study.csv", "profile_study.png"}
