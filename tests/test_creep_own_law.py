"""A law of one's own works wherever a name does: a copy of a built-in law gives the same bits."""

import math
import pickle
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import exudyn as exu
import numba
import numpy as np
import pytest

from exudyn_wheelset import (
    LateralWheelset,
    Track,
    Wheelset,
    contact_forces,
    create_wheelset,
    creep_force,
    linearise,
    register_creep_law,
)
from exudyn_wheelset.catalogue.by_name import s1002_wheelset
from exudyn_wheelset.contact.descriptions import Contact
from exudyn_wheelset.creep import CREEP_LAWS, creep_law, creep_parameters, law_of_kernel
from exudyn_wheelset.creep.saturation import (
    LEAST_FRICTION_FORCE,
    bounded,
    cubic_share,
    linear_force,
)
from exudyn_wheelset.errors import WheelsetError

BUILT_IN = "shen-hedrick-elkins"


def _shen(
    creep_x, creep_y, spin, a, b, normal_force, friction, shear_modulus, poisson, parameters
):  # fmt: skip
    limit = friction * normal_force
    if not (limit > LEAST_FRICTION_FORCE and a > 0.0 and b > 0.0):
        return 0.0, 0.0, 0.0
    creep_x, creep_y, spin = bounded(creep_x), bounded(creep_y), bounded(spin)
    force_x, force_y = linear_force(creep_x, creep_y, spin, a, b, shear_modulus, poisson)
    share = cubic_share(math.sqrt(force_x * force_x + force_y * force_y) / limit)
    return share * force_x, share * force_y, 0.0


shen = numba.njit(error_model="numpy")(_shen)


@numba.njit
def scaled(cx, cy, spin, a, b, normal_force, friction, shear_modulus, poisson, parameters):
    """Two parameters, to see that they arrive in order and number."""
    return -parameters[0] * cx, -parameters[1] * cy, float(len(parameters))


@pytest.fixture
def registered():
    before = dict(CREEP_LAWS)
    yield register_creep_law
    CREEP_LAWS.clear()
    CREEP_LAWS.update(before)


STATES = (
    np.random.default_rng(7).normal(0.0, 2e-3, (3, 500)) * [[1.0], [1.0], [100.0]],
    (6e-3, 4e-3, 8e4, 0.3, 82e9, 0.28),
)


def test_creep_force_has_the_same_bits():
    own = creep_force(shen, *STATES[0], *STATES[1])
    np.testing.assert_array_equal(own, creep_force(BUILT_IN, *STATES[0], *STATES[1]))


def test_plain_function_and_cfunc_are_compiled():
    expected = creep_force(BUILT_IN, 1e-3, 2e-3, 0.1, *STATES[1])
    number = numba.types.float64
    signature = numba.types.UniTuple(number, 3)(*[number] * 9, number[::1])
    c_law = numba.cfunc(signature)(_shen)
    for law in (_shen, c_law):
        assert creep_force(law, 1e-3, 2e-3, 0.1, *STATES[1]) == expected


def test_registered_by_name_with_parameters(registered):
    law = registered("scaled", scaled, parameters={"along": 2.0, "across": 3.0})
    assert creep_law("scaled") is law
    assert creep_force("scaled", 1.0, 1.0, 0.0, *STATES[1]) == (-2.0, -3.0, 2.0)
    assert creep_force("scaled", 1.0, 1.0, 0.0, *STATES[1], across=5.0) == (-2.0, -5.0, 2.0)
    fx, fy, _ = creep_force("scaled", 1.0, 1.0, 0.0, *STATES[1], along=np.array([1.0, 4.0]))
    assert (fx.tolist(), fy.tolist()) == ([-1.0, -4.0], [-3.0, -3.0])
    with pytest.raises(WheelsetError, match="unknown parameter of creep law 'scaled' 'alone'"):
        creep_force("scaled", 1.0, 1.0, 0.0, *STATES[1], alone=1.0)
    values = creep_parameters("scaled", along=7.0)
    assert law_of_kernel(law.number, values) == (law, {"along": 7.0, "across": 3.0})
    assert values[1:].tolist() == [7.0, 3.0]


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_exception_in_the_law_is_no_number():
    @numba.njit
    def failing(cx, cy, spin, a, b, normal_force, friction, shear_modulus, poisson, parameters):
        if cx > 0.0:
            raise ValueError("no")
        return 0.0, 0.0, 0.0

    assert creep_force(failing, 0.0, 0.0, 0.0, *STATES[1]) == (0.0, 0.0, 0.0)
    assert np.isnan(creep_force(failing, 1.0, 0.0, 0.0, *STATES[1])).all()


