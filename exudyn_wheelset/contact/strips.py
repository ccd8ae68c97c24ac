"""Normal contact strip by strip: pressure of patches that are no ellipse, on surfaces that curve.

Near-conformal contact (the throat of a wheel in the gauge corner of a rail) has a patch along
which the contact angle turns by tens of degrees, the pressure gathers at one end, and neighbouring
patches press on each other. Here the patch is cut into strips along the rolling direction, as Kik
and Piotrowski, STRIPES (Quost et al. 2006) and ANALYN (Sichani et al. 2014) do, but the strips are
joined by the elastic half-space itself. In strip j, at wheel arc length s_j, the pressure is
    p = p_j sqrt(1 - (x/a_j)^2),    |x| <= a_j.
Full solutions have this shape along x to some 2 % even where nothing is elliptic across it. With
Boussinesq's displacement the half-space gives at the middle of a strip, at a distance sigma, the
displacement and half its curvature along x in closed form: with u = sigma/a, r = sqrt(1 + u^2)
and D = K - E, the complete elliptic integrals of parameter 1/r^2,
    int sqrt(1 - x^2/a^2)/sqrt(x^2 + sigma^2) dx = 2 r D,
    -1/2 d^2/dx^2 of it = D/(r a^2).
So both conditions of contact, depth P_i = P(s_i) and half curvature A_i = cos(angle)/(2 R),
    P_i = 1/(pi E*) sum_j c_ij p_j int 2 r D ds,    A_i = 1/(pi E*) sum_j c_ij p_j/a_j^2 int D/r ds,
are sums over strips (1/E* = (1 - nu)/G). c_ij = cos(angle_i - angle_j): the normal displacement
points along the normal where the pressure is, and bodies of one material have no difference of
tangential displacement under pressure. The depth P is the distance along the local normal, so the
reference surface is curved; sigma is measured along it. For a Hertz ellipse both equations hold
exactly.

Solved from Hertz's ellipse of each lobe: the first set with p >= 0 (an active set), the second by
a <- a sqrt(A found/A wanted), which is Newton's step where the patch is wide; a fixed number of
times, so that forces are continuous in the pose. HERTZ_OVER_STRIPS takes the error of the finite
number of strips out of an ellipse. Lobes need no merging here: the strips of all lobes are solved
together, which makes patches feel each other.

Not in it: under yaw the middles of the strips lie along the slanted contact locus; the distance
between strips does not see that.

Frame: track frame, left side. Records STRIP, LOBE: layout.py.
"""

import math

import numpy as np

from exudyn_wheelset.compilation import AS_REAL_NUMBERS, compiled
from exudyn_wheelset.contact.hertz import hertz_from_approach
from exudyn_wheelset.contact.layout import STRIPS_A_LOBE
from exudyn_wheelset.contact.locus import rail_foot, wheel_point
from exudyn_wheelset.contact.search import VIRTUAL, grid_foot, zone_end, zone_moments

ROUNDS = 4
_LEAST_LENGTH = 0.05
_OUTSIDE = 0.25
_SLENDER = 5.0
# Force of Hertz's ellipse over that of its strips at ln(B/A) = FACTOR_START + k FACTOR_STEP, by
# tools/make_strip_factors.py.
FACTOR_START = -6.0
FACTOR_STEP = 0.25
# fmt: off
HERTZ_OVER_STRIPS = np.array(
    [
        1.05586, 1.04584, 1.03702, 1.02931, 1.02268, 1.01712, 1.01259, 1.00901, 1.00628,
        1.00425, 1.00279, 1.00176, 1.00096, 0.99997, 0.99925, 0.99877, 0.99847, 0.99835,
        0.99838, 0.99854, 0.99881, 0.99916, 0.99951, 0.99891, 0.99849, 0.99839, 0.99857,
        0.99898, 0.99972, 1.00076, 0.99969, 0.99872, 1.00040, 1.00320, 1.00700, 1.01144,
        1.01589, 1.01965, 1.01870, 1.01679, 1.01451, 1.01955, 1.02469, 1.02980, 1.03478,
        1.03954, 1.04397, 1.04800, 1.05154, 1.05449, 1.05675, 1.05603, 1.05416, 1.05195,
        1.04937, 1.04639, 1.04295, 1.03901, 1.04131, 1.04483, 1.04833,
    ]
)
# fmt: on


@compiled(fastmath=AS_REAL_NUMBERS)
def k_minus_e(u_squared):
    """D = K - E for parameter m = 1/(1 + u^2): to 5e-8.

    Abramowitz and Stegun 1964, equations 17.3.34 and 17.3.36; series in m where it is small.
    """
    n = u_squared / (1.0 + u_squared)
    m = 1.0 - n
    if m < 0.003:
        return 0.25 * math.pi * m * (1.0 + 0.375 * m)
    k = 1.38629436112 + n * (
        0.09666344259 + n * (0.03590092383 + n * (0.03742563713 + n * 0.01451196212))
    )
    k_log = 0.5 + n * (
        0.12498593597 + n * (0.06880248576 + n * (0.03328355346 + n * 0.00441787012))
    )
    e = 1.0 + n * (0.44325141463 + n * (0.06260601220 + n * (0.04757383546 + n * 0.01736506451)))
    e_log = n * (0.24998368310 + n * (0.09200180037 + n * (0.04069697526 + n * 0.00526449639)))
    return k - e - (k_log - e_log) * math.log(n)


