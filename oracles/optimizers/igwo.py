"""Improved grey wolves. Draws: the map's starts; per component whether it is a drop; N, N' of the drop, or per leader r of A, r of C."""

import numpy as np
from optimizers.ssa_cloud import drop
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "igwo"
LAWS = ["scale", "offset", "greedy", "strict"]
ALL = {"drop", "leaders", "new leader", "clamped", "accepted", "rejected", "best moved"}
CASES = [("defaults", {"drops": 0.2}, MOTOR_BOX, 6, 4, 1, ALL), ("altered", {"drops": 0.5}, SHIFTED_BOX, 7, 5, 1, ALL)]


class Method(Generations):
    def follow(self):
        for x, f in zip(self.x, self.f):
            if any((x == place).all() for _, place in self.leaders):
                continue
            assert all(abs(f - held) > 1e-9 for held, _ in self.leaders), "two costs are too close to compare; take another seed"
            self.leaders.append((f, x.copy()))
            self.leaders.sort(key=lambda leader: leader[0])
            self.seen["new leader"] += len(self.leaders) > 3 and self.leaders[3][0] != f
            del self.leaders[3:]

    def generations(self):
        trials = self.logistic_start()
        costs = yield trials
        self.accept_all(trials, costs)
        self.leaders = []
        self.follow()
        yield
        while True:
            a = 2 * (1 - self.u**2)
            trials = np.empty_like(self.x)
            for i in range(self.population):
                for d in range(self.d):
                    x = self.x[i, d]
                    if self.draws.uniform() < self.settings["drops"]:
                        self.seen["drop"] += 1
                        alpha = self.leaders[0][1][d]
                        trials[i, d] = alpha + drop(self.draws, abs(alpha - x))
                    else:
                        self.seen["leaders"] += 1
                        trials[i, d] = 0
                        for weight, (_, leader) in zip((0.5, 0.3, 0.2), self.leaders):
                            r1, r2 = self.draws.uniform(2)
                            trials[i, d] += weight * (leader[d] - (2 * a * r1 - a) * abs(2 * r2 * leader[d] - x))
            trials = self.clamp(trials)
            costs = yield trials
            self.accept_better(trials, costs)
            self.follow()
            yield
