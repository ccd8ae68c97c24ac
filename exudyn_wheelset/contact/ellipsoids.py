"""Semi-ellipsoids of pressure: the energy that one takes and the field in which others sink.

A load N on an ellipse of semi-axes a (rolling) and b (lateral) with the pressure of Hertz takes,
on a gap A x^2 + g(s), the energy (x^2 and the self-displacement averaged over the pressure)
    W(N, b) = min over a of  N A a^2/5 + N^2 S(a, b)/2,   S = 6 K/(5 pi E* max(a, b)).
The ellipse at which a is best is Hertz's for A and some lateral half curvature B; with t = ln(B/A)
and the shape functions of hertz.py (alpha = axis(t), beta = axis(-t), gamma = depth(t))
    N = E* A b^3 nu,  nu = 4/3 (1 + e^t) exp(-3 beta),      a = b exp(alpha - beta),
    approach = A b^2 D,  D = (1 + e^t) exp(gamma - 2 beta),  dW/dN = A b^2 (D - e^t/5),
    dW/db = -2 N B b/5,   dW/dA = N a^2/5,   W = N (0.6 approach - B b^2/5),
so that (b, t) stand for (b, N); the derivatives make (1) of ritz.py stationary.

Two loads N_1, N_2 at a distance r across add N_1 N_2 T, T the mean of 1/(pi E* distance) over both.
Seen along a direction theta from x a semi-ellipsoid is a parabola f(u) = 3/(4 h) (1 - u^2/h^2) of
half width h = sqrt(a^2 cos^2 + b^2 sin^2), and by Fourier's slices
    T = 2/(pi E*) int from 0 to pi/2 of (f_1 * f_2)(r sin theta) d theta,
* the convolution; at r = 0 it is S. The convolution is a polynomial: with h the larger and g the
smaller half width, R the offset and w = h + g - R > 0 the overlap,
    3/(4 h) (1 - (R^2 + g^2/5)/h^2)                                 for R <= h - g,
    9/(16 h^3 g^3) (2/3 h g w^3 - (h + g) w^4/6 + w^5/30)           else.
Eight Gauss points in phi, tan theta = k tan phi, k^2 = q/(q + r^2), q = 2 (a_1^2 + a_2^2), give T
to 2e-4 where the patches are as large as their distance and to 1 % where they are a tenth of it,
where T is a small thing. Its derivatives are those of the sum.
"""

import math

import numpy as np

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.hertz import shape_and_slopes

DIRECTIONS = 8
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(DIRECTIONS)
SINES = np.sin(0.25 * math.pi * (_POINTS + 1.0))
COSINES = np.cos(0.25 * math.pi * (_POINTS + 1.0))
PORTIONS = 0.5 * _WEIGHTS


