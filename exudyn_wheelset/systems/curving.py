"""Vehicles on a track that is not straight: steady running in a curve, and what a run needs.

In a circular curve at constant speed everything that a vehicle feels in the frame that travels with
it is constant (coupling/moving_frame.py), so the steady curve is an equilibrium. Newton's method
finds it from straight track by continuation: curvature, cant, gradient and widening grow together,
each step begins from the line through the last two states, and a step that fails is halved.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.coupling.registration import WheelsetItems
from exudyn_wheelset.coupling.track_frame import TrackFrame
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.systems.system import newton_equilibrium

if TYPE_CHECKING:
    from exudyn_wheelset.systems.exudyn_system import ExudynSystem

# Shares of the curve: of the first step and of the least one.
_FIRST_SHARE, _LEAST_SHARE = 0.2, 1.0e-3
# Newton's steps of a share of the curve: more of them mean that it was too large a share.
_NEWTON_STEPS = 25


def frames_of(wheelsets: Iterable[WheelsetItems]) -> list[TrackFrame]:
    """The frames that wheelsets stand in, each once."""
    frames = [items.contact.track_frame for items in wheelsets]
    return list({id(frame): frame for frame in frames}.values())


def forget(wheelsets: Iterable[WheelsetItems]) -> None:
    """Drop what the contacts have kept, after a frame has changed."""
    for items in wheelsets:
        items.contact.forget()


def stand_at(wheelsets: Iterable[WheelsetItems], start: float, live: bool) -> None:
    """Let the frames stand at a station [m] at time zero; not live, the track is for ever so."""
    wheelsets = list(wheelsets)
    for frame in frames_of(wheelsets):
        frame.begin(start)
        frame.set_live(live and not frame.is_plain)
    forget(wheelsets)


def curve_equilibrium(system: ExudynSystem, frame: TrackFrame, speed: float) -> Array:
    """Steady state (n,) at a speed [m/s] on the track as the frame holds it, not live.

    Raises AnalysisError with how much of the curve was reached.
    """
    target = frame.frozen

    def lie(share: float) -> None:
        frame.freeze(*(share * target))
        forget(system.wheelsets)

    try:
        lie(0.0)
        states = [newton_equilibrium(system, speed, system.initial_state(speed))]
        shares = [0.0]
        step = _FIRST_SHARE
        reason = ""
        while shares[-1] < 1.0 and np.any(target):
            share = min(1.0, shares[-1] + step)
            guess = states[-1].copy()
            if len(states) > 1:
                ahead = (share - shares[-1]) / (shares[-1] - shares[-2])
                guess += ahead * (states[-1] - states[-2])
            lie(share)
            try:
                state = newton_equilibrium(system, speed, guess, steps=_NEWTON_STEPS)
            except AnalysisError as error:
                reason = str(error)
                step *= 0.5
                if step < _LEAST_SHARE:
                    radius = 1.0 / (shares[-1] * target[0]) if target[0] else np.inf
                    raise AnalysisError(
                        f"{system.name}: no steady running at {speed:g} m/s beyond "
                        f"{shares[-1]:.3f} of the curve (radius {radius:.4g} m): {reason}"
                    ) from error
                continue
            states.append(state)
            shares.append(share)
            step = min(1.6 * (share - shares[-2]), 0.5)
        return states[-1]
    finally:
        lie(1.0)


def check_run(
    wheelsets: Iterable[WheelsetItems], speed: float, start: float, duration: float, step: float
) -> None:
    """Raise AnalysisError where an irregularity does not go with a run.

    start [m], duration [s]; step [s] of the solver. It must reach as far as the first wheelset
    gets, and a step must not go past a whole interval of its points.
    """
    for items in wheelsets:
        irregularity = items.contact.track_frame.irregularity
        if irregularity is None:
            continue
        way = speed * duration
        reached = start + items.reference[0] + max(way, 0.0)
        if reached > irregularity.end + 1e-6:
            raise AnalysisError(
                f"the irregularity {irregularity.name!r} ends at {irregularity.end:g} m, "
                f"{items.name} runs to {reached:g} m: make it longer, or the run shorter than "
                f"{(irregularity.end - start - items.reference[0]) / abs(speed):.4g} s"
            )
        if abs(speed) * step > irregularity.spacing * (1.0 + 1e-9):
            raise AnalysisError(
                f"at {speed:g} m/s a step of {step:g} s goes {abs(speed) * step:.4g} m, past whole "
                f"intervals of the irregularity {irregularity.name!r}, whose points lie "
                f"{irregularity.spacing:.4g} m apart: give step="
                f"{irregularity.spacing / abs(speed):.3g}, a lower speed, or points farther apart"
            )
