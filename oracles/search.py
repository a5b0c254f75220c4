"""What the oracles of all search methods share: recorded draws, the objective, the box, which branches were taken."""

import math
from collections import Counter

import numpy as np

POPULATION = 6
ITERATIONS = 4

# Widths as far apart as those of a motor's resistance, inductances and flux linkage, so that a step scaled by the wrong width shows.
MOTOR_BOX = np.array([[0.0, 5.0], [0.0, 0.05], [0.0, 0.05], [0.0, 1.0]])
# Faces away from zero, on both sides of it, so that a forgotten lower bound shows.
SHIFTED_BOX = np.array([[-1.0, 4.0], [0.01, 0.06], [-0.05, 0.02], [0.25, 2.25]])

# f = z' A z + (c . z)^4 with z = (x - lower) / (upper - lower) - centre: not separable, one minimum, inside the box.
OBJECTIVE = {
    "coupling": [[4.0, 1.5, -0.5, 0.75], [1.5, 3.0, 0.5, -1.0], [-0.5, 0.5, 2.0, 0.25], [0.75, -1.0, 0.25, 5.0]],
    "quartic": [1.0, -2.0, 1.5, 0.5],
    "centre": [0.19, 0.105, 0.24, 0.1827],
}


class Draws:
    """Draws random numbers and writes each of them down.

    `normals` is what a case makes of the normal numbers, to take a branch that they hardly ever take: replayed, they are only numbers.
    """

    def __init__(self, seed, normals=None):
        self.generator = np.random.default_rng(seed)
        self.normals = normals or (lambda numbers: numbers)
        self.record = []

    def _noted(self, numbers):
        self.record += np.ravel(numbers).tolist()
        return numbers

    def uniform(self, *shape):
        return self._noted(self.generator.random(shape))

    def normal(self, *shape):
        return self._noted(self.normals(self.generator.standard_normal(shape)))

    def student_t(self, degrees):
        return self._noted(self.generator.standard_t(degrees))

    def partners(self, i, count, population=POPULATION):
        return self._noted(self.generator.choice(np.delete(np.arange(population), i), count, replace=False))

    def index(self, count):
        return int(self._noted(self.generator.integers(count)))

    def permutation(self, count):
        return self._noted(self.generator.permutation(count))

    def sign(self):
        return 1.0 if self.uniform() < 0.5 else -1.0


class Search:
    """What all methods share: the box, the objective, the best seen, and which branches were taken."""

    floor = 0.0  # no cost is lower: the objective has none below 0, a case may have it flat below more

    def __init__(self, settings, box, seed):
        self.settings, self.draws, self.seen = settings, Draws(seed), Counter()
        self.lower, self.upper = box.T
        self.width = self.upper - self.lower
        self.x = self.start()
        self.f = self.cost(self.x)
        self.g, self.f_g = self.x[np.argmin(self.f)].copy(), self.f.min()

    def cost(self, x):
        return np.maximum(self.height(x), self.floor)

    def height(self, x):
        z = (x - self.lower) / self.width - np.array(OBJECTIVE["centre"])
        quadratic = (z[:, :, None] * np.array(OBJECTIVE["coupling"]) * z[:, None, :]).sum(axis=(1, 2))
        return quadratic + ((z * np.array(OBJECTIVE["quartic"])).sum(axis=1)) ** 4

    def start(self):
        return self.lower + self.draws.uniform(POPULATION, len(self.width)) * self.width

    def clamp(self, x):
        clamped = np.clip(x, self.lower, self.upper)
        self.seen["clamped"] += int((clamped != x).sum())
        return clamped

    def less(self, x, f, x_held, f_held):
        """Which costs are lower. A comparison that rounding could turn around would make a bad oracle: refused."""
        same_place = (x == x_held).all(axis=-1)
        on_floor = (f == self.floor) & (f_held == self.floor)
        assert (same_place | on_floor | (abs(f - f_held) > 1e-9)).all(), "two costs are too close to compare; take another seed"
        return ~same_place & (f < f_held)

    def ranking(self, costs):
        """From the lowest to the highest; of two on the floor, the first one first."""
        order = np.argsort(costs, kind="stable")
        ranked = costs[order]
        assert ((np.diff(ranked) > 1e-9) | (ranked[1:] == self.floor)).all(), "two costs are too close to compare; take another seed"
        return order

    def keep_best(self):
        best = np.argmin(self.f)
        if self.less(self.x[best], self.f[best], self.g, self.f_g):
            self.g, self.f_g = self.x[best].copy(), self.f[best]
            self.seen["best moved"] += 1

    def state(self):
        return {"positions": self.x.ravel().tolist(), "costs": self.f.tolist(), "best": self.g.tolist(), "best_cost": float(self.f_g)}


