"""Whales. Draws per whale: r of A, r of C, r of l, p; then, where it searches, the other whale."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "woa"
LAWS = ["scale", "offset"]
ALL = {"encircle", "search", "spiral", "clamped", "best moved"}
CASES = [("defaults", {}, MOTOR_BOX, 6, 4, 1, ALL), ("altered", {}, SHIFTED_BOX, 7, 5, 1, ALL)]


class Method(Generations):
    def generations(self):
        trials = self.uniform_start()
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        while True:
            trials = self.clamp(np.array([self.trial(i) for i in range(self.population)]))
            costs = yield trials
            self.accept_all(trials, costs)
            yield

    def a(self):
        return 2 * (1 - self.u)

    def trial(self, i):
        r_a, r_c, r_l, p = self.draws.uniform(4)
        a = self.a()
        big_a, big_c, l = 2 * a * r_a - a, 2 * r_c, 2 * r_l - 1
        if p >= 0.5:
            self.seen["spiral"] += 1
            return abs(self.g - self.x[i]) * np.exp(l) * np.cos(2 * np.pi * l) + self.g
        if abs(big_a) < 1:
            self.seen["encircle"] += 1
            towards = self.g
        else:
            self.seen["search"] += 1
            towards = self.x[self.draws.index(self.population)]
        return towards - big_a * abs(big_c * towards - self.x[i])
