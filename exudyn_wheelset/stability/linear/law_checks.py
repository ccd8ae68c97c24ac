"""What the linearised equations know of the creep law: whether it is linear, and how stiff.

A Jacobian by differences always gives eigenvalues. They are growth rates only if f has a derivative
at the equilibrium. Along a mode v = a + i b the motion runs through all combinations of a and b, so

    additivity = |g(a + b) - g(a) - g(b)|/|g|,   g(d) = lim (f(x0 + s d) - f(x0))/s, s > 0,

measured in the scales of the states, |g| the largest of the three, must vanish: for a law that is
homogeneous of degree one but not linear (Polach 1999 at zero creepage with spin) it does not. The
limit is taken from SMALL of the scales (0.1 micrometre) and half of it, which removes the curvature
of profiles and laws, for PHASES of the mode's phase, of which additivity is the largest; 1e-6 to
1e-4 remain of rounding, 1e-3 where forces all but cancel. The judge is the growth of simulated
small motion (tests/test_growth_rates_by_law.py): eigenvalues of laws with an additivity below
0.1 % agree with it to 0.3 % of the frequency. Polach's law, 0.8 % on the AAR wheelset, is off by
0.03 % of the frequency there; with 10 % on an S1002 wheelset by 0.8 %, with 17 % on a truck by
0.9 %, where the eigenvalue grows from 44.7 m/s on and the motion does not up to 51 m/s.

A law may be linear with the wrong slope: spin softens the exact law, and most fast laws do not know
it. slope_ratio is the law's -dF/dxi over that of the exact law on the same patch, of the patch and
direction where it is farthest from 1.

Contact forces may step or bend so near to the equilibrium that eigenvalues hold for nothing that
moves: amplitude_error is by how much a motion of up to 10 um sees another one (amplitudes.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from exudyn_wheelset.arrays import Array
from exudyn_wheelset.checking import warn
from exudyn_wheelset.creep import CREEP_LAWS
from exudyn_wheelset.creep.slopes import creep_slopes
from exudyn_wheelset.errors import WheelsetWarning
from exudyn_wheelset.stability.linear.amplitudes import farthest_off
from exudyn_wheelset.systems.system import DynamicSystem

ADDITIVITY_LIMIT = 0.02
SLOPE_LIMIT = 0.10
AMPLITUDE_LIMIT = 0.02
SMALL = 1.0e-4
PHASES = 6
# The laws that the others are measured by, the cheaper first.
EXACT_LAWS = ("exact-table", "exact")
# A slope below this share of Kalker's is that of a patch that slips: its ratio says nothing.
LEAST_SLOPE = 0.05


class LawWarning(WheelsetWarning):
    """A creep law that the linear equations do not describe well.

    about: which system, law and fault, in words without numbers: a script says it once.
    """

    def __init__(self, message: str, about: str) -> None:
        super().__init__(message)
        self.about = about


@dataclass(frozen=True)
class LawCheck:
    """What was measured of the creep law about one equilibrium.

    additivity     |f(a + b) - f(a) - f(b)| over |f| along the mode; 0 for linear equations
    law            name of the law (names, if wheelsets have different ones); "" if none is known
    slope_ratio    slope of the law over that of the exact law where they differ most; None if the
                   system has no contact patches
    slope, exact_slope  [N] behind it
    direction      "x" (along) or "y" (lateral)
    where          wheelset and wheel of that patch
    meaning        what "linear" means for a law without a derivative; "" for the others
    amplitude_error  |lambda(A) - lambda| over |Im lambda| of a motion of the lateral amplitude A
    amplitude      [m] A where that is greatest, up to 10 um
    """

    additivity: float
    law: str = ""
    slope_ratio: float | None = None
    slope: float = 0.0
    exact_slope: float = 0.0
    direction: str = ""
    where: str = ""
    meaning: str = ""
    amplitude_error: float = 0.0
    amplitude: float = 0.0

    @property
    def remark(self) -> str:
        """What "linear" means for a law without a derivative, with its additivity; or nothing."""
        if not self.meaning:
            return ""
        return f"creep law {self.law!r}: {self.meaning} Here by {100.0 * self.additivity:.2g} %."

    def additivity_warning(self, name: str, speed: float) -> str:
        """What is wrong with the system `name` linearised at a speed [m/s]; "" if nothing."""
        if not self.additivity > ADDITIVITY_LIMIT:
            return ""
        whose = f"the creep law {self.law!r} is" if self.law else "the equations are"
        return (
            f"{name} at {speed:.4g} m/s: {whose} not linear about the equilibrium: f(a + b) is off "
            f"f(a) + f(b) by {100.0 * self.additivity:.1f} % along the mode (limit "
            f"{100.0 * ADDITIVITY_LIMIT:.0f} %), so eigenvalues are no growth rates. "
            + (f"{self.meaning} " if self.meaning else "")
            + 'Take a law with a derivative, such as creep="polach-kalker", or the growth of '
            "simulated small motion."
        )

    def slope_warning(self, name: str, speed: float) -> str:
        """What is wrong with the stiffness of the law at a speed [m/s]; "" if nothing."""
        if self.slope_ratio is None or not abs(self.slope_ratio - 1.0) > SLOPE_LIMIT:
            return ""
        return (
            f"{name} at {speed:.4g} m/s: the creep law {self.law!r} has the slope "
            f"-dF{self.direction}/dxi = {self.slope / 1e6:.3g} MN at the equilibrium "
            f"({self.where}), the exact law {self.exact_slope / 1e6:.3g} MN: "
            f"{100.0 * (self.slope_ratio - 1.0):+.0f} % (limit {100.0 * SLOPE_LIMIT:.0f} %). "
            "Critical speed and growth rates move with it: compare with "
            f"creep={exact_law()!r}."
        )

    def amplitude_warning(self, name: str, speed: float) -> str:
        """What is wrong with the eigenvalue for motion of some micrometres; "" if nothing."""
        if not self.amplitude_error > AMPLITUDE_LIMIT:
            return ""
        return (
            f"{name} at {speed:.4g} m/s: motion of {1e6 * self.amplitude:.0f} um sees an "
            f"eigenvalue that is {100.0 * self.amplitude_error:.0f} % of the frequency off (limit "
            f"{100.0 * AMPLITUDE_LIMIT:.0f} %): forces step or bend beside the equilibrium, as "
            "where patches of a measured profile merge. Take normal='energy', or the growth of "
            "simulated motion of the amplitude that matters."
        )


def exact_law() -> str | None:
    """Name of the law that the others are measured by."""
    return next((name for name in EXACT_LAWS if name in CREEP_LAWS), None)


def check_law(
    system: DynamicSystem, state: Array, speed: float, mode: Array, jacobian: Array
) -> LawCheck:
    """Measure the creep law about an equilibrium (n,) along a mode (n,) at a speed [m/s].

    jacobian (n, n): at the equilibrium. Costs some 70 right-hand sides and twelve forces a patch.
    """
    measured = additivity(system, state, speed, mode)
    patches = [p for p in system.creep_patches(state, speed) if p.friction * p.normal_force > 0.0]
    laws = list(dict.fromkeys(patch.law.name for patch in patches))
    meanings = dict.fromkeys(p.law.when_linearised for p in patches if p.law.when_linearised)
    check = LawCheck(additivity=measured, law=" and ".join(laws), meaning=" ".join(meanings))
    if measured <= ADDITIVITY_LIMIT:
        off, amplitude = farthest_off(system, state, speed, mode, jacobian)
        check = replace(check, amplitude_error=off, amplitude=amplitude)
    exact = exact_law()
    if exact is None or not patches:
        return check
    own, exactly = creep_slopes(patches), creep_slopes(patches, exact)
    with np.errstate(divide="ignore", invalid="ignore"):
        wrong = np.abs(own / exactly - 1.0)
    wrong[exactly < LEAST_SLOPE * creep_slopes(patches, "linear")] = 0.0
    patch, direction = np.unravel_index(np.argmax(wrong), wrong.shape)
    return replace(
        check,
        slope_ratio=float(own[patch, direction] / exactly[patch, direction]),
        slope=float(own[patch, direction]),
        exact_slope=float(exactly[patch, direction]),
        direction="xy"[direction],
        where=patches[patch].where,
    )


def additivity(system: DynamicSystem, state: Array, speed: float, mode: Array) -> float:
    """|g(a + b) - g(a) - g(b)| over the largest of the three, along a mode a + i b (n,)."""
    scales = system.scales
    size = float(np.max(np.abs(mode) / scales))
    if size == 0.0:
        return 0.0
    at_rest = np.array(system.derivative(state, speed))

    def slope(direction: Array) -> Array:
        """One-sided derivative of f along a direction, to second order."""
        changes = [
            (np.array(system.derivative(state + step * direction, speed)) - at_rest) / step
            for step in (SMALL, 0.5 * SMALL)
        ]
        return np.asarray((2.0 * changes[1] - changes[0]) / scales)

    worst = 0.0
    for phase in np.pi * np.arange(PHASES) / PHASES:
        turned = np.asarray(mode) / size * np.exp(1j * phase)
        one, other = slope(turned.real), slope(turned.imag)
        both = slope(turned.real + turned.imag)
        whole = max(float(np.linalg.norm(part)) for part in (both, one, other))
        if whole > 0.0:
            worst = max(worst, float(np.linalg.norm(both - one - other)) / whole)
    return worst


def warn_of_law(name: str, checks: Sequence[tuple[float, LawCheck]]) -> None:
    """Warn of the worst of the checks (speed [m/s], check) of a system, once for each fault."""
    if not checks:
        return
    speed, check = max(checks, key=lambda entry: entry[1].additivity)
    steep_speed, steep = max(checks, key=lambda entry: abs((entry[1].slope_ratio or 1.0) - 1.0))
    near_speed, near = max(checks, key=lambda entry: entry[1].amplitude_error)
    for fault, message in (
        ("not linear", check.additivity_warning(name, speed)),
        ("another slope", steep.slope_warning(name, steep_speed)),
        ("not linear near by", near.amplitude_warning(name, near_speed)),
    ):
        if message:
            warning = LawWarning(message, about=f"{name}, {check.law}: {fault}")
            warn(warning)
