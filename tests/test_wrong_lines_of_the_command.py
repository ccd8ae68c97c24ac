"""Wrong lines of the command: exit status 2, and one line that names value and mend."""

import pytest

from exudyn_wheelset.front.command import main

COMMAND = {
    "conicity --gauge 1435": ["1435", "m"],
    "conicity --gauge 1e999": ["inf"],
    "conicity --gauge wide": ["wide", "float"],
    "conicity --inclination 1:0": ["1:0", "1:40"],
    "conicity --smoothing much": ["much", "auto"],
    "conicity --wheel UIC60": ["UIC60", "wheel"],
    "conicity --amplitudes-mm -3": ["-0.003 m", "positive"],
    "conicity --amplitudes-mm nan": ["nan"],
    "conicity --radius 0": ["0", "positive"],
    "conicity --shift top": ["top", "rail"],
    "geometry --half-range 8": ["8", "metres"],
    "geometry --wheel nowhere.whl": ["nowhere.whl"],
    "creep --creep-x 0:1": ["0:1", "LOW:HIGH:COUNT"],
    "creep --creep-x 0:1:1": ["0:1:1", "COUNT"],
    "creep --creep-x 0:1:999999999": ["999999999", "COUNT"],
    "creep --creep-x 0:1:3 --spin 0:1:3": ["creep_x and spin", "one range"],
    "creep --creep polach:kA": ["kA", "fastsim:"],
    "creep --creep fastsim:gird=20": ["gird", "grid"],
    "creep --a -1": ["-1", "a"],
    "stability --vehicle dtu_cra": ["dtu_cra", "dtu_car"],
    "stability --vehicle nowhere.toml": ["nowhere.toml"],
    "stability --vehicle s1002 --friction 3": ["3", "1"],
    "stability --vehicle s1002 --conicity 0.05 --wheel S1002": ["not both"],
    "stability --vehicle cooperrider --gauge 1.43": ["gauge", "friction, conicity"],
    "stability --vehicle s1002 --set track.gauge": ["track.gauge", "a value"],
    "stability --vehicle s1002 --set track.gauge=wide": ["wide", "number"],
    "stability --vehicle s1002 --set bodies.body.mass=3": ["body"],
    "stability --vehicle s1002 --searched 90 30": ["90", "30"],
    "map --over conicity=0.2:0.02": ["0.2:0.02", "lower end first"],
    "map --over flavour=0.1:0.2": ["flavour"],
    "map --over conicity=0.1:0.2 --points 1": ["points = 1", "at least 2"],
    "study --vary friction=0.1:0.3": ["0.1:0.3", "LOW:HIGH:COUNT"],
    "study --vary wheel=/nowhere/*.whl": ["/nowhere", "no file"],
    "study --vary friction": ["friction", "values"],
    "study --vary friction=0.1 --vary friction=0.2": ["friction", "twice", "in one"],
    "simulate --speed 0": ["0", "m/s"],
    "simulate --speed 500": ["500", "200"],
    "simulate --duration 0": ["0", "s"],
    "simulate --initial 3": ["3", "metres"],
    "simulate --vehicle s1002 --interval 9": ["9", "s"],
    "film --out /tmp --size 0 0 --vehicle s1002 --picture": ["0", "pixels"],
    "hunt --vehicle s1002 --speeds 90 30": ["90 30", "lower one first"],
    "hunt --redraw nowhere.npz": ["nowhere.npz"],
    "info polack": ["polack", "polach"],
}


@pytest.mark.parametrize("line", COMMAND)
def test_a_wrong_line_of_the_command(line, capsys):
    try:
        status = main(line.split())
    except SystemExit as leaving:
        status = leaving.code
    said = capsys.readouterr()
    assert status == 2, said
    assert all(word in said.err.splitlines()[-1] for word in COMMAND[line]), said.err
