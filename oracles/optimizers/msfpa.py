"""Pollination with several strategies. Draws per flower: rand; the Lévy steps; or which half, then e, j, k, r per component, or F's normal number,
j, k, the forced coordinate, one number per component."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "msfpa"
LAWS = ["scale", "shift", "offset", "greedy", "strict"]
ALL = {"global", "local", "crossed", "kept coordinate", "clamped", "accepted", "rejected", "best moved"}
CASES = [
    ("defaults", {"switch_probability": 0.8, "gamma": 0.1, "crossover": 0.9}, MOTOR_BOX, 6, 5, 1, ALL),
    ("altered", {"switch_probability": 0.4, "gamma": 0.5, "crossover": 0.3}, SHIFTED_BOX, 7, 5, 1, ALL),
]


class Method(Generations):
    def trial(self, i):
        x, draws, s = self.x, self.draws, self.settings
        if draws.uniform() > s["switch_probability"]:
            self.seen["global"] += 1
            w = 0.9 - 0.5 * self.u
            return w * x[i] + (1 - w) * self.g + s["gamma"] * self.levy() * (x[i] - self.g)
        if draws.uniform() < 0.5:
            self.seen["local"] += 1
            e = draws.uniform()
            j, k = draws.partners(i, 2, self.population)
            return x[i] + e * (x[j] - x[k]) + draws.uniform(self.d) * (self.g - x[i])
        factor = 0.5 + 0.3 * draws.normal()
        j, k = draws.partners(i, 2, self.population)
        forced = draws.index(self.d)
        crossed = draws.uniform(self.d) < s["crossover"]
        crossed[forced] = True
        self.seen["crossed"] += int(crossed.sum())
        self.seen["kept coordinate"] += int((~crossed).sum())
        return np.where(crossed, self.g + factor * (x[j] - x[k]), x[i])

    def generations(self):
        trials = self.uniform_start()
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        while True:
            trials = self.clamp(np.array([self.trial(i) for i in range(self.population)]))
            costs = yield trials
            self.accept_better(trials, costs)
            yield
