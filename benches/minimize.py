"""`fluxfit.minimize` in Python beside mealpy, pymoo and scipy: fitness (11) in numpy, 50 candidates, 300 iterations, one thread. Prints Markdown.

    minimize.py      in an environment with the package fluxfit

Each program is given the function as its interface takes it: a generation at once where it can, else point by point. Times are of the
processor, medians of several runs. Exit status 1 if a limit is exceeded.
"""

import os

for library in ("OMP", "OPENBLAS", "MKL"):  # one thread for every program
    os.environ[f"{library}_NUM_THREADS"] = "1"

import statistics
import sys
import tempfile
import time
from pathlib import Path

import mealpy
import numpy as np
import pymoo
import scipy
from mealpy import DE, FPA, PSO, FloatVar
from pymoo.algorithms.soo.nonconvex.de import DE as PymooDE
from pymoo.algorithms.soo.nonconvex.pso import PSO as PymooPSO
from pymoo.core.problem import Problem as PymooProblem
from pymoo.optimize import minimize as pymoo_minimize
from scipy.optimize import differential_evolution

import fluxfit
from problem import LOWER, UPPER, Problem, write_log

POPULATION, ITERATIONS = 50, 300
BOX = list(zip(LOWER, UPPER))
RUNS = 5  # of another program, after a warm-up run
REPETITIONS = 31  # of fluxfit, whose runs are short

OVERHEAD_LIMIT = 1.3  # times the function's own time
FASTER_LIMIT = 1.0  # times faster than every other program


def ours(function, method, seed, box=BOX):
    return fluxfit.minimize(function, box, method, vectorized=True, seed=seed, population=POPULATION, iterations=ITERATIONS).x


def of_mealpy(optimizer):
    def solve(problem, seed):
        asked = {"obj_func": problem.by_factor, "bounds": FloatVar(lb=LOWER, ub=UPPER), "minmax": "min", "log_to": None}
        return optimizer(epoch=ITERATIONS, pop_size=POPULATION).solve(asked, seed=seed).solution

    return solve


def of_pymoo(algorithm):
    class Asked(PymooProblem):
        def __init__(self, problem):
            super().__init__(n_var=4, n_obj=1, xl=LOWER, xu=UPPER)
            self.problem = problem

        def _evaluate(self, x, out, *args, **kwargs):
            out["F"] = self.problem.by_factor_of_many(x.T)

    def solve(problem, seed):
        # Its first generation is the start.
        return pymoo_minimize(Asked(problem), algorithm(pop_size=POPULATION), ("n_gen", ITERATIONS + 1), seed=seed).X

    return solve


def of_scipy(problem, seed):
    start = LOWER + (UPPER - LOWER) * np.random.default_rng(seed).random((POPULATION, 4))
    settings = {"maxiter": ITERATIONS, "tol": 0, "polish": False, "vectorized": True, "updating": "deferred"}
    return differential_evolution(problem.by_factor_of_many, BOX, init=start, rng=seed, **settings).x


def of_fluxfit(method):
    return lambda problem, seed: ours(lambda x: problem.by_factor_of_many(x.T), method, seed)


PROGRAMS = {
    "**fluxfit tgfpa**": of_fluxfit("tgfpa"),
    "**fluxfit l-shade**": of_fluxfit("l-shade"),
    "**fluxfit de**": of_fluxfit("de"),
    "scipy differential_evolution, vectorized": of_scipy,
    "pymoo DE, generations at once": of_pymoo(PymooDE),
    "pymoo PSO, generations at once": of_pymoo(PymooPSO),
    "mealpy OriginalFPA, point by point": of_mealpy(FPA.OriginalFPA),
    "mealpy OriginalDE, point by point": of_mealpy(DE.OriginalDE),
    "mealpy OriginalPSO, point by point": of_mealpy(PSO.OriginalPSO),
}


def timed(work):
    """Milliseconds of the processor, and what the work gives."""
    start = time.process_time_ns()
    given = work()
    return (time.process_time_ns() - start) / 1e6, given


