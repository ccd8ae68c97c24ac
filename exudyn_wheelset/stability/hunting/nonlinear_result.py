"""What `nonlinear_critical_speed` gives: the speed and how it was found, or an error."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.brief import brief
from exudyn_wheelset.stability.hunting.branch import Branch
from exudyn_wheelset.stability.hunting.descent_result import Descent
from exudyn_wheelset.stability.linear.crossings import CriticalPoint

if TYPE_CHECKING:
    from exudyn_wheelset.stability.gradients import Gradient

Method = Literal["continuation", "descent"]


class NoLimitCycleError(AnalysisError):
    """No stable limit cycle was found; `branch` holds what was."""

    def __init__(self, message: str, branch: Branch | Descent) -> None:
        super().__init__(message)
        self.branch = branch


@brief
@dataclass(frozen=True, eq=False)
class NonlinearCriticalSpeed(float):
    """The lowest speed of stable hunting; a float, the speed itself [m/s].

    speed     [m/s]
    method    "continuation" or "descent"
    how       what the number is, what it was found from and how it was checked
    bracket   speeds [m/s] between which it lies by the method
    hopf      the Hopf point that the search began with
    branch    the Branch or Descent behind it
    by_truck  speed [m/s] at which each truck stops hunting, by descent; the trucks that hunt at the
              answer, by continuation; empty for a vehicle without trucks
    others    branches looked at beside it
    """

    speed: float
    method: Method
    how: str
    bracket: tuple[float, float]
    hopf: CriticalPoint
    branch: Branch | Descent
    by_truck: dict[str, float] = field(default_factory=dict)
    others: tuple[Branch, ...] = ()

    def __new__(cls, speed: float, *_: Any, **__: Any) -> NonlinearCriticalSpeed:
        return super().__new__(cls, speed)

    def gradient(self, names: Sequence[str] | None = None, vehicle: Any = None) -> Gradient:
        """Derivative of the speed by the numbers of the vehicle: name -> (m/s)/unit.

        That of the fold, or of the Hopf point where it is supercritical; see `Fold.gradient`.
        Raises AnalysisError where the speed is neither, and for a descent.
        """
        if self.speed == self.hopf.speed:
            return self.hopf.gradient(names, vehicle)
        for fold in getattr(self.branch, "folds", ()):
            if fold.speed == self.speed:
                gradient: Gradient = fold.gradient(names, vehicle)
                return gradient
        raise AnalysisError(
            f"{self.speed:.4f} m/s is neither a fold nor a Hopf point, so it has no gradient: "
            "ask for method='continuation'"
        )
