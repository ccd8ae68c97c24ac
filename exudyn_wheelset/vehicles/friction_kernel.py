"""Dry friction in the compiled call: what presses, how far the hold is strained, what resists.

A contact that is pressed by N resists sliding at the velocity u (1 to 3 components) with

    F = mu N (h + T h'),   h' = (u - |u| h)/delta,

h the strained part of the hold, 0 relaxed and |h| = 1 slipping, delta the presliding displacement,
T a time of damping of the hold. At constant load and T = 0 this is the law "elastic, then slipping"

    F' = k (u - |u| F/F_slip),   F_slip = mu N,   k = F_slip/delta

(P. Dahl, A solid friction model, Aerospace Corporation, TOR-0158(3107-18)-1, 1968; T as the damping
of the bristles of C. Canudas de Wit et al., IEEE Trans. Automatic Control 40 (1995) 419-425). It
does not depend on the rate; the kink of |u| is left, so that nothing creeps at rest. Held in h, a
contact without load has no force, no stiffness and no fast rate. Coupled components slip on a
circle: |u| is that of the vector.

Pressure, over the displacement d and the rotation theta of the upper end (kernel.py), c the
compression:

    CONSTANT     N given
    PRESSED      N = k c, c = c0 - d_z >= 0, pushes along z; beyond a gap it begins over a width w
                 as k c^2/(2 w), so that neither force nor stiffness jumps
    HUNG         as PRESSED on links of the lengths L_x, L_y, whose ends rise by x^2/(2 L):
                 c = c0 - d_z + x^2/(2 L_x) + y^2/(2 L_y); N x/L_x, N y/L_y bring it back
    DISC         a flat disc of radius R on a bed that only pushes: `disc`
    WEDGE        S = k c of a spring (or S given) presses a wedge on a column: `column_force`; its
                 face, where it has a stiffness, is squeezed and tilted: `column_face`

Every pressure but the wedge's on its column is the derivative of a potential.
"""

from __future__ import annotations

import math

from exudyn_wheelset.compilation import compiled

# Friction on the faces of a wedge beyond which its column force changes no more.
STEEPEST = 1.5
# Kinds of pressure.
CONSTANT, PRESSED, HUNG, DISC, WEDGE = 0, 1, 2, 3, 4
# Places in the data of a law.
(
    P_KIND,
    P_STIFFNESS,
    P_COMPRESSION,
    P_ONSET,
    P_FORCE,
    P_RADIUS,
    P_TILT_X,
    P_TILT_Y,
    P_PLAY,
    P_STOP,
    P_STOP_ONSET,
    P_LENGTH_X,
    P_LENGTH_Y,
    P_TANGENT,
    P_SLOPE,
    P_DAMPING_TIME,
    P_COUPLED,
    P_COUNT,
    P_BED,
    P_SIDE,
    P_RELAXED,
) = range(21)
P_COMPONENTS = 21
# Of a component: sliding velocity as a row over (d', w1 - w0), friction, presliding displacement.
C_FRICTION, C_PRESLIDING = 6, 7
COMPONENT = 8


@compiled
def pressed(c, stiffness, onset):
    """Force [N] and potential [J] of a spring that only pushes, compressed by c [m]."""
    if c <= 0.0:
        return 0.0, 0.0
    if c < onset:
        return stiffness * c * c / (2.0 * onset), stiffness * c**3 / (6.0 * onset)
    beyond = c - 0.5 * onset
    return stiffness * beyond, 0.5 * stiffness * (beyond * beyond + onset * onset / 12.0)


@compiled
def disc(c, tilt, radius, stiffness):
    """Force [N], moment [N m] against the tilt and potential [J] of a disc on a pushing bed.

    The bed's stiffness per area is stiffness/(pi R^2); at t R along the tilt it is compressed by
    c + tilt R t where that is positive, for t > t0. With the chord 2 R sqrt(1 - t^2),
    I_n = integral of t^n sqrt(1 - t^2) from t0 to 1,

        N = (2 k/pi) (c I_0 + tilt R I_1),   M = (2 k R/pi) (c I_1 + tilt R I_2),
        U = (k/pi) (c^2 I_0 + 2 c tilt R I_1 + (tilt R)^2 I_2).

    All of it carries for c > tilt R: k c and (k R^2/4) tilt; far beyond, M tends to N R, rocking
    on the edge; nothing is left for c < -tilt R.
    """
    rise = tilt * radius
    if c <= -rise:
        return 0.0, 0.0, 0.0
    i0, i1, i2 = 0.5 * math.pi, 0.0, 0.125 * math.pi
    if c < rise:
        t = -c / rise
        root = math.sqrt(max(0.0, 1.0 - t * t))
        angle = math.acos(t)
        i0 = 0.5 * (angle - t * root)
        i1 = root**3 / 3.0
        i2 = 0.125 * (angle + t * root * (1.0 - 2.0 * t * t))
    force = 2.0 * stiffness / math.pi * (c * i0 + rise * i1)
    moment = 2.0 * stiffness * radius / math.pi * (c * i1 + rise * i2)
    energy = stiffness / math.pi * (c * c * i0 + 2.0 * c * rise * i1 + rise * rise * i2)
    return force, moment, energy


