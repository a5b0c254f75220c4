"""Salps. Draws per component of a leader: c2, the sign."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "ssa"
LAWS = ["scale", "offset"]
ALL = {"forwards", "backwards", "clamped", "best moved"}
CASES = [("defaults", {}, MOTOR_BOX, 6, 4, 1, ALL), ("altered", {}, SHIFTED_BOX, 7, 5, 1, ALL)]


class Method(Generations):
    def generations(self):
        trials = self.uniform_start()
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        while True:
            c1 = 2 * np.exp(-((4 * self.u) ** 2))
            chain = []
            for i in range(self.population):
                if i < self.population // 2:
                    c2, c3 = self.draws.uniform(self.d, 2).T
                    step = c1 * (self.width * c2 + self.lower)
                    chain.append(np.where(c3 < 0.5, self.g + step, self.g - step))
                    self.seen["forwards"] += int((c3 < 0.5).sum())
                    self.seen["backwards"] += int((c3 >= 0.5).sum())
                else:
                    # The one before it has moved already, and is not yet put back into the box.
                    chain.append((self.x[i] + chain[-1]) / 2)
            trials = self.clamp(np.array(chain))
            costs = yield trials
            self.accept_all(trials, costs)
            yield