def measured(problem, solve, runs):
    """Milliseconds, evaluations and F - F_LS of a run."""
    solve(problem, 0)
    milliseconds, above = [], []
    for seed in range(1, runs + 1):
        problem.evaluations = 0
        took, x = timed(lambda seed=seed: solve(problem, seed))
        milliseconds.append(took)
        above.append(problem.above_optimum(x))
    return statistics.median(milliseconds), problem.evaluations, statistics.median(above)


def rosenbrock(x):
    return (100 * (x[:, 1:] - x[:, :-1] ** 2) ** 2 + (1 - x[:, :-1]) ** 2).sum(axis=1)


def sphere(x):
    return (x**2).sum(axis=1)


def over_samples(problem):
    """Fitness (11) over all samples, of a generation at once."""
    a, b = problem.equations()
    return lambda x: ((a @ x.T - b[:, None]) ** 2).sum(axis=0)


def overhead(function, box, repetitions):
    """Milliseconds of a run of tgfpa, and of the function alone on the same generations."""
    generations = []

    def kept(x):
        generations.append(x)
        return function(x)

    ours(kept, "tgfpa", 1, box)
    runs, alone = [], []
    for _ in range(repetitions):  # by turns, so that other work on the machine affects both alike
        runs.append(timed(lambda: ours(function, "tgfpa", 1, box))[0])
        alone.append(timed(lambda: [function(x) for x in generations])[0])
    return statistics.median(runs), statistics.median(alone)


def main():
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "two_modes.csv"
        write_log(log)
        problem = Problem(log)
    rows = {name: measured(problem, solve, REPETITIONS if "fluxfit" in name else RUNS) for name, solve in PROGRAMS.items()}
    reference = rows["**fluxfit tgfpa**"][0]
    print("| who | ms per run | evaluations | median F - F_LS | times slower than fluxfit tgfpa |\n|---|--:|--:|--:|--:|")
    for name, (milliseconds, evaluations, above) in rows.items():
        print(f"| {name} | {milliseconds:.3g} | {evaluations} | {above:.1e} | {milliseconds / reference:.3g} |")
    print(f"\nmealpy {mealpy.__version__}, pymoo {pymoo.__version__}, scipy {scipy.__version__}, numpy {np.__version__}, one thread each.\n")
    print("| function of numpy | variables | ms per run | ms in the function | times the function's own time | us a generation beside it |")
    print("|---|--:|--:|--:|--:|--:|")
    functions = [(sphere, "sphere", 4), (rosenbrock, "Rosenbrock's", 2), (rosenbrock, "Rosenbrock's", 4), (rosenbrock, "Rosenbrock's", 10)]
    cheap = [(name, dimension, overhead(function, [(-2.0, 2.0)] * dimension, REPETITIONS)) for function, name, dimension in functions]
    dear = ("fitness (11) over the samples", 4, overhead(over_samples(problem), BOX, RUNS))
    for name, dimension, (run, alone) in [*cheap, dear]:
        beside = 1e3 * (run - alone) / (ITERATIONS + 1)
        print(f"| {name} | {dimension} | {run:.3g} | {alone:.3g} | {run / alone:.2f} | {beside:.1f} |")
    slowest = max(milliseconds for name, (milliseconds, *_) in rows.items() if "fluxfit" in name)
    faster = min(milliseconds for name, (milliseconds, *_) in rows.items() if "fluxfit" not in name) / slowest
    print("\n| limit on | limit | measured | |\n|---|--:|--:|---|")
    (of_cheap, of_dear) = (max(run / alone for *_, (run, alone) in cheap), dear[2][0] / dear[2][1])
    for what, limit, is_met, figure in [
        ("times the function's own time, fitness over the samples", f"at most {OVERHEAD_LIMIT}", of_dear <= OVERHEAD_LIMIT, of_dear),
        ("the same, the cheapest function", f"at most {OVERHEAD_LIMIT}", of_cheap <= OVERHEAD_LIMIT, of_cheap),
        ("times faster than the fastest other program", f"at least {FASTER_LIMIT:g}", faster > FASTER_LIMIT, faster),
    ]:
        print(f"| {what} | {limit} | {figure:.2f} | {'ok' if is_met else 'MISSED'} |")
    sys.exit(not (max(of_dear, of_cheap) <= OVERHEAD_LIMIT and faster > FASTER_LIMIT))


if __name__ == "__main__":
    main()