def test_refusals(registered):
    @numba.njit
    def two_results(cx, cy, spin, a, b, normal_force, friction, shear_modulus, poisson, parameters):
        return cx, cy

    with pytest.raises(WheelsetError, match="'two_results' cannot be compiled as law"):
        creep_force(two_results, 0.0, 0.0, 0.0, *STATES[1])
    with pytest.raises(WheelsetError, match=r"give the name of a law or a function compiled"):
        creep_force(3.0, 0.0, 0.0, 0.0, *STATES[1])
    with pytest.raises(WheelsetError, match="'polach' belongs to the package"):
        registered("polach", shen)
    with pytest.raises(WheelsetError, match=r"'friction'.*another name"):
        registered("mine", shen, parameters={"friction": 1.0})
    with pytest.raises(WheelsetError, match="has 8 parameters"):
        registered("mine", shen, parameters={f"p{k}": 1.0 for k in range(8)})
    assert "mine" not in CREEP_LAWS


WHEELSET = Wheelset(mass=1813.0, inertia=(1120.0, 112.0, 1120.0), radius=0.46, wheel="S1002")
TRACK = Track("UIC60")


def test_contact_forces_have_the_same_bits():
    pose = (0.0, 3e-3, -2.0e-4, 2e-4, 0.0, 1e-3)
    velocity = (20.0, 0.01, 0.0, 0.0, 20.0 / 0.46, 0.0)
    own = contact_forces(WHEELSET, TRACK, pose, velocity, creep=shen)
    built_in = contact_forces(WHEELSET, TRACK, pose, velocity, creep=BUILT_IN)
    np.testing.assert_array_equal(own.force, built_in.force)
    np.testing.assert_array_equal(own.moment, built_in.moment)
    assert own.left == built_in.left


def simulated(creep):
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    create_wheelset(mbs, WHEELSET, TRACK, speed=20.0, lateral_offset=2e-3, creep=creep)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = 200
    settings.timeIntegration.endTime = 0.1
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44, showHints=False)
    coordinates = mbs.systemData.GetODE2Coordinates()
    # The rails carry it: in free fall it would be 49 mm lower.
    assert abs(coordinates[2]) < 1e-3
    return coordinates


def test_create_wheelset_has_the_same_motion(registered):
    """The same operations; the compiler may order them otherwise where it has inlined the law."""
    registered("shen of my own", shen)
    expected = simulated(BUILT_IN)
    close = {"rtol": 1e-9, "atol": 1e-12 * np.abs(expected).max()}
    np.testing.assert_allclose(simulated(shen), expected, **close)
    np.testing.assert_allclose(simulated("shen of my own"), expected, **close)


def test_vehicles_have_the_same_eigenvalues():
    for make in (
        lambda law: s1002_wheelset(creep=law).dynamic_system(),
        lambda law: LateralWheelset(creep=law),
    ):
        own, built_in = (linearise(make(law), 30.0) for law in (shen, BUILT_IN))
        np.testing.assert_array_equal(own.eigenvalues, built_in.eigenvalues)


def rate_of(system):
    return system.derivative(np.array([1e-3, 1e-4, 0.01, 0.01]), 30.0)


def test_addresses_do_not_survive_pickling():
    """In a fresh process the function lies elsewhere: descriptions and systems are made anew."""
    system = LateralWheelset(creep=shen)
    expected = rate_of(LateralWheelset(creep=BUILT_IN))
    # Kernels compiled in another place may round otherwise.
    np.testing.assert_allclose(rate_of(pickle.loads(pickle.dumps(system))), expected, rtol=1e-12)
    contact = Contact(creep=shen)
    assert pickle.loads(pickle.dumps(contact)) == contact
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        np.testing.assert_allclose(pool.submit(rate_of, system).result(), expected, rtol=1e-12)


def test_kernels_kept_on_disk_serve_every_law(tmp_path):
    """A second process with another function loads the same kernels and compiles none."""
    script = tmp_path / "own.py"
    script.write_text(
        "import logging, sys, numba\n"
        "from exudyn_wheelset import creep_force\n"
        "logging.basicConfig(level=logging.WARNING)\n"
        "gain = float(sys.argv[1])\n"
        "@numba.njit\n"
        "def law(cx, cy, spin, a, b, n, mu, g, nu, p):\n"
        "    return -gain * cx, 0.0, 0.0\n"
        "print(creep_force(law, 1.0, 0.0, 0.0, 6e-3, 4e-3, 8e4, 0.3, 82e9, 0.28)[0])\n"
    )
    outputs = []
    for gain in ("2.5", "4.0"):
        run = subprocess.run(
            [sys.executable, str(script), gain],
            capture_output=True,
            text=True,
            check=True,
            cwd=Path(__file__).parents[1],
        )
        outputs.append((float(run.stdout), run.stderr))
    assert [value for value, _ in outputs] == [-2.5, -4.0]
    assert "compiling the kernels" not in outputs[1][1]
