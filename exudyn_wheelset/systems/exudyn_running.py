"""Running an Exudyn system from given coordinates, and its coordinates at every step."""

from __future__ import annotations

from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import SensorNode
from scipy.interpolate import CubicSpline

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import positive, unknown
from exudyn_wheelset.coupling.registration import wheelsets_of
from exudyn_wheelset.coupling.running import copied_settings, run_solver
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.endings import Outcome

# RK44 at this step [s] is within 1 % of the converged growth rate of a wheelset on stiff contact,
# and explicit steps need no Jacobian of the loads.
DEFAULT_SOLVER = "RK44"
DEFAULT_STEP = 5.0e-4


class Runner:
    """Runs an Exudyn system from given coordinates and reads every step back.

    solver_type, step [s]: those of the settings where they are given, else RK44 and 5e-4 s, less
    where rails are elastic.
    nodes: all but Exudyn's ground. Sensors are added to `mbs`, which is assembled by the caller.
    memory: data coordinates may be there; they are not recorded.
    Raises AnalysisError, which begins with `name`, for nodes of data coordinates and for a solver
    or a step that does not exist.
    """

    def __init__(
        self,
        mbs: Any,
        name: str,
        settings: exu.SimulationSettings | None,
        solver_type: exu.DynamicSolverType | str | None,
        step: float | None,
        memory: bool = False,
    ) -> None:
        self._mbs = mbs
        self._contacts = [items.contact for items in wheelsets_of(mbs)]
        self.settings = copied_settings(settings)
        integration = self.settings.timeIntegration
        if step is None:
            softened = [one.elasticity for one in self._contacts if one.elasticity is not None]
            step = min([DEFAULT_STEP, *(one.longest_step() for one in softened)])
            if settings is not None:
                step = (integration.endTime - integration.startTime) / integration.numberOfSteps
        self.step = positive("step", step, "s", 1.0)
        if solver_type is None:
            solver_type = DEFAULT_SOLVER if settings is None else integration.solverType
        if isinstance(solver_type, str):
            if solver_type not in exu.DynamicSolverType.__members__:
                raise unknown("solver type", solver_type, sorted(exu.DynamicSolverType.__members__))
            solver_type = exu.DynamicSolverType.__members__[solver_type]
        self.solver_type = solver_type
        self._sensors = _state_sensors(mbs, name, memory)

    @property
    def nodes(self) -> list[int]:
        """Numbers of the nodes whose coordinates are recorded."""
        return [node for node, *_ in self._sensors]

    def run(
        self,
        start: tuple[Array, Array, Array],
        steps: int,
        duration: float,
        progress: bool = False,
        description: str = "simulating",
    ) -> Outcome:
        """Run from coordinates, velocities (nq,), (nq,) and first-order ones (n1,).

        Returns how it ended, FINISHED after the whole duration [s]. The system's initial values are
        left as they were.
        """
        data, initial = self._mbs.systemData, exu.ConfigurationType.Initial
        coordinates, velocities, first_order = start
        kept = [
            data.GetODE2Coordinates(initial),
            data.GetODE2Coordinates_t(initial),
            data.GetODE1Coordinates(initial),
        ]
        settings = self.settings
        settings.timeIntegration.startTime = 0.0
        settings.timeIntegration.endTime = duration
        settings.timeIntegration.numberOfSteps = steps
        settings.solution.sensors.active = True
        # Half a step: every step is stored, whatever the rounding of the times.
        settings.solution.sensors.writePeriod = 0.5 * duration / steps
        try:
            data.SetODE2Coordinates(coordinates, initial)
            data.SetODE2Coordinates_t(velocities, initial)
            if len(first_order):
                data.SetODE1Coordinates(first_order, initial)
            return run_solver(
                self._mbs, settings, self.solver_type, self._contacts, progress, description
            )
        finally:
            data.SetODE2Coordinates(kept[0], initial)
            data.SetODE2Coordinates_t(kept[1], initial)
            if len(first_order):
                data.SetODE1Coordinates(kept[2], initial)
            data.SetTime(0.0)

    def recorded(self) -> tuple[Array, tuple[Array, Array, Array]]:
        """Times (m,) of the last run's steps; coordinates, velocities (m, nq), first order (m, n1).

        Adaptive solvers step where they please.
        """
        mbs, data = self._mbs, self._mbs.systemData
        times = mbs.GetSensorStoredData(self._sensors[0][1])[:, 0]
        coordinates = np.zeros((len(times), data.ODE2Size()))
        velocities = np.zeros((len(times), data.ODE2Size()))
        first_order = np.zeros((len(times), data.ODE1Size()))
        for node, positions, rates in self._sensors:
            stored = mbs.GetSensorStoredData(positions)[:, 1:]
            indices = data.GetNodeLTGODE2(node)
            if len(indices):
                coordinates[:, indices] = stored
                velocities[:, indices] = mbs.GetSensorStoredData(rates)[:, 1:]
            else:
                first_order[:, data.GetNodeLTGODE1(node)] = stored
        return times, (coordinates, velocities, first_order)


def sampled(times: Array, values: Array, wanted: Array) -> Array:
    """Values (m, k) at rising times (m,), taken at those of the `wanted` times that were reached.

    Steps that meet the wanted times are picked, others interpolated by cubic splines. What is no
    longer finite ends the motion.
    """
    finite = np.isfinite(values).all(axis=1)
    if not finite.all():
        end = int(np.argmin(finite))
        times, values = times[:end], values[:end]
    if not len(times):
        return values
    tolerance = 1e-9 * (wanted[-1] - wanted[0])
    wanted = wanted[wanted <= times[-1] + tolerance]
    rows = np.searchsorted(times, wanted - tolerance)
    if np.all(np.abs(times[rows] - wanted) <= tolerance):
        return np.asarray(values[rows])
    return np.asarray(CubicSpline(times, values)(wanted))


def _state_sensors(mbs: Any, name: str, memory: bool) -> list[tuple[int, int, int]]:
    """Sensors of every node's coordinates and velocities: node, sensor, sensor.

    Those of an earlier call are found again.
    """
    data = mbs.systemData
    nodes = [mbs.GetNode(node) for node in range(data.NumberOfNodes())]
    hidden = [node["name"] for node in nodes if node["nodeType"] == "GenericData"]
    if hidden and not memory:
        raise AnalysisError(
            f"{name}: the model has data coordinates (friction or contact memory) in "
            f"{', '.join(hidden)}; their state is hidden from the analysis: leave them out, or "
            "replace them by first-order coordinates (ObjectGenericODE1)"
        )
    known = {mbs.GetSensor(k)["name"]: k for k in range(data.NumberOfSensors())}
    types = exu.OutputVariableType
    sensors = []
    for number, node in enumerate(nodes):
        if "Ground" in node["nodeType"] or node["nodeType"] == "GenericData":
            continue
        of_node = []
        for what in (types.Coordinates, types.Coordinates_t):
            if what == types.Coordinates_t and node["nodeType"] == "GenericODE1":
                continue
            label = f"state of node {number}: {what.name}"
            if label not in known:
                known[label] = mbs.AddSensor(
                    SensorNode(
                        nodeNumber=number,
                        storeInternal=True,
                        writeToFile=False,
                        outputVariableType=what,
                        name=label,
                    )
                )
            of_node.append(known[label])
        sensors.append((number, of_node[0], of_node[-1]))
    return sensors
