"""Vehicles on a track that is not straight: steady running in a curve, and what a run needs.

In a circular curve at constant speed everything that a vehicle feels in the frame that travels with
it is constant (coupling/moving_frame.py), so the steady curve is an equilibrium. Newton's method
finds it from straight track by continuation: curvature, cant, gradient and widening grow together,
each step begins from the line through the last two states, measured from the track at every body,
and a step that fails is halved. Where Newton's method ends (a wheel that goes over from tread to
flange), the vehicle runs in the curve until it is steady, and Newton's method goes on from there.

Where normal or creep forces jump (two patches of a wheel that become one), there may be no state in
which all balance: the vehicle then runs steadily but for a chatter of hundredths of a millimetre
across the jump. Its mean is given, with how far it chatters (`VehicleSystem.unsteadiness`).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import Rotation

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.coupling.derailment import DerailmentWatch
from exudyn_wheelset.coupling.registration import WheelsetItems
from exudyn_wheelset.coupling.track_frame import TrackFrame
from exudyn_wheelset.coupling.track_kernel import frame_beside, relative_pose
from exudyn_wheelset.errors import AnalysisError
from exudyn_wheelset.results.endings import Ending, Outcome
from exudyn_wheelset.systems.fitting import check_gauge
from exudyn_wheelset.systems.system import newton_equilibrium

if TYPE_CHECKING:
    from exudyn_wheelset.systems.exudyn_system import ExudynSystem
    from exudyn_wheelset.systems.vehicle_system import VehicleSystem

# Shares of the curve: of the first step and of the least one.
_FIRST_SHARE, _LEAST_SHARE = 0.2, 1.0e-3
# Newton's steps of a share of the curve: more of them mean that it was too large a share.
_NEWTON_STEPS = 25
# Where Newton's method ends: shares of the curve to leap by, and seconds to settle.
_LEAPS, _SETTLING_RUNS = (0.02, 0.05, 0.1, 0.2, 0.4), 15
# A motion that stays within this [m, rad] for a second is steady but for a jump of forces.
_STEADY, _SURELY_STEADY = 2.0e-4, 1.0e-5
# Seconds in a curve after which a vehicle that was driven in is steady.
DRIVE = 12.0
# Way [m] for the rate at which the track changes beside a frame.
_DIFFERENCE = 1.0e-3


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


def moved_with_track(
    system: Any, frame: TrackFrame, state: Array, before: Array, after: Array | None
) -> Array:
    """The state (n,) whose bodies stand to the track `after` as they stood to `before`.

    Both are what `TrackFrame.freeze` takes; None: the track as it really lies from the frame's
    start on, with the velocities at which it changes beside the frame. The frame is left so.
    """
    coordinates, velocities, first_order = system.layout.expand(state)
    centres = system.centres
    frame.freeze(*before)
    places = [_track_beside(frame, centre[0]) for centre in centres]
    if after is None:
        frame.set_live(True)
    else:
        frame.freeze(*after)
    for k, (centre, (old, old_origin, _, _)) in enumerate(zip(centres, places, strict=True)):
        new, new_origin, moving, spinning = _track_beside(frame, centre[0])
        turn = new @ old.T
        first = int(system.layout.rotations[k, 0]) - 3
        at, way = slice(first, first + 3), slice(first + 3, first + 6)
        offset = turn @ (centre + coordinates[at] - old_origin)
        coordinates[at] = new_origin + offset - centre
        velocities[at] = turn @ velocities[at] + moving + np.cross(spinning, offset)
        rotation = Rotation.from_matrix(turn) * Rotation.from_rotvec(coordinates[way])
        coordinates[way] = rotation.as_rotvec()
        velocities[way] += rotation.inv().apply(spinning)
    forget(system.wheelsets)
    return np.asarray(
        system.layout.reduce(coordinates[None], velocities[None], first_order[None])[0]
    )


def _track_beside(frame: TrackFrame, x: float) -> tuple[Array, Array, Array, Array]:
    """Axes (3, 3), origin, velocity and angular velocity of the track's frame x [m] ahead."""
    poses = []
    pose = np.zeros(12)
    station = frame_beside(frame.array, frame.start, x, 0.0, 0.0, pose)
    for ahead in (0.0, _DIFFERENCE, -_DIFFERENCE):
        relative_pose(frame.array, frame.start + ahead, station + ahead, pose)
        poses.append((pose[:9].reshape(3, 3).copy(), pose[9:].copy()))
    (axes, origin), (later, there), (earlier, here) = poses
    per_second = 0.5 * frame.speed / _DIFFERENCE
    turning = per_second * (later - earlier) @ axes.T
    spin = np.array([turning[2, 1], turning[0, 2], turning[1, 0]])
    return axes, origin, per_second * (there - here), spin


