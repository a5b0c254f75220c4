"""Compares fluxfit with other programs: same log, same fitness, same population and iterations, one machine, one run. Prints Markdown.

    peers.py [directory of fluxfit and fluxfit-benches]      default target/release

Exit status 1 if a limit is exceeded. mealpy is under the GPL, pygmo under the MPL-2.0 (its package holds libraries under other licences):
both are run as separate programs and never linked with fluxfit.
"""

import os

for library in ("OMP", "OPENBLAS", "MKL"):  # one thread for every program
    os.environ[f"{library}_NUM_THREADS"] = "1"

import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mealpy
import numpy as np
import pygmo
import scipy
from mealpy import FPA, FloatVar
from scipy.optimize import differential_evolution

from problem import LOWER, UPPER, Problem, write_log

POPULATION, ITERATIONS = 50, 300
RUNS = 5  # of another program's swarm, after a warm-up run
SOLUTIONS = 201  # of an exact solver
COMMANDS = 3  # `fluxfit compare`, each time

RUN_LIMIT_MS = 0.9
COMPARE_LIMIT_MS = 60.0
PYGMO_FACTOR = 10.0
SAMPLES_FACTOR = 500.0
FACTOR_FACTOR = 300.0
AGREEMENT = 1e-9  # relative, of both programs' F_LS: rounding over 16 000 squares is far below


def mealpy_fpa(fitness, seed, **settings):
    problem = {"obj_func": fitness, "bounds": FloatVar(lb=LOWER, ub=UPPER), "minmax": "min", "log_to": None}
    return FPA.OriginalFPA(epoch=ITERATIONS, pop_size=POPULATION, **settings).solve(problem, seed=seed).solution


def scipy_de(fitness, seed, **settings):
    start = LOWER + (UPPER - LOWER) * np.random.default_rng(seed).random((POPULATION, 4))
    box = list(zip(LOWER, UPPER))
    return differential_evolution(fitness, box, init=start, maxiter=ITERATIONS, tol=0, polish=False, rng=seed, **settings).x


class OfPygmo:
    """Fitness (11) as pygmo asks for it: candidates one after the other in one vector, all of a generation at once."""

    def __init__(self, problem):
        self.problem = problem

    def fitness(self, x):
        return [self.problem.by_factor(x)]

    def batch_fitness(self, x):
        return self.problem.by_factor_of_many(x.reshape(-1, 4).T)

    def get_bounds(self):
        return LOWER, UPPER


def pygmo_swarm(problem, seed):
    """The swarm in C++ that hands over whole generations; its own settings."""
    asked = pygmo.problem(OfPygmo(problem))
    swarm = pygmo.pso_gen(gen=ITERATIONS, seed=seed)
    swarm.set_bfe(pygmo.bfe())
    # The first population is evaluated as a batch too.
    population = pygmo.population(asked, POPULATION, b=pygmo.bfe(), seed=seed)
    population = pygmo.algorithm(swarm).evolve(population)
    problem.evaluations = population.problem.get_fevals()  # pygmo evaluates a copy of the problem
    return population.champion_x


def measure(who, problem, solve, runs):
    """A row of the table: `solve(seed)` is one run. Swarms by CPU time, so that other work on the machine does not count; exact solvers, whose
    calls are short, by the clock that is read faster. fluxfit is timed alike."""
    clock = time.process_time if runs == RUNS else time.perf_counter
    solve(0)
    milliseconds, evaluations, above = [], [], []
    for seed in range(1, runs + 1):
        problem.evaluations = 0
        start = clock()
        x = solve(seed)
        milliseconds.append(1e3 * (clock() - start))
        evaluations.append(problem.evaluations)
        above.append(problem.above_optimum(x))
    return who, statistics.median(milliseconds), max(evaluations), statistics.median(above)


def peers(problem):
    """Names, runs and how each is run; the limits concern the first two, the last two are exact."""
    samples, factor, many = problem.by_samples, problem.by_factor, problem.by_factor_of_many
    vectorized = {"vectorized": True, "updating": "deferred"}
    return [
        ("mealpy OriginalFPA, fitness over the samples", RUNS, lambda seed: mealpy_fpa(samples, seed)),
        ("mealpy OriginalFPA, triangular factor", RUNS, lambda seed: mealpy_fpa(factor, seed)),
        ("mealpy OriginalFPA, p_s = 0.2, triangular factor", RUNS, lambda seed: mealpy_fpa(factor, seed, p_s=0.2)),
        ("scipy differential_evolution, fitness over the samples", RUNS, lambda seed: scipy_de(samples, seed)),
        ("scipy differential_evolution, triangular factor", RUNS, lambda seed: scipy_de(factor, seed)),
        ("scipy differential_evolution, triangular factor, vectorized", RUNS, lambda seed: scipy_de(many, seed, **vectorized)),
        ("pygmo pso_gen, triangular factor, generations at once", RUNS, lambda seed: pygmo_swarm(problem, seed)),
        ("numpy least squares, from the rows", SOLUTIONS, lambda _: np.linalg.lstsq(*problem.equations(), rcond=None)[0]),
        ("numpy least squares, factor at hand", SOLUTIONS, lambda _: problem.solve_factor()),
    ]


