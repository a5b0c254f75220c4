"""What the recursive estimators of fluxfit-core must give, computed independently: other formulas, the same definitions.

    python3 oracles/estimators.py        rewrites crates/fluxfit-core/tests/estimators.json; needs numpy

Kalman filter: the current after a period is a matrix exponential here, its derivatives come from complex steps, and the covariance is a
full matrix in Joseph's form; the library has a Taylor series with sensitivities and the factors U D U'. Block least squares: all weighted
equations are solved at once by numpy.linalg.lstsq; the library rotates them in one by one.
"""

import json
from pathlib import Path

import numpy as np

NUMBERS = Path(__file__).parent.parent / "crates/fluxfit-core/tests/estimators.json"

TRUTH = np.array([0.958, 5.25e-3, 12e-3, 0.1827])
NOMINAL = np.array([1.1, 4.5e-3, 13e-3, 0.17])
PERIOD = 1e-4
NOISE = 0.04  # A, each axis
STEPS = 400

# The filter's settings and constants, as its documentation has them.
RATED_CURRENT, START_NOISE, START_ERROR, ADAPTION, OUTLIER, LARGEST_SEEN = 10.0, 5e-3, 0.5, 1e-3, 3.0, 25.0
WALK = np.array([6e-3, 1e-3, 5e-4, 2e-3])  # per square root of a second
UNKNOWN_VOLTAGE = 0.3  # V

# Block least squares.
BLOCK, FORGETTING, START_WEIGHT = 50, 0.98, 1e-3


def exponential(matrix):
    """exp(matrix) by its series after halvings; complex steps pass through it."""
    halvings = 6
    matrix = matrix / 2**halvings
    term = total = np.eye(len(matrix), dtype=complex)
    for n in range(1, 20):
        term = term @ matrix / n
        total = total + term
    for _ in range(halvings):
        total = total @ total
    return total


def after(theta, i, u, omega):
    """The current after a period: the linear system of current, turning voltage and one. `u` is in the frame at the period's middle."""
    rs, ld, lq, psi = theta
    system = np.zeros((5, 5), dtype=complex)
    system[0] = [-rs / ld, omega * lq / ld, 1 / ld, 0, 0]
    system[1] = [-omega * ld / lq, -rs / lq, 0, 1 / lq, -omega * psi / lq]
    system[2:4, 2:4] = [[0, omega], [-omega, 0]]
    half = omega * PERIOD / 2
    turn = np.array([[np.cos(half), -np.sin(half)], [np.sin(half), np.cos(half)]])
    state = np.concatenate([i, turn @ u, [1.0]]).astype(complex)
    return (exponential(system * PERIOD) @ state)[:2]


def derivative(of, x):
    """The derivatives of a function of a vector, a column each, by complex steps."""
    step = 1e-30
    return np.stack([of(x + 1j * step * unit).imag / step for unit in np.eye(len(x))], axis=1)


