"""How a track lies: straights, transitions and circular curves by arc length, cant, gradient.

    Layout([Straight(50), Transition(50, shape="bloss"), Curve(radius=-300, cant=0.12, length=500)])

The arc length s [m] runs along the centre line, in the middle of the nominal gauge in the plane of
the rail tops. Its frame has x along it, z along the canted normal, and the rotation
Rz(heading) Ry(-slope) Rx(roll) against level ground: heading' = curvature, positive to the left;
tan(slope) the gradient, positive uphill; sin(roll) = -+cant/base, with the outer rail raised where
the cant is positive, about the centre line. Curvature and cant are continuous; kinks of cant and
gradient are rounded off over `rounding`, as rails do not bend in a corner and a frame that turned
so would kick what stands in it. Beyond its ends a layout stays what it is there.

Widening of the gauge moves the inner rail inwards by the whole of it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import number, numbers, positive, unknown
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.track.piecewise import Pieces, on_common_breaks, polyline, rounded
from exudyn_wheelset.track.transitions import SHAPES, STRAIGHT_RAMPS, shape_pieces

# Tightest curve [m] that flanges and gauges of main lines allow with widening.
_TIGHTEST = 20.0
# Distance [m] of the running surfaces that cant is measured over, at 1435 mm of gauge.
BASE = 1.5
# A kernel integrates the direction over pieces up to this long [m] with five points.
LONGEST_PIECE = 8.0
# Stations that are given again agree with the sum of the lengths to this [m].
_STATION = 1e-3


def _check_element(element: Any, what: str) -> None:
    put = object.__setattr__
    put(element, "length", positive(f"{what}: length", element.length, "m", 1e7))
    if element.start is not None:
        put(element, "start", number(f"{what}: start", element.start, "m"))


@spelt_class
@dataclass(frozen=True)
class Straight:
    """Straight level track of a length [m]; start [m]: its station, to be checked if given.

    Examples
    --------
    >>> from exudyn_wheelset import Straight
    >>> Straight(50).length
    50.0
    """

    length: float
    start: float | None = None

    def __post_init__(self) -> None:
        _check_element(self, "straight")


@spelt_class
@dataclass(frozen=True)
class Curve:
    """Circular curve: radius [m], positive to the left, length [m] along the centre line.

    cant [m]: rise of the outer rail over the inner one; widening [m] of the gauge.

    Examples
    --------
    >>> from exudyn_wheelset import Curve
    >>> Curve(radius=-500, length=200, cant=0.1).radius  # to the right
    -500.0
    """

    radius: float
    length: float
    cant: float = 0.0
    widening: float = 0.0
    start: float | None = None

    def __post_init__(self) -> None:
        _check_element(self, "curve")
        put = object.__setattr__
        radius = number("curve: radius", self.radius, "m", -1e7, 1e7, "a straight is Straight(...)")
        if abs(radius) < _TIGHTEST:
            raise WheelsetError(
                f"curve: radius = {radius:g} m: give at least {_TIGHTEST:g} m, positive to the left"
            )
        put(self, "radius", radius)
        put(self, "cant", number("curve: cant", self.cant, "m", -0.3, 0.3, "metres are asked"))
        put(self, "widening", number("curve: widening", self.widening, "m", 0.0, 0.04, "metres"))

    @property
    def curvature(self) -> float:
        """Curvature [1/m], positive to the left."""
        return 1.0 / self.radius


@spelt_class
@dataclass(frozen=True)
class Transition:
    """Transition curve of a length [m] between the elements beside it; shape: see transitions.py.

    At an end of the layout it leads to straight track.

    Examples
    --------
    >>> from exudyn_wheelset import Transition
    >>> Transition(40, shape="bloss").shape
    'bloss'
    """

    length: float
    shape: str = "clothoid"
    start: float | None = None

    def __post_init__(self) -> None:
        _check_element(self, "transition")
        if self.shape not in SHAPES:
            raise unknown("shape of a transition", self.shape, SHAPES)


TrackElement = Straight | Curve | Transition


@spelt_class
@dataclass(frozen=True)
class Layout:
    """Elements of a track one after the other from station 0.

    elements: Straight, Transition, Curve; gradient: pairs (station [m], rise a metre [-]) with
    straight lines between, constant beyond; base [m]: distance that cant is measured over;
    rounding [m]: of kinks of cant and gradient. Raises WheelsetError for a jump in curvature or
    cant, a gap between stations that are given, and what no track has.

    Examples
    --------
    >>> from exudyn_wheelset import Curve, Layout, Straight, Transition
    >>> layout = Layout([Straight(50), Transition(40), Curve(300, 100, cant=0.1)])
    >>> layout.length
    190.0
    """

    elements: tuple[TrackElement, ...]
    gradient: tuple[tuple[float, float], ...] = ()
    base: float = BASE
    rounding: float = 5.0

    def __init__(
        self,
        elements: Iterable[TrackElement],
        gradient: Iterable[Sequence[float]] = (),
        base: float = BASE,
        rounding: float = 5.0,
    ) -> None:
        put = object.__setattr__
        put(self, "elements", tuple(elements))
        points = tuple(
            numbers("gradient (station, rise)", point, 2, "m, -", -1e9, 1e9) for point in gradient
        )
        put(self, "gradient", points)
        put(self, "base", positive("base", base, "m", 3.0))
        put(self, "rounding", positive("rounding", rounding, "m", 100.0))
        self._check()

    def _check(self) -> None:
        if not self.elements:
            raise WheelsetError("the layout has no element: give at least Straight(length)")
        station = 0.0
        for k, element in enumerate(self.elements):
            if not isinstance(element, TrackElement):
                raise WheelsetError(
                    f"element {k} of the layout is {element!r}: give Straight, Transition or Curve"
                )
            if element.start is not None and abs(element.start - station) > _STATION:
                gap = element.start - station
                raise WheelsetError(
                    f"element {k} of the layout starts at {element.start:g} m, the one before ends "
                    f"at {station:g} m: {'a gap' if gap > 0 else 'an overlap'} of {abs(gap):g} m; "
                    "mend the lengths, or leave the starts out"
                )
            if k > 0:
                self._check_joint(self.elements[k - 1], element, station)
            station += element.length
        for one, other in zip(self.gradient, self.gradient[1:], strict=False):
            if other[0] <= one[0]:
                raise WheelsetError(
                    f"gradient: station {other[0]:g} m follows {one[0]:g} m: give rising stations, "
                    "two of them for the beginning and the end of a vertical curve"
                )
        for at, rise in self.gradient:
            number(f"gradient at {at:g} m", rise, "-", -0.2, 0.2, "a rise a metre, 0.025 for 25 ‰")
        for k in range(len(self.elements)):
            cant = abs(self._cant_of(k))
            if cant > 0.3 * self.base:
                raise WheelsetError(f"cant = {cant:g} m over a base of {self.base:g} m: too steep")

    def _check_joint(self, one: TrackElement, other: TrackElement, station: float) -> None:
        if isinstance(one, Transition) and isinstance(other, Transition):
            raise WheelsetError(
                f"two transitions meet at {station:g} m: what is the curvature there? Put a "
                "Straight or a Curve between, or make one Transition of them"
            )
        if isinstance(one, Transition) or isinstance(other, Transition):
            return
        for what, unit, a, b in (
            ("curvature", "1/m", _curvature(one), _curvature(other)),
            ("cant", "m", self._cant_between(one), self._cant_between(other)),
        ):
            if abs(b - a) > 1e-12:
                raise WheelsetError(
                    f"the layout's {what} jumps from {a:g} to {b:g} {unit} at {station:g} m: put a "
                    "Transition between"
                )

    @staticmethod
    def _cant_between(element: TrackElement) -> float:
        """Rise [m] of the right rail over the left one."""
        if isinstance(element, Curve):
            return math.copysign(1.0, element.radius) * element.cant
        return 0.0

    def _cant_of(self, k: int) -> float:
        return self._cant_between(self.elements[k])

    @property
    def length(self) -> float:
        """Length [m] of all elements."""
        return math.fsum(element.length for element in self.elements)

    @cached_property
    def is_straight(self) -> bool:
        """Whether the track is straight, level, without cant and widening throughout."""
        curved = any(not isinstance(element, Straight) for element in self.elements)
        return not curved and not any(rise for _, rise in self.gradient)

    @cached_property
    def _functions(self) -> tuple[Pieces, Pieces, Pieces, Pieces]:
        """Curvature, sin(roll), gradient, signed widening over s."""
        breaks: list[list[float]] = [[0.0], [0.0], [0.0]]
        rows: list[list[Array]] = [[], [], []]
        count = len(self.elements)
        station = 0.0
        for k, element in enumerate(self.elements):
            ends = []
            for j in (k - 1, k, k + 1):
                beside = self.elements[j] if 0 <= j < count else None
                turn = _curvature(beside)
                cant = 0.0 if beside is None else self._cant_between(beside)
                wide = math.copysign(getattr(beside, "widening", 0.0), turn)
                ends.append((turn, -cant / self.base, wide))
            shapes = ["clothoid"] * 3
            first = last = ends[1]
            if isinstance(element, Transition):
                first, last = ends[0], ends[2]
                shapes[0] = element.shape
                shapes[1] = "clothoid" if element.shape in STRAIGHT_RAMPS else element.shape
            for which in range(3):
                rise = last[which] - first[which]
                t, f = shape_pieces(shapes[which], element.length, rise)
                scaled = rise * f / element.length ** np.arange(4)
                scaled[:, 0] += first[which]
                rows[which] += list(scaled)
                breaks[which] += list(station + element.length * t[1:])
            station += element.length
        turns, rolls, widths = (
            Pieces(np.array(b), np.array(r)) for b, r in zip(breaks, rows, strict=True)
        )
        grades = polyline(np.array(self.gradient or ((0.0, 0.0),)))
        return turns, rounded(rolls, self.rounding), rounded(grades, self.rounding), widths

    def curvature(self, station: Array | float) -> Array:
        """Curvature [1/m] of the plan at stations, positive to the left."""
        return self._functions[0](station)

    def cant(self, station: Array | float) -> Array:
        """Rise [m] of the right rail over the left one, positive in a left curve."""
        return -self.base * self._functions[1](station)

    def roll(self, station: Array | float) -> Array:
        """Roll [rad] of the track, positive where the left rail is higher."""
        return np.asarray(np.arcsin(self._functions[1](station)))

    def gradient_at(self, station: Array | float) -> Array:
        """Rise a metre [-] at stations."""
        return self._functions[2](station)

    def widening(self, station: Array | float) -> Array:
        """Widening [m] of the gauge, positive where the left rail is moved (a left curve)."""
        return self._functions[3](station)

    @cached_property
    def table(self) -> tuple[Array, Array]:
        """Breaks (n + 1,) [m] and coefficients (n, 4, 4) of the four functions, for the kernels."""
        return on_common_breaks(list(self._functions), LONGEST_PIECE)

    def at(self, station: float) -> tuple[float, float, float, float]:
        """Curvature, sin(roll), gradient and signed widening at a station, as a layout for ever."""
        curvature, roll, grade, wide = (float(one(station)) for one in self._functions)
        return curvature, roll, grade, wide

    def mirrored(self) -> Layout:
        """The layout with left and right exchanged."""
        elements = [
            replace(element, radius=-element.radius) if isinstance(element, Curve) else element
            for element in self.elements
        ]
        return Layout(elements, self.gradient, self.base, self.rounding)

    def save(self, path: str | Path) -> Path:
        """Write the layout as TOML, whole or not at all; `Layout.load` reads it back."""
        from exudyn_wheelset.track.files import write_layout

        return write_layout(self, path)

    @classmethod
    def load(cls, path: str | Path) -> Layout:
        """Read a TOML file; raises WheelsetError with the file, the entry and the mend."""
        from exudyn_wheelset.track.files import read_layout

        return read_layout(path)


def _curvature(element: TrackElement | None) -> float:
    return element.curvature if isinstance(element, Curve) else 0.0
