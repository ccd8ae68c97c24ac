"""Measure what the pages under docs/decisions state: run it, read it beside the pages.

    python docs/figures/measure_decisions.py [curvature] [loads] [frame] [calls] [spin]

Costs are ratios within one run; on a shared machine microseconds do not carry.
"""

from __future__ import annotations

import csv
import math
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import LoadForceVector, LoadTorqueVector, SensorNode
from numba import njit

from exudyn_wheelset import (
    Suspension,
    Track,
    Wheelset,
    WheelsetOnFrame,
    contact_forces,
    contact_geometry,
    create_wheelset,
    linearise,
)
from exudyn_wheelset.catalogue.paper_wheelset import paper_wheelset
from exudyn_wheelset.contact.layout import SIDE, Axle

REFERENCE = Path(__file__).parents[2] / "tests" / "reference" / "contact_forces_manchester_A22.csv"
WHEELSET = Wheelset(mass=1813, inertia=(1120, 112, 1120), radius=0.46, wheel="S1002")
TRACK = Track(rail="UIC60")
MODELS = ("hertz", "hertz-local", "virtual-penetration", "strips")


def curvature() -> None:
    """Steps of the left wheel's normal force over the shift; normal force beside CONTACT's."""
    shifts = np.arange(-5.5e-3, 5.5e-3, 2e-6)
    rigid = contact_geometry(WHEELSET, TRACK, shifts)
    rolling = (20.0, 0.0, 0.0, 0.0, 20.0 / 0.46, 0.0)
    for model in MODELS:
        force = [
            sum(patch.normal_force for patch in contact_forces(
                WHEELSET, TRACK, (0, y, z - 6e-5, roll, 0, 0), rolling, normal=model
            ).left)
            for y, roll, z in zip(shifts, rigid.roll, rigid.z, strict=True)
        ]  # fmt: skip
        change = np.abs(np.diff(force))
        place = shifts[np.argmax(change)]
        print(
            f"{model:20s} N {min(force) / 1e3:.1f} to {max(force) / 1e3:.1f} kN, largest change "
            f"over 2 um of shift {change.max():.0f} N at y = {1e3 * place:.3f} mm"
        )
    with REFERENCE.open(encoding="utf-8") as file:
        rows = [
            {k: float(v) for k, v in row.items() if k != "side"} for row in csv.DictReader(file)
        ]
    print("normal force against CONTACT [%]:", *MODELS)
    for row in rows:
        roll, yaw = row["roll_rad"], row["yaw_rad"]
        axle = (-math.sin(yaw) * math.cos(roll), math.cos(yaw) * math.cos(roll), math.sin(roll))
        pose = (0.0, row["y_m"], row["z_m"], roll, 0.0, yaw)
        velocity = (2.0, 0.0, 0.0, *(row["spin_rad_per_s"] * np.array(axle)))
        errors = []
        for model in MODELS:
            left = contact_forces(WHEELSET, TRACK, pose, velocity, normal=model).left
            whole = sum(patch.normal_force for patch in left)
            errors.append(100.0 * (whole / row["normal_force_N"] - 1.0))
        print(f"  y = {1e3 * row['y_m']:4.1f} mm", *(f"{error:+6.1f}" for error in errors))


def _settings(steps: int, end: float) -> Any:
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = end
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e-3
    return settings


def loads() -> None:
    """A step with one contact evaluation for both loads, with two, and with empty loads."""
    model = WheelsetOnFrame(
        WHEELSET, TRACK, Suspension(1.0, (2e6, 1e6, 0.0)), 120e3, {"damping": 1.0}
    )
    seconds: dict[str, float] = {}
    for _ in range(3):
        for mode in ("shared", "twice", "empty"):
            _, mbs, items = model.build(30.0, lateral_offset=1e-3, sensors=False, show=False)
            contact = items.contact

            def force(mbs, t, load, contact=contact, mode=mode):
                contact.forget()
                return contact.force_load(mbs, t, load) if mode == "twice" else (0.0, 0.0, 120e3)

            def torque(mbs, t, load, contact=contact, mode=mode):
                contact.forget()
                return contact.torque_load(mbs, t, load) if mode == "twice" else (0.0, 0.0, 0.0)

            if mode != "shared":
                mbs.SetLoadParameter(items.force_load, "loadVectorUserFunction", force)
                mbs.SetLoadParameter(items.torque_load, "loadVectorUserFunction", torque)
            mbs.Assemble()
            for _ in range(3):
                start = time.perf_counter()
                mbs.SolveDynamic(_settings(2000, 1.0), solverType=exu.DynamicSolverType.RK44)
                taken = time.perf_counter() - start
                seconds[mode] = min(seconds.get(mode, np.inf), taken)
    print("one step, relative to a shared evaluation:", end=" ")
    print({mode: round(value / seconds["shared"], 2) for mode, value in seconds.items()})