@compiled
def fill(load, modulus):
    """Fill what a LOAD is, from its place's half curvature `along`, b and t."""
    b = load.b
    alpha, beta, gamma, alpha1, beta1, gamma1, alpha2, beta2 = shape_and_slopes(load.t)
    ratio = math.exp(load.t)
    part = ratio / (1.0 + ratio)
    square = load.along * b * b
    width = square * ratio
    approach = square * (1.0 + ratio) * math.exp(gamma - 2.0 * beta)
    load.a = b * math.exp(alpha - beta)
    load.lateral = load.along * ratio
    load.approach = approach
    load.force = modulus * square * b * (4.0 / 3.0) * (1.0 + ratio) * math.exp(-3.0 * beta)
    load.width = width
    load.own = approach - 0.2 * width
    load.work = 0.6 * approach - 0.2 * width
    load.force_by_t = part - 3.0 * beta1
    load.force_by_tt = part * (1.0 - part) - 3.0 * beta2
    load.own_by_t = approach * (part + gamma1 - 2.0 * beta1) - 0.2 * width
    load.ratio_by_t = alpha1 - beta1
    load.ratio_by_tt = alpha2 - beta2


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def overlap(one, two, offset):
    """Convolution C of two parabolas of half widths `one` and `two` at an offset R >= 0.

    Returns (C, C_1, C_2, C_R, C_11, C_12, C_22, C_1R, C_2R, C_RR), all without a branch.
    """
    h = max(one, two)
    g = min(one, two)
    u = 1.0 / h
    v = 1.0 / g
    cube = u * u * u
    spread = (offset * offset + 0.2 * g * g) * u * u
    over = max(h + g - offset, 0.0)
    square = over * over
    third = square * over
    front = 0.5625 * cube * v * v * v
    q = third * (h * g / 1.5 - over * (h + g) / 6.0 + square / 30.0)
    qu = square * (2.0 * h * g - over * (h + g) / 1.5 + square / 6.0)
    quu = over * (4.0 * h * g - 2.0 * over * (h + g) + square / 1.5)
    quh = square * (2.0 * g - over / 1.5)
    qug = square * (2.0 * h - over / 1.5)
    dh = third * (g / 1.5 - over / 6.0) + qu
    dg = third * (h / 1.5 - over / 6.0) + qu
    chg = front * (third / 1.5 + quu + quh + qug - 3.0 * u * dg - 3.0 * v * dh + 9.0 * u * v * q)
    chh = front * (quu + 2.0 * quh - 6.0 * u * dh + 12.0 * u * u * q)
    cgg = front * (quu + 2.0 * qug - 6.0 * v * dg + 12.0 * v * v * q)
    inside = offset <= h - g
    c = 0.75 * u * (1.0 - spread) if inside else front * q
    ch = 0.75 * u * u * (3.0 * spread - 1.0) if inside else front * (dh - 3.0 * u * q)
    cg = -0.3 * g * cube if inside else front * (dg - 3.0 * v * q)
    cr = -1.5 * offset * cube if inside else -front * qu
    chh = cube * (1.5 - 9.0 * spread) if inside else chh
    chg = 0.9 * g * cube * u if inside else chg
    cgg = -0.3 * cube if inside else cgg
    chr_ = 4.5 * offset * cube * u if inside else -front * (quu + quh - 3.0 * u * qu)
    cgr = 0.0 if inside else -front * (quu + qug - 3.0 * v * qu)
    crr = -1.5 * cube if inside else front * quu
    kept = one >= two
    return (
        c,
        ch if kept else cg,
        cg if kept else ch,
        cr,
        chh if kept else cgg,
        chg,
        cgg if kept else chh,
        chr_ if kept else cgr,
        cgr if kept else chr_,
        crr,
    )


@compiled
def coupling(one, two, modulus, k):
    """T [m/N] of two LOADs and its derivatives, into the record k (COUPLING).

    By r = c_2 - c_1, by the logarithm l of b at constant t, and by t: the half width h of a
    projection is homogeneous in (a, b), so h_l = h. Second derivatives at constant k of the
    quadrature.
    """
    r = two.place - one.place
    distance = abs(r)
    side = 1.0 if r >= 0.0 else -1.0
    a1 = one.a * one.a
    a2 = two.a * two.a
    f1 = one.ratio_by_t
    f2 = two.ratio_by_t
    q = 2.0 * (a1 + a2)
    whole = q + distance * distance
    ratio = math.sqrt(q / whole)
    (
        total, t_r, l1, t1, l2, t2, t_k, rr, rl1, rt1, rl2, rt2, l1l1, l1t1, t1t1, l2l2, l2t2,
        t2t2, l1l2, l1t2, t1l2, t1t2,
    ) = _integrals(
        a1, one.b * one.b, f1, one.ratio_by_tt, a2, two.b * two.b, f2, two.ratio_by_tt, distance,
        ratio, ratio / modulus,
    )  # fmt: skip
    t_k /= ratio
    k_square = 2.0 * t_k * distance * distance / (ratio * whole * whole)
    k.total = total
    k.r = side * (t_r - t_k * ratio * distance / whole)
    k.l1 = l1 + k_square * a1
    k.t1 = t1 + k_square * a1 * f1
    k.l2 = l2 + k_square * a2
    k.t2 = t2 + k_square * a2 * f2
    k.rr = rr
    k.rl1 = side * rl1
    k.rt1 = side * rt1
    k.rl2 = side * rl2
    k.rt2 = side * rt2
    k.l1l1 = l1l1
    k.l1t1 = l1t1
    k.t1t1 = t1t1
    k.l2l2 = l2l2
    k.l2t2 = l2t2
    k.t2t2 = t2t2
    k.l1l2 = l1l2
    k.l1t2 = l1t2
    k.t1l2 = t1l2
    k.t1t2 = t1t2


