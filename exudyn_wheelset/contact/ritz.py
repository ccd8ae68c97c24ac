"""Normal contact as a stored energy: loads, and the forces that are its gradient.

p(s) is the penetration on the rail's normals, s the rail's arc length (gap.py), A(s) the half
curvature along rolling. Any pressure on a half-space of the gap p(s) - A x^2 gives

    W = int pressure (p - A x^2) - 1/2 int pressure u(pressure),

u the displacement; the true pressure makes W the greatest, and the greatest is the energy U that
is stored. Here pressure is a sum of semi-ellipsoids (c_k, b_k, a_k, N_k), c_k the place of the
centre (Ritz's method). With P(c, b), the mean of p(c + b x) over the load of the strips,
3/4 (1 - x^2) on (-1, 1), p a spline on a fixed grid of the rail (gap_spline.py),

    Pi = sum_k [N_k P(c_k, b_k) - W(N_k, b_k; A(c_k))] - sum_(k<l) N_k N_l T_kl           (1)

(W, T: ellipsoids.py). U is Pi where it is stationary in all c, b, N:

    by N:  P - dW/dN = sum_l N_l d(N_k T)/dN_k           the load that the approach makes
    by b:  b dP/db + 2/5 B b^2 = sum_l N_l dT/dln b      width
    by c:  dP/dc - a^2/5 dA/dc = sum_l N_l dT/dc         balance of moments about x

(a in T is W's, a function of N, b, A; its part is taken along). One ellipse alone is Hertz's of
the parabola that fits p over the ellipse itself, and where p is a parabola U = 2/5 N delta exactly.
Patches of a wheel sink in each other's field by N T, 1/(pi E* r) far apart.

Gradient. P = sum w_j p_j over the lines of the grid, and Pi is stationary in all but the pose, so
dU = sum_k N_k sum_j w_j dp_j: the rails push with loads N_k w_j on fixed lines, each along the
wheel's normal at its own point (gap.py). Exactly, whatever the spacing of the grid. For a rigid
approach along the gap all of them rise alike, and the force is sum N.

How many ellipses. One for each lobe of p that reaches deeper than the others' field: a lobe begins
as Hertz does, with N ~ depth^1.5. Where p bends sharply inside a patch (R300/R80 of a rail head) or
has a shoulder instead of a lobe, one ellipse misses the contact condition at its ends, p - u <> 0
there; beyond MISFIT of the approach the lobe gets a second one. With U_1 and U_2 the energies
without and with it, gain g = U_2/U_1 - 1,

    V(U_1, U_2) = U_1 (1 + s(g)),   s = 0 for small g, s = g for large, smooth between.      (2)

A lobe that dies in another's flank goes on as that shoulder's load. (1) may be stationary at more
than one place; a set's energy is the greatest of those found. While the valley between two lobes is
shallow (q from 0 to 1 with its depth, load_sets.py), U_0 without the lesser counts as well:

    U = q V(U_1, U_2) + (1 - q) V(U_0, U_1),                                               (3)

and the forces are the gradient of (3): sums of those of U_0, U_1, U_2 and a small one along grad q,
on lines at the two lobes and the valley.

Against half-space solutions of the same p (tests/test_contact_energy.py): U and N within 1 %, N in
the blend of (2) and under light loads within 3 %; U is low, as it must be.

Frame: track frame, left side; lengths in metres. Records LOAD, LOBE, WORK: layout.py.
"""

import math

from exudyn_wheelset.compilation import compiled
from exudyn_wheelset.contact.curve import curve_point
from exudyn_wheelset.contact.ellipsoids import coupling, fill, mean_distance
from exudyn_wheelset.contact.gap_spline import average

# (p - u)/approach at the end of an ellipse that asks for a second one; an end over nothing counts
# half. Gains of (2) at this misfit are below what it lets through.
MISFIT = 0.06
# The step after one of this size, relative, is about its square: forces are right to 2e-6, those
# of two loads that share a lobe, which a step changes by more, to 1e-6.
ALONE, TOLERANCE = 1.2e-3, 2.0e-5
MOST_STEPS = 40
# A load narrower than this part of the spacing of lines has come to nothing: means over it are
# differences of almost equal numbers.
NARROWEST = 0.03


