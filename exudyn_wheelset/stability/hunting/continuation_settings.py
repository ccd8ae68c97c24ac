"""How a branch of limit cycles is followed: mesh, accuracy, steps and ends, in one description.

The defaults serve a wheelset, a bogie and a textbook equation alike; what was measured for them
is in docs/decisions/periodic-orbits-by-collocation.md.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.stability.hunting.orbit import DEGREE, INTERVALS


@spelt_class
@dataclass(frozen=True)
class ContinuationSettings:
    """How a branch is followed.

    intervals, degree   mesh intervals of an orbit to begin with, polynomial degree on each
    maximum_intervals   to which the mesh is refined, by halves, while the trivial multiplier is
    accuracy            off by more than this: rapid motion after a flange's impact needs it
    tolerance           of Newton's correction, relative to the size of the orbit
    roughness           correction at which an orbit is taken if it falls no further (f jumps)
    first_amplitude     of the first orbit off a Hopf point, in units of the state's scale
    growth              largest change of the orbit in one step, as a fraction of its size
    speed_steps         the speed range is crossed in at least this many steps
    smallest_step       of the arclength, as a fraction of the largest allowed one
    mirror              whether orbits may be taken as their own mirror image, which halves the
                        cost, where system and start are found to be symmetric
    turn, corner        largest turn of the tangent in one step [rad], asked for in steps down to
                        this fraction of the largest allowed one
    adapt_every         points between two adaptations of the mesh
    maximum_points      a branch ends after so many points
    amplitude_limits    state name to half peak to peak [m or rad] at which a branch ends
    fold_tolerance      relative error of the speed of a fold
    fold_visible        relative change of speed about a fold below which it is not one
    stability_margin    a multiplier of size 1 + this is not yet called unstable
    """

    intervals: int = INTERVALS
    degree: int = DEGREE
    maximum_intervals: int = 60
    accuracy: float = 0.1
    tolerance: float = 1e-8
    roughness: float = 1e-3
    first_amplitude: float = 0.2
    growth: float = 0.3
    speed_steps: int = 25
    smallest_step: float = 1e-4
    mirror: bool = True
    turn: float = 0.5
    corner: float = 0.03
    adapt_every: int = 4
    maximum_points: int = 200
    amplitude_limits: tuple[tuple[str, float], ...] = ()
    fold_tolerance: float = 1e-6
    fold_visible: float = 1e-5
    stability_margin: float = 1e-5

    def __post_init__(self) -> None:
        if self.intervals < 4 or not 2 <= self.degree <= 7:
            raise AnalysisError(
                f"intervals = {self.intervals}, degree = {self.degree}: an orbit needs at least "
                "4 intervals and a degree from 2 to 7 (30 and 4 serve most vehicles)"
            )
        if self.maximum_points < 1 or self.speed_steps < 1 or self.adapt_every < 1:
            raise AnalysisError(
                f"maximum_points = {self.maximum_points}, speed_steps = {self.speed_steps} and "
                f"adapt_every = {self.adapt_every} must be at least 1"
            )
        for name in ("tolerance", "first_amplitude", "growth", "smallest_step", "turn"):
            if not getattr(self, name) > 0.0:
                raise AnalysisError(f"{name} = {getattr(self, name)!r} must be positive")

    def record(self) -> dict[str, object]:
        """The settings as plain values for a file."""
        return asdict(self)