@compiled(fastmath=AS_REAL_NUMBERS)
def _integrals(a1, b1, f1, f11, a2, b2, f2, f22, distance, ratio, scale):
    """Sums over the directions; a, b: squares of the semi-axes, f: of ln(a/b) by t."""
    total = t_r = l1 = t1 = l2 = t2 = t_k = 0.0
    rr = rl1 = rt1 = rl2 = rt2 = 0.0
    l1l1 = l1t1 = t1t1 = l2l2 = l2t2 = t2t2 = l1l2 = l1t2 = t1l2 = t1t2 = 0.0
    for i in range(DIRECTIONS):
        sine = ratio * SINES[i]
        along = COSINES[i] * COSINES[i]
        across = sine * sine
        h = math.sqrt(a1 * along + b1 * across)
        g = math.sqrt(a2 * along + b2 * across)
        c, ch, cg, cr, chh, chg, cgg, chr_, cgr, crr = overlap(h, g, distance * sine)
        norm = along + across
        weight = PORTIONS[i] * scale / math.sqrt(norm)
        part1 = a1 * along / h
        part2 = a2 * along / g
        ht = f1 * part1
        gt = f2 * part2
        htt = part1 * (2.0 * f1 * f1 + f11) - ht * ht / h
        gtt = part2 * (2.0 * f2 * f2 + f22) - gt * gt / g
        total += weight * c
        t_r += weight * cr * sine
        l1 += weight * ch * h
        t1 += weight * ch * ht
        l2 += weight * cg * g
        t2 += weight * cg * gt
        t_k += weight * (
            c * (1.0 - across / norm) + cr * distance * sine
            + ch * b1 * across / h + cg * b2 * across / g
        )  # fmt: skip
        rr += weight * crr * across
        rl1 += weight * chr_ * sine * h
        rt1 += weight * chr_ * sine * ht
        rl2 += weight * cgr * sine * g
        rt2 += weight * cgr * sine * gt
        l1l1 += weight * (chh * h + ch) * h
        l1t1 += weight * (chh * h + ch) * ht
        t1t1 += weight * (chh * ht * ht + ch * htt)
        l2l2 += weight * (cgg * g + cg) * g
        l2t2 += weight * (cgg * g + cg) * gt
        t2t2 += weight * (cgg * gt * gt + cg * gtt)
        l1l2 += weight * chg * h * g
        l1t2 += weight * chg * h * gt
        t1l2 += weight * chg * ht * g
        t1t2 += weight * chg * ht * gt
    return (
        total, t_r, l1, t1, l2, t2, t_k, rr, rl1, rt1, rl2, rt2, l1l1, l1t1, t1t1, l2l2, l2t2,
        t2t2, l1l2, l1t2, t1l2, t1t2,
    )  # fmt: skip


@compiled(fastmath=AS_REAL_NUMBERS)
def mean_distance(r, a1, b1, a2, b2, modulus):
    """T [m/N] alone; squares of the semi-axes."""
    q = 2.0 * (a1 + a2)
    ratio = math.sqrt(q / (q + r * r))
    total = 0.0
    for i in range(DIRECTIONS):
        sine = ratio * SINES[i]
        along = COSINES[i] * COSINES[i]
        across = sine * sine
        h = math.sqrt(a1 * along + b1 * across)
        g = math.sqrt(a2 * along + b2 * across)
        c = overlap(h, g, abs(r) * sine)[0]
        total += PORTIONS[i] * ratio * c / math.sqrt(along + across)
    return total / modulus


@compiled
def field(place, load, modulus):
    """Displacement [m] at a place on the line x = 0 in the field of a LOAD."""
    return load.force * mean_distance(
        place - load.place, load.a * load.a, load.b * load.b, 1.0e-10, 1.0e-10, modulus
    )
