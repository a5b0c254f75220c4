"""tMFPA. Draws: the map's starts; per flower rand; the Lévy steps, T(t), j, k; or e, e', j, k, l, m, whether coordinates are drawn anew, and if so
a permutation of them and their places."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "tmfpa"
LAWS = ["limit", "scale", "shift", "offset", "greedy", "strict"]
ALL = {"global", "local", "renewed", "clamped", "accepted", "rejected", "best moved"}
CASES = [
    ("defaults", {"switch_probability": 0.8, "gamma": 0.1, "renewed": 0.05}, MOTOR_BOX, 6, 5, 3, ALL),
    ("altered", {"switch_probability": 0.4, "gamma": 0.5, "renewed": 0.5}, SHIFTED_BOX, 7, 5, 1, ALL),
]


class Method(Generations):
    def trial(self, i, t):
        x, draws, s = self.x, self.draws, self.settings
        if draws.uniform() > s["switch_probability"]:
            self.seen["global"] += 1
            step = s["gamma"] * self.levy() * (x[i] - self.g)
            perturbation = draws.student_t(t)
            j, k = draws.partners(i, 2, self.population)
            return x[i] + step + perturbation * (x[j] - x[k])
        self.seen["local"] += 1
        first, second = draws.uniform(2)
        j, k, l, m = draws.partners(i, 4, self.population)
        trial = self.g + first * (x[j] - x[k]) + second * (x[l] - x[m])
        if draws.uniform() < s["renewed"]:
            self.seen["renewed"] += 1
            for d in draws.permutation(self.d)[: max(1, self.d // 4)]:
                trial[d] = self.lower[d] + draws.uniform() * self.width[d]
        return trial

    def generations(self):
        trials = self.logistic_start()
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        for t in range(1, self.iterations + 1):
            trials = self.clamp(np.array([self.trial(i, t) for i in range(self.population)]))
            costs = yield trials
            self.accept_better(trials, costs)
            yield
