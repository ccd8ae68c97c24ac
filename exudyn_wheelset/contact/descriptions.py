"""What a wheelset, a track and their contact are: frozen descriptions, validated on creation.

Frames (docs/conventions.md): track frame x forward, y left, z up, origin on the track centre line
in the plane of the rail tops. A profile is stored for one side, y > 0 towards the field side, and
mirrored for the right one.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import brentq

from exudyn_wheelset.checking import moments_of_inertia, number, positive, unknown
from exudyn_wheelset.contact.friction import FLANGE, TOP, TREAD, frictions
from exudyn_wheelset.contact.normal_models import NORMAL_MODELS
from exudyn_wheelset.contact.rail_section import ProfileSource, RailSection, profile_of_kind
from exudyn_wheelset.creep import creep_law, creep_parameters
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.profiles import Profile
from exudyn_wheelset.spelling import spelt_class
from exudyn_wheelset.track.irregularity import Irregularity
from exudyn_wheelset.track.layout import Layout

# The creep law whose friction falls with slip by itself; in a contact the contact sees to that.
_FALLING = "polach-2005"


@spelt_class
@dataclass(frozen=True)
class Wheelset:
    """A rigid axle with two profiled wheels.

    mass [kg]; inertia (Ix, Iy, Iz) [kg m^2] about the centre, y the axle; radius [m] of the left
    wheel at the tape circle; wheel: profile, name or path; tape_half_distance [m] from the axle's
    centre to a tape circle. right_wheel and right_radius default to the left ones.
    Raises WheelsetError for values that no wheelset has.

    Examples
    --------
    >>> from exudyn_wheelset import Wheelset
    >>> axle = Wheelset(mass=1500, inertia=(800, 110, 800), radius=0.46, wheel="S1002")
    >>> axle.wheel.name, axle.tape_half_distance
    ('S1002', 0.75)
    """

    mass: float
    inertia: tuple[float, float, float]
    radius: float
    wheel: Profile
    tape_half_distance: float = 0.75
    right_wheel: Profile | None = None
    right_radius: float | None = None

    def __init__(
        self,
        mass: float,
        inertia: tuple[float, float, float],
        radius: float,
        wheel: ProfileSource,
        tape_half_distance: float = 0.75,
        right_wheel: ProfileSource | None = None,
        right_radius: float | None = None,
    ) -> None:
        put = object.__setattr__
        put(self, "mass", positive("mass", mass, "kg", 1e5))
        put(self, "inertia", moments_of_inertia("inertia", inertia, self.mass))
        put(self, "radius", positive("radius", radius, "m", 2.0))
        put(self, "wheel", profile_of_kind(wheel, "wheel"))
        half_distance = positive("tape_half_distance", tape_half_distance, "m", 2.0)
        put(self, "tape_half_distance", half_distance)
        right = None if right_wheel is None else profile_of_kind(right_wheel, "wheel")
        put(self, "right_wheel", right)
        if right_radius is not None:
            right_radius = positive("right_radius", right_radius, "m", 2.0)
        put(self, "right_radius", right_radius)


@spelt_class
@dataclass(frozen=True)
class Contact:
    """How wheels and rails press and rub on each other.

    normal: "hertz" (curvature averaged over the patch), "energy" (the gradient of one stored
    energy, at 1.4 to 1.9 times the cost), "hertz-local" (curvature at the deepest point),
    "virtual-penetration", "ritz" (a gradient, nearer to the half-space, at two to six times the
    cost) or "strips" (patches that are no ellipse, near-conformal contact, at some thirty times);
    creep: name of a creep law, or a compiled function of one's own
    (`register_creep_law`); friction [-] of both rails everywhere; shear_modulus [Pa]; poisson [-];
    damping [s/m] of the normal contact, whose force it makes 1 + damping times the closing speed as
    large (0: elastic; 0.3 s/m is that of steel, docs/decisions/contact-damping.md, and damps the
    bounce of a wheelset on its contact by some 1 % of critical).
    law_parameters: those of the creep law, by name, here as pairs sorted by name; they may be given
    as keywords of their own as well.
    Friction by rail and zone, each None where it is not of its own: flange_friction (flange on
    gauge face), top_friction (top of rail), right_friction, right_flange_friction,
    right_top_friction; what else is the right rail's is the left one's. friction_ratio A and
    friction_decay B [s/m] let all of them fall with the slip velocity w [m/s] of a patch, mu_0
    ((1 - A) exp(-B w) + A), for every creep law; None: those of "polach-2005" for that law, 1 and
    0 for the others (contact/friction.py).
    These are the only defaults of a contact in the package. Raises WheelsetError for unknown
    names, with the nearest known one, and for impossible values.

    Examples
    --------
    >>> from exudyn_wheelset import Contact
    >>> contact = Contact(creep="fastsim", friction=0.4, grid=20)
    >>> contact.normal, contact.law_parameters
    ('hertz', (('cells_across', 20.0), ('cells_along', 20.0)))
    """

    normal: str = "hertz"
    creep: Any = "exact-table"
    friction: float = 0.3
    shear_modulus: float = 82.0e9
    poisson: float = 0.28
    damping: float = 0.3
    law_parameters: tuple[tuple[str, float], ...] = ()
    right_friction: float | None = None
    flange_friction: float | None = None
    right_flange_friction: float | None = None
    top_friction: float | None = None
    right_top_friction: float | None = None
    friction_ratio: float | None = None
    friction_decay: float | None = None

    def __init__(
        self,
        normal: str = normal,
        creep: Any = creep,
        friction: float = friction,
        shear_modulus: float = shear_modulus,
        poisson: float = poisson,
        damping: float = damping,
        law_parameters: Mapping[str, float] | Iterable[tuple[str, float]] = (),
        right_friction: float | None = None,
        flange_friction: float | None = None,
        right_flange_friction: float | None = None,
        top_friction: float | None = None,
        right_top_friction: float | None = None,
        friction_ratio: float | None = None,
        friction_decay: float | None = None,
        **more_law_parameters: float,
    ) -> None:
        if normal not in NORMAL_MODELS:
            raise unknown("normal contact", normal, list(NORMAL_MODELS))
        own = {**dict(law_parameters), **more_law_parameters}
        check_contact_names(creep, own)
        if creep == _FALLING:
            if "speed" in own:
                raise WheelsetError(
                    f"speed = {own['speed']!r} of creep law {creep!r}: leave it out, a contact "
                    "knows the speed of its wheelset"
                )
            friction_ratio = own.pop("friction_ratio", friction_ratio)
            friction_decay = own.pop("friction_decay", friction_decay)
        # Refuses what the law does not take together or in that range.
        creep_parameters(creep, **own)
        own = creep_law(creep).expand(own)
        put = object.__setattr__
        put(self, "normal", normal)
        put(self, "creep", creep)
        put(self, "friction", number("friction", friction, "-", 0.0, 5.0))
        modulus = number("shear_modulus", shear_modulus, "Pa", 1e6, 1e13, "steel has 82e9 Pa")
        put(self, "shear_modulus", modulus)
        put(self, "poisson", number("poisson", poisson, "-", 0.0, 0.5))
        put(self, "damping", number("damping", damping, "s/m", 0.0, 1e3))
        put(self, "law_parameters", tuple(sorted((k, float(v)) for k, v in own.items())))
        for name, value, unit, high in (
            ("right_friction", right_friction, "-", 5.0),
            ("flange_friction", flange_friction, "-", 5.0),
            ("right_flange_friction", right_flange_friction, "-", 5.0),
            ("top_friction", top_friction, "-", 5.0),
            ("right_top_friction", right_top_friction, "-", 5.0),
            ("friction_ratio", friction_ratio, "-", 1.0),
            ("friction_decay", friction_decay, "s/m", 1e6),
        ):
            put(self, name, None if value is None else number(name, value, unit, 0.0, high))
        given = (self.friction_ratio is None, self.friction_decay is None)
        if creep != _FALLING and given[0] != given[1]:
            raise WheelsetError(
                f"friction_ratio = {friction_ratio!r}, friction_decay = {friction_decay!r}: give "
                "both, such as 0.4 and 0.6 s/m of dry rails, or neither"
            )

    @property
    def falling_friction(self) -> tuple[float, float]:
        """A [-] and B [s/m] of the friction that falls with slip."""
        law = creep_law(self.creep)
        own = {one.name: one.default for one in law.parameters if law.name == _FALLING}
        ratio, decay = self.friction_ratio, self.friction_decay
        return (
            own.get("friction_ratio", 1.0) if ratio is None else ratio,
            own.get("friction_decay", 0.0) if decay is None else decay,
        )

    def mirrored(self) -> Contact:
        """The contact with the left and the right rail exchanged."""
        left, right = frictions(self).tolist()
        if left == right:
            return self
        return replace(
            self,
            friction=right[TREAD],
            right_friction=left[TREAD],
            flange_friction=right[FLANGE],
            right_flange_friction=left[FLANGE],
            top_friction=right[TOP],
            right_top_friction=left[TOP],
        )


CONTACT_NUMBERS = ("normal", "creep", "friction", "shear_modulus", "poisson", "damping")
# Not in the signatures of the functions that take a contact by keywords.
FURTHER_NUMBERS = (
    "right_friction", "flange_friction", "right_flange_friction", "top_friction",
    "right_top_friction", "friction_ratio", "friction_decay",
)  # fmt: skip


def check_contact_names(creep: Any, names: Iterable[str], others: Iterable[str] = ()) -> None:
    """Raise WheelsetError for a name that is neither the creep law's nor a contact's own.

    The message offers the nearest of the law's parameters, the contact's numbers and `others`,
    the further keywords of the function that was called.
    """
    law = creep_law(creep)
    of_law = [*(parameter.name for parameter in law.parameters), *law.shorthands]
    for name in names:
        if name not in of_law and name not in FURTHER_NUMBERS:
            known = [*of_law, *CONTACT_NUMBERS, *FURTHER_NUMBERS, *others]
            raise unknown(f"parameter of creep law {law.name!r}, or option", name, known)


@dataclass(frozen=True)
class RailPlacement:
    """A rail's profile curve in the track frame, mirrored to the left side.

    coefficients: (n, 8) of y [m] and z [m] as cubics of the arc length [m] in segments of length
    `spacing`; datum_y [m]: lateral position of the highest point, where z = 0.
    """

    coefficients: np.ndarray
    spacing: float
    datum_y: float


@spelt_class
@dataclass(frozen=True)
class Track:
    """Two profiled rails at a gauge.

    rail: profile, name or path; gauge [m] measured gauge_depth [m] below the highest point;
    inclination [-] turns the rails about the head centre towards the track centre (1/40, 1/20, or
    0 for a profile that is already inclined). right_rail defaults to the left one.
    Instead of the gauge, datum_half_distance [m] may place the rails' highest points directly.
    layout: how the track lies, None for straight and level for ever; irregularity: how far the
    rails lie off that, None for not at all. sections: RailSection by RailSection, from where on the
    rails have other profiles, each over a length `blend` [m] about its start (changing_rails.py).

    Examples
    --------
    >>> from exudyn_wheelset import Track
    >>> track = Track("UIC60", gauge=1.435, inclination=1 / 40)
    >>> round(2 * track.left_placement.datum_y, 3)  # [m] between the rails' tops
    1.521
    """

    rail: Profile
    gauge: float = 1.435
    gauge_depth: float = 0.014
    inclination: float = 1.0 / 40.0
    right_rail: Profile | None = None
    datum_half_distance: float | None = None
    origin_half_distance: float | None = field(default=None)
    layout: Layout | None = None
    irregularity: Irregularity | None = None
    sections: tuple[RailSection, ...] = ()
    blend: float = 5.0

    def __init__(
        self,
        rail: ProfileSource,
        gauge: float = 1.435,
        gauge_depth: float = 0.014,
        inclination: float = 1.0 / 40.0,
        right_rail: ProfileSource | None = None,
        datum_half_distance: float | None = None,
        origin_half_distance: float | None = None,
        layout: Layout | None = None,
        irregularity: Irregularity | None = None,
        sections: Iterable[RailSection] = (),
        blend: float = 5.0,
    ) -> None:
        if not isinstance(layout, Layout | None):
            raise WheelsetError(f"layout = {layout!r}: give a Layout([Straight(...), ...])")
        if not isinstance(irregularity, Irregularity | None):
            raise WheelsetError(
                f"irregularity = {irregularity!r}: give an Irregularity, from_psd, from_points or "
                "from_functions"
            )
        if datum_half_distance is not None and origin_half_distance is not None:
            raise WheelsetError("give datum_half_distance or origin_half_distance, not both")
        put = object.__setattr__
        put(self, "rail", profile_of_kind(rail, "rail"))
        put(self, "gauge", positive("gauge", gauge, "m", 3.0))
        put(self, "gauge_depth", positive("gauge_depth", gauge_depth, "m", 0.05))
        slope = number("inclination", inclination, "-", -0.2, 0.2, "a slope such as 1/40")
        put(self, "inclination", slope)
        right = None if right_rail is None else profile_of_kind(right_rail, "rail")
        put(self, "right_rail", right)
        for what, value in (
            ("datum_half_distance", datum_half_distance),
            ("origin_half_distance", origin_half_distance),
        ):
            put(self, what, None if value is None else positive(what, value, "m", 2.0))
        put(self, "layout", layout)
        put(self, "irregularity", irregularity)
        put(self, "blend", positive("blend", blend, "m", 1e3))
        put(self, "sections", tuple(sections))
        self._check_sections()

    def _check_sections(self) -> None:
        for one in self.sections:
            if not isinstance(one, RailSection):
                raise WheelsetError(f"sections: {one!r}: give RailSection(start, rail)")
        for one, other in pairwise(self.sections):
            if other.start - one.start < self.blend:
                raise WheelsetError(
                    f"sections: {other.start:g} m follows {one.start:g} m, where the rails change "
                    f"over {self.blend:g} m: give starts that rise by that, or a shorter blend"
                )

    @cached_property
    def left_placement(self) -> RailPlacement:
        """Left rail in the track frame."""
        return self._place(self.rail)

    @cached_property
    def right_placement(self) -> RailPlacement:
        """Right rail, mirrored to the left side."""
        return self.left_placement if self.right_rail is None else self._place(self.right_rail)

    def _place(self, rail: Profile) -> RailPlacement:
        table = rail.arc_table()
        angle = np.arctan(self.inclination)
        cosine, sine = np.cos(angle), np.sin(angle)
        along_y, along_z = table.coefficients[:, :4], table.coefficients[:, 4:]
        turned = np.hstack([cosine * along_y - sine * along_z, sine * along_y + cosine * along_z])
        datum, height = _highest_point(turned, table.ds)
        if self.datum_half_distance is not None:
            shift = self.datum_half_distance - datum
        elif self.origin_half_distance is not None:
            shift = self.origin_half_distance
        else:
            level = height - self.gauge_depth
            shift = 0.5 * self.gauge - _gauge_point(turned, table.ds, level, rail)
        turned[:, 0] += shift
        turned[:, 4] -= height
        return RailPlacement(turned, table.ds, datum + shift)


def _highest_point(coefficients: np.ndarray, spacing: float) -> tuple[float, float]:
    """Lateral position and height of the curve's highest point."""
    best = (float(coefficients[0, 0]), float(coefficients[0, 4]))
    top = int(np.argmax(coefficients[:, 4]))
    for segment in coefficients[max(top - 1, 0) : top + 1]:
        slope, bend, twist = segment[5], 2.0 * segment[6], 3.0 * segment[7]
        places = [0.0, spacing]
        places += [float(root.real) for root in np.roots([twist, bend, slope]) if root.imag == 0.0]
        for place in places:
            height = float(np.polynomial.polynomial.polyval(place, segment[4:]))
            if 0.0 <= place <= spacing and height > best[1]:
                best = (float(np.polynomial.polynomial.polyval(place, segment[:4])), height)
    return best


def _gauge_point(coefficients: np.ndarray, spacing: float, level: float, rail: Profile) -> float:
    """Lateral position of the gauge-side point at height `level`, nearest to the top.

    The gauge is the least distance between the rails from their tops down to that height (EN
    13848-1): on a face that undercuts above it, the last point before it does.
    """
    top = int(np.argmax(coefficients[:, 4]))
    below = np.flatnonzero(coefficients[:top, 4] <= level)
    if below.size == 0 and rail.ends_at_gauge_face:
        return float(coefficients[0, 0])
    if below.size == 0:
        reached = coefficients[top, 4] - coefficients[0, 4]
        raise WheelsetError(
            f"rail {rail.name!r} reaches {1e3 * reached:.2f} mm below its top on the gauge side, "
            "less than the depth at which the gauge is measured: give gauge_depth="
            f"{max(np.floor(1e4 * reached - 1.0), 1.0) / 1e4:g} or less, or datum_half_distance"
        )
    segment = coefficients[below[-1]]
    height = np.polynomial.Polynomial(segment[4:]) - level
    place = brentq(height, 0.0, spacing, xtol=1e-15)
    return float(np.polynomial.Polynomial(segment[:4])(place))