def recorded(random):
    """Periods (ud, uq, omega) and the measured current at the end of each, under a controller that sees the noise."""
    i, measured, rows = np.array([0.0, 5.0]), np.array([0.0, 5.0]), []
    start = measured
    for k in range(STEPS):
        omega = 419.0 + 40.0 * np.sin(k / 60)
        wanted = np.array([-2.0 if k // 100 % 2 else 0.0, 9.0])
        rs, ld, lq, psi = TRUTH
        feed = np.array([rs * wanted[0] - omega * lq * wanted[1], rs * wanted[1] + omega * (ld * wanted[0] + psi)])
        u = feed + 1200 * np.array([ld, lq]) * (wanted - measured)
        i = after(TRUTH, i, u, omega).real
        measured = i + NOISE * random.standard_normal(2)
        if k == 250:
            measured = measured + [1.5, 0.0]  # an outlier
        rows.append([*u, omega, *measured])
    return start, np.array(rows)


def filtered(start, rows):
    """The state: i_d, i_q, rs and psi_f over nominal values, logarithms of ld and lq over theirs."""

    def parameters(z):
        return NOMINAL * np.array([z[0], np.exp(z[1]), np.exp(z[2]), z[3]])

    x = np.concatenate([start, [1.0, 0.0, 0.0, 1.0]])
    noise = (START_NOISE * RATED_CURRENT) ** 2
    p = np.diag([4 * noise, 4 * noise, *[START_ERROR**2] * 4])
    for ud, uq, omega, *measured in rows:
        u = np.array([ud, uq])

        def moved(x):
            return np.concatenate([after(parameters(x[2:]), x[:2], u, omega), x[2:]])

        phi = derivative(moved, x)
        kick = PERIOD * UNKNOWN_VOLTAGE / parameters(x[2:])[1:3]
        x = moved(x).real
        p = phi @ p @ phi.T + np.diag([*kick**2, *WALK**2 * PERIOD])
        for c in range(2):
            innovation = measured[c] - x[c]
            explained = p[c, c]
            deviation = np.sqrt(explained + noise)
            used = noise
            if abs(innovation) > OUTLIER * deviation:
                used = abs(innovation) * deviation / OUTLIER - explained
            gain = p[:, c] / (explained + used)
            x = x + gain * innovation
            keep = np.eye(6) - np.outer(gain, np.eye(6)[c])
            p = keep @ p @ keep.T + used * np.outer(gain, gain)
            seen = min(innovation**2 - explained, LARGEST_SEEN * noise)
            noise = noise + ADAPTION * (seen - noise)
    values = parameters(x[2:])
    scale = np.array([NOMINAL[0], values[1], values[2], NOMINAL[3]])
    return values, np.sqrt(np.diag(p)[2:]) * scale, noise


def least_squares(start, rows):
    """Weighted equations of whole blocks; the start is the equations z = 1 with a small weight."""
    equations, begin = [], np.array(start)
    for first in range(0, len(rows) - BLOCK + 1, BLOCK):
        ud, uq, omega, i_d, i_q = rows[first : first + BLOCK].T
        before_d, before_q = np.concatenate([[begin[0]], i_d[:-1]]), np.concatenate([[begin[1]], i_q[:-1]])
        half = omega * PERIOD / 2
        mean_ud, mean_uq = ud * np.sin(half) / half, uq * np.sin(half) / half
        mean_d = (before_d + i_d) / 2 - omega * PERIOD**2 * mean_uq / (12 * NOMINAL[1])
        mean_q = (before_q + i_q) / 2 + omega * PERIOD**2 * mean_ud / (12 * NOMINAL[2])
        end = np.array([i_d[-1], i_q[-1]])
        slope = (end - begin) / (BLOCK * PERIOD)
        equations.append(
            (
                np.array([[mean_d.mean(), slope[0], -(omega * mean_q).mean(), 0], [mean_q.mean(), (omega * mean_d).mean(), slope[1], omega.mean()]])
                * NOMINAL,
                np.array([mean_ud.mean(), mean_uq.mean()]),
            )
        )
        begin = end
    age = len(equations)
    phi, y = [np.eye(4) * START_WEIGHT * FORGETTING ** (age / 2)], [np.full(4, START_WEIGHT * FORGETTING ** (age / 2))]
    for number, (coefficients, right) in enumerate(equations, 1):
        weight = FORGETTING ** ((age - number) / 2)
        phi.append(weight * coefficients)
        y.append(weight * right)
    return np.linalg.lstsq(np.concatenate(phi), np.concatenate(y), rcond=None)[0] * NOMINAL


def main():
    start, rows = recorded(np.random.default_rng(15))
    # As the test reads them: nine digits.
    rows = np.array([[float(f"{value:.9g}") for value in row] for row in rows])
    values, errors, noise = filtered(start, rows)
    numbers = {
        "nominal": NOMINAL.tolist(),
        "start": start.tolist(),
        "rows": rows.tolist(),
        "filter": {"values": values.tolist(), "standard_errors": errors.tolist(), "noise": noise},
        "least_squares": least_squares(start, rows).tolist(),
    }
    NUMBERS.write_text(json.dumps(numbers, indent=None, separators=(",", ":")) + "\n")
    print(values / TRUTH - 1, errors / TRUTH, noise, np.array(numbers["least_squares"]) / TRUTH - 1)


if __name__ == "__main__":
    main()
