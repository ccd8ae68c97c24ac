"""The papers behind what a vehicle and an analysis use: what to cite with a result.

    print(citation("dtu_car", "linear_critical_speed", "limit_cycles"))

Names follow from the description: creep law and normal contact, friction elements, measured
profiles that are smoothed, the source of a vehicle of the catalogue. Methods are the names of the
package's functions.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from exudyn_wheelset.checking import unknown
from exudyn_wheelset.creep import CREEP_LAWS
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt
from exudyn_wheelset.stability.subject import description_of

PAPERS = {
    "exudyn": "J. Gerstmayr, Exudyn - a C++-based Python package for flexible multibody systems, "
    "Multibody System Dynamics 60 (2024) 533-561",
    "hertz": "H. Hertz, Über die Berührung fester elastischer Körper, Journal für die reine und "
    "angewandte Mathematik 92 (1881) 156-171",
    "kalker": "J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, Kluwer, 1990",
    "fastsim": "J. J. Kalker, A fast algorithm for the simplified theory of rolling contact, "
    "Vehicle System Dynamics 11 (1982) 1-13",
    "polach-1999": "O. Polach, A fast wheel-rail forces calculation computer code, Vehicle System "
    "Dynamics 33, supplement (1999) 728-739",
    "polach-2005": "O. Polach, Creep forces in simulations of traction vehicles running on "
    "adhesion limit, Wear 258 (2005) 992-1000",
    "shen": "Z. Y. Shen, J. K. Hedrick, J. A. Elkins, A comparison of alternative creep force "
    "models for rail vehicle dynamic analysis, Vehicle System Dynamics 12 (1983) 79-83",
    "vermeulen": "P. J. Vermeulen, K. L. Johnson, Contact of nonspherical elastic bodies "
    "transmitting tangential forces, Journal of Applied Mechanics 31 (1964) 338-340",
    "kik": "W. Kik, J. Piotrowski, A fast approximate method to calculate normal load at contact "
    "between wheel and rail and creep forces during rolling, 2nd Mini Conference on Contact "
    "Mechanics and Wear of Rail/Wheel Systems, Budapest, 1996",
    "dahl": "P. Dahl, A solid friction model, Aerospace Corporation, TOR-0158(3107-18)-1, 1968",
    "lugre": "C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky, A new model for control "
    "of systems with friction, IEEE Transactions on Automatic Control 40 (1995) 419-425",
    "en15302": "EN 15302, Railway applications - Wheel-rail contact geometry parameters",
    "en14363": "EN 14363, Railway applications - Testing and simulation for the acceptance of "
    "running characteristics of railway vehicles",
    "collocation": "C. de Boor, B. Swartz, Collocation at Gaussian points, SIAM Journal on "
    "Numerical Analysis 10 (1973) 582-606",
    "doedel": "E. J. Doedel, H. B. Keller, J. P. Kernevez, Numerical analysis and control of "
    "bifurcation problems (II), International Journal of Bifurcation and Chaos 1 (1991) 745-772",
    "wilson": "E. B. Wilson, Probable inference, the law of succession, and statistical "
    "inference, Journal of the American Statistical Association 22 (1927) 209-212",
    "latin": "M. D. McKay, R. J. Beckman, W. J. Conover, A comparison of three methods for "
    "selecting values of input variables, Technometrics 21 (1979) 239-245",
    "kaas-petersen": "C. Kaas-Petersen, Chaos in a railway bogie, Acta Mechanica 61 (1986) 89-107",
    "manchester": "S. Iwnicki, Manchester benchmarks for rail vehicle simulation, Vehicle System "
    "Dynamics 30 (1998) 295-313",
    "hoffmann": "M. Hoffmann, H. True, The dynamics of European two-axle railway freight wagons "
    "with UIC standard suspension, Vehicle System Dynamics 46, supplement (2008) 225-236",
    "piotrowski": "J. Piotrowski, Model of the UIC link suspension for freight wagons, Archive of "
    "Applied Mechanics 73 (2003) 517-532",
    "three-piece": "F. Xia, H. True, The dynamics of the three-piece-freight truck, Vehicle System "
    "Dynamics 41, supplement (2004) 212-221",
}
_LAWS = {
    "linear": ("kalker",),
    "vermeulen-johnson": ("vermeulen",),
    "shen-hedrick-elkins": ("shen", "kalker"),
    "polach": ("polach-1999",),
    "polach-2005": ("polach-2005", "polach-1999"),
    "polach-kalker": ("polach-1999", "kalker"),
    "fastsim": ("fastsim", "kalker"),
    "exact": ("kalker",),
    "exact-table": ("kalker",),
}
_NORMAL = {
    "hertz": ("hertz", "kik"),
    "hertz-local": ("hertz",),
    "virtual-penetration": ("kik",),
    "energy": ("hertz",),
    "ritz": ("hertz",),
    "strips": ("hertz", "kik"),
}
_VEHICLES = {
    "cooperrider": ("kaas-petersen",),
    "cooperrider_bogie_3d": ("kaas-petersen",),
    "truck": ("kaas-petersen",),
    "dtu_car": ("kaas-petersen",),
    "s1002": ("manchester",),
    "manchester_coach": ("manchester",),
    "two_axle_wagon": ("piotrowski", "hoffmann"),
    "freight_car": ("three-piece",),
}
_METHODS: dict[str, tuple[str, ...]] = {
    "equivalent_conicity": ("en15302",),
    "limit_cycles": ("collocation", "doedel"),
    "nonlinear_critical_speed": ("collocation", "doedel"),
    "stability_map": ("collocation", "doedel"),
    "basin": ("wilson",),
    "latin_hypercube": ("latin",),
    "steady_curve": ("en14363",),
}
_FRICTION = ("FrictionWedge", "CoilNest", "CentrePlate", "SideBearer", "LeafSpring")


@dataclass(frozen=True)
class Citation:
    """References with what each is used for; printing it gives one a line.

    entries: pairs (what it is used for, reference), without doubles, in the order of use.
    """

    entries: tuple[tuple[str, str], ...]

    def __str__(self) -> str:
        return "\n".join(f"{use}: {reference}." for use, reference in self.entries)

    def __len__(self) -> int:
        return len(self.entries)


@spelt
def citation(vehicle: Any = None, *methods: str) -> Citation:
    """The papers behind a vehicle's laws and models, and behind the methods used on it.

    vehicle  a description, a name of the catalogue, a system that knows its description; None for
             methods alone
    methods  names of the package's functions, such as "limit_cycles", "equivalent_conicity"

    Raises WheelsetError for an unknown method or vehicle.

    Examples
    --------
    >>> from exudyn_wheelset import citation
    >>> print(citation(None, "equivalent_conicity"))
    equivalent_conicity: EN 15302, Railway applications - Wheel-rail contact geometry parameters.
    """
    import exudyn_wheelset

    names = exudyn_wheelset.__all__

    found: list[tuple[str, str]] = []
    if vehicle is not None:
        found += _of_vehicle(vehicle)
    for method in methods:
        if method not in names and method not in _METHODS:
            raise unknown("method to cite for", method, sorted({*_METHODS, *names}))
        found += [(method, key) for key in _METHODS.get(method, ())]
    uses: dict[str, list[str]] = {}
    for use, key in found:
        uses.setdefault(key, [])
        if use not in uses[key]:
            uses[key].append(use)
    return Citation(tuple((", ".join(use), PAPERS[key]) for key, use in uses.items()))


def _of_vehicle(vehicle: Any) -> list[tuple[str, str]]:
    found = [("multibody engine", "exudyn")]
    if isinstance(vehicle, str):
        found += [(f"vehicle {vehicle}", key) for key in _VEHICLES.get(vehicle, ())]
    description = description_of(vehicle)
    contact = getattr(description, "contact", None)
    if contact is None or not hasattr(contact, "normal"):
        if isinstance(vehicle, str):
            return found
        raise WheelsetError(
            f"{vehicle!r} has no description with a contact: give a Vehicle, or a catalogue name"
        )
    found += [(f"normal contact {contact.normal}", key) for key in _NORMAL.get(contact.normal, ())]
    law = contact.creep if isinstance(contact.creep, str) else ""
    if law in CREEP_LAWS:
        found += [(f"creep law {law}", key) for key in _LAWS.get(law, ())]
    elements = {type(one.element).__name__ for one in description.connections}
    for name in sorted(elements.intersection(_FRICTION)):
        found += [(f"friction of {name}", key) for key in ("dahl", "lugre")]
    if "LinkSuspension" in elements:
        found.append(("link suspension", "piotrowski"))
    return found
