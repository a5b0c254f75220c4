"""The problem that every program solves: the paper's rig in two steady modes, as a log in a file, and fitness (11) on what the file holds.

    f(x) = sum_k 1/4 [e_d0^2 + e_q0^2 + e_d^2 + e_q^2],   x = (R_s, L_d, L_q, psi_f)

e: measured minus computed voltage of equation (2), mode i_d = 0 (index 0) and mode i_d < 0. SI units.
"""

import numpy as np

RS, LD, LQ, PSI_F, POLE_PAIRS = 0.958, 5.25e-3, 12e-3, 0.1827, 4
SPEED_RPM, LOAD_TORQUE, ID_OF_MODES = 1000.0, 10.0, (0.0, -2.0)
ROWS, RATE, PAUSE = 4000, 10e3, 1.0  # per mode; Hz; s between the modes
NOISE = 0.005  # standard deviation, of the length of the current and the voltage vector
SEED = 1

LOWER = np.zeros(4)
UPPER = np.array([5.0, 0.05, 0.05, 1.0])
COLUMNS = "t,ud,uq,id,iq,omega_e"


def write_log(path):
    """Both modes, one after the other, every number with all its digits."""
    random = np.random.default_rng(SEED)
    omega_e = POLE_PAIRS * SPEED_RPM * 2 * np.pi / 60
    modes = []
    for mode, i_d in enumerate(ID_OF_MODES):
        i_q = LOAD_TORQUE / (1.5 * POLE_PAIRS * (PSI_F + (LD - LQ) * i_d))
        u_d = RS * i_d - omega_e * LQ * i_q
        u_q = RS * i_q + omega_e * (LD * i_d + PSI_F)
        voltage, current = NOISE * np.hypot(u_d, u_q), NOISE * np.hypot(i_d, i_q)
        noise = random.standard_normal((ROWS, 4)) * [voltage, voltage, current, current]
        t = mode * (ROWS / RATE + PAUSE) + np.arange(ROWS) / RATE
        modes.append(np.column_stack([t, [u_d, u_q, i_d, i_q] + noise, np.full(ROWS, omega_e)]))
    np.savetxt(path, np.vstack(modes), fmt="%.17g", delimiter=",", header=COLUMNS, comments="")


class Problem:
    """Fitness (11) of a log, in the two forms that one would write in numpy, and its exact minimum."""

    def __init__(self, path):
        t, *columns = np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)
        start = 1 + int(np.argmax(np.diff(t)))
        self.zero, self.negative = ([column[rows] for column in columns] for rows in (slice(start), slice(start, None)))
        self.evaluations = 0
        a, b = self.equations()
        self.least_squares = np.linalg.lstsq(a, b, rcond=None)[0]
        r = np.linalg.qr(np.column_stack([a, -b]), mode="r")
        self.r4, self.z, self.rho2 = np.ascontiguousarray(r[:4, :4]), r[:4, 4].copy(), r[4, 4] ** 2
        self.least_cost = self.by_samples(self.least_squares)

    def equations(self):
        """The rows of fitness (11) as equations A x = b."""
        blocks = []
        for u_d, u_q, i_d, i_q, omega_e in (self.zero, self.negative):
            none = np.zeros_like(i_d)
            blocks.append((np.column_stack([i_d, none, -omega_e * i_q, none]), u_d))
            blocks.append((np.column_stack([i_q, omega_e * i_d, none, omega_e]), u_q))
        a, b = (np.concatenate(parts) for parts in zip(*blocks))
        return a / 2, b / 2  # the root of the weight 1/4

    def by_samples(self, x):
        """As a user would write it: the equations over all samples of both modes."""
        self.evaluations += 1
        rs, ld, lq, psi_f = x
        total = 0.0
        for u_d, u_q, i_d, i_q, omega_e in (self.zero, self.negative):
            e_d = u_d - (rs * i_d - omega_e * lq * i_q)
            e_q = u_q - (rs * i_q + omega_e * (ld * i_d + psi_f))
            total += 0.25 * (e_d @ e_d + e_q @ e_q)
        return float(total)

    def by_factor(self, x):
        """As fluxfit computes it: through the triangular factor of the equations."""
        self.evaluations += 1
        e = self.r4 @ x + self.z
        return float(e @ e + self.rho2)

    def by_factor_of_many(self, x):
        """The same for candidates in columns."""
        self.evaluations += x.shape[1]
        e = self.r4 @ x + self.z[:, None]
        return np.einsum("ij,ij->j", e, e) + self.rho2

    def solve_factor(self):
        """The exact minimum, the factor at hand."""
        return np.linalg.solve(self.r4, -self.z)

    def above_optimum(self, x):
        """F - F_LS, without cancellation."""
        e = self.r4 @ (np.asarray(x) - self.least_squares)
        return float(e @ e)