class Generations(Search):
    """A method whose generations may have any size; a state is noted after every `population` evaluations.

    `generations` yields trials and is sent their costs; when it has accepted, it yields nothing (`None`).
    """

    def __init__(self, settings, box, seed, population, iterations, floor=0.0, normals=None):
        self.settings, self.draws, self.seen, self.floor = settings, Draws(seed, normals), Counter(), floor
        self.lower, self.upper = box.T
        self.width = self.upper - self.lower
        self.d = len(self.width)
        self.population, self.iterations, self.evaluations = population, iterations, 0
        self.g, self.f_g = None, math.inf

    @property
    def u(self):
        return min(self.evaluations / (self.population * self.iterations), 1.0)

    def uniform_start(self, rows=None):
        return self.lower + self.draws.uniform(rows or self.population, self.d) * self.width

    def logistic_start(self):
        b = self.draws.uniform(self.d)
        # The library draws again near the starts that end in a fixed point; not exercised here.
        assert abs(b[:, None] - [0, 0.25, 0.5, 0.75, 1]).min() > 1e-3
        chain = [b]
        while len(chain) < self.population:
            chain.append(4 * chain[-1] * (1 - chain[-1]))
        return self.lower + np.array(chain) * self.width

    def course(self):
        """The states after the first population, and after each iteration."""
        states, generations = [], self.generations()
        total = self.population * (1 + self.iterations)
        while True:
            trials = next(generations)
            self.x_shown, self.f_shown = (self.x, self.f) if states or self.evaluations else (trials, np.full(len(trials), 1.7976931348623157e308))
            costs = self.cost(trials)
            for k, (trial, cost) in enumerate(zip(trials, costs)):
                if self.g is None or self.less(trial, cost, self.g, self.f_g):
                    self.seen["best moved"] += self.g is not None
                    self.g, self.f_g = trial.copy(), float(cost)
                self.evaluations += 1
                if k + 1 == len(trials):
                    assert generations.send(costs) is None
                    self.x_shown, self.f_shown = self.x, self.f
                if self.evaluations % self.population == 0:
                    states.append(self.state())
                    if k + 1 < len(trials):
                        self.seen["a generation goes on in the next iteration"] += 1
                if self.evaluations == total:
                    return states

    def state(self):
        return {
            "positions": self.x_shown.ravel().tolist(),
            "costs": self.f_shown.tolist(),
            "best": self.g.tolist(),
            "best_cost": self.f_g,
        }

    def accept_all(self, trials, costs):
        self.x, self.f = trials.copy(), costs.copy()

    def accept_better(self, trials, costs):
        """Takes the trials that are better than the candidates of the same number."""
        better = self.less(trials, costs, self.x, self.f)
        self.seen["accepted"] += int(better.sum())
        self.seen["rejected"] += int((~better).sum())
        self.x, self.f = np.where(better[:, None], trials, self.x), np.where(better, costs, self.f)
        return better

    def levy(self):
        """Mantegna's steps, one per dimension."""
        lam = 1.5
        sigma = math.gamma(1 + lam) * math.sin(math.pi * lam / 2) / (math.gamma((1 + lam) / 2) * lam * 2 ** ((lam - 1) / 2))
        u, v = self.draws.normal(self.d, 2).T
        return sigma ** (1 / lam) * u / abs(v) ** (1 / lam)
