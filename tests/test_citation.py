"""Papers to cite: every law and model of the package has one, vehicles bring theirs along."""

import pytest

from exudyn_wheelset import Contact, WheelsetError, catalogue, citation
from exudyn_wheelset.contact.descriptions import NORMAL_MODELS
from exudyn_wheelset.creep import CREEP_LAWS
from exudyn_wheelset.front import citation as module


def test_every_law_and_model_has_a_paper():
    laws = {name for name, law in CREEP_LAWS.items() if law.function is None}
    assert laws <= set(module._LAWS)
    assert set(NORMAL_MODELS) <= set(module._NORMAL)
    tables = (module._LAWS, module._NORMAL, module._VEHICLES, module._METHODS)
    assert {key for table in tables for keys in table.values() for key in keys} <= set(
        module.PAPERS
    )
    assert set(module._VEHICLES) <= set(catalogue.CATALOGUE)


def test_what_a_vehicle_uses_is_cited():
    car = catalogue.vehicle("dtu_car", creep="fastsim")
    text = str(citation(car, "limit_cycles"))
    assert "simplified theory of rolling contact" in text
    assert "Collocation at Gaussian points" in text
    assert "polach" not in text.lower()
    assert "Chaos in a railway bogie" in str(citation("cooperrider"))
    assert "solid friction" in str(citation("freight_car"))
    exact = car.replace("contact", Contact(creep="exact"))
    assert "Three-Dimensional Elastic Bodies" in str(citation(exact))


def test_unknown_names_are_refused():
    with pytest.raises(WheelsetError, match="did you mean 'limit_cycles'"):
        citation(None, "limit_cycle")
    with pytest.raises(WheelsetError, match="dtu_car"):
        citation("dtu_cat")
