"""The output error as one would write it with numba: one candidate at a time, a compiled loop over the rows.

Equation (1) is integrated exactly over each period, in which the voltage vector stands still in the stator; the first current, and of
centred voltages the first vector, are solved for inside. Two ways to know what a period does to the current, `i' = F i + G u + h`:

- exact: the exponential of a 2 x 2 matrix in closed form for every row;
- polynomials: F, G and h as polynomials of the squared turn per period, through the exact ones at Chebyshev nodes.

SI units; voltages in the frame at the middle of the period.
"""

import math

import numba
import numpy as np

SMOOTHED = 25  # rows to either side over which the steps of the logged angle are averaged, twice
COEFFICIENTS = 4  # of each polynomial; its error is below 1e-14 at the paper's 0.042 rad a row
BLOCK = 64  # rows between two looks at the response to the first current
DIED_OUT = 1e-12  # A per A: the response is left alone from here on
TURN, PLACE, U_D, U_Q, A_D, A_Q, COS, SIN = range(8)  # columns of a period

# All of it in one file and at the top level, so that numba keeps what it compiled from one run to the next.
compiled = numba.njit(cache=True, fastmath=True, error_model="numpy")
inlined = numba.njit(inline="always", fastmath=True, error_model="numpy")


def moving_mean(series):
    """Of as many rows on one side as on the other: fewer near the ends."""
    sums = np.concatenate([[0.0], np.cumsum(series)])
    row = np.arange(len(series))
    reach = np.minimum(SMOOTHED, np.minimum(row, len(series) - 1 - row))
    return (sums[row + reach + 1] - sums[row - reach]) / (2 * reach + 1)


class Rows:
    """A log without gaps: its periods and measured currents as columns, and the squared turns' range."""

    def __init__(self, path, centred):
        columns = np.genfromtxt(path, delimiter=",", names=True)
        t, omega_e, logged = columns["t"], columns["omega_e"], np.unwrap(columns["theta_e"])
        summed = np.concatenate([[0.0], np.cumsum(0.5 * (omega_e[1:] + omega_e[:-1]) * np.diff(t))])
        rotor = summed + moving_mean(moving_mean(logged - summed))
        length, turn, middle = np.diff(t), np.diff(rotor), 0.5 * (rotor[1:] + rotor[:-1])
        voltage = (columns["ud"] + 1j * columns["uq"])[:-1]
        sign = np.where(np.arange(len(turn)) % 2 == 0, 1.0, -1.0)
        if centred:  # V_k = 2 U_k - V_(k-1) in the stator's frame; the mean at the first row stands in for the vector before it
            mean = voltage * np.exp(1j * logged[:-1])
            stator = sign * (np.cumsum(2 * sign * mean) - mean[0])
        else:  # the drive has advanced the angle by half a period
            stator = voltage * np.exp(1j * (logged[:-1] + 0.5 * omega_e[:-1] * length))
        u = stator * np.exp(-1j * middle)
        alternating = sign * np.exp(-1j * middle)
        square = turn**2
        self.middle, self.reach = 0.5 * (square.max() + square.min()), 0.5 * (square.max() - square.min())
        self.length = length.mean()
        place = (square - self.middle) / self.reach
        half = np.exp(0.5j * turn)
        parts = [turn, place, u.real, u.imag, alternating.real, alternating.imag, half.real, half.imag]
        self.periods = np.ascontiguousarray(np.column_stack(parts))
        current = (columns["id"] + 1j * columns["iq"]) * np.exp(1j * (logged - rotor))
        self.measured = np.ascontiguousarray(np.column_stack([current.real, current.imag]))
        self.centred = centred
        nodes = np.cos(np.pi * (np.arange(COEFFICIENTS) + 0.5) / COEFFICIENTS)
        self.node_turns = np.sqrt(np.maximum(self.middle + self.reach * nodes, 1e-18))
        # From values at the nodes to coefficients; at Chebyshev nodes, least squares of a lower degree is the truncated series.
        self.even = np.linalg.inv(np.vander(nodes, increasing=True))
        self.odd = np.linalg.pinv(np.vander(nodes, COEFFICIENTS - 1, increasing=True))

    def costs(self, motors, exact):
        return costs(motors, True if self.centred else None, *self.arguments()[:-2], *((None, None) if exact else (self.even, self.odd)))

    def errors(self, motor):
        return errors(motor, *self.arguments())

    def arguments(self):
        return self.periods, self.measured, self.length, self.node_turns, self.even, self.odd


