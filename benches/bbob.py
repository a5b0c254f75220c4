"""fluxfit's DE/rand/1/bin and CMA-ES beside scipy's and pycma's on the BBOB functions: the same settings, evaluations and instances. Markdown.

    bbob.py [directory of swarms] [instances]      default target/release, 5

scipy and pycma evaluate COCO's functions, fluxfit its own, which a test holds against COCO's to 1e-10. A problem is solved if a run comes within
1e-8 (or 1e-1) of its lowest cost. Two programs differ by no more than noise if the problems that only one of them solves are shared
evenly: McNemar's test, two-sided, exact, at 1 %. Exit status 1 if a pair differs by more.
"""

import os

for library in ("OMP", "OPENBLAS", "MKL"):  # one thread for every program
    os.environ[f"{library}_NUM_THREADS"] = "1"

import subprocess
import sys
import tempfile
import warnings
from contextlib import chdir
from pathlib import Path

import cma
import cocoex
import numpy as np
import scipy
from scipy.optimize import differential_evolution
from scipy.stats import binomtest

DIMENSION = 5
POPULATION, ITERATIONS = 50, 300
EVALUATIONS = POPULATION * (ITERATIONS + 1)
TARGETS = (1e-1, 1e-8)
HALF_BOX = 5.0
FIRST_SIZE = 0.3 * 2 * HALF_BOX  # sigma of CMA-ES
REDRAWS = 100  # of a sample outside the box, then it is clamped
DOUBT = 0.01


class Solved(Exception):
    """The last target is reached."""


class Counted:
    """A problem with its lowest cost known, that remembers the best cost and ends at the last target or the last evaluation."""

    def __init__(self, problem, lowest):
        self.problem, self.lowest, self.best, self.left = problem, lowest, np.inf, EVALUATIONS

    def __call__(self, x):
        self.left -= 1
        cost = self.problem(x)
        self.best = min(self.best, cost - self.lowest)
        if self.best <= TARGETS[-1] or self.left == 0:
            raise Solved
        return cost


def de(cost, seed):
    """The settings of fluxfit's; scipy draws anew what leaves the box, where fluxfit goes half way back."""
    start = HALF_BOX * (2 * np.random.default_rng(seed).random((POPULATION, DIMENSION)) - 1)
    settings = {"strategy": "rand1bin", "mutation": 0.5, "recombination": 0.9, "updating": "deferred", "tol": 0, "polish": False}
    differential_evolution(cost, [(-HALF_BOX, HALF_BOX)] * DIMENSION, init=start, maxiter=ITERATIONS, rng=seed, **settings)


def cma_es(cost, seed):
    """Positive weights only, samples outside the box drawn again; it goes on where pycma would stop, as fluxfit's does."""
    start = HALF_BOX * (2 * np.random.default_rng(seed).random(DIMENSION) - 1)
    strategy = cma.CMAEvolutionStrategy(start, FIRST_SIZE, {"seed": seed, "verbose": -9, "CMA_active": False})
    while True:
        samples = []
        for _ in range(strategy.popsize):
            for _ in range(REDRAWS):
                (sample,) = strategy.ask(1)
                if np.abs(sample).max() <= HALF_BOX:
                    break
            samples.append(np.clip(sample, -HALF_BOX, HALF_BOX))
        strategy.tell(samples, [cost(sample) for sample in samples])


def reached(search, instances):
    """Whether each problem's targets are reached, by function and instance."""
    solved = {}
    for problem in cocoex.Suite("bbob", f"instances: 1-{instances}", f"dimensions: {DIMENSION}"):
        function, _, instance = problem.id_triple
        problem._best_parameter("print")
        counted = Counted(problem, problem(np.loadtxt("._bbob_problem_best_parameter.txt").ravel()))
        try:
            search(counted, instance)
        except Solved:
            pass
        solved[function, instance] = [counted.best <= target for target in TARGETS]
    return solved


def fluxfit(program, key, instances):
    lines = subprocess.run([program, "errors", str(DIMENSION), str(instances), key], check=True, capture_output=True, text=True).stdout.split()
    rows = [line.split(",") for line in lines]
    return {(int(function), int(instance)): [rough == "1", exact == "1"] for _, function, instance, rough, exact in rows}


def main():
    program = Path(sys.argv[1] if len(sys.argv) > 1 else "target/release").resolve() / "swarms"
    instances = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    warnings.simplefilter("ignore")
    print(f"| {DIMENSION} dimensions, {EVALUATIONS} evaluations | target | fluxfit | {'peer'} | of | only fluxfit | only the peer | p |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|")
    alike = True
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        for key, peer, search in (("de", "scipy", de), ("cma-es", "pycma", cma_es)):
            ours, theirs = fluxfit(program, key, instances), reached(search, instances)
            for k, target in enumerate(TARGETS):
                one = {problem for problem in theirs if ours[problem][k]}
                other = {problem for problem in theirs if theirs[problem][k]}
                only, only_other = len(one - other), len(other - one)
                p = binomtest(only, only + only_other).pvalue if only + only_other else 1.0
                alike = alike and p >= DOUBT
                print(f"| `{key}` beside {peer} | {target:g} | {len(one)} | {len(other)} | {len(theirs)} | {only} | {only_other} | {p:.2f} |")
    print(f"\nscipy {scipy.__version__}, pycma {cma.__version__}, coco-experiment {cocoex.__version__}.")
    sys.exit(not alike)


if __name__ == "__main__":
    main()
