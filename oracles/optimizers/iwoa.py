"""Improved whales. Draws: the map's starts; WOA's; then per trial about the best and component whether it moves, the Cauchy number if so."""

import numpy as np
from optimizers import woa
from search import MOTOR_BOX, SHIFTED_BOX

KEY = "iwoa"
LAWS = ["scale", "offset", "greedy", "strict"]
ALL = {"encircle", "search", "spiral", "clamped", "accepted", "rejected", "best moved", "best whale moved", "a generation goes on in the next iteration"}
CASES = [("defaults", {"width": 0.1}, MOTOR_BOX, 6, 8, 1, ALL), ("altered", {"width": 0.3}, SHIFTED_BOX, 7, 8, 1, ALL)]


class Method(woa.Method):
    def a(self):
        return 2 * (1 - self.u**2)

    def generations(self):
        n = self.population
        trials = self.logistic_start()
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        while True:
            trials = [self.trial(i) for i in range(n)]
            width = self.settings["width"] * self.width * (1 - self.u) ** 3
            for _ in range(5):
                trial = self.g.copy()
                for d in range(self.d):
                    if self.draws.uniform() < 0.5:
                        trial[d] += width[d] * self.draws.student_t(1)
                trials.append(trial)
            trials = self.clamp(np.array(trials))
            best = np.argmin(self.f)
            costs = yield trials
            self.accept_better(trials[:n], costs[:n])
            self.x, self.f = self.x.copy(), self.f.copy()
            for trial, cost in zip(trials[n:], costs[n:]):
                if self.less(trial, cost, self.x[best], self.f[best]):
                    self.seen["best whale moved"] += 1
                    self.x[best], self.f[best] = trial, cost
            yield