@inlined
def exact(rs, ld, lq, psi_f, turn, length, cos, sin):
    """F, G and h in closed form; cosine and sine of half the turn do not depend on the candidate.

    The voltage turns backward with w, seen from the rotor: the current that turns with it is P u, with P from (j w - A)^-1 B, and what is
    left of the current decays by F. So i' = P u(end) + s + F (i - P u(start) - s), s the steady current of the magnet alone.
    """
    w = turn / length
    over_d, over_q = 1.0 / ld, 1.0 / lq
    a, d = -rs * over_d, -rs * over_q
    b, c = w * lq * over_d, -w * ld * over_q
    # exp(A T): the roots are complex unless the rotor hardly turns.
    mean, difference = 0.5 * (a + d) * length, 0.5 * (a - d) * length
    square = difference * difference + b * c * length * length
    root = math.sqrt(abs(square))
    if root < 1e-6:
        even, odd = 1.0 + 0.5 * square, 1.0 + square / 6.0
    elif square < 0.0:
        even, odd = math.cos(root), math.sin(root) / root
    else:
        even, odd = math.cosh(root), math.sinh(root) / root
    decay = math.exp(mean)
    even, odd = decay * even, decay * odd
    fdd, fqq = even + odd * difference, even - odd * difference
    fdq, fqd = odd * b * length, odd * c * length
    # (j w - A)^-1 = adj(j w - A) / det, det = rs^2 / (ld lq) + j w rs (1/ld + 1/lq).
    real, imaginary = rs * rs * over_d * over_q, -w * (a + d)
    scale = 1.0 / (real * real + imaginary * imaginary)
    real, imaginary = real * scale, -imaginary * scale
    zdd_r, zdd_i = (-d * real - w * imaginary) * over_d, (w * real - d * imaginary) * over_d
    zdq_r, zdq_i = b * real * over_q, b * imaginary * over_q
    zqd_r, zqd_i = c * real * over_d, c * imaginary * over_d
    zqq_r, zqq_i = (-a * real - w * imaginary) * over_q, (w * real - a * imaginary) * over_q
    pdd, pdq = zdd_r - zdq_i, zdq_r + zdd_i
    pqd, pqq = zqd_r - zqq_i, zqq_r + zqd_i
    # P with the voltage half a turn later and earlier than in the middle.
    edd, edq = pdd * cos - pdq * sin, pdd * sin + pdq * cos
    eqd, eqq = pqd * cos - pqq * sin, pqd * sin + pqq * cos
    sdd, sdq = pdd * cos + pdq * sin, pdq * cos - pdd * sin
    sqd, sqq = pqd * cos + pqq * sin, pqq * cos - pqd * sin
    magnet = -w * psi_f * over_q
    steady = magnet / (a * d - b * c)
    s_d, s_q = b * steady, -a * steady
    return (
        fdd, fdq, fqd, fqq,
        edd - fdd * sdd - fdq * sqd, edq - fdd * sdq - fdq * sqq,
        eqd - fqd * sdd - fqq * sqd, eqq - fqd * sdq - fqq * sqq,
        s_d - fdd * s_d - fdq * s_q, s_q - fqd * s_d - fqq * s_q,
    )