@compiled
def look_along(table, side, load):
    """Half curvature of the gap along rolling at the load's place, and its relative slope."""
    _, r1, r2, rz, q1, _ = curve_point(table, side.rail, load.place)
    r = side.radius - rz
    upright = max(r1, 0.05)
    load.along = 0.5 * upright / r
    load.relative = (r2 / r1 if r1 > 0.05 else 0.0) + q1 / r


@compiled
def _look(table, side, load, work, modulus):
    """Fill what a LOAD is at its place, width and t."""
    look_along(table, side, load)
    fill(load, modulus)
    average(work.gap, load, side.line_start, 1.0 / side.line_spacing)


@compiled
def _own_equations(load, k, count, matrix):
    """Newton's equations of one load alone: dPi/dx over N for x = t, ln b, place.

    Rows and columns k, count + k, 2 count + k; of the last both are times b.
    """
    b = load.b
    wide = count + k
    aside = wide + count
    end = 3 * count
    rise = load.average - load.own
    by_wide = load.spread - 2.0 * load.own
    by_aside = b * (load.slope - load.relative * load.own)
    first = load.force_by_t
    matrix[k, end] = -first * rise
    matrix[wide, end] = -3.0 * rise - load.spread - 0.4 * load.width
    matrix[aside, end] = -b * (load.slope + load.relative * (load.average - 2.0 * load.work))
    matrix[k, k] = load.force_by_tt * rise - first * load.own_by_t
    matrix[k, wide] = first * by_wide
    matrix[k, aside] = first * by_aside
    matrix[wide, k] = 0.4 * load.width - 3.0 * load.own_by_t
    matrix[wide, wide] = 3.0 * by_wide + load.spread + load.spread_spread + 0.8 * load.width
    matrix[wide, aside] = 3.0 * by_aside + b * (
        load.slope_spread + 0.4 * load.width * load.relative
    )
    matrix[aside, k] = -2.0 * b * load.relative * first * (load.own - load.work)
    matrix[aside, wide] = b * (load.slope_spread + load.relative * (load.spread - 4.0 * load.work))
    matrix[aside, aside] = b * b * (load.bend + load.relative * load.slope)


@compiled
def _couple(
    me, other, k, j, count, matrix, t, c, v, u, lo, uo, cc, cl, cu, clo, cuo, ll, lu, uu,
    llo, luo, ulo, uuo,
):  # fmt: skip
    """What the other load adds to the equations of `me`; return its field N_other T.

    Derivatives of T by my place c, ln b (v), t (u) and the other's (lo, uo); by the other's place
    they are those by mine with the opposite sign.
    """
    n = other.force
    b = me.b
    first = me.force_by_t
    wide = count + k
    aside = wide + count
    end = 3 * count
    relative = me.relative
    matrix[k, end] += n * (first * t + u)
    matrix[wide, end] += n * (3.0 * t + v)
    matrix[aside, end] += n * b * (c + relative * t)
    matrix[k, k] -= n * (me.force_by_tt * t + first * u + uu)
    matrix[k, wide] -= n * (first * v + lu)
    matrix[k, aside] -= n * b * (first * c + cu)
    matrix[wide, k] -= n * (3.0 * u + lu)
    matrix[wide, wide] -= n * (3.0 * v + ll)
    matrix[wide, aside] -= n * b * (3.0 * c + cl)
    matrix[aside, k] -= n * b * (cu + relative * u)
    matrix[aside, wide] -= n * b * (cl + relative * v)
    matrix[aside, aside] -= n * b * b * (cc + relative * c)
    wider = count + j
    beside = wider + count
    o = other.b
    grow = other.force_by_t
    shift = other.relative
    matrix[k, j] -= n * (first * (grow * t + uo) + grow * u + uuo)
    matrix[k, wider] -= n * (first * (3.0 * t + lo) + 3.0 * u + ulo)
    matrix[k, beside] -= n * o * (first * (shift * t - c) + shift * u - cu)
    matrix[wide, j] -= n * (3.0 * (grow * t + uo) + grow * v + luo)
    matrix[wide, wider] -= n * (3.0 * (3.0 * t + lo) + 3.0 * v + llo)
    matrix[wide, beside] -= n * o * (3.0 * (shift * t - c) + shift * v - cl)
    matrix[aside, j] -= n * b * (grow * c + cuo)
    matrix[aside, wider] -= n * b * (3.0 * c + clo)
    matrix[aside, beside] -= n * b * o * (shift * c - cc)
    return n * t


