"""What a neural network makes of the paper's four voltages, beside their exact solution: the figures of docs/swarms.md on reference [14].

    python3 studies/network.py        needs numpy, scipy

A network of 4-10-4 neurons (tanh) learns R_s, L_d, L_q and psi_f from the mean voltages of two operating points, at fixed currents and speed,
by Levenberg and Marquardt's method, on simulated motors. It is tested on other motors within the range that it has learnt, and beyond. The exact
solution solves the same four equations of the same noisy voltages.
"""

import time

import numpy as np
from scipy.optimize import least_squares

MOTOR = np.array([0.958, 5.25e-3, 12e-3, 0.1827])  # the paper's; ohm, H, H, Wb
SPEED = 4 * 1000 * 2 * np.pi / 60  # electrical rad/s
I_Q0, I_D, I_Q = 9.12, -2.0, 8.5  # A; first operating point i_d = 0
NOISE = 0.02  # V, standard deviation of a mean
HIDDEN = 10
PAIRS = 400
TESTS = 2000
LEARNT, BEYOND = 0.3, 0.6  # of the nominal values
ROUNDS = 300  # of Levenberg and Marquardt's method
SEED = 1


def voltages(motors):
    rs, ld, lq, psi_f = motors.T
    flux = SPEED * psi_f
    return np.column_stack([-SPEED * lq * I_Q0, rs * I_Q0 + flux, rs * I_D - SPEED * lq * I_Q, rs * I_Q + SPEED * ld * I_D + flux])


def exact(u):
    u_d0, u_q0, u_d, u_q = u.T
    lq = -u_d0 / (SPEED * I_Q0)
    rs = (u_d + SPEED * lq * I_Q) / I_D
    psi_f = (u_q0 - rs * I_Q0) / SPEED
    return np.column_stack([rs, (u_q - rs * I_Q - SPEED * psi_f) / (SPEED * I_D), lq, psi_f])


def split(weights):
    a, b = weights[: 5 * HIDDEN].reshape(5, HIDDEN), weights[5 * HIDDEN :].reshape(HIDDEN + 1, 4)
    return a, b


def network(weights, z):
    a, b = split(weights)
    return np.tanh(z @ a[:4] + a[4]) @ b[:-1] + b[-1]


def derivatives(weights, z, _):
    """Of all outputs by all weights."""
    a, b = split(weights)
    h = np.tanh(z @ a[:4] + a[4])
    inner = np.einsum("ni,nh,ho->noih", np.column_stack([z, np.ones(len(z))]), 1 - h * h, b[:-1]).reshape(len(z), 4, -1)
    outer = np.einsum("nh,op->nohp", np.column_stack([h, np.ones(len(z))]), np.eye(4)).reshape(len(z), 4, -1)
    return np.concatenate([inner, outer], axis=2).reshape(4 * len(z), -1)


def main():
    random = np.random.default_rng(SEED)

    def drawn(count, spread):
        motors = MOTOR * (1 + spread * (2 * random.random((count, 4)) - 1))
        return motors, voltages(motors) + NOISE * random.standard_normal((count, 4))

    motors, u = drawn(PAIRS, LEARNT)
    centre, scale = u.mean(axis=0), u.std(axis=0)
    z, targets = (u - centre) / scale, motors / MOTOR
    start = time.perf_counter()
    error = lambda weights, z, targets: (network(weights, z) - targets).ravel()
    first = random.standard_normal(9 * HIDDEN + 4) / 2
    weights = least_squares(error, first, derivatives, method="lm", args=(z, targets), max_nfev=ROUNDS).x
    seconds = time.perf_counter() - start
    print(f"| rms error, % | R_s | L_d | L_q | psi_f |\n|---|--:|--:|--:|--:|")
    for name, spread in ((f"within {100 * LEARNT:.0f} %", LEARNT), (f"within {100 * BEYOND:.0f} %", BEYOND)):
        motors, u = drawn(TESTS, spread)
        for who, found in (("network", MOTOR * network(weights, (u - centre) / scale)), ("exact", exact(u))):
            rms = 100 * np.sqrt((((found - motors) / MOTOR) ** 2).mean(axis=0))
            print(f"| {who}, motors {name} | " + " | ".join(f"{error:.2g}" for error in rms) + " |")
    start = time.perf_counter()
    exact(u)
    print(f"\nTraining {seconds:.1f} s; {1e6 * (time.perf_counter() - start) / TESTS:.2g} us for an exact solution.")


if __name__ == "__main__":
    main()
