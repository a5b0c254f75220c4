"""Bacteria in niches. Draws of a tumble per bacterium: d, whether it is drawn, r per component if so and a better one exists; of a split per
offspring: its partners, r per component; of a scattering: one number for each but the best, then the places."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "nbfo"
LAWS = ["scale", "shift", "offset"]
ALL = {"drawn", "not drawn", "nobody better", "swims on", "stops", "swims to the end", "split", "clamped", "best moved"}
CASES = [
    ("defaults", {"step": 0.1, "pull": 1.5, "scattered": 0.05, "tumbles": 20, "splits": 4}, MOTOR_BOX, 6, 70, 2, ALL),
    ("altered", {"step": 0.3, "pull": 1.0, "scattered": 0.5, "tumbles": 3, "splits": 2}, SHIFTED_BOX, 7, 40, 1, ALL | {"scattered"}),
]


class Method(Generations):
    def step(self, i, size):
        d = 2 * self.draws.uniform(self.d) - 1
        step = size * d / np.linalg.norm(d) * self.width
        if self.draws.uniform() >= 0.5:
            self.seen["not drawn"] += 1
            return step, 0 * step
        better = np.flatnonzero(self.f < self.f[i])
        if not len(better):
            self.seen["nobody better"] += 1
            return step, 0 * step
        self.seen["drawn"] += 1
        distance = (((self.x[better] - self.x[i]) / self.width) ** 2).sum(axis=1)
        return step, self.settings["pull"] * self.draws.uniform(self.d) * (self.x[better[np.argmin(distance)]] - self.x[i])

    def generations(self):
        n = self.population
        trials = self.uniform_start()
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        while True:
            for split in range(self.settings["splits"]):
                for tumble in range(self.settings["tumbles"]):
                    size = self.settings["step"] * 10 ** (-6 * self.u)
                    step, pull = (np.array(parts) for parts in zip(*[self.step(i, size) for i in range(n)]))
                    who = np.arange(n)
                    for swim in range(5):
                        # Only the tumble is drawn; the swim goes on along its direction.
                        trials = self.clamp(self.x[who] + step[who] + (pull[who] if swim == 0 else 0))
                        costs = yield trials
                        on = self.less(trials, costs, self.x[who], self.f[who])
                        self.x, self.f = self.x.copy(), self.f.copy()
                        self.x[who[on]], self.f[who[on]] = trials[on], costs[on]
                        self.seen["swims to the end" if swim == 4 else "swims on"] += int(on.sum())
                        self.seen["stops"] += int((~on).sum())
                        who = who[on]
                        yield
                        if not len(who):
                            break
                order = np.argsort(self.f, kind="stable")
                survivors, places = order[: n - n // 2], np.sort(order[n - n // 2 :])
                self.seen["split"] += 1
                trials = []
                for k in range(n // 2):
                    to, fro = survivors[self.draws.partners(k, 2, n - n // 2)]
                    trials.append(self.x[order[k]] + self.draws.uniform(self.d) * (self.x[to] - self.x[fro]))
                trials = self.clamp(np.array(trials))
                costs = yield trials
                self.x, self.f = self.x.copy(), self.f.copy()
                self.x[places], self.f[places] = trials, costs
                yield
            best = np.argmin(self.f)
            gone = np.zeros(n, bool)
            gone[np.arange(n) != best] = self.draws.uniform(n - 1) < self.settings["scattered"]
            if gone.any():
                self.seen["scattered"] += 1
                trials = self.uniform_start(int(gone.sum()))
                costs = yield trials
                self.x, self.f = self.x.copy(), self.f.copy()
                self.x[gone], self.f[gone] = trials, costs
                yield