@inlined
def by_polynomials(table, period):
    """Horner's rule; F_qq and F_qd from the other two (Cayley and Hamilton)."""
    w, x = period[TURN], period[PLACE]
    fdd = table[0, 0] + x * (table[0, 1] + x * (table[0, 2] + x * table[0, 3]))
    gdd = table[1, 0] + x * (table[1, 1] + x * (table[1, 2] + x * table[1, 3]))
    gqq = table[2, 0] + x * (table[2, 1] + x * (table[2, 2] + x * table[2, 3]))
    hd = table[3, 0] + x * (table[3, 1] + x * (table[3, 2] + x * table[3, 3]))
    slope = table[4, 0] + x * (table[4, 1] + x * table[4, 2])
    gdq = w * (table[5, 0] + x * (table[5, 1] + x * table[5, 2]))
    gqd = w * (table[6, 0] + x * (table[6, 1] + x * table[6, 2]))
    hq = w * (table[7, 0] + x * (table[7, 1] + x * table[7, 2]))
    fdq = w * slope
    return fdd, fdq, table[8, 1] * fdq, fdd + table[8, 0] * slope, gdd, gdq, gqd, gqq, hd, hq


@inlined
def table_of_polynomials(motor, length, turns, even, odd):
    """Rows 0 to 3: F_dd, G_dd, G_qq, h_d; 4 to 7: F_dq, G_dq, G_qd, h_q over the turn; 8: (F_qq - F_dd) w / F_dq and F_qd / F_dq."""
    rs, ld, lq, psi_f = motor
    table = np.zeros((9, COEFFICIENTS))
    for j in range(COEFFICIENTS):
        turn = turns[j]
        fdd, fdq, fqd, fqq, gdd, gdq, gqd, gqq, hd, hq = exact(
            rs, ld, lq, psi_f, turn, length, math.cos(0.5 * turn), math.sin(0.5 * turn)
        )
        for k in range(COEFFICIENTS):
            table[0, k] += even[k, j] * fdd
            table[1, k] += even[k, j] * gdd
            table[2, k] += even[k, j] * gqq
            table[3, k] += even[k, j] * hd
        for k in range(COEFFICIENTS - 1):
            table[4, k] += odd[k, j] * fdq / turn
            table[5, k] += odd[k, j] * gdq / turn
            table[6, k] += odd[k, j] * gqd / turn
            table[7, k] += odd[k, j] * hq / turn
    ratio = ld / lq
    table[8, 0] = ratio * rs * (length / ld - length / lq)
    table[8, 1] = -ratio * ratio
    return table


