"""The fit of `fluxfit identify` as one would write it with scipy and numba: least squares of simulated currents. Prints JSON.

    fit.py LOG.csv

The voltages are known to be centred, the drive to be perfect; `fluxfit identify` finds out. It starts from the equations over differences.
"""

import json
import sys
import time

import numpy as np
from scipy.optimize import least_squares

from simulation import Rows


def start(rows):
    """Least squares of the voltage equations with the rows' differences as derivatives."""
    turn, u_d, u_q = (rows.periods[:, column] for column in (0, 2, 3))
    omega_e = turn / rows.length
    i_d, i_q = (0.5 * (rows.measured[1:] + rows.measured[:-1])).T
    slope_d, slope_q = (np.diff(rows.measured, axis=0) / rows.length).T
    none = np.zeros_like(i_d)
    d = np.column_stack([i_d, slope_d, -omega_e * i_q, none])
    q = np.column_stack([i_q, omega_e * i_d, slope_q, omega_e])
    return np.linalg.lstsq(np.concatenate([d, q]), np.concatenate([u_d, u_q]), rcond=None)[0]


def fit(rows):
    """Logarithms of the parameters, so that none of them becomes negative and all are of one scale."""
    first = np.abs(start(rows))
    return least_squares(lambda x: rows.errors(first * np.exp(x)).ravel(), np.zeros(4), method="lm"), first


def main():
    began = time.perf_counter()
    rows = Rows(sys.argv[1], centred=True)
    result, first = fit(rows)
    taken = time.perf_counter() - began
    covariance = np.linalg.inv(result.jac.T @ result.jac) * 2 * result.cost / (result.fun.size - 8)
    motor = first * np.exp(result.x)
    errors = motor * np.sqrt(np.diag(covariance))
    figures = {"motor": motor.tolist(), "standard_errors": errors.tolist(), "cost": 2 * result.cost, "evaluations": result.nfev}
    print(json.dumps(figures | {"start": first.tolist(), "seconds": taken}))


if __name__ == "__main__":
    main()