@compiled(inline="always", fastmath=AS_REAL_NUMBERS)
def _integral_of_log(x):
    return x * math.log(abs(x)) - x if x != 0.0 else 0.0


@compiled(fastmath=AS_REAL_NUMBERS)
def influence(distance, width, half_length):
    """Integrals over a strip's width of 2 r D and of D/(r a^2), seen from `distance` [m].

    Far away by the middle and the second derivative there, from its limits for small and large u;
    near by, the logarithm of D = ln(4/u) - 1 + ... is integrated in closed form and the rest by two
    Gauss points.
    """
    per_length = 1.0 / half_length
    if abs(distance) > 1.75 * width:
        u = distance * per_length
        square = u * u
        r = math.sqrt(1.0 + square)
        d = k_minus_e(square)
        curving = width * width / (12.0 * distance * distance)
        depth = 2.0 * r * d + curving / (1.0 + 2.0 / math.pi * abs(u))
        bend = d / r + 0.5 * curving / (1.0 + abs(u) * square / (3.0 * math.pi))
        return depth * width, bend * width * per_length * per_length
    half = 0.5 * width
    logarithm = _integral_of_log(distance + half) - _integral_of_log(distance - half)
    logarithm += width * math.log(per_length)
    depth = 0.0
    bend = 0.0
    for sign in (-1.0, 1.0):
        u = (distance + sign * half * 0.5773502691896257) * per_length
        square = u * u
        r = math.sqrt(1.0 + square)
        d = k_minus_e(square)
        log_u = 0.5 * math.log(square)
        depth += half * (2.0 * r * d + 2.0 * log_u)
        bend += half * (d / r + log_u)
    return depth - 2.0 * logarithm, (bend - logarithm) * per_length * per_length


@compiled(fastmath=AS_REAL_NUMBERS)
def _solve_active(matrix, wanted, active, pressure, work):
    """Pressures of the active strips for the wanted depths: elimination without pivoting.

    The matrix is that of an elastic body, positive in every part.
    """
    size = 0
    count = len(wanted)
    places = np.empty(count, np.int64)
    for i in range(count):
        pressure[i] = 0.0
        if active[i]:
            places[size] = i
            size += 1
    right = np.empty(size)
    for i in range(size):
        right[i] = wanted[places[i]]
        for j in range(size):
            work[i, j] = matrix[places[i], places[j]]
    for k in range(size):
        for i in range(k + 1, size):
            factor = work[i, k] / work[k, k]
            for j in range(k + 1, size):
                work[i, j] -= factor * work[k, j]
            right[i] -= factor * right[k]
    for i in range(size - 1, -1, -1):
        total = right[i]
        for j in range(i + 1, size):
            total -= work[i, j] * right[j]
        right[i] = total / work[i, i]
        pressure[places[i]] = right[i]


@compiled(fastmath=AS_REAL_NUMBERS)
def _contact(matrix, wanted, active, pressure, work):
    """Pressures >= 0 whose displacement is the depth where they act, and not less elsewhere."""
    count = len(wanted)
    for _ in range(40):
        _solve_active(matrix, wanted, active, pressure, work)
        changed = False
        for i in range(count):
            if active[i] and pressure[i] < 0.0:
                active[i] = False
                pressure[i] = 0.0
                changed = True
        if changed:
            continue
        for i in range(count):
            if not active[i]:
                left = wanted[i]
                for j in range(count):
                    left -= matrix[i, j] * pressure[j]
                if left > 1.0e-12:
                    active[i] = True
                    changed = True
        if not changed:
            break


@compiled(fastmath=AS_REAL_NUMBERS)
def _lay_strips(table, side, lobe, strips, axle):
    """Fill the strips of a lobe: from where it enters the rail to where it leaves it."""
    left = zone_end(table, side, lobe, lobe.left, 0.0, axle)
    right = zone_end(table, side, lobe, lobe.right, 0.0, axle)
    width = (right - left) / STRIPS_A_LOBE
    for k in range(STRIPS_A_LOBE):
        strip = strips[k]
        arc = left + (k + 0.5) * width
        px, py, pz, ny, nz, radius, _, _ = wheel_point(table, side, arc, axle)
        foot = grid_foot(table, side, arc, axle)
        foot, _, _, _, _ = rail_foot(table, side, py, pz, foot)
        foot, ty, tz, _, height = rail_foot(table, side, py, pz, foot)
        ny = -tz - ny
        nz = ty - nz
        length = math.sqrt(ny * ny + nz * nz)
        strip.arc = arc
        strip.foot = foot
        strip.width = width
        strip.depth = max(-height, 0.0)
        strip.normal_y = ny / length
        strip.normal_z = nz / length
        strip.x = px
        strip.y = py - axle.y
        strip.z = pz - axle.z
        strip.curvature = 0.5 * strip.normal_z / radius


