"""Compiled arithmetic of collocation: condensing an orbit's linear equations, and solving them.

An orbit has N intervals of m nodes with n states; w, T, S are an interval's width, the time that
the stored part takes, and V, D the values and slopes of the m + 1 polynomials at the nodes. Node k
of an interval gives, for changes y_0 .. y_m of its points and q = (x(0), T, V),

    sum_j (D_kj - w T V_kj J_k) y_j - w (f_k dT + T df/dV_k dV) = -defect_k             (1)

so that y_1 .. y_m = influence (y_0, dT, dV) + local, and y_m begins the next interval. The blocks
are inverted once; every correction is then products of matrices and vectors. All in scales.
"""

from __future__ import annotations

import numpy as np

from exudyn_wheelset.compilation import compiled


@compiled
def condense_intervals(
    by_state, by_period, by_speed, widths, duration, values, slopes, inverse, propagation, points
):
    """Fill inverse (N, m n, m n), propagation (N, m n, n) and points (N, m + 1, n, n + 2).

    by_state (N m, n, n); by_period, by_speed (N m, n): what stands beside w dT and w dV in (1).
    Raises LinAlgError or ValueError where an interval's block is singular or not finite.
    """
    intervals, degree, size = widths.shape[0], values.shape[0], by_state.shape[1]
    rows = degree * size
    block, known = np.empty((rows, rows)), np.empty((rows, size + 2))
    start = np.zeros((size, size + 2))
    for a in range(size):
        start[a, a] = 1.0
    for i in range(intervals):
        for k in range(degree):
            node = i * degree + k
            for a in range(size):
                row = k * size + a
                for j in range(degree):
                    share = -widths[i] * duration * values[k, j + 1]
                    for b in range(size):
                        block[row, j * size + b] = share * by_state[node, a, b]
                    block[row, j * size + a] += slopes[k, j + 1]
                share = widths[i] * duration * values[k, 0]
                for b in range(size):
                    known[row, b] = share * by_state[node, a, b]
                known[row, a] -= slopes[k, 0]
                known[row, size] = widths[i] * by_period[node, a]
                known[row, size + 1] = widths[i] * by_speed[node, a]
        inverse[i] = np.linalg.inv(block)
        influence = inverse[i] @ known
        propagation[i] = influence[:, :size]
        inner = propagation[i] @ start
        points[i, 0] = start
        for row in range(rows):
            inner[row, size] += influence[row, size]
            inner[row, size + 1] += influence[row, size + 1]
            points[i, 1 + row // size, row % size] = inner[row]
        start = points[i, degree].copy()


@compiled
def bordered_matrix(points, closure, forms, ends):
    """Matrix (n + 2, n + 2) of q: the closing condition, then two linear forms.

    forms (2, N, m + 1, n) with ends (2, 2), their coefficients of period and speed.
    """
    intervals, count, size, columns = points.shape
    matrix = np.empty((columns, columns))
    for a in range(size):
        matrix[a] = points[intervals - 1, count - 1, a]
        matrix[a, a] -= closure[a]
    flat = points.reshape(intervals * count * size, columns)
    for line in range(2):
        matrix[size + line] = np.dot(forms[line].reshape(intervals * count * size), flat)
        matrix[size + line, size] += ends[line, 0]
        matrix[size + line, size + 1] += ends[line, 1]
    return matrix


@compiled
def solve_condensed(inverse, propagation, points, forms, solution, defects, values):
    """Changes (N, m + 1, n) of an orbit and q (n + 2) that remove the defects (N, m, n) and give
    the forms their values (2); solution (n + 2, n + 2): (pseudo-)inverse of `bordered_matrix`."""
    intervals, count, size, columns = points.shape
    rows = (count - 1) * size
    change = np.empty((intervals, count, size))
    start = np.zeros(size)
    for i in range(intervals):
        inner = np.dot(propagation[i], start) - np.dot(inverse[i], defects[i].reshape(rows))
        change[i, 0] = start
        for row in range(rows):
            change[i, 1 + row // size, row % size] = inner[row]
        start = change[i, count - 1].copy()
    flat = change.reshape(intervals * count * size)
    right = np.empty(columns)
    right[:size] = -start
    for line in range(2):
        form = forms[line].reshape(intervals * count * size)
        right[size + line] = values[line] - np.dot(form, flat)
    base = np.dot(solution, right)
    flat += np.dot(points.reshape(intervals * count * size, columns), base)
    return change, base


@compiled
def speed_functional(inverse, propagation, forms, solution):
    """Weights (N, m, n) of the defects in the speed that `solve_condensed` gives, by the transposed
    equations."""
    intervals, rows, size = propagation.shape
    count = forms.shape[2]
    last = solution[size + 1]
    weights = np.empty((intervals, count - 1, size))
    carried = -last[:size]
    for i in range(intervals - 1, -1, -1):
        felt = np.empty(rows)
        for j in range(1, count):
            for a in range(size):
                felt[(j - 1) * size + a] = -(
                    last[size] * forms[0, i, j, a] + last[size + 1] * forms[1, i, j, a]
                )
        felt[rows - size :] += carried
        weights[i] = -np.dot(inverse[i].T, felt).reshape(count - 1, size)
        carried = np.dot(propagation[i].T, felt)
        for a in range(size):
            carried[a] -= last[size] * forms[0, i, 0, a] + last[size + 1] * forms[1, i, 0, a]
    return weights


@compiled
def weighed(orbit, widths, gram, shares, odd):
    """Coefficients (N, m + 1, n) of the covariance with an orbit (N, m + 1, n) over the phase.

    gram (m + 1, m + 1) and shares (m + 1): integrals of products of the polynomials and of
    themselves; odd (n): states without a mean.
    """
    intervals, count, size = orbit.shape
    mean = np.zeros(size)
    for i in range(intervals):
        for j in range(count):
            for a in range(size):
                mean[a] += widths[i] * shares[j] * orbit[i, j, a]
    for a in range(size):
        if odd[a]:
            mean[a] = 0.0
    result = np.empty_like(orbit)
    for i in range(intervals):
        for j in range(count):
            for a in range(size):
                result[i, j, a] = -widths[i] * shares[j] * mean[a]
            for k in range(count):
                share = widths[i] * gram[j, k]
                for a in range(size):
                    result[i, j, a] += share * orbit[i, k, a]
    return result


@compiled
def at_nodes(states, weights):
    """Sums (N, k, n) of each interval's points, states (N m + 1, n), with weights (k, m + 1)."""
    rows, count = weights.shape
    size, degree = states.shape[1], count - 1
    intervals = (states.shape[0] - 1) // degree
    result = np.zeros((intervals, rows, size))
    for i in range(intervals):
        for k in range(rows):
            for j in range(count):
                for a in range(size):
                    result[i, k, a] += weights[k, j] * states[i * degree + j, a]
    return result


@compiled
def half_ranges(phases, values):
    """Half of the distance from the least to the largest value (n) of columns (k, n) over a
    period, extrema by parabolas through three samples; phases (k,), rising in [0, 1)."""
    count, size = values.shape
    result = np.zeros(size)
    for a in range(size):
        for sign in (1.0, -1.0):
            place = 0
            for k in range(count):
                if sign * values[k, a] > sign * values[place, a]:
                    place = k
            before, after = (place - 1) % count, (place + 1) % count
            middle = sign * values[place, a]
            left = (phases[place] - phases[before]) % 1.0
            right = (phases[after] - phases[place]) % 1.0
            slope_left = (middle - sign * values[before, a]) / left
            slope_right = (sign * values[after, a] - middle) / right
            curvature = 2.0 * (slope_right - slope_left) / (left + right)
            slope = (slope_left * right + slope_right * left) / (left + right)
            if curvature < 0.0:
                middle -= 0.5 * slope * slope / curvature
            result[a] += 0.5 * middle
    return result
