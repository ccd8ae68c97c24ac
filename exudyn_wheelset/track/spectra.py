"""Power spectral densities of track irregularity: formulas, constants, sources, variances.

All are one-sided in the angular spatial frequency O [rad/m]: the variance in a band is the integral
of S over it, in m^2 for S in square metres per (radian per metre). They have the form

    S = A O^(2 p)/((O^2 + a_1^2) (O^2 + a_2^2) ...),

whose integral is closed: with partial fractions r_i of x^p/prod(x + a_j^2),
    int S dO = A sum r_i F_i,   F_i = atan(O/a_i)/a_i,  or -1/O for a_i = 0.

ERRI B176 (ORE B176 RP 1, 1989), "low" and "high" disturbance, O_c = 0.8246, O_r = 0.0206,
O_s = 0.4380 rad/m, b = 0.75 m:
    vertical, alignment  A O_c^2/((O^2 + O_r^2)(O^2 + O_c^2))
    cross level          A_v O_c^2 O^2/(b^2 (O^2 + O_r^2)(O^2 + O_c^2)(O^2 + O_s^2)), an angle; here
                         the difference of heights over 2 b, 4 b^2 as large
    gauge                A_g O_c^2 O^2/((O^2 + O_r^2)(O^2 + O_c^2)(O^2 + O_s^2))
FRA, classes 4 to 6 (Hamid et al. 1983; Fries and Coffey 1990), k = 0.25, O_c = 0.8245 rad/m, O_s by
class:
    vertical, alignment  k A O_c^2/(O^2 (O^2 + O_c^2)), with no variance down to O = 0
    cross level, gauge   4 k A_v O_c^2/((O^2 + O_c^2)(O^2 + O_s^2))
Cross level: height of the left rail over the right one. Gauge: by how much it is wider.

Second sources: GENSYS (documentation of its program TRC_IPSD) has vertical and alignment of ORE
B176 high level as points in m^2/(1/m), the same to 1e-4 from 5 to 50 m; its gauge there is half of
the alignment, four times as much as here. FRA vertical of classes 5 and 6: 2.095e-5 and 3.4e-6
m^2 rad/m in open programs after Zhang et al. 2001 and Podworna 2015. None for FRA class 4, nor for
cross level and gauge.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import number, positive, unknown, whole
from exudyn_wheelset.errors import WheelsetError
from exudyn_wheelset.spelling import spelt_class

KINDS = ("alignment", "vertical", "cross_level", "gauge")
UNIT = "m^2/(rad/m), square metres per radian per metre"
_ERRI = "ORE B176 RP 1, 1989"
_FRA = "FRA, Hamid et al. 1983"


@spelt_class
@dataclass(frozen=True)
class Spectrum:
    """One-sided power spectral density of one kind of irregularity.

    edition: where it stands; formula, in O [rad/m]; amplitude A [SI]; power p; poles a_i [rad/m].

    Examples
    --------
    >>> from exudyn_wheelset.track.spectra import SPECTRA
    >>> sorted(SPECTRA)[:2]
    ['ERRI B176 high', 'ERRI B176 low']
    """

    edition: str
    formula: str
    amplitude: float
    power: int
    poles: tuple[float, ...]
    unit: str = UNIT

    def __post_init__(self) -> None:
        positive("amplitude", self.amplitude, "SI", 1.0)
        whole("power", self.power, 0, 20)
        for pole in self.poles:
            number("one of poles", pole, "rad/m", 0.0, 1e3)

    def density(self, frequency: Array | float) -> Array:
        """S [m^2/(rad/m)] at angular spatial frequencies O [rad/m]."""
        square = np.asarray(frequency, dtype=float) ** 2
        value = self.amplitude * square**self.power
        for pole in self.poles:
            value = value / (square + pole * pole)
        return np.asarray(value)

    def variance(self, low: float = 0.0, high: float = math.inf) -> float:
        """Variance [m^2] of what lies between two frequencies [rad/m], in closed form.

        Raises WheelsetError from 0 on for a spectrum that grows without end there.
        """
        if low <= 0.0 and 0.0 in self.poles and self.power == 0:
            raise WheelsetError(
                f"{self.formula}: no finite variance down to 0 rad/m: give a lower limit above 0"
            )
        total = 0.0
        for k, pole in enumerate(self.poles):
            others = [other for j, other in enumerate(self.poles) if j != k]
            weight = (-(pole**2)) ** self.power if self.power else 1.0
            weight /= math.prod(other**2 - pole**2 for other in others)
            if weight == 0.0:
                continue
            total += weight * (_integral(pole, high) - _integral(pole, low))
        return self.amplitude * total


def _integral(pole: float, frequency: float) -> float:
    if pole == 0.0:
        return -1.0 / frequency if math.isfinite(frequency) else 0.0
    return math.atan(frequency / pole) / pole


def _erri(vertical: float, alignment: float, gauge: float) -> dict[str, Spectrum]:
    cut, low, short, half = 0.8246, 0.0206, 0.4380, 0.75
    plain = "A Oc^2/((O^2 + Or^2)(O^2 + Oc^2))"
    third = "(O^2 + Or^2)(O^2 + Oc^2)(O^2 + Os^2)"
    return {
        "alignment": Spectrum(_ERRI, plain, alignment * cut**2, 0, (low, cut)),
        "vertical": Spectrum(_ERRI, plain, vertical * cut**2, 0, (low, cut)),
        "cross_level": Spectrum(
            _ERRI, f"(2 b)^2 A Oc^2 O^2/(b^2 {third})",
            (2.0 * half) ** 2 / half**2 * vertical * cut**2, 1, (low, cut, short),
        ),
        "gauge": Spectrum(_ERRI, f"A Oc^2 O^2/({third})", gauge * cut**2, 1, (low, cut, short)),
    }  # fmt: skip


def _fra(vertical: float, alignment: float, short: float) -> dict[str, Spectrum]:
    """vertical, alignment: A in cm^2 rad/m, as the source gives them; short: O_s [rad/m]."""
    cut, k = 0.8245, 0.25
    plain = "k A Oc^2/(O^2 (O^2 + Oc^2))"
    both = Spectrum(
        _FRA, "4 k A Oc^2/((O^2 + Oc^2)(O^2 + Os^2))",
        4.0 * k * 1e-4 * vertical * cut**2, 0, (cut, short),
    )  # fmt: skip
    return {
        "alignment": Spectrum(_FRA, plain, k * 1e-4 * alignment * cut**2, 0, (0.0, cut)),
        "vertical": Spectrum(_FRA, plain, k * 1e-4 * vertical * cut**2, 0, (0.0, cut)),
        "cross_level": both,
        "gauge": both,
    }


SPECTRA: dict[str, dict[str, Spectrum]] = {
    "ERRI B176 low": _erri(4.032e-7, 2.119e-7, 5.32e-8),
    "ERRI B176 high": _erri(10.80e-7, 6.125e-7, 1.032e-7),
    "FRA class 4": _fra(0.5376, 0.3027, 1.1312),
    "FRA class 5": _fra(0.2095, 0.0762, 0.8209),
    "FRA class 6": _fra(0.0339, 0.0339, 0.4380),
}


def spectra(name: str) -> dict[str, Spectrum]:
    """The spectra of a track by its name, by kind; spelt with any signs ("erri-b176-low", "fra 5").

    Raises WheelsetError for an unknown one, with the nearest.
    """
    words = re.findall(r"[a-z]+|\d+", str(name).lower())
    for known, found in SPECTRA.items():
        own = re.findall(r"[a-z]+|\d+", known.lower())
        # "ERRI low", "B176 high", "AAR 5" say enough.
        telling = own[-1]
        first = {"erri", "ore", "b"} if own[0] == "erri" else {"fra", "aar"}
        if telling in words and (first & set(words) or words == [telling]):
            return found
    raise unknown("track spectrum", name, tuple(SPECTRA))
