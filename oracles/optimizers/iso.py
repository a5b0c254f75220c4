"""Improved snakes. Draws: the map's starts, then r of each quasi-opposite; SO's; of the helpers a permutation, the Cauchy numbers, then per
snake helped r, its partners, one number per component."""

import numpy as np
from optimizers.so import ALL as SNAKES
from optimizers.so import Snakes
from search import MOTOR_BOX, SHIFTED_BOX

KEY = "iso"
LAWS = ["scale"]
ALL = (SNAKES - {"no egg"}) | {"helped", "not helped", "best helped"}
CASES = [
    ("defaults", {"c1": 0.5, "c2": 0.05, "c3": 2.0}, MOTOR_BOX, 8, 10, 1, ALL),
    ("altered", {"c1": 0.6, "c2": 0.5, "c3": 1.5}, SHIFTED_BOX, 9, 10, 2, ALL - {"explore"}),
]


class Method(Snakes):
    def generations(self):
        n = self.population
        x = self.logistic_start()
        centre = (self.lower + self.upper) / 2
        trials = np.vstack([x, centre + self.draws.uniform(n, self.d) * (self.lower + self.upper - x - centre)])
        costs = yield trials
        best = np.sort(np.argsort(costs)[:n])
        self.x, self.f = trials[best], costs[best]
        yield
        while True:
            trials = self.crawl()
            costs = yield trials
            self.accept_better(trials, costs)
            yield
            helped = self.draws.permutation(n)[: n // 4]
            width = 0.1 * (1 - self.u)
            trials = [self.g * (1 + width * np.array([float(self.draws.student_t(1)) for _ in range(self.d)]))]
            for i in helped:
                r = self.draws.uniform()
                j, k = self.draws.partners(i, 2, n)
                trials.append(self.x[i] + np.where(self.draws.uniform(self.d) < 0.5, r * (self.x[j] - self.x[k]), 0))
            trials = self.clamp(np.array(trials))
            whom = [np.argmin(self.f), *helped]
            costs = yield trials
            self.x, self.f = self.x.copy(), self.f.copy()
            for k, i in enumerate(whom):
                better = self.less(trials[k], costs[k], self.x[i], self.f[i])
                self.seen["best helped" if better and k == 0 else "helped" if better else "not helped"] += 1
                if better:
                    self.x[i], self.f[i] = trials[k], costs[k]
            yield
