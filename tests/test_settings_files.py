"""Settings files against Exudyn's own dictionary of settings: nothing is named twice here.

Every name, type and default comes from exudyn.SimulationSettings; a file may hold any of them,
nested or dotted, and nothing else.
"""

import json
from pathlib import Path

import exudyn as exu
import pytest

from exudyn_wheelset.errors import SettingsError
from exudyn_wheelset.front.settings import apply_settings, changed_settings, load_settings

RUNS = Path(__file__).parents[1] / "runs"


def flat(entries, prefix=""):
    for name, value in entries.items():
        if isinstance(value, dict):
            yield from flat(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value


DEFAULTS = dict(flat(exu.SimulationSettings().GetDictionary()))


def nested(entries):
    tree = {}
    for name, value in entries.items():
        *groups, last = name.split(".")
        branch = tree
        for group in groups:
            branch = branch.setdefault(group, {})
        branch[last] = value
    return tree


def write(path, entries):
    path.write_text(json.dumps(entries), encoding="utf-8")
    return path


def test_no_file_gives_exudyns_defaults():
    assert dict(flat(load_settings(None).GetDictionary())) == DEFAULTS
    assert load_settings({}).GetDictionary() == exu.SimulationSettings().GetDictionary()
    assert changed_settings(exu.SimulationSettings()) == {}


EXAMPLE = {
    "timeIntegration.numberOfSteps": 4000,
    "timeIntegration.endTime": 2.5,
    "timeIntegration.solverType": "RK44",
    "timeIntegration.generalizedAlpha.spectralRadius": 0.7,
    "solution.file.write": False,
    "solution.sensors.writePeriod": 0.002,
    "linearSolver.solverType": "EigenSparse",
}


@pytest.mark.parametrize(
    "entries",
    [
        EXAMPLE,
        nested(EXAMPLE),
        {"timeIntegration": {"generalizedAlpha.spectralRadius": 0.7}, **EXAMPLE},
    ],
    ids=["dotted", "nested", "mixed"],
)
def test_nested_and_dotted_names_set_the_same(tmp_path, entries):
    settings = load_settings(write(tmp_path / "run.json", entries))
    integration = settings.timeIntegration
    assert integration.numberOfSteps == 4000
    assert integration.endTime == 2.5
    assert integration.solverType == exu.DynamicSolverType.RK44
    assert integration.generalizedAlpha.spectralRadius == 0.7
    assert settings.solution.file.write is False
    assert settings.linearSolver.solverType == exu.LinearSolverType.EigenSparse
    assert changed_settings(settings) == EXAMPLE


def test_what_changed_written_to_a_file_gives_the_same_settings(tmp_path):
    settings = exu.SimulationSettings()
    settings.timeIntegration.newton.relativeTolerance = 1e-9
    settings.timeIntegration.solverType = exu.DynamicSolverType.DOPRI5
    settings.solution.sensors.active = False
    settings.timeIntegration.verboseMode = 2
    path = write(tmp_path / "run.json", changed_settings(settings))
    again = load_settings(str(path))
    assert dict(flat(again.GetDictionary())) == dict(flat(settings.GetDictionary()))


def other_value(value):
    """A value of the same type that Exudyn accepts and that is not the default."""
    if hasattr(type(value), "__members__"):
        return next(name for name, member in type(value).__members__.items() if member != value)
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return value + 1
    if isinstance(value, float):
        return 0.5 * value if value else 0.25
    return value + "x"


@pytest.mark.parametrize("name", DEFAULTS)
def test_every_setting_of_exudyn_can_be_set(name):
    value = other_value(DEFAULTS[name])
    changed = changed_settings(load_settings({name: value}))
    # Exudyn itself couples a few entries; the one that was asked for is as asked.
    assert changed[name] == pytest.approx(value)


@pytest.mark.parametrize(
    ("wrong", "nearest"),
    [
        ({"timeIntegration": {"endtime": 1.0}}, "timeIntegration.endTime"),
        ({"timeIntegration.numberOfStep": 10}, "timeIntegration.numberOfSteps"),
        ({"solverType": "RK44"}, "solverType"),
        ({"endTime": 1.0}, "timeIntegration.endTime"),
        ({"timeIntegration": 3}, "timeIntegration"),
    ],
)
def test_an_unknown_name_names_the_nearest(wrong, nearest):
    with pytest.raises(SettingsError, match=nearest.replace(".", r"\.")):
        load_settings(wrong)


@pytest.mark.parametrize(
    ("name", "value", "wanted"),
    [
        ("timeIntegration.endTime", "2.0", "float"),
        ("timeIntegration.endTime", True, "float"),
        ("timeIntegration.endTime", None, "float"),
        ("timeIntegration.endTime", [1.0], "float"),
        ("timeIntegration.verboseMode", 1.5, "int"),
        ("timeIntegration.verboseMode", True, "int"),
        ("solution.file.write", 0, "bool"),
        ("solution.file.write", "false", "bool"),
        ("timeIntegration.solverType", "RK45", "'RK44'"),
        ("timeIntegration.solverType", "rk44", "'RK44'"),
        ("timeIntegration.solverType", 3, "RK44"),
    ],
)
def test_a_wrong_type_is_refused_with_the_right_one(name, value, wanted):
    with pytest.raises(SettingsError, match=wanted) as raised:
        load_settings({name: value})
    assert name in str(raised.value)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("timeIntegration.numberOfSteps", -5),
        ("timeIntegration.endTime", float("nan")),
        ("timeIntegration.endTime", -1.0),
    ],
)
def test_a_value_that_exudyn_refuses_is_a_settings_error(name, value):
    with pytest.raises(SettingsError, match=name.replace(".", r"\.")):
        load_settings({name: value})