def fluxfit(programs, log):
    """The figures of the Rust program, and the time of the whole command `fluxfit compare`."""
    figures = json.loads(subprocess.run([programs / "fluxfit-benches", log], check=True, capture_output=True).stdout)
    commands = []
    for _ in range(COMMANDS):
        start = time.perf_counter()
        subprocess.run([programs / "fluxfit", "compare", log, "--json"], check=True, stdout=subprocess.DEVNULL)
        commands.append(1e3 * (time.perf_counter() - start))
    return figures | {"milliseconds_compare": statistics.median(commands)}


def middle(measurements):
    """The median of each figure over several measurements of the same shape."""
    first = measurements[0]
    if isinstance(first, dict):
        return {key: middle([measurement[key] for measurement in measurements]) for key in first}
    if isinstance(first, list):
        return [middle(parts) for parts in zip(*measurements)]
    return first if isinstance(first, str) else statistics.median(measurements)


def digits(value):
    """Three of them, never as a power of ten."""
    return f"{value:.3g}" if value < 1000 else f"{float(f'{value:.3g}'):.0f}"


def table(ours, theirs):
    exact = ours["least_squares"]
    rows = [
        (f"**fluxfit {swarm['label']}**", swarm["milliseconds_per_run"], swarm["evaluations"], swarm["cost_above_optimum"])
        for swarm in ours["swarms"]
    ]
    rows += theirs[:-2]
    rows += [("**fluxfit exact least squares, from the rows**", exact["microseconds_from_rows"] / 1e3, 0, 0.0), theirs[-2]]
    rows += [("**fluxfit exact least squares, factor at hand**", exact["microseconds_solve"] / 1e3, 0, 0.0), theirs[-1]]
    reference = rows[0][1]
    print("| who | ms per run | evaluations | median F - F_LS | times slower than fluxfit tGFPA |")
    print("|---|--:|--:|--:|--:|")
    for who, milliseconds, evaluations, above in rows:
        # No evaluations: an exact solver.
        excess = "exact" if evaluations == 0 else f"{above:.1e}"
        print(f"| {who} | {digits(milliseconds)} | {f'{evaluations:.0f}' if evaluations else ''} | {excess} | {digits(milliseconds / reference)} |")


def verdicts(ours, theirs):
    """Whether all limits are met."""
    run = ours["swarms"][0]["milliseconds_per_run"]
    by_samples, by_factor = (row[1] for row in theirs[:2])
    by_pygmo = theirs[-3][1]
    # Quantity, limit, the good side of it, measured value.
    limits = [
        ("tGFPA run, ms", RUN_LIMIT_MS, "at most", run),
        ("`fluxfit compare`, 4 x 50 runs, ms", COMPARE_LIMIT_MS, "at most", ours["milliseconds_compare"]),
        ("times faster than mealpy, fitness over the samples", SAMPLES_FACTOR, "at least", by_samples / run),
        ("times faster than mealpy, triangular factor", FACTOR_FACTOR, "at least", by_factor / run),
        ("times faster than pygmo's swarm", PYGMO_FACTOR, "at least", by_pygmo / run),
    ]
    print("| limit on | limit | measured | |\n|---|--:|--:|---|")
    met = True
    for what, limit, side, measured in limits:
        ok = measured <= limit if side == "at most" else measured >= limit
        met = met and ok
        print(f"| {what} | {side} {limit:g} | {digits(measured)} | {'ok' if ok else 'MISSED'} |")
    return met


def main():
    programs = Path(sys.argv[1] if len(sys.argv) > 1 else "target/release")
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "two_modes.csv"
        write_log(log)
        problem = Problem(log)
        ours = [fluxfit(programs, log)]
        difference = abs(ours[0]["cost_least_squares"] / problem.least_cost - 1)
        if difference > AGREEMENT:
            sys.exit(f"F_LS of fluxfit and of numpy differ by {difference:.1e}: not the same fitness")
        theirs = []
        for who, runs, solve in peers(problem):
            theirs.append(measure(who, problem, solve, runs))
            # Measured again after each peer, so that other work on the machine affects all programs alike.
            ours.append(fluxfit(programs, log))
        ours = middle(ours)
    table(ours, theirs)
    print(f"\nmealpy {mealpy.__version__}, pygmo {pygmo.__version__}, scipy {scipy.__version__}, numpy {np.__version__}, one thread each.")
    print(f"One evaluation of fluxfit's fitness: {ours['nanoseconds_per_evaluation']:.2g} ns.")
    print(f"F_LS = {problem.least_cost:.6g}, the same in both programs to {difference:.0e} relative.\n")
    sys.exit(not verdicts(ours, theirs))


if __name__ == "__main__":
    main()
