"""Honey badgers. Draws per badger: r of the intensity, which phase, the sign; per component: r3, r4, r5 when it digs, else r7."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "hba"
LAWS = ["offset", "greedy", "strict"]
ALL = {"dig", "honey", "clamped", "accepted", "rejected", "best moved"}
CASES = [
    ("defaults", {"beta": 6.0, "c": 2.0}, MOTOR_BOX, 6, 4, 1, ALL),
    ("altered", {"beta": 0.5, "c": 1.5}, SHIFTED_BOX, 7, 5, 1, ALL),
]

EPS = np.finfo(float).eps


class Method(Generations):
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

    def trial(self, i):
        r, phase = self.draws.uniform(2)
        sign = self.draws.sign()
        x, prey = self.x[i], self.g
        source = ((x - self.x[(i + 1) % self.population] + EPS) ** 2).sum()
        distance = ((x - prey + EPS) ** 2).sum()
        intensity = r * source / (4 * np.pi * distance)
        alpha = self.settings["c"] * np.exp(-self.u)
        if phase < 0.5:
            self.seen["dig"] += 1
            r3, r4, r5 = self.draws.uniform(self.d, 3).T
            swing = abs(np.cos(2 * np.pi * r4) * (1 - np.cos(2 * np.pi * r5)))
            return prey + sign * self.settings["beta"] * intensity * prey + sign * r3 * alpha * (prey - x) * swing
        self.seen["honey"] += 1
        return prey + sign * self.draws.uniform(self.d) * alpha * (prey - x)
