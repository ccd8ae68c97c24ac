"""The frame that a vehicle lives in: where it is on its track, and its array for the kernels."""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.contact.changing_rails import rails_change
from exudyn_wheelset.contact.descriptions import Track
from exudyn_wheelset.coupling import track_kernel as kernel
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.track.irregularity import Irregularity
from exudyn_wheelset.track.layout import Layout

# Station [m] before every other.
_FAR_BEHIND = -1.0e12


@spelt_class
class TrackFrame:
    """A frame that travels along a track, for all wheelsets and bodies of one vehicle.

    layout, irregularity: of the track, or None; changing: whether its rails' profiles change. At
    time zero it stands at the station `start` [m] and has the speed [m/s]. Until it is live the
    track is everywhere as at `start`, without irregularity. array: for the kernels,
    track_kernel.py.

    Examples
    --------
    >>> from exudyn_wheelset import Curve, Layout, Straight, TrackFrame, Transition
    >>> layout = Layout([Straight(50), Transition(40), Curve(300, 100)])
    >>> TrackFrame().is_plain, TrackFrame(layout).is_plain
    (True, False)
    """

    def __init__(
        self,
        layout: Layout | None = None,
        irregularity: Irregularity | None = None,
        changing: bool = False,
    ) -> None:
        self.layout, self.irregularity, self.changing = layout, irregularity, changing
        parts: list[Array] = [np.zeros(kernel.HEADER)]
        count = 0
        if layout is not None:
            breaks, cubics = layout.table
            count = len(cubics)
            rows = np.zeros((count, kernel.PIECE))
            rows[:, kernel.FIRST] = breaks[:-1]
            rows[:, kernel.CIRCLE] = ~np.any(cubics[:, :, 1:] != 0.0, axis=(1, 2))
            rows[:, kernel.CUBICS :] = cubics.reshape(count, 16)
            # Beyond its end a layout stays what it is there.
            last = np.zeros((1, kernel.PIECE))
            last[0, kernel.FIRST], last[0, kernel.CIRCLE] = breaks[-1], 1.0
            last[0, kernel.CUBICS :: 4] = layout.at(breaks[-1])
            before = last.copy()
            before[0, kernel.FIRST] = _FAR_BEHIND
            before[0, kernel.CUBICS :: 4] = layout.at(breaks[0])
            parts += [before.ravel(), rows.ravel(), last.ravel()]
            count += 2
        else:
            row = np.zeros(kernel.PIECE)
            row[kernel.FIRST], row[kernel.CIRCLE] = _FAR_BEHIND, 1.0
            parts.append(row)
            count = 1
        knots_at = sum(len(part) for part in parts)
        if irregularity is not None:
            distance, coefficients = irregularity.table
            parts += [distance, coefficients.ravel()]
        self.array = np.concatenate(parts)
        self.array[kernel.PIECES] = count
        self.array[kernel.KNOTS] = 0 if irregularity is None else len(irregularity.distance)
        self.array[kernel.KNOTS_AT] = knots_at
        self.array[kernel.CURVED] = float(layout is not None and not layout.is_straight)
        self.begin(0.0)

    @classmethod
    def of(cls, track: Track) -> TrackFrame:
        """The frame of a track."""
        return cls(track.layout, track.irregularity, rails_change(track))

    @property
    def is_plain(self) -> bool:
        """Whether all stations of the track are alike, straight and level."""
        return not self.is_curved and self.irregularity is None and not self.changing

    @property
    def is_curved(self) -> bool:
        """Whether the frame turns anywhere."""
        return bool(self.array[kernel.CURVED])

    @property
    def start(self) -> float:
        """Station [m] at time zero."""
        return float(self.array[kernel.START])

    @property
    def speed(self) -> float:
        """Speed [m/s] along the track."""
        return float(self.array[kernel.SPEED])

    def set_speed(self, speed: float) -> None:
        """Set the speed [m/s] along the track."""
        self.array[kernel.SPEED] = speed

    def begin(self, start: float) -> None:
        """Stand at a station [m] at time zero, on a track that is everywhere as there."""
        self.array[kernel.START] = start
        self.array[kernel.LIVE] = 0.0
        at = (0.0, 0.0, 0.0, 0.0) if self.layout is None else self.layout.at(start)
        self.freeze(*at)

    def freeze(self, curvature: float, roll: float, gradient: float, widening: float) -> None:
        """Let the track be one for ever: curvature [1/m], sin(roll), gradient, signed widening."""
        self.array[kernel.FROZEN] = curvature, roll, gradient, widening

    @property
    def frozen(self) -> Array:
        """What `freeze` has set (4)."""
        return self.array[kernel.FROZEN].copy()

    def set_live(self, live: bool) -> None:
        """Let stations count from now on, or no more."""
        self.array[kernel.LIVE] = float(live)
