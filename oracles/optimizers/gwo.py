"""Grey wolves. Draws per component and leader: r of A, r of C."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "gwo"
LAWS = ["scale", "offset"]
ALL = {"clamped", "new alpha", "new beta", "new delta", "no new leader"}
CASES = [("defaults", {}, MOTOR_BOX, 6, 4, 2, ALL), ("altered", {}, SHIFTED_BOX, 7, 5, 1, ALL)]


class Method(Generations):
    def generations(self):
        trials = self.uniform_start()
        costs = yield trials
        self.accept_all(trials, costs)
        order = np.argsort(costs)[:3]
        self.leaders = [(costs[k], trials[k].copy()) for k in order]
        yield
        while True:
            a = 2 * (1 - self.u)
            r1, r2 = np.moveaxis(self.draws.uniform(self.population, self.d, 3, 2), -1, 0)
            trials = np.zeros_like(self.x)
            for k, (_, leader) in enumerate(self.leaders):
                trials += leader - (2 * a * r1[:, :, k] - a) * abs(2 * r2[:, :, k] * leader - self.x)
            trials = self.clamp(trials / 3)
            costs = yield trials
            self.accept_all(trials, costs)
            for x, f in zip(trials, costs):
                if any((x == place).all() for _, place in self.leaders):
                    continue
                assert all(abs(f - held) > 1e-9 for held, _ in self.leaders), "two costs are too close to compare; take another seed"
                rank = sum(f > held for held, _ in self.leaders)
                self.seen[("new alpha", "new beta", "new delta", "no new leader")[rank]] += 1
                self.leaders.insert(rank, (f, x.copy()))
                del self.leaders[3:]
            yield