def frame() -> None:
    """The same run over the ground and in the moving frame."""

    def run(moving: bool) -> np.ndarray:
        container = exu.SystemContainer()
        mbs = container.AddSystem()
        items = create_wheelset(
            mbs, WHEELSET, TRACK, speed=30.0, moving_frame=moving, lateral_offset=1e-3, show=False,
            sensors=False,
        )  # fmt: skip
        kinds = exu.OutputVariableType

        def spring(mbs, t, load):
            y = mbs.GetNodeOutput(items.node, kinds.Displacement)[1]
            return [0.0, -2e6 * y, -102e3]

        def yaw_spring(mbs, t, load):
            turn = mbs.GetNodeOutput(items.node, kinds.RotationMatrix).reshape(3, 3)
            return [0.0, 0.0, 4e6 * math.asin(turn[0, 1])]

        mbs.AddLoad(LoadForceVector(markerNumber=items.marker, loadVectorUserFunction=spring))
        mbs.AddLoad(LoadTorqueVector(markerNumber=items.marker, loadVectorUserFunction=yaw_spring))
        sensor = mbs.AddSensor(
            SensorNode(nodeNumber=items.node, storeInternal=True, writeToFile=False,
                       outputVariableType=kinds.Displacement)
        )  # fmt: skip
        mbs.Assemble()
        mbs.SolveDynamic(_settings(8000, 2.0), solverType=exu.DynamicSolverType.RK44)
        return mbs.GetSensorStoredData(sensor)

    ground, moving = run(False), run(True)
    print(
        f"60 m at 30 m/s: y differs by {np.abs(ground[:, 2] - moving[:, 2]).max():.1e} m, "
        f"x - V t by {np.abs(ground[:, 1] - moving[:, 1] - 30.0 * ground[:, 0]).max():.1e} m"
    )


def _per_call(function: Callable[..., object], arguments: tuple) -> float:
    function(*arguments)
    best = np.inf
    for _ in range(20):
        start = time.perf_counter()
        for _ in range(5000):
            function(*arguments)
        best = min(best, time.perf_counter() - start)
    return best / 5000


def calls() -> None:
    """Calling an empty compiled function from Python, over its kinds of arguments."""
    arrays = Axle(*(np.zeros(5) for _ in range(5)))  # type: ignore[arg-type]
    cases = [(f"{count} arrays", (np.zeros(5),) * count) for count in (1, 2, 4, 8, 12)]
    cases.append(("12 numbers", (0.1,) * 12))
    cases.append(("a named tuple of 5 numbers", (Axle(0.1, 0.1, 0.1, 0.1, 0.1),)))
    cases.append(("a named tuple of 5 arrays", (arrays,)))
    cases.append(("a record", (np.zeros(1, SIDE)[0],)))
    base = 0.0
    for name, arguments in cases:
        names = ", ".join(f"a{k}" for k in range(len(arguments)))
        space: dict[str, Any] = {}
        exec(f"def empty({names}):\n    return 0.0", space)
        taken = _per_call(njit(space["empty"]), arguments)
        base = base or taken
        print(f"{name:28s}{1e6 * taken:7.3f} us, {taken / base:5.1f} times one array")


def spin() -> None:
    """Least damped hunting root with and without the term of the frame that does not spin."""
    model, speed = paper_wheelset(1, driven=False), 34.0
    system = model.dynamic_system()
    jacobian = linearise(system, speed).jacobian
    names = system.state_names
    wx, wz = (names.index(name) for name in ("wx [rad/s]", "wz [rad/s]"))
    geometry = contact_geometry(model.wheelset, model.track, [0.0])
    rate = speed / float(geometry.left.radius[0])
    spinning = jacobian.copy()
    spinning[wx, wz] -= rate
    spinning[wz, wx] += rate
    for name, matrix in (("frame without spin", jacobian), ("spinning frame", spinning)):
        roots = np.linalg.eigvals(matrix)
        pairs = roots[(roots.imag > 5.0) & (roots.imag < 50.0)]
        print(f"{name}: {', '.join(f'{root:.3f}' for root in pairs)} 1/s at {speed:g} m/s")


def main() -> None:
    parts = {"curvature": curvature, "loads": loads, "frame": frame, "calls": calls, "spin": spin}
    for name in sys.argv[1:] or parts:
        print(f"-- {name}")
        parts[name]()


if __name__ == "__main__":
    main()