@compiled
def _equations(loads, count, modulus, work):
    """Fill Newton's equations of all loads; return Pi."""
    matrix = work.matrix
    x = work.coupling
    end = 3 * count
    for k in range(end):
        for j in range(end + 1):
            matrix[k, j] = 0.0
    energy = 0.0
    for k in range(count):
        load = loads[k]
        load.sunk = 0.0
        _own_equations(load, k, count, matrix)
        energy += load.force * (load.average - load.work)
    for k in range(count):
        for j in range(k + 1, count):
            one = loads[k]
            two = loads[j]
            coupling(one, two, modulus, x)
            one.sunk += _couple(
                one, two, k, j, count, matrix, x.total, -x.r, x.l1, x.t1, x.l2, x.t2,
                x.rr, -x.rl1, -x.rt1, -x.rl2, -x.rt2,
                x.l1l1, x.l1t1, x.t1t1, x.l1l2, x.l1t2, x.t1l2, x.t1t2,
            )  # fmt: skip
            two.sunk += _couple(
                two, one, j, k, count, matrix, x.total, x.r, x.l2, x.t2, x.l1, x.t1,
                x.rr, x.rl2, x.rt2, x.rl1, x.rt1,
                x.l2l2, x.l2t2, x.t2t2, x.l1l2, x.t1l2, x.l1t2, x.t1t2,
            )  # fmt: skip
            energy -= one.force * two.force * x.total
    return energy


@compiled
def _solve(loads, count, matrix):
    """Solve the equations in place; the step stands in the last column.

    Where Pi is greatest, all pivots are negative. One that is not is turned round, so that the
    step leads uphill from anywhere.
    """
    size = 3 * count
    for k in range(size):
        pivot = matrix[k, k]
        load = loads[k % count]
        floor = 0.05 * load.force_by_t * load.own_by_t if k < count else 0.2 * load.width
        if not pivot < -floor:
            pivot = -max(abs(pivot), floor)
            matrix[k, k] = pivot
        inverse = 1.0 / pivot
        for i in range(k + 1, size):
            factor = matrix[i, k] * inverse
            for j in range(k + 1, size + 1):
                matrix[i, j] -= factor * matrix[k, j]
    for k in range(size - 1, -1, -1):
        rest = matrix[k, size]
        for j in range(k + 1, size):
            rest -= matrix[k, j] * matrix[j, size]
        matrix[k, size] = rest / matrix[k, k]


@compiled
def _first_forces(loads, count, modulus, sweeps):
    """Bring t of each load to where dPi/dN is near zero at its place and width."""
    for _ in range(sweeps):
        for k in range(count):
            load = loads[k]
            rest = load.average
            for j in range(count):
                if j != k:
                    other = loads[j]
                    rest -= other.force * mean_distance(
                        other.place - load.place, load.a * load.a, load.b * load.b,
                        other.a * other.a, other.b * other.b, modulus,
                    )  # fmt: skip
            for _ in range(6):
                step = (rest - load.own) / load.own_by_t
                if abs(step) < 1.0e-5:
                    break
                load.t = min(max(load.t + min(max(step, -2.0), 2.0), -20.0), 20.0)
                fill(load, modulus)
        if count == 1:
            break