@compiled
def column_force(spring_force, hold, tangent, friction, slope_friction):
    """Normal force [N] of a wedge on its column; `hold` is the strain of its hold, 1 in loading.

    A wedge without mass stands between a vertical column and a face of the bolster at the angle a
    from the vertical, on a spring S. Going down with the bolster (loading) it is held back, upward,
    by the column, and pressed into its pocket, where the slope holds it back, downward. With the
    friction angle phi = atan(mu_s h) of the slope its force on the wedge leans by a + phi:

        N = R cos(a + phi),   S + mu h N = R sin(a + phi),   so   N = S/(tan(a + phi) - mu h)

    and, with h = -1 in unloading, S/(tan(a - phi) + mu): the two limits of the patent US 6269752
    (D. V. Taylor). Relaxed it is S/tan(a). Where the slope alone holds the wedge (a + phi of 90
    degrees and more) nothing is left for the column. Frictions above STEEPEST stand for a rigid
    hold, whose column force is that of STEEPEST.
    """
    friction = min(friction, STEEPEST)
    slope = min(slope_friction, STEEPEST) * hold
    # tan(a + phi) = (tan a + slope)/(1 - slope tan a), put under one fraction.
    above = 1.0 - slope * tangent
    below = tangent + slope - friction * hold * above
    return spring_force * above / below if above > 0.0 and below > 0.0 else 0.0


@compiled
def column_force_slope(spring_force, hold, tangent, friction, slope_friction):
    """Derivative [N] of `column_force` by the hold."""
    friction = min(friction, STEEPEST)
    steep = min(slope_friction, STEEPEST)
    above = 1.0 - steep * hold * tangent
    below = tangent + steep * hold - friction * hold * above
    if above <= 0.0 or below <= 0.0 or abs(hold) >= 1.0:
        return 0.0
    by_hold = steep - friction * above + friction * hold * steep * tangent
    return spring_force * (-steep * tangent * below - above * by_hold) / (below * below)


@compiled
def column_face(normal, grown, block, at, strain, speeds, g, drag):
    """Normal force [N] of a wedge's face on its column, energy [J] and power [W]; fills g and drag.

    normal: of `column_force`, growing at the rate `grown` [N/s]. The face is a disc of radius R on
    a bed of stiffness k between wedge and column, compressed by N0/k by the wedge's own force N0,
    by the way s x on which the bolster nears the column (s = 1 ahead of it, -1 behind it), and by
    tilting: its turning about z (warp of the truck) and about y (pitch). `disc` gives N and the
    moment, up to N R. What a like wedge on the other side holds when relaxed is taken off along x.
    Stored is U - N0^2/(2 k) - s x N0(relaxed); the change (N - N0) N0'/k of it is none of the
    forces': the wedge's spring makes it.
    """
    bed, side, radius = block[at + P_BED], block[at + P_SIDE], block[at + P_RADIUS]
    ty, tz = strain[4], strain[5]
    tilt = math.sqrt(ty * ty + tz * tz)
    own = normal / bed
    total, moment, stored = disc(own + side * strain[0], tilt, radius, bed)
    relaxed = block[at + P_RELAXED]
    g[0] = side * (total - relaxed)
    if tilt > 0.0:
        g[4] = moment * ty / tilt
        g[5] = moment * tz / tilt
    energy = stored - 0.5 * normal * own - side * strain[0] * relaxed
    power = -(total - normal) * grown / bed
    if total > 0.0:
        resisting = bed * block[at + P_DAMPING_TIME]
        turning = 0.25 * radius * radius * resisting
        drag[0] = resisting * speeds[0]
        drag[4] = turning * speeds[4]
        drag[5] = turning * speeds[5]
        power += drag[0] * speeds[0] + drag[4] * speeds[4] + drag[5] * speeds[5]
    return total, energy, power


