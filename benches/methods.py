"""One evaluation of fluxfit's methods beside those of mealpy, pygmo, pycma, scipy and pymoo: same log, fitness, population and iterations, one run. Markdown.

    methods.py [directory of fluxfit-benches]      default target/release

The time of a run divided by its evaluations, the method's own work and the fitness together, in CPU time. Each peer calls fitness (11) as its
interface does, candidate by candidate, pymoo by whole generations, in the short form of a 4 x 4 product, which fluxfit evaluates too. fluxfit is
measured before and after each peer. Exit status 1 if a limit is missed.
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

import cma
import mealpy
import numpy as np
import pygmo
import pymoo
import scipy
from mealpy import CSA, DE, FPA, GWO, HBA, PSO, SHADE, SSO, WOA, FloatVar
from pymoo.algorithms.soo.nonconvex.de import DE as PymooDE
from pymoo.core.problem import Problem as PymooProblem
from pymoo.optimize import minimize as pymoo_minimize
from scipy.optimize import differential_evolution

from problem import LOWER, UPPER, Problem, write_log

POPULATION, ITERATIONS = 50, 300
EVALUATIONS = POPULATION * (ITERATIONS + 1)
RUNS = 3  # of another program, after a warm-up run
# How many times as long an evaluation takes in a peer, at least: of the method where the ratio is least. None is asked of the others.
LIMITS = {"mealpy": 200, "pygmo": 10, "pycma": 50}


def of_mealpy(method, **settings):
    def run(problem, seed):
        asked = {"obj_func": problem.by_factor, "bounds": FloatVar(lb=LOWER, ub=UPPER), "minmax": "min", "log_to": None}
        method(epoch=ITERATIONS, pop_size=POPULATION, **settings).solve(asked, seed=seed)

    return run


class OfPygmo:
    """Fitness (11) as pygmo asks for it."""

    def __init__(self, problem):
        self.problem = problem

    def fitness(self, x):
        return [self.problem.by_factor(x)]

    def get_bounds(self):
        return LOWER, UPPER


def of_pygmo(method, **settings):
    def run(problem, seed):
        population = pygmo.population(pygmo.problem(OfPygmo(problem)), POPULATION, seed=seed)
        population = pygmo.algorithm(method(gen=ITERATIONS, seed=seed, **settings)).evolve(population)
        problem.evaluations = population.problem.get_fevals()  # pygmo evaluates a copy of the problem

    return run


def of_pycma(problem, seed):
    """In the unit box, as fluxfit's works; it goes on where pycma would stop."""
    settings = {"seed": seed, "verbose": -9, "bounds": [0, 1], "CMA_active": False}
    strategy = cma.CMAEvolutionStrategy(np.random.default_rng(seed).random(len(LOWER)), 0.3, settings)
    while problem.evaluations < EVALUATIONS:
        samples = strategy.ask()
        strategy.tell(samples, [problem.by_factor(LOWER + sample * (UPPER - LOWER)) for sample in samples])


def of_scipy(problem, seed):
    start = LOWER + (UPPER - LOWER) * np.random.default_rng(seed).random((POPULATION, len(LOWER)))
    settings = {"strategy": "rand1bin", "mutation": 0.5, "recombination": 0.9, "updating": "deferred", "tol": 0, "polish": False}
    differential_evolution(problem.by_factor, list(zip(LOWER, UPPER)), init=start, maxiter=ITERATIONS, rng=seed, **settings)


class OfPymoo(PymooProblem):
    """Fitness (11) as pymoo asks for it: of a whole generation."""

    def __init__(self, problem):
        super().__init__(n_var=len(LOWER), n_obj=1, xl=LOWER, xu=UPPER)
        self.problem = problem

    def _evaluate(self, x, out, *args, **kwargs):
        out["F"] = self.problem.by_factor_of_many(x.T)


def of_pymoo(problem, seed):
    """Its first generation is the start."""
    pymoo_minimize(OfPymoo(problem), PymooDE(pop_size=POPULATION, variant="DE/rand/1/bin", CR=0.9, F=0.5), ("n_gen", ITERATIONS + 1), seed=seed)


