"""DE/rand/1/bin. Draws per candidate: a, b, c; the forced index; one number per dimension."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "de"
LAWS = ["limit", "scale", "shift", "offset", "greedy"]
ALL = {"crossed", "kept coordinate", "below the box", "above the box", "accepted", "rejected", "best moved"}
CASES = [
    ("defaults", {"factor": 0.5, "crossover": 0.9}, MOTOR_BOX, 6, 4, 1, ALL),
    ("altered", {"factor": 0.8, "crossover": 0.4}, SHIFTED_BOX, 6, 4, 1, ALL),
]


class Method(Generations):
    def generations(self):
        trials = self.uniform_start()
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        while True:
            trials = np.array([self.trial(i) for i in range(self.population)])
            costs = yield trials
            self.accept_better(trials, costs)
            yield

    def trial(self, i):
        a, b, c = self.draws.partners(i, 3, self.population)
        forced = self.draws.index(self.d)
        crossed = self.draws.uniform(self.d) < self.settings["crossover"]
        crossed[forced] = True
        mutant = np.where(crossed, self.x[a] + self.settings["factor"] * (self.x[b] - self.x[c]), self.x[i])
        below, above = mutant < self.lower, mutant > self.upper
        for branch, hit in (("crossed", crossed), ("kept coordinate", ~crossed), ("below the box", below), ("above the box", above)):
            self.seen[branch] += int(hit.sum())
        mutant = np.where(below, (self.lower + self.x[i]) / 2, mutant)
        return np.where(above, (self.upper + self.x[i]) / 2, mutant)