@compiled
def friction_law(block, at, strain, speeds, states, first, rates, own, g, drag):
    """Potential forces g (6) and resisting forces drag (6), rates of the holds; energy and power.

    block[at:]: data of the law; strain, speeds (6): as in kernel.py; the holds stand at
    states[first:], their rates go to rates[own:]. Energy [J] of the pressures; power [W] that the
    friction takes, some of which a strained hold gives back.
    """
    kind = int(block[at + P_KIND])
    stiffness = block[at + P_STIFFNESS]
    count = int(block[at + P_COUNT])
    friction = block[at + P_COMPONENTS + C_FRICTION]
    energy = 0.0
    for i in range(6):
        g[i] = 0.0
        drag[i] = 0.0
    normal = block[at + P_FORCE]
    c = block[at + P_COMPRESSION] - strain[2]
    if kind == DISC:
        # Compressed by c + theta_y x - theta_x y at (x, y).
        tx, ty = strain[3] + block[at + P_TILT_X], strain[4] + block[at + P_TILT_Y]
        tilt = math.sqrt(tx * tx + ty * ty)
        normal, moment, energy = disc(c, tilt, block[at + P_RADIUS], stiffness)
        g[2] = -normal
        if tilt > 0.0:
            g[3] = moment * tx / tilt
            g[4] = moment * ty / tilt
        out = math.sqrt(strain[0] * strain[0] + strain[1] * strain[1])
        beyond = out - block[at + P_PLAY]
        if beyond > 0.0:
            stop, stored = pressed(beyond, block[at + P_STOP], block[at + P_STOP_ONSET])
            energy += stored
            g[0] = stop * strain[0] / out
            g[1] = stop * strain[1] / out
    elif kind == HUNG:
        x, y = strain[0], strain[1]
        lx, ly = block[at + P_LENGTH_X], block[at + P_LENGTH_Y]
        c += 0.5 * x * x / lx + 0.5 * y * y / ly
        normal, energy = pressed(c, stiffness, 0.0)
        g[0] = normal * x / lx
        g[1] = normal * y / ly
        g[2] = -normal
    elif kind != CONSTANT and stiffness > 0.0:
        normal, energy = pressed(c, stiffness, block[at + P_ONSET])
        g[2] = -normal
    spring_force = normal
    hold, tangent, slope = 0.0, block[at + P_TANGENT], block[at + P_SLOPE]
    if kind == WEDGE:
        # The second component is the vertical one; upward motion of the upper body unloads.
        hold = min(1.0, max(-1.0, -states[first + 1]))
        normal = column_force(spring_force, hold, tangent, friction, slope)
    total = 0.0
    for i in range(count):
        place = at + P_COMPONENTS + COMPONENT * i
        u = 0.0
        for j in range(6):
            u += block[place + j] * speeds[j]
        rates[own + i] = u
        total += u * u
    total = math.sqrt(total)
    coupled = block[at + P_COUPLED] > 0.0
    time = block[at + P_DAMPING_TIME]
    power = 0.0
    if kind == WEDGE and block[at + P_BED] > 0.0:
        down = -rates[own + 1]
        presliding = block[at + P_COMPONENTS + COMPONENT + C_PRESLIDING]
        grown = column_force_slope(spring_force, hold, tangent, friction, slope)
        grown *= (down - (total if coupled else abs(down)) * hold) / presliding
        if stiffness > 0.0 and spring_force > 0.0:
            grown -= normal / spring_force * stiffness * speeds[2]
        normal, stored, power = column_face(normal, grown, block, at, strain, speeds, g, drag)
        energy += stored
    for i in range(count):
        place = at + P_COMPONENTS + COMPONENT * i
        u = rates[own + i]
        hold = states[first + i]
        sliding = total if coupled else abs(u)
        rate = (u - sliding * hold) / block[place + C_PRESLIDING]
        rates[own + i] = rate
        force = block[place + C_FRICTION] * normal * (hold + time * rate)
        power += force * u
        for j in range(6):
            drag[j] += block[place + j] * force
    return energy, power


@compiled
def monotone_hold(block, at, strain, holds, own):
    """Holds, from relaxed ones, after a straight way to `strain` (6): 1 - exp(-way/delta)."""
    count = int(block[at + P_COUNT])
    total = 0.0
    for i in range(count):
        place = at + P_COMPONENTS + COMPONENT * i
        way = 0.0
        for j in range(6):
            way += block[place + j] * strain[j]
        holds[own + i] = way
        total += way * way
    total = math.sqrt(total)
    coupled = block[at + P_COUPLED] > 0.0
    for i in range(count):
        way = holds[own + i]
        length = total if coupled else abs(way)
        if length > 0.0:
            presliding = block[at + P_COMPONENTS + COMPONENT * i + C_PRESLIDING]
            holds[own + i] = -math.expm1(-length / presliding) * way / length
