"""IPOP-CMA-ES. Draws as CMA-ES; a restart draws the new mean."""

import numpy as np
from optimizers import cma_es
from search import MOTOR_BOX, SHIFTED_BOX

KEY = "ipop-cma-es"
LAWS = ["limit", "scale", "shift", "offset"]
CLIMB = cma_es.ALL
CASES = [
    ("defaults", {"tolerance": 1e-13}, MOTOR_BOX, 6, 12, 28, CLIMB),
    ("altered", {"tolerance": 0.2}, SHIFTED_BOX, 12, 40, 1, CLIMB | {"restarted: small"}),
    ("flat", {"tolerance": 0.25}, SHIFTED_BOX, 20, 30, 92, CLIMB | {"restarted: flat"}),
    ("plateau", {"tolerance": 1e-13}, SHIFTED_BOX, 20, 30, 1, {"restarted: flat"}, {"floor": 1.0}),
]


class Method(cma_es.Method):
    def generations(self):
        lam, bests = 4 + int(3 * np.log(self.d)), []
        self.fresh()
        while True:
            trials = self.sample(lam)
            costs = yield trials
            self.accept_all(trials, costs)
            self.learn(costs)
            window = 10 + int(np.ceil(30 * self.d / lam))
            bests = (bests + [costs.min()])[-window:]
            flat = len(bests) == window and max(bests) - min(bests) < self.settings["tolerance"]
            small = self.sigma < self.settings["tolerance"]
            if flat or small:
                self.seen["restarted: flat"] += flat
                self.seen["restarted: small"] += small
                lam, bests = 2 * lam, []
                self.fresh()
            yield