def curve_equilibrium(system: VehicleSystem, frame: TrackFrame, speed: float) -> Array:
    """Steady state (n,) at a speed [m/s] on the track as the frame holds it, not live.

    Sets `system.unsteadiness` to how far a motion chatters about it [m, rad], 0 for an equilibrium.
    Raises AnalysisError with how much of the curve was reached.
    """
    target = frame.frozen
    straight = 0.0 * target
    system.unsteadiness = 0.0
    try:
        frame.freeze(*straight)
        forget(system.wheelsets)
        # Measured from the track, as if it were straight.
        states = [newton_equilibrium(system, speed, system.initial_state(speed))]
        shares = [0.0]
        step = _FIRST_SHARE
        while shares[-1] < 1.0 and np.any(target):
            share = min(1.0, shares[-1] + step)
            guess = states[-1].copy()
            if len(states) > 1:
                ahead = (share - shares[-1]) / (shares[-1] - shares[-2])
                guess += ahead * (states[-1] - states[-2])
            here = share * target
            guess = moved_with_track(system, frame, guess, straight, here)
            try:
                state = newton_equilibrium(system, speed, guess, steps=_NEWTON_STEPS)
                system.unsteadiness = 0.0
            except AnalysisError as error:
                if step > _LEAST_SHARE:
                    step *= 0.5
                    continue
                beyond = _beyond(system, frame, speed, states[-1], shares[-1], target)
                if beyond is None:
                    radius = 1.0 / (shares[-1] * target[0]) if target[0] else np.inf
                    raise AnalysisError(
                        f"{system.name}: no steady running at {speed:g} m/s beyond "
                        f"{shares[-1]:.3f} of the curve (radius {radius:.4g} m): {error}"
                    ) from error
                share, state, system.unsteadiness = beyond
                here = share * target
                states, shares = states[:0], shares[:0]
            off = _off_the_rails(system, state, speed)
            if off is not None:
                raise AnalysisError(
                    f"{system.name}: no steady running at {speed:g} m/s beyond {shares[-1]:.3f} of "
                    f"the curve: {off}; give a wider curve or widen the gauge"
                    if shares
                    else f"{system.name}: no steady running at {speed:g} m/s: {off}"
                )
            states.append(moved_with_track(system, frame, state, here, straight))
            before = shares[-1] if shares else share
            shares.append(share)
            step = min(1.6 * (share - before), 0.5) or _LEAPS[0]
        return moved_with_track(system, frame, states[-1], straight, target)
    finally:
        frame.freeze(*target)
        forget(system.wheelsets)


def _beyond(
    system: VehicleSystem, frame: TrackFrame, speed: float, state: Array, share: float,
    target: Array,
) -> tuple[float, Array, float] | None:  # fmt: skip
    """Share of the curve, steady state there and its chatter, where Newton's method ends.

    state: measured from the track at `share`. By leaps, and by letting the vehicle run until
    Newton's method goes on or the motion is steady but for a chatter.
    """
    straight = 0.0 * target
    for leap in _LEAPS:
        there = min(1.0, share + leap)
        guess = moved_with_track(system, frame, state, straight, there * target)
        try:
            return there, newton_equilibrium(system, speed, guess, steps=_NEWTON_STEPS), 0.0
        except AnalysisError:
            continue
    # A longer way at once throws the vehicle off its rails.
    there = min(1.0, share + _LEAPS[0])
    guess = moved_with_track(system, frame, state, straight, there * target)
    settled, chatter = _settled(system, guess, speed)
    return (there, settled, chatter) if settled is not None and chatter < _STEADY else None


def _off_the_rails(system: VehicleSystem, state: Array, speed: float) -> Outcome | None:
    """How a wheelset stands beside its rails in a state, or None."""
    system.derivative(state, speed)
    return DerailmentWatch(system.contacts).look(0.0)


def _settled(system: VehicleSystem, state: Array, speed: float) -> tuple[Array | None, float]:
    """Steady state that a motion from a state comes to, or its mean over a second, and its chatter.

    The chatter [m, rad] is the greatest that a pose changes within the second, 0 for an
    equilibrium; None where the motion ends.
    """
    if system.compiled is None:
        return None, np.inf
    samples, chatter = np.zeros((1, len(state))), np.inf
    for _ in range(_SETTLING_RUNS):
        samples, outcome = system.carry_on(state, speed, np.linspace(0.0, 1.0, 201))
        if outcome.ending is not Ending.FINISHED:
            return None, np.inf
        state = samples[-1]
        try:
            return newton_equilibrium(system, speed, state, steps=_NEWTON_STEPS), 0.0
        except AnalysisError:
            chatter = chatter_of(system, samples)
            if chatter < _SURELY_STEADY:
                break
    return samples.mean(axis=0), chatter


