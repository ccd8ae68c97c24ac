"""A curve in a plane of two coordinates (u, w), followed through turns in both.

The curve is where a value, known at one place at a time, is zero: the growth rate over speed and
parameter for Hopf points, the slope of a branch over amplitude and parameter for folds. From a
place on it the next is predicted along the last two and corrected by secants, in u with w held
(the vehicle stays the same) wherever the curve runs along w, in w where it turns back in w: a cusp
of a fold curve in speed and parameter is such a turn and nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.errors import AnalysisError, WheelsetError

# Below this share of the heading along w, corrections are made in w.
ALONG = 0.5
# Below this share the start of a curve is next to a turn in w.
CUSP = 0.1
# Largest turn of the heading in one step [rad].
TURN = 0.5
SMALLEST_STEP = 1e-3
# Sideways by less than this a turn is let through.
CORNER = 0.03
# The heading is taken over at least this share of the largest step.
BASELINE = 0.3
CORRECTIONS = 16
# A prediction is taken as it is if its error, by a slope that is not its own, is below this share.
UNSURE = 0.02


class Place(Protocol):
    """A place at which the value is known; parameter: w in its own unit."""

    @property
    def value(self) -> float: ...

    @property
    def parameter(self) -> float: ...


P = TypeVar("P", bound=Place)


class World(Protocol[P]):
    """What the curve lives in.

    reach     the place at (u, w) from another one, w relative to `span` of the parameter
    between   (u, w) from one place to another
    error     what is left to correct by a move (u, w), relative to what is allowed
    ended     why the curve ends at a place, or ""
    span      of the parameter; low and high: its range
    """

    span: float
    low: float
    high: float

    def reach(self, base: P, move: Array) -> P: ...

    def between(self, base: P, other: P) -> Array: ...

    def error(self, place: P, move: Array) -> float: ...

    def ended(self, place: P) -> str: ...


@dataclass
class _Slopes:
    """Derivatives of the value by u and by w, as the corrections have shown them."""

    u: float
    w: float


class Tracer(Generic[P]):
    """Follows one curve from one of its places."""

    def __init__(
        self, world: World[P], start: P, step: float, report: Callable[[], object]
    ) -> None:
        self.world, self.start = world, start
        self.largest = step
        self.report = report
        probe = 0.1 * step
        sideways = world.reach(start, np.array([probe, 0.0]))
        # Inwards at an end of the range.
        sign = 1.0 if start.parameter + probe * world.span <= world.high else -1.0
        onward = world.reach(start, np.array([0.0, sign * probe]))
        self.slopes = _Slopes(
            (sideways.value - start.value) / probe, sign * (onward.value - start.value) / probe
        )

    def both_ways(self, most: int) -> tuple[list[P], tuple[str, str]]:
        """Places of the curve, one end to the other, and why it ends at either."""
        forward, last = self.follow(1.0, most)
        if last == CLOSED:
            return forward, (last, last)
        backward, first = self.follow(-1.0, most)
        return [*backward[:0:-1], *forward], (first, last)

    def follow(self, sign: float, most: int) -> tuple[list[P], str]:
        """Places from the start on, towards rising (sign 1) or falling parameter first."""
        slopes = _Slopes(self.slopes.u, self.slopes.w)
        heading = np.array([-slopes.w, slopes.u])
        heading *= sign * (np.sign(heading[1]) or 1.0) / max(float(np.linalg.norm(heading)), 1e-300)
        if abs(heading[1]) > CUSP:
            # The step shows the way better than differences beside a corner.
            heading = np.array([0.0, sign])
        places, step = [self.start], 0.5 * self.largest
        while len(places) < most:
            base = places[-1]
            edge = self.world.low if heading[1] < 0.0 else self.world.high
            if base.parameter == edge and abs(heading[1]) > 1e-9:
                return places, f"the parameter's range ends at {edge:g}"
            try:
                new, effort = self._step(base, heading, step, slopes)
                way = -self.world.between(new, base)
                onward = float(way @ heading)
                aside = float(np.linalg.norm(way - onward * heading))
                # At a corner (a flange that sets in) any step turns: small ones go through.
                turns = aside > max(np.tan(TURN) * onward, CORNER)
                if onward <= 0.0 or (turns and len(places) > 1):
                    raise AnalysisError("the curve turns more sharply than a step may")
                turned = self._heading(places, new, way)
            except WheelsetError as error:
                step *= 0.4
                if step < SMALLEST_STEP * self.largest:
                    return places, f"no step leads on: {error}"
                continue
            places.append(new)
            self.report()
            reason = self.world.ended(new)
            if reason:
                return places, reason
            if self._closed(places):
                return places, CLOSED
            heading = turned / float(np.linalg.norm(turned))
            step = min(self.largest, step * (1.5 if effort <= 3 else 1.0 if effort <= 6 else 0.7))
        return places, f"{most} places are the most that were asked for"

    def _heading(self, places: list[P], new: P, way: Array) -> Array:
        """Direction of the curve at a new place, over a length that corrections do not blur."""
        for older in places[-2:-6:-1]:
            if float(np.linalg.norm(way)) > BASELINE * self.largest:
                break
            way = -self.world.between(new, older)
        return way

    def _step(self, base: P, heading: Array, step: float, slopes: _Slopes) -> tuple[P, int]:
        move = step * heading
        world = self.world
        end = base.parameter + move[1] * world.span
        held = not world.low <= end <= world.high
        if held:
            # The last place lies on the end of the range.
            left = float(np.clip(end, world.low, world.high) - base.parameter) / world.span
            if abs(left) < 1e-9:
                raise AnalysisError("the parameter's range ends here")
            move = move * (left / move[1])
            move[1] = left
        sideways = np.array([1.0, 0.0])
        if not held and abs(heading[1]) < ALONG:
            sideways = np.array([0.0, 1.0])
        slope = float(sideways @ [slopes.u, slopes.w])
        if sideways[0] and abs(heading[0]) > ALONG:
            # Along the curve the value does not change.
            slope = -slopes.w * float(heading[1] / heading[0])
        place = world.reach(base, move)
        known: list[tuple[float, float]] = [(0.0, place.value)]
        for effort in range(1, CORRECTIONS):
            if slope == 0.0 or not np.isfinite(slope):
                raise AnalysisError("the value does not change across the curve")
            change = _next(known, slope, step)
            # The first error is judged by the slope of another place.
            if world.error(place, change * sideways) <= (UNSURE if effort == 1 else 1.0):
                return place, effort
            move = move + change * sideways
            place = world.reach(base, move)
            offset = known[-1][0] + change
            if change:
                slope = (place.value - known[-1][1]) / change
                if sideways[0]:
                    slopes.u = slope
                else:
                    slopes.w = slope
            known.append((offset, place.value))
        raise AnalysisError(f"corrections do not settle: the value {place.value:.3g} is left")

    def _closed(self, places: list[P]) -> bool:
        if len(places) < 10:
            return False
        back = self.world.between(places[-1], places[0])
        ahead = self.world.between(places[-2], places[-1])
        return float(np.linalg.norm(back)) < 0.7 * float(np.linalg.norm(ahead))


CLOSED = "the curve is closed"


def _next(known: list[tuple[float, float]], slope: float, step: float) -> float:
    """Change of the offset to where the value vanishes; inside the bracket where there is one."""
    offset, value = known[-1]
    change = float(np.clip(-value / slope, -step, step))
    opposite = [pair for pair in known if pair[1] * value < 0.0]
    if opposite:
        other, against = min(opposite, key=lambda pair: abs(pair[0] - offset))
        share = float(np.clip(value / (value - against), 0.1, 0.9))
        # At a jump of the value false position creeps up from one side.
        if len(known) > 2 and known[-2][1] * value > 0.0:
            share = 0.5
        change = share * (other - offset)
    return change


class Family:
    """The systems of a vehicle over one of its numbers; the last ones are kept."""

    def __init__(self, make: Callable[[float], Any], keep: int = 12) -> None:
        self._make, self._keep = make, keep
        self._known: dict[float, Any] = {}

    def __call__(self, value: float) -> Any:
        if value not in self._known:
            while len(self._known) >= self._keep:
                self._known.pop(next(iter(self._known)))
            self._known[value] = self._make(value)
        return self._known[value]