@compiled(fastmath=AS_REAL_NUMBERS)
def _lobe_curvatures(table, side, lobe, strips, axle):
    """Half curvatures of a lobe: along x at its deepest point, lateral averaged over it."""
    extent = VIRTUAL * lobe.penetration
    zone = zone_moments(table, side, lobe, lobe.penetration - extent, axle)
    place = int((lobe.arc - strips[0].arc) / strips[0].width + 0.5)
    along = strips[min(max(place, 0), STRIPS_A_LOBE - 1)].curvature
    return along, 16.0 / 9.0 * extent * extent * extent / (zone.total * zone.total)


@compiled(fastmath=AS_REAL_NUMBERS)
def begin_with_ellipse(strips, depth, along, lateral, material):
    """Give strips of a lobe the half lengths of Hertz's ellipse; return how local bending is.

    The ellipse reaches where the parabola through the lobe has fallen by B b^2; strips outside
    begin with half the length that their depth would have alone. The result is 1 where the
    curvature along x is a matter of the strip itself, 0 where a slender patch shares it.
    """
    _, a, b = hertz_from_approach(along, lateral, depth, material.shear_modulus, material.poisson)
    fall = lateral * b * b
    for k in range(len(strips)):
        inside = 1.0 - (depth - strips[k].depth) / fall
        outside = max(_OUTSIDE * strips[k].depth / depth, _LEAST_LENGTH * _LEAST_LENGTH)
        strips[k].half_length = a * math.sqrt(max(inside, outside))
        strips[k].pressure = inside
    return 1.0 / (1.0 + (a / (_SLENDER * b)) ** 2)


@compiled(fastmath=AS_REAL_NUMBERS)
def hertz_over_strips(along, lateral):
    """Force of Hertz's ellipse over that of its strips, for half curvatures A and B."""
    place = (math.log(lateral / along) - FACTOR_START) / FACTOR_STEP
    place = min(max(place, 0.0), len(HERTZ_OVER_STRIPS) - 1.000001)
    cell = int(place)
    low = HERTZ_OVER_STRIPS[cell]
    return low + (place - cell) * (HERTZ_OVER_STRIPS[cell + 1] - low)


@compiled(fastmath=AS_REAL_NUMBERS)
def press_strips(strips, locality, material):
    """Find pressure and half length of the strips of a side, all at once.

    strips: begun with ellipses; locality: of each lobe, from `begin_with_ellipse`.
    """
    size = len(strips)
    depth_of = np.empty((size, size))
    bend_of = np.empty((size, size))
    work = np.empty((size, size))
    pressure = np.empty(size)
    wanted = np.empty(size)
    bends = np.empty(size)
    misfit = np.empty(size)
    active = np.empty(size, np.bool_)
    for i in range(size):
        wanted[i] = strips[i].depth
        active[i] = strips[i].pressure > 0.0
    unit = (1.0 - material.poisson) / (math.pi * material.shear_modulus)
    for turn in range(ROUNDS):
        for i in range(size):
            one = strips[i]
            for j in range(size):
                other = strips[j]
                depth, bend = influence(one.arc - other.arc, other.width, other.half_length)
                cosine = one.normal_y * other.normal_y + one.normal_z * other.normal_z
                depth_of[i, j] = unit * cosine * depth
                bend_of[i, j] = unit * cosine * bend
        _contact(depth_of, wanted, active, pressure, work)
        if turn == ROUNDS - 1:
            break
        for i in range(size):
            total = 0.0
            for j in range(size):
                bend_of[i, j] *= pressure[j]
                total += bend_of[i, j]
            bends[i] = total
            misfit[i] = 0.0
            if active[i]:
                misfit[i] = math.log(min(max(total / strips[i].curvature, 0.3), 3.0))
        for i in range(size):
            mean = 0.0
            for j in range(size):
                mean += bend_of[i, j] * misfit[j]
            local = locality[i // STRIPS_A_LOBE]
            mean = local * misfit[i] + (1.0 - local) * mean / bends[i]
            strips[i].half_length *= math.exp(0.5 * mean)
    for i in range(size):
        strips[i].pressure = pressure[i]


@compiled(fastmath=AS_REAL_NUMBERS)
def solve_strips(table, side, lobes, count, strips, material, axle):
    """Fill the strips of the lobes of a side: place, half length [m], pressure [Pa]."""
    locality = np.empty(count)
    factors = np.empty(count)
    for k in range(count):
        own = strips[k * STRIPS_A_LOBE : (k + 1) * STRIPS_A_LOBE]
        _lay_strips(table, side, lobes[k], own, axle)
        along, lateral = _lobe_curvatures(table, side, lobes[k], own, axle)
        locality[k] = begin_with_ellipse(own, lobes[k].penetration, along, lateral, material)
        factors[k] = hertz_over_strips(along, lateral)
    press_strips(strips[: count * STRIPS_A_LOBE], locality, material)
    for k in range(count * STRIPS_A_LOBE):
        strips[k].pressure *= factors[k // STRIPS_A_LOBE]