@compiled
def _alone(table, side, load, modulus, work):
    """`stationary` for one load by plain steps of Newton's method: whether they led there, and Pi.

    The same equations as `_own_equations`, rows and columns t, ln b, place; solved by elimination.
    """
    for _ in range(8):
        _look(table, side, load, work, modulus)
        rise = load.average - load.own
        first = load.force_by_t
        relative = load.relative
        by_wide = load.spread - 2.0 * load.own
        by_aside = load.slope - relative * load.own
        m00 = load.force_by_tt * rise - first * load.own_by_t
        m01 = first * by_wide
        m02 = first * by_aside
        r0 = -first * rise
        down = (0.4 * load.width - 3.0 * load.own_by_t) / m00
        m11 = 3.0 * by_wide + load.spread + load.spread_spread + 0.8 * load.width - down * m01
        m12 = 3.0 * by_aside + load.slope_spread + 0.4 * load.width * relative - down * m02
        r1 = -3.0 * rise - load.spread - 0.4 * load.width - down * r0
        down = -2.0 * relative * first * (load.own - load.work) / m00
        m21 = load.slope_spread + relative * (load.spread - 4.0 * load.work) - down * m01
        m22 = load.bend + relative * load.slope - down * m02
        r2 = -load.slope - relative * (load.average - 2.0 * load.work) - down * r0
        down = m21 / m11
        m22 -= down * m12
        if not (m00 < 0.0 and m11 < 0.0 and m22 < 0.0):
            return False, 0.0
        aside = (r2 - down * r1) / m22
        wider = (r1 - m12 * aside) / m11
        rounder = (r0 - m01 * wider - m02 * aside) / m00
        largest = max(abs(aside) / load.b, abs(wider), 0.3 * abs(rounder))
        if not largest < 0.3:
            return False, 0.0
        energy = load.force * (load.average - load.work)
        load.t += rounder
        load.place += aside
        load.b *= 1.0 + wider * (1.0 + wider * (0.5 + wider / 6.0))
        if largest < ALONE:
            fill(load, modulus)
            return energy > 0.0, energy
    return False, 0.0


@compiled
def stationary(table, side, loads, count, modulus, work):
    """Bring the loads from near guesses of place, b and t to where (1) is stationary.

    Newton's method on a function that is to become greatest: a step after which it is less is
    taken back and damped. Returns (number of loads left, energy [J]); loads that come to nothing
    are taken out. Number 0: not found, as it is centimetres deep in the rail.
    """
    matrix = work.matrix
    kept = work.kept
    if count == 1:
        kept[0] = loads[0]
        found, energy = _alone(table, side, loads[0], modulus, work)
        if found:
            return 1, energy
        loads[0] = kept[0]
    damping = 0.0
    best = -1.0e300
    least = NARROWEST * side.line_spacing
    for step in range(MOST_STEPS):
        total = 0.0
        for k in range(count):
            _look(table, side, loads[k], work, modulus)
        if step == 0 and count > 1:
            _first_forces(loads, count, modulus, 3)
        for k in range(count):
            total += loads[k].force
        left = 0
        for k in range(count):
            if loads[k].force > 1.0e-8 * total and loads[k].b > least:
                if left != k:
                    loads[left] = loads[k]
                left += 1
        if left < count:
            count = left
            best = -1.0e300
        if count == 0:
            return 0, 0.0
        energy = _equations(loads, count, modulus, work)
        if energy < best - 1.0e-7 * abs(best):
            for k in range(count):
                loads[k] = kept[k]
            damping = max(4.0 * damping, 0.3)
            _equations(loads, count, modulus, work)
        else:
            for k in range(count):
                kept[k] = loads[k]
            best = energy
            damping = 0.25 * damping if damping > 0.1 else 0.0
        end = 3 * count
        if damping > 0.0:
            for k in range(count):
                width = damping * loads[k].width
                matrix[k, k] -= damping * loads[k].force_by_t * loads[k].own_by_t
                matrix[count + k, count + k] -= width
                matrix[2 * count + k, 2 * count + k] -= 2.0 * width
        _solve(loads, count, matrix)
        over = 1.0
        largest = 0.0
        for k in range(count):
            rounder = abs(matrix[k, end])
            wider = abs(matrix[count + k, end])
            aside = abs(matrix[2 * count + k, end])
            over = max(over, aside / 0.4, wider / 0.4, 0.5 * rounder)
            largest = max(largest, aside, wider, 0.3 * rounder)
        if not over < 1.0e300:
            return 0, 0.0
        for k in range(count):
            load = loads[k]
            load.t += matrix[k, end] / over
            load.place += matrix[2 * count + k, end] / over * load.b
            load.b *= math.exp(matrix[count + k, end] / over)
        if largest < (ALONE if count == 1 else TOLERANCE):
            for k in range(count):
                fill(loads[k], modulus)
            return (count, energy) if energy > 0.0 else (0, 0.0)
    for k in range(count):
        loads[k] = kept[k]
    return (count, best) if best > 0.0 else (0, 0.0)