@compiled
def solved(motor, table, centred, periods, measured, length):
    """The cost with the linear unknowns that fit best, and these. No table: exactly; `centred` is None or True: known to the compiler."""
    i_d, i_q = measured[0, 0], measured[0, 1]
    total, responding = 0.0, True
    fdd_, fdq_, fqd_, fqq_ = 1.0, 0.0, 0.0, 1.0  # response to the first current
    add, aqd, adq, aqq = 0.0, 0.0, 0.0, 0.0  # to the first vector along alpha, along beta
    n00, n01, n11, r0, r1 = 1.0, 0.0, 1.0, 0.0, 0.0
    n02, n03, n12, n13, n22, n23, n33, r2, r3 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for row in range(len(periods)):
        period = periods[row]
        if table is None:
            fdd, fdq, fqd, fqq, gdd, gdq, gqd, gqq, hd, hq = exact(
                motor[0], motor[1], motor[2], motor[3], period[TURN], length, period[COS], period[SIN]
            )
        else:
            fdd, fdq, fqd, fqq, gdd, gdq, gqd, gqq, hd, hq = by_polynomials(table, period)
        u_d, u_q = period[U_D], period[U_Q]
        i_d, i_q = (
            fdd * i_d + (fdq * i_q + (gdd * u_d + (gdq * u_q + hd))),
            fqq * i_q + (fqd * i_d + (gqq * u_q + (gqd * u_d + hq))),
        )
        e_d, e_q = measured[row + 1, 0] - i_d, measured[row + 1, 1] - i_q
        total += e_d * e_d + e_q * e_q
        if centred is not None:
            a_d, a_q = period[A_D], period[A_Q]
            add, aqd = (
                fdd * add + (fdq * aqd + (gdd * a_d + gdq * a_q)),
                fqq * aqd + (fqd * add + (gqq * a_q + gqd * a_d)),
            )
            adq, aqq = (
                fdd * adq + (fdq * aqq + (gdq * a_d - gdd * a_q)),
                fqq * aqq + (fqd * adq + (gqq * a_d - gqd * a_q)),
            )
            n22 += add * add + aqd * aqd
            n23 += add * adq + aqd * aqq
            n33 += adq * adq + aqq * aqq
            r2 += e_d * add + e_q * aqd
            r3 += e_d * adq + e_q * aqq
        if responding:
            fdd_, fqd_ = fdd * fdd_ + fdq * fqd_, fqq * fqd_ + fqd * fdd_
            fdq_, fqq_ = fdd * fdq_ + fdq * fqq_, fqq * fqq_ + fqd * fdq_
            n00 += fdd_ * fdd_ + fqd_ * fqd_
            n01 += fdd_ * fdq_ + fqd_ * fqq_
            n11 += fdq_ * fdq_ + fqq_ * fqq_
            r0 += e_d * fdd_ + e_q * fqd_
            r1 += e_d * fdq_ + e_q * fqq_
            if centred is not None:
                n02 += fdd_ * add + fqd_ * aqd
                n03 += fdd_ * adq + fqd_ * aqq
                n12 += fdq_ * add + fqq_ * aqd
                n13 += fdq_ * adq + fqq_ * aqq
            if row % BLOCK == 0:
                responding = abs(fdd_) + abs(fdq_) + abs(fqd_) + abs(fqq_) > DIED_OUT
    unknowns = 2 if centred is None else 4
    normal, right = np.empty((unknowns, unknowns)), np.empty(unknowns)
    normal[0, 0], normal[0, 1], normal[1, 0], normal[1, 1], right[0], right[1] = n00, n01, n01, n11, r0, r1
    if centred is not None:
        normal[0, 2], normal[0, 3], normal[1, 2], normal[1, 3] = n02, n03, n12, n13
        normal[2, 0], normal[3, 0], normal[2, 1], normal[3, 1] = n02, n03, n12, n13
        normal[2, 2], normal[2, 3], normal[3, 2], normal[3, 3] = n22, n23, n23, n33
        right[2], right[3] = r2, r3
    best = np.linalg.solve(normal, right)
    return total - np.sum(right * best), best

@compiled
def costs(motors, centred, periods, measured, length, turns, even, odd):
    """Of each candidate. Without `even`: exactly, otherwise by polynomials."""
    result = np.empty(len(motors))
    for k in range(len(motors)):
        motor = (motors[k, 0], motors[k, 1], motors[k, 2], motors[k, 3])
        table = None if even is None else table_of_polynomials(motor, length, turns, even, odd)
        result[k] = solved(motor, table, centred, periods, measured, length)[0]
    return result

@compiled
def errors(motor, periods, measured, length, turns, even, odd):
    """Measured less simulated currents of centred voltages, by polynomials, with the linear unknowns that fit best."""
    motor = (motor[0], motor[1], motor[2], motor[3])
    table = table_of_polynomials(motor, length, turns, even, odd)
    best = solved(motor, table, True, periods, measured, length)[1]
    result = np.empty(measured.shape)
    i_d, i_q = measured[0, 0] + best[0], measured[0, 1] + best[1]
    result[0, 0], result[0, 1] = -best[0], -best[1]
    for row in range(len(periods)):
        period = periods[row]
        fdd, fdq, fqd, fqq, gdd, gdq, gqd, gqq, hd, hq = by_polynomials(table, period)
        u_d, u_q = period[U_D], period[U_Q]
        u_d += best[2] * period[A_D] - best[3] * period[A_Q]
        u_q += best[2] * period[A_Q] + best[3] * period[A_D]
        i_d, i_q = (
            fdd * i_d + (fdq * i_q + (gdd * u_d + (gdq * u_q + hd))),
            fqq * i_q + (fqd * i_d + (gqq * u_q + (gqd * u_d + hq))),
        )
        result[row + 1, 0], result[row + 1, 1] = measured[row + 1, 0] - i_d, measured[row + 1, 1] - i_q
    return result