# fluxfit's method, the peer, the peer's name of it, and how it is run.
PEERS = [
    ("fpa", "mealpy", "OriginalFPA", of_mealpy(FPA.OriginalFPA)),
    ("lpso", "mealpy", "LDW_PSO", of_mealpy(PSO.LDW_PSO)),
    ("de", "mealpy", "OriginalDE", of_mealpy(DE.OriginalDE, wf=0.5, cr=0.9)),
    ("l-shade", "mealpy", "L_SHADE", of_mealpy(SHADE.L_SHADE)),
    ("gwo", "mealpy", "OriginalGWO", of_mealpy(GWO.OriginalGWO)),
    ("woa", "mealpy", "OriginalWOA", of_mealpy(WOA.OriginalWOA)),
    ("ssa", "mealpy", "OriginalSSO", of_mealpy(SSO.OriginalSSO)),
    ("hba", "mealpy", "OriginalHBA", of_mealpy(HBA.OriginalHBA)),
    ("cuckoo", "mealpy", "OriginalCSA", of_mealpy(CSA.OriginalCSA)),
    ("de", "pygmo", "de, variant 7", of_pygmo(pygmo.de, F=0.5, CR=0.9, variant=7, ftol=0, xtol=0)),
    ("lpso", "pygmo", "pso_gen", of_pygmo(pygmo.pso_gen)),
    ("gwo", "pygmo", "gwo", of_pygmo(pygmo.gwo)),
    ("cma-es", "pygmo", "cmaes", of_pygmo(pygmo.cmaes, ftol=0, xtol=0, force_bounds=True)),
    ("cma-es", "pycma", "CMAEvolutionStrategy", of_pycma),
    ("de", "scipy", "differential_evolution", of_scipy),
    ("de", "pymoo", "DE, generations at once", of_pymoo),
]


def nanoseconds(problem, run):
    """Of one evaluation."""
    run(problem, 1)
    each = []
    for seed in range(2, RUNS + 2):
        problem.evaluations = 0
        start = time.process_time()
        run(problem, seed)
        each.append(1e9 * (time.process_time() - start) / problem.evaluations)
    return statistics.median(each)


def nanoseconds_of_fluxfit(program, log, key):
    figures = json.loads(subprocess.run([program, log, key], check=True, capture_output=True).stdout)
    (swarm,) = figures["swarms"]
    return 1e6 * swarm["milliseconds_per_run"] / swarm["evaluations"]


def main():
    program = Path(sys.argv[1] if len(sys.argv) > 1 else "target/release") / "fluxfit-benches"
    ratios = {}
    print("| method | ns per evaluation in fluxfit | peer | ns per evaluation | times slower |\n|---|--:|---|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "two_modes.csv"
        write_log(log)
        problem = Problem(log)
        for key, peer, name, run in PEERS:
            before = nanoseconds_of_fluxfit(program, log, key)
            theirs = nanoseconds(problem, run)
            ours = (before + nanoseconds_of_fluxfit(program, log, key)) / 2
            ratios.setdefault(peer, []).append(theirs / ours)
            print(f"| `{key}` | {ours:.0f} | {peer} {name} | {theirs:.0f} | {theirs / ours:.0f} |", flush=True)
    peers = {"mealpy": mealpy, "pygmo": pygmo, "pycma": cma, "scipy": scipy, "pymoo": pymoo, "numpy": np}
    print(f"\n{', '.join(f'{peer} {module.__version__}' for peer, module in peers.items())}, one thread each.\n")
    print("| limit on | limit | measured | |\n|---|--:|--:|---|")
    for peer, limit in LIMITS.items():
        least = min(ratios[peer])
        print(f"| least times faster than {peer}, per evaluation | at least {limit} | {least:.0f} | {'ok' if least >= limit else 'MISSED'} |")
    sys.exit(any(min(ratios[peer]) < limit for peer, limit in LIMITS.items()))


if __name__ == "__main__":
    main()
