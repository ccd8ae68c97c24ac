"""How a computation ended: an enum whose value is the sentence, and where there are any, numbers.

A simulation, a branch, a descent ends in one of these ways and keeps what it had found by then.
Code asks for the member (`outcome.ending is Ending.INTERRUPTED`, `ending.derailed`), people read
the sentence; no sentence is ever taken apart again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

from exudyn_wheelset.spelling import spelt_class


class Ending(Enum):
    """A way to end; the value says it in words.

    Examples
    --------
    >>> from exudyn_wheelset import Ending
    >>> Ending.FINISHED.name
    'FINISHED'
    """

    FINISHED = "the planned end was reached"
    INTERRUPTED = "interrupted by the user"
    # A motion leaves the rails: coupling/derailment.py has the thresholds and their reasons.
    WHEEL_CLIMB = "derailment: a flange has climbed onto its rail"
    LIFT_OFF = "derailment: a wheel has been off its rail for too long a way"
    LOST_GAUGE = "derailment: a wheelset stands beside the track"
    # A motion cannot go on.
    NOT_FINITE = "the motion is no longer finite"
    RAN_AWAY = "the motion ran away"
    NO_CONVERGENCE = "the solver did not converge"
    MODEL_FAILED = "the model could not be evaluated"
    # A motion is judged.
    SETTLED = "the motion has settled"
    DIED_OUT = "the motion has died out"
    UNDECIDED = "the motion is neither settled nor dying out"
    # A branch of limit cycles.
    LOWER_END = "the speed range was left at its lower end"
    UPPER_END = "the speed range was left at its upper end"
    AMPLITUDE_LIMIT = "the amplitude limit was passed"
    EQUILIBRIUM = "the orbit shrank to an equilibrium (Hopf point)"
    CLOSED = "the branch closed on itself"
    MAXIMUM_POINTS = "the maximum of points was reached"
    ORBIT_LOST = "no convergence at the smallest step"
    CONTACT_LOST = "lost contact or derailment"
    # A descent.
    JUMP_FOUND = "the jump was found"
    STILL_HUNTING = "still hunting at the lower end"

    @property
    def derailed(self) -> bool:
        """Whether a wheelset left the rails."""
        return self in (Ending.WHEEL_CLIMB, Ending.LIFT_OFF, Ending.LOST_GAUGE)

    @property
    def sentence(self) -> str:
        """The ending in words."""
        return str(self.value)


@spelt_class
@dataclass(frozen=True)
class Outcome:
    """An ending with its numbers: `detail` says which wheelset, speed or height, or is empty.

    Examples
    --------
    >>> from exudyn_wheelset import Ending, Outcome
    >>> str(Outcome(Ending.FINISHED))
    'the planned end was reached'
    """

    ending: Ending
    detail: str = ""

    def __str__(self) -> str:
        return f"{self.ending.sentence}: {self.detail}" if self.detail else self.ending.sentence

    def record(self) -> dict[str, str]:
        """The outcome for a file; `Outcome.read` is its inverse."""
        return {"ending": self.ending.name, "detail": self.detail}

    @classmethod
    def read(cls, record: Mapping[str, Any]) -> Outcome:
        """The outcome of a record."""
        return cls(Ending[record["ending"]], str(record.get("detail", "")))
