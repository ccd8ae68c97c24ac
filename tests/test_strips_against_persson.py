"""Strips in conformal contact against plane elasticity: Persson's disc in a hole, in closed form.

A. Persson, On the stress distribution of cylindrical elastic bodies in contact, Chalmers 1964; as
in M. Ciavarella and P. Decuzzi, The state of stress induced by the plane frictionless cylindrical
contact, Int. J. Solids and Structures 38, 2001. Disc and plate of the same material, radii R - dR
and R, pressed together by Q per length; pressed over |phi| < eps, b = tan(eps/2), t = tan(phi/2):
    p R/Q = 2 sqrt(b^2 - t^2)/(pi sqrt(1 + b^2) (1 + t^2)) + L(t)/(2 pi b^2 (1 + b^2)),
    L(t) = ln[(sqrt(b^2 + 1) + sqrt(b^2 - t^2))/(sqrt(b^2 + 1) - sqrt(b^2 - t^2))],
    E dR/Q = 2 (1 - b^2)/(pi b^2) - int L/(1 + t^2) dt/(pi^2 b^2 (1 + b^2)),   E = 2 G/(1 - nu)
in plane strain. A wheel of very large rolling radius makes a patch that is long in x, whose middle
section is plane.
"""

import math

import numpy as np
import pytest
from numba import njit
from scipy.integrate import quad
from scipy.optimize import brentq

from exudyn_wheelset.contact import strips as module
from exudyn_wheelset.contact.layout import STRIP, STRIPS_A_LOBE, Material

STEEL = Material(82e9, 0.28)
PLANE = 2.0 * STEEL.shear_modulus / (1.0 - STEEL.poisson)
THROAT = 13e-3


def logarithm(t, b):
    root, whole = math.sqrt(max(b * b - t * t, 0.0)), math.sqrt(b * b + 1.0)
    return math.log((whole + root) / (whole - root))


def pressure(phi, b):
    """p R/Q at an angle of the disc."""
    t = math.tan(0.5 * phi)
    if abs(t) >= b:
        return 0.0
    elliptic = 2.0 * math.sqrt(b * b - t * t) / (math.pi * math.sqrt(1.0 + b * b) * (1.0 + t * t))
    return elliptic + logarithm(t, b) / (2.0 * math.pi * b * b * (1.0 + b * b))


def clearance(b):
    """E dR/Q at which the contact reaches to b."""
    integral = quad(lambda t: logarithm(t, b) / (1.0 + t * t), -b, b)[0]
    rest = integral / (math.pi**2 * b * b * (1.0 + b * b))
    return 2.0 * (1.0 - b * b) / (math.pi * b * b) - rest


@njit
def press(numbers, gap, depth, along):
    """Strips of a cylinder in a trough of radius THROAT, `gap` wider, overlapping by `depth`."""
    strips = numbers.view(STRIP)
    shift = gap + depth
    end = math.acos(gap / shift)
    for k in range(STRIPS_A_LOBE):
        strip = strips[k]
        angle = end * ((2.0 * k + 1.0) / STRIPS_A_LOBE - 1.0)
        strip.width = 2.0 * THROAT * end / STRIPS_A_LOBE
        strip.arc = THROAT * angle
        strip.depth = shift * math.cos(angle) - gap
        strip.curvature = along * math.cos(angle)
        strip.normal_y = math.sin(angle)
        strip.normal_z = math.cos(angle)
    lateral = 0.5 * gap / (THROAT * THROAT)
    locality = np.empty(1)
    locality[0] = module.begin_with_ellipse(strips, depth, along, lateral, STEEL)
    module.press_strips(strips, locality, STEEL)
    for k in range(STRIPS_A_LOBE):
        strips[k].pressure *= module.hertz_over_strips(along, lateral)


@pytest.mark.parametrize("b", [0.01, 0.1, 0.3, 0.6, 1.0])
def test_the_closed_form_is_in_equilibrium(b):
    """The vertical part of the pressure is Q; at small angles it is Hertz's, 2/(pi eps)."""
    reach = 2.0 * math.atan(b)
    load = quad(lambda phi: pressure(phi, b) * math.cos(phi), -reach, reach)[0]
    assert load == pytest.approx(1.0, rel=1e-8)
    if b == 0.01:
        assert pressure(0.0, b) == pytest.approx(2.0 / (math.pi * reach), rel=1e-3)
        assert clearance(b) == pytest.approx(2.0 / (math.pi * b * b), rel=1e-3)


@pytest.mark.parametrize("rolling", [5.0, 50.0])
@pytest.mark.parametrize("gap", [0.3e-3, 0.5e-3, 1e-3, 2e-3])
@pytest.mark.parametrize("depth", [3e-5, 6e-5, 1.2e-4, 2e-4])
def test_pressure_in_the_middle_section(rolling, gap, depth):
    """To 34 degrees of half angle: peak 3 % (20 strips), every strip 5 % of the peak, width 6 %.

    The width is found to half a strip: there are seven on each side.
    Hertz's line contact is up to 14 % low in the peak there, and the contact bends round by as
    much as the arc is long: the projections cos(angle_i - angle_j) are what this tests.
    """
    room = np.zeros(STRIPS_A_LOBE * STRIP.itemsize // 8)
    press(room, gap, depth, 0.5 / rolling)
    strips = room.view(STRIP).view(np.recarray)
    angle = strips.arc / THROAT
    load = np.sum(strips.pressure * strips.width * strips.normal_z)
    b = brentq(lambda b: clearance(b) - PLANE * gap / load, 1e-3, 0.9)
    wanted = load / THROAT * np.array([pressure(phi, b) for phi in angle])
    peak = load / THROAT * pressure(0.0, b)
    assert np.max(strips.pressure) == pytest.approx(peak, rel=0.03)
    # the last strip inside is pressed over a part of its width
    inner = np.abs(angle) < 2.0 * math.atan(b) - strips.width / THROAT
    assert np.max(np.abs(strips.pressure - wanted)[inner]) < 0.05 * peak
    width = math.sqrt(np.sum(strips.pressure * angle**2) / np.sum(strips.pressure))
    reach = 2.0 * math.atan(b)
    second = quad(lambda phi: pressure(phi, b) * phi * phi, -reach, reach)[0]
    whole = quad(lambda phi: pressure(phi, b), -reach, reach)[0]
    assert width == pytest.approx(math.sqrt(second / whole), rel=0.06)


def test_hertz_is_what_it_leaves_behind():
    """At 30 degrees of half angle Hertz's line contact has a peak 10 % lower and more."""
    b = math.tan(math.radians(15.0))
    gap = 0.3e-3
    load = PLANE * gap / clearance(b)
    hertz = math.sqrt(load * 0.5 * PLANE * gap / THROAT**2 / math.pi)
    assert hertz < 0.9 * load / THROAT * pressure(0.0, b)
