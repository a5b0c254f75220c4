"""Cuckoos. Draws of a flight per component: u, v of the Lévy step (all components), then the normal factors; of an abandonment: two
permutations, the factor r, then per nest and component one number."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "cuckoo"
LAWS = ["limit", "scale", "shift", "offset", "greedy", "strict"]
ALL = {"egg moved", "egg stays", "clamped", "accepted", "rejected", "best moved"}
CASES = [
    ("defaults", {"scale": 0.01, "abandoned": 0.25}, MOTOR_BOX, 6, 6, 1, ALL),
    ("altered", {"scale": 0.5, "abandoned": 0.6}, SHIFTED_BOX, 7, 5, 1, ALL),
]


class Method(Generations):
    def generations(self):
        trials = self.uniform_start()
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        while True:
            flights = [x + self.settings["scale"] * self.levy() * (x - self.g) * self.draws.normal(self.d) for x in self.x]
            trials = self.clamp(np.array(flights))
            costs = yield trials
            self.accept_better(trials, costs)
            yield
            a, b = self.draws.permutation(self.population), self.draws.permutation(self.population)
            r = self.draws.uniform()
            moved = self.draws.uniform(self.population, self.d) > self.settings["abandoned"]
            self.seen["egg moved"] += int(moved.sum())
            self.seen["egg stays"] += int((~moved).sum())
            trials = self.clamp(np.where(moved, self.x + r * (self.x[a] - self.x[b]), self.x))
            costs = yield trials
            self.accept_better(trials, costs)
            yield
