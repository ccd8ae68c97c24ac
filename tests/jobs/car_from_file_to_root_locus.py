"""A car from a TOML file, changed there, to its root locus, with the file's mistakes told."""

from pathlib import Path

import numpy as np

from exudyn_wheelset import VehicleError, catalogue, load_vehicle, root_locus, save_vehicle

save_vehicle(catalogue.dtu_car(), "car.toml")
text = Path("car.toml").read_text(encoding="utf-8")
car = load_vehicle("car.toml")
locus = root_locus(car, np.linspace(20.0, 30.0, 3))
assert locus.eigenvalues.shape[0] == 3
Path("wrong.toml").write_text(text.replace("mass", "mas", 1), encoding="utf-8")
try:
    load_vehicle("wrong.toml")
except VehicleError as error:
    assert "wrong.toml" in str(error) and "mass" in str(error)
else:
    raise AssertionError("a misspelt key was read")