def test_a_whole_number_is_a_float_too():
    assert load_settings({"timeIntegration.endTime": 3}).timeIntegration.endTime == 3.0


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"{'timeIntegration': 1}", "line 1: not JSON"),
        (b'{\n "timeIntegration": {\n', "line 3: not JSON"),
        (b"[1, 2]", "list"),
        (b"3", "int"),
        (b"\xff\xfe\x00", "cannot be read"),
        (b"", "line 1: not JSON"),
    ],
)
def test_a_file_that_is_no_settings_file(tmp_path, content, message):
    path = tmp_path / "run.json"
    path.write_bytes(content)
    with pytest.raises(SettingsError, match=message) as raised:
        load_settings(path)
    assert "run.json" in str(raised.value)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b'{"timeIntegration": {"endTime": 1e999}}', "not finite"),
        (b'{"timeIntegration": {"endTime": NaN}}', "not finite"),
        (b'{"timeIntegration": {"numberOfSteps": ' + b"7" * 5000 + b"}}", "digits"),
        (b'{"timeIntegration": {"numberOfSteps": ' + b"7" * 400 + b"}}", "400 digits"),
        (b'{"timeIntegration": {"endTime": ' + b"7" * 400 + b"}}", "400 digits"),
        (b'{"a": ' * 100 + b"1" + b"}" * 100, "four deep"),
        (b'{"a": ' * 100000 + b"1" + b"}" * 100000, "four deep"),
        (b"[" * 100000, "four deep"),
    ],
    ids=["1e999", "nan", "5000 digits", "400 digits", "float", "100 deep", "1e5 deep", "lists"],
)
def test_numbers_and_nesting_beyond_reason(tmp_path, content, message):
    path = tmp_path / "run.json"
    path.write_bytes(content)
    with pytest.raises(SettingsError, match=message) as raised:
        load_settings(path)
    assert len(str(raised.value)) < 300 + len(str(path))


def test_missing_file_and_directory(tmp_path):
    with pytest.raises(
        SettingsError, match=r"no such settings file.*fine, generalized_alpha, rk44"
    ):
        load_settings(tmp_path / "absent.json")
    with pytest.raises(SettingsError, match="cannot be read"):
        load_settings(tmp_path)


@pytest.mark.parametrize("name", ["rk44", "rk44.json"])
def test_files_of_the_package_by_their_names(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    named, file = load_settings(name), load_settings(RUNS / "rk44.json")
    assert changed_settings(named) == changed_settings(file)


def test_settings_in_place():
    settings = exu.SimulationSettings()
    apply_settings(settings, {"timeIntegration": {"endTime": 7.0}})
    apply_settings(settings, {"timeIntegration.numberOfSteps": 70})
    assert (settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps) == (7.0, 70)


@pytest.mark.parametrize("path", sorted(RUNS.glob("*.json")), ids=lambda path: path.stem)
def test_every_file_that_comes_with_the_project(path):
    settings = load_settings(path)
    wanted = dict(flat(json.loads(path.read_text(encoding="utf-8"))))
    changed = changed_settings(settings)
    # Only what differs from Exudyn's defaults; naming the solver helps whoever reads the file.
    assert changed.items() <= wanted.items()
    assert set(wanted) - set(changed) <= {"timeIntegration.solverType"}


def test_there_are_settings_files():
    assert len(list(RUNS.glob("*.json"))) >= 2