def chatter_of(system: VehicleSystem, samples: Array) -> float:
    """The greatest that a pose [m, rad] changes over samples (m, n) of a motion."""
    poses = [
        k for k, name in enumerate(system.state_names)
        if name.endswith((": y [m]", ": z [m]", ": yaw [rad]", ": roll [rad]"))
    ]  # fmt: skip
    return float(np.ptp(samples[:, poses], axis=0).max())


def driven_in(
    system: VehicleSystem, arriving: VehicleSystem, speed: float, way: float, drive: float = DRIVE
) -> tuple[Array, float]:
    """Steady state (n,) of a system in a curve, and its chatter, by driving into the curve.

    arriving: the same vehicle on a track that leads over a transition into that curve, which it has
    reached after the way [m]; drive [s]: how long it runs in it. Raises AnalysisError with how the
    drive ended.
    """
    duration = way / speed + drive
    samples = max(2, round(200 * duration))
    state = arriving.equilibrium(speed)
    stand_at(arriving.wheelsets, 0.0, True)
    states, outcome = arriving.carry_on(state, speed, np.linspace(0.0, duration, samples + 1))
    if outcome.ending is not Ending.FINISHED:
        raise AnalysisError(f"driven into it over a transition: {outcome}")
    last = states[-200:]
    try:
        return newton_equilibrium(system, speed, states[-1], steps=_NEWTON_STEPS), 0.0
    except AnalysisError as error:
        chatter = chatter_of(system, last)
        if chatter > _STEADY:
            raise AnalysisError(
                f"driven into it over a transition it moves by {1e3 * chatter:.3g} mm or mrad for "
                f"ever: {error}"
            ) from error
        return last.mean(axis=0), chatter


def follow_rails(system: ExudynSystem, state: Array, speed: float, start: float) -> Array:
    """The state (n,) with every body moved along with the track where it is crooked.

    A wheelset stands as much off and moves as fast as the rails under it: on contact without
    damping, one that is dropped onto them would hop on for seconds. start: station [m].
    """
    frame = getattr(getattr(system, "vehicle_items", None), "frame", None)
    if frame is not None and frame.is_curved:
        state = moved_with_track(system, frame, state, frame.frozen, None)
    state = state.copy()
    for items, places in zip(system.wheelsets, system.pose_indices, strict=True):
        irregularity = items.contact.track_frame.irregularity
        if irregularity is None or min(places) < 0:
            continue
        shifts, slopes = irregularity.shape(start + items.reference[0])
        first = int(system.mbs.systemData.GetNodeLTGODE2(items.node)[0])
        width = 2.0 * items.contact.wheelset.tape_half_distance
        for values, where in (
            (shifts, places),
            (speed * slopes, [system.layout.positions + first + k for k in (1, 2, 3)]),
        ):
            left_y, left_z, right_y, right_z = values
            state[where[0]] += 0.5 * (left_y + right_y)
            state[where[1]] += 0.5 * (left_z + right_z)
            state[where[2]] += (left_z - right_z) / width
    return state


def check_run(
    wheelsets: Iterable[WheelsetItems], speed: float, start: float, duration: float, step: float
) -> None:
    """Raise AnalysisError where an irregularity does not go with a run.

    start [m], duration [s]; step [s] of the solver. It must reach as far as the first wheelset
    gets, a step must not go past a whole interval of its points, and the flanges must fit in.
    """
    wheelsets = list(wheelsets)
    ends = sorted((start, start + speed * duration))
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
        if speed < 0.0 and ends[0] + items.reference[0] < irregularity.distance[0] - 1e-6:
            raise AnalysisError(
                f"the irregularity {irregularity.name!r} begins at {irregularity.distance[0]:g} m, "
                f"{items.name} runs back to {ends[0] + items.reference[0]:g} m: begin it earlier, "
                "or start farther on"
            )
        if abs(speed) * step > irregularity.spacing * (1.0 + 1e-9):
            raise AnalysisError(
                f"at {speed:g} m/s a step of {step:g} s goes {abs(speed) * step:.4g} m, past whole "
                f"intervals of the irregularity {irregularity.name!r}, whose points lie "
                f"{irregularity.spacing:.4g} m apart: give step="
                f"{irregularity.spacing / abs(speed):.3g}, a lower speed, or points farther apart"
            )
    check_gauge(wheelsets, *ends)
