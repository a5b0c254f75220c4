"""Values of the BBOB functions by the COCO platform (package coco-experiment), which the functions of studies/src/bbob are held against.

    python3 oracles/bbob.py        rewrites studies/tests/bbob.json; needs numpy, coco-experiment

For each function, dimension and instance: the place and cost of the optimum, the costs at points in and around the box, and at points near
the optimum, where the cost is a small difference.
"""

import json
import tempfile
from contextlib import chdir
from pathlib import Path

import cocoex
import numpy as np

VALUES = Path(__file__).parent.parent / "studies/tests/bbob.json"

DIMENSIONS = (2, 5, 10)
INSTANCES = (1, 2, 15)
SEED = 1
# Half the box is 5: some points lie outside.
HALF_WIDTHS = (1.0, 4.0, 5.0, 6.0)
# Steps from the optimum.
NEAR = (1e-1, 1e-3)


def optimum(problem):
    """COCO tells it only through a file in the working folder."""
    problem._best_parameter("print")
    return np.loadtxt("._bbob_problem_best_parameter.txt").ravel()


def main():
    random = np.random.default_rng(SEED)
    points = {d: np.array([half * (2 * random.random(d) - 1) for half in HALF_WIDTHS]) for d in DIMENSIONS}
    steps = {d: np.array([size * random.standard_normal(d) for size in NEAR]) for d in DIMENSIONS}
    cases = []
    instances = ",".join(map(str, INSTANCES))
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        for problem in cocoex.Suite("bbob", f"instances: {instances}", f"dimensions: {','.join(map(str, DIMENSIONS))}"):
            function, dimension, instance = problem.id_triple
            best = optimum(problem)
            cases.append(
                {
                    "function": function,
                    "instance": instance,
                    "optimum": best.tolist(),
                    "lowest": problem(best),
                    "costs": [problem(x) for x in points[dimension]],
                    "near": [problem(best + step) for step in steps[dimension]],
                }
            )
    compact = {"separators": (",", ":"), "allow_nan": False}
    rows = ",\n".join(json.dumps(case, **compact) for case in cases)
    by_dimension = lambda of: json.dumps({str(d): of[d].tolist() for d in DIMENSIONS}, **compact)
    VALUES.write_text(f'{{"points":{by_dimension(points)},\n"steps":{by_dimension(steps)},\n"cases":[\n{rows}\n]}}\n')


if __name__ == "__main__":
    main()
