"""Salps in a cloud. Draws per component: of a leader c2, the sign; of a follower whether it is a drop, then N, N' if so."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "ssa-cloud"
LAWS = ["scale", "offset", "greedy", "strict"]
ALL = {"forwards", "backwards", "drop", "chain", "clamped", "accepted", "rejected", "best moved"}
CASES = [("defaults", {"drops": 0.8}, MOTOR_BOX, 6, 4, 1, ALL), ("altered", {"drops": 0.4}, SHIFTED_BOX, 7, 5, 1, ALL)]


def drop(draws, entropy):
    """Li and Du's generator."""
    wide = entropy + entropy / 10 * draws.normal()
    return wide * draws.normal()


class Method(Generations):
    def generations(self):
        trials = self.uniform_start()
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        while True:
            c1 = 2 * np.exp(-16 * self.u**2)
            chain = []
            for i in range(self.population):
                trial = np.empty(self.d)
                for d in range(self.d):
                    if i < self.population // 2:
                        step = c1 * (self.width[d] * self.draws.uniform() + self.lower[d])
                        sign = self.draws.sign()
                        self.seen["forwards" if sign > 0 else "backwards"] += 1
                        trial[d] = self.g[d] + sign * step
                    elif self.draws.uniform() < self.settings["drops"]:
                        entropy = 0.1 * self.width[d] * (1 - self.u) ** 4 + 0.5 * abs(self.x[i, d] - self.g[d])
                        trial[d] = self.g[d] + drop(self.draws, entropy)
                        self.seen["drop"] += 1
                    else:
                        trial[d] = (self.x[i, d] + chain[-1][d]) / 2
                        self.seen["chain"] += 1
                chain.append(trial)
            trials = self.clamp(np.array(chain))
            costs = yield trials
            self.accept_better(trials, costs)
            yield
