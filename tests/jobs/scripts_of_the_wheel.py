"""Model scripts and solver settings come with the wheel."""

import importlib.resources
import json

from exudyn_wheelset.models import table2

from exudyn_wheelset import load_settings

runs = importlib.resources.files("exudyn_wheelset.runs")
assert json.loads((runs / "rk44.json").read_text(encoding="utf-8"))
assert load_settings(str(runs / "rk44.json")) is not None
assert 30 < table2.run(rows=("mohan",))["mohan"][0] < 45
