"""Bacteria. Draws of a tumble: d of all bacteria; of a scattering: one number per bacterium, then the places of those that go."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "bfo"
LAWS = ["limit", "scale", "shift", "offset"]
ALL = {"swims on", "stops at once", "swims to the end", "split", "clamped", "best moved", "a generation goes on in the next iteration"}
CASES = [
    ("defaults", {"step": 0.01, "scattered": 0.25, "tumbles": 20, "splits": 4}, MOTOR_BOX, 6, 60, 3, ALL),
    ("altered", {"step": 0.05, "scattered": 0.5, "tumbles": 3, "splits": 2}, SHIFTED_BOX, 7, 40, 1, ALL | {"scattered"}),
]


class Method(Generations):
    def attracted(self, i):
        distance = (((self.x[i] - self.x) / self.width) ** 2).sum(axis=1)
        return self.f[i] + (-0.1 * np.exp(-0.2 * distance) + 0.1 * np.exp(-10 * distance)).sum()

    def moved(self, who, trials, costs):
        self.x, self.f = self.x.copy(), self.f.copy()
        self.x[who], self.f[who] = trials, costs

    def generations(self):
        n = self.population
        trials = self.uniform_start()
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        while True:
            for _ in range(self.settings["splits"]):
                health = np.zeros(n)
                for tumble in range(self.settings["tumbles"]):
                    j = np.array([self.attracted(i) for i in range(n)])
                    d = 2 * self.draws.uniform(n, self.d) - 1
                    step = self.settings["step"] * d / np.linalg.norm(d, axis=1)[:, None] * self.width
                    who = np.arange(n)
                    for swim in range(5):
                        trials = self.clamp(self.x[who] + step[who])
                        costs = yield trials
                        self.moved(who, trials, costs)
                        new = np.array([self.attracted(i) for i in who])
                        assert ((abs(new - j[who]) > 1e-9) | (trials == self.x[who]).all()).all()
                        on = new < j[who]
                        j[who] = new
                        if swim == 0:
                            self.seen["stops at once"] += int((~on).sum())
                            self.seen["swims on"] += int(on.sum())
                        if swim == 4:
                            self.seen["swims to the end"] += int(on.sum())
                        who = who[on]
                        ends = len(who) == 0 or swim == 4
                        if not (ends and tumble == self.settings["tumbles"] - 1):
                            if ends:
                                health += j
                            yield
                        if ends:
                            break
                health += j
                assert np.diff(np.sort(health)).min() > 1e-9
                order = np.argsort(health, kind="stable")
                self.seen["split"] += 1
                order[n - n // 2 :] = order[: n // 2]
                self.x, self.f = self.x[order], self.f[order]
                yield
            gone = self.draws.uniform(n) < self.settings["scattered"]
            if gone.any():
                self.seen["scattered"] += 1
                trials = self.uniform_start(int(gone.sum()))
                costs = yield trials
                self.moved(np.flatnonzero(gone), trials, costs)
                yield
