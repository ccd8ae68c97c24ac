"""Whether wheelsets fit between their rails: curves and gauges too narrow for the flanges.

Axles that their truck holds parallel stand askew in a curve, and those between the ends of a truck
of three or more stand off the line that the outer ones can follow, by
(x_first - x)(x - x_last)/(2 R), half of which the others take over. Against that stands the play of
the flanges: the shift at which a wheel of the rigid wheelset, as askew as it is, comes onto its
flange (geometry/rigid.py), steeper than FLANGE_ANGLE, from the profiles themselves. Two axles can
follow every curve as long as an axle askew finds room at all: turned by psi its wheels come closer
together by 1 - cos(psi) as their flanges reach farther ahead. Soft axle guidance lets axles give
way, so such a curve is warned of; what is refused is what no guidance can mend: rails that are
closer together than the flanges, a vehicle that stands across its track.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from exudyn_wheelset.checking import warn
from exudyn_wheelset.contact.descriptions import Track, Wheelset
from exudyn_wheelset.coupling.registration import WheelsetItems
from exudyn_wheelset.coupling.wheel_forces import FLANGE_ANGLE
from exudyn_wheelset.errors import AnalysisError, ContactError
from exudyn_wheelset.geometry.rigid import contact_geometry
from exudyn_wheelset.systems.trucks import trucks_by_distance
from exudyn_wheelset.track.layout import Curve

# Shifts [m] that are tried: flanges of all gauges have a play of some millimetres.
_SHIFTS = np.linspace(0.0, 0.03, 121)
# A wheelset farther ahead than this part of the radius stands across the track.
_ACROSS = 0.35


@lru_cache(maxsize=64)
def play(wheelset: Wheelset, track: Track, yaw: float = 0.0) -> float:
    """Shift [m] from the middle at which a wheel of a wheelset at `yaw` [rad] is on its flange.

    0 where it is so in the middle, infinite for wheels without flanges.
    """
    reached = 0.0
    # Beyond the flanges there is no contact at all: from the middle outwards, a part at a time.
    for part in np.array_split(_SHIFTS, 10):
        try:
            geometry = contact_geometry(wheelset, track, part, yaw=yaw)
        except ContactError:
            return reached
        steep = np.maximum(np.abs(geometry.left.angle), np.abs(geometry.right.angle))
        if np.any(steep > FLANGE_ANGLE):
            return float(part[np.argmax(steep > FLANGE_ANGLE)])
        reached = float(part[-1])
    return math.inf


def radial_steering_index(wheelset: Wheelset, track: Track, radius: float) -> float:
    """Rolling radius difference that a curve asks for over what there is before the flange.

    q_E = (e r_0/|R|)/dr(y), e the distance of the tape circles, y the play (EN 14363:2016): up to 1
    a wheelset can roll through a curve of the radius R [m] without slip. Infinite without conicity.
    """
    shift = min(play(wheelset, track), 0.02)
    geometry = contact_geometry(wheelset, track, [max(shift - _SHIFTS[1], 0.0)])
    there_is = float(geometry.rolling_radius_difference[0])
    needed = 2.0 * wheelset.tape_half_distance * wheelset.radius / abs(radius)
    return needed / there_is if there_is > 0.0 else math.inf


def check_curves(name: str, wheelsets: Sequence[WheelsetItems]) -> None:
    """Warn of curves in which parallel axles of a truck do not fit between their rails.

    name: of the vehicle. Raises AnalysisError for a curve that the vehicle would stand across.
    """
    layouts = {id(one): one for items in wheelsets if (one := items.contact.track_frame.layout)}
    places = {items.name: items.reference[0] for items in wheelsets}
    if not layouts or len(places) < 2:
        return
    trucks = trucks_by_distance(places) or {name: tuple(places)}
    farthest = max(abs(x) for x in places.values())
    items_of = {items.name: items for items in wheelsets}
    for layout in layouts.values():
        curves = [element for element in layout.elements if isinstance(element, Curve)]
        for curve in sorted(curves, key=lambda one: abs(one.radius)):
            radius = abs(curve.radius)
            if farthest > _ACROSS * radius:
                raise AnalysisError(
                    f"{name}: its wheelsets stand up to {farthest:g} m from its origin, too "
                    f"far for a curve of R = {radius:g} m: give at least {farthest / _ACROSS:.3g} m"
                )
            for axles in trucks.values():
                x = np.array([places[axle] for axle in axles])
                if len(axles) < 2:
                    continue
                askew = round(0.5 * float(np.ptp(x)) / radius, 4)
                aside = 0.25 * float(np.max((x.max() - x) * (x - x.min()))) / radius
                contact = items_of[axles[0]].contact
                track = _widened(contact.track, curve.widening)
                shift = play(contact.wheelset, track, askew)
                if aside <= shift and shift > 0.0:
                    continue
                plain = play(contact.wheelset, track)
                least = radius * aside / shift if shift > 0.0 else radius * aside / plain
                mend = f"give R = {least:.3g} m or more, or" if least > radius else "give"
                warn(
                    f"{name}: in a curve of R = {radius:g} m parallel axles {axles[0]!r} to "
                    f"{axles[-1]!r} stand {1e3 * askew:.3g} mrad askew and {1e3 * aside:.3g} mm "
                    f"off, and their flanges leave {1e3 * shift:.3g} mm: too narrow unless the "
                    f"axles give way; {mend} a wider gauge (widening of the Curve)"
                )
                return


def _widened(track: Track, widening: float) -> Track:
    if not widening:
        return track
    for place in ("datum_half_distance", "origin_half_distance"):
        half = getattr(track, place)
        if half is not None:
            return replace(track, **{place: half + 0.5 * widening})
    return replace(track, gauge=track.gauge + widening)


def check_gauge(wheelsets: Sequence[WheelsetItems], low: float, high: float) -> None:
    """Raise AnalysisError where an irregularity between two stations [m] pinches the flanges."""
    for items in wheelsets:
        contact = items.contact
        irregularity = contact.track_frame.irregularity
        if irregularity is None:
            continue
        at = irregularity.distance
        inside = (at >= low + items.reference[0]) & (at <= high + items.reference[0])
        narrower = irregularity.shifts[:, 2] - irregularity.shifts[:, 0]
        if not inside.any() or narrower[inside].max() < 2e-3:
            continue
        row = int(np.argmax(np.where(inside, narrower, -np.inf)))
        shift = play(contact.wheelset, contact.track)
        if narrower[row] > 2.0 * shift:
            raise AnalysisError(
                f"the irregularity {irregularity.name!r} narrows the gauge by "
                f"{1e3 * narrower[row]:.3g} mm at {at[row]:g} m, the flanges of {items.name} leave "
                f"{2e3 * shift:.3g} mm: give a wider gauge, or metres where it holds millimetres"
            )
