"""CMA-ES. Draws: the mean in the unit box; per sample, as often as it is drawn, one normal number per component."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "cma-es"
LAWS = ["limit", "scale", "shift", "offset"]
ALL = {"drawn again", "inside at once", "long path", "short path", "best moved", "a generation goes on in the next iteration"}
CASES = [
    ("defaults", {}, MOTOR_BOX, 6, 12, 28, ALL),
    ("altered", {}, SHIFTED_BOX, 7, 12, 28, ALL),
    ("wide", {}, SHIFTED_BOX, 6, 4, 2, {"clamped sample", "drawn again"}, {"normals": lambda numbers: 4 * numbers}),
]


class Method(Generations):
    def fresh(self):
        self.m = self.draws.uniform(self.d)
        self.sigma, self.C = 0.3, np.eye(self.d)
        self.p_s, self.p_c, self.count = np.zeros(self.d), np.zeros(self.d), 0

    def sample(self, lam):
        values, vectors = np.linalg.eigh(self.C)
        root = (vectors * np.sqrt(values)) @ vectors.T
        self.inverse_root = (vectors / np.sqrt(values)) @ vectors.T
        self.y = []
        for _ in range(lam):
            for attempt in range(101):
                y = root @ self.draws.normal(self.d)
                x = self.m + self.sigma * y
                if ((x >= 0) & (x <= 1)).all():
                    self.seen["drawn again" if attempt else "inside at once"] += 1
                    break
            else:
                self.seen["clamped sample"] += 1
                y = (np.clip(x, 0, 1) - self.m) / self.sigma
            self.y.append(y)
        self.y = np.array(self.y)
        return self.lower + (self.m + self.sigma * self.y) * self.width

    def learn(self, costs):
        n, lam = self.d, len(costs)
        best = self.ranking(costs)[: lam // 2]
        w = np.log((lam + 1) / 2) - np.log(np.arange(1, lam // 2 + 1))
        w /= w.sum()
        mu = 1 / (w**2).sum()
        c_s = (mu + 2) / (n + mu + 5)
        d_s = 1 + 2 * max(0, np.sqrt((mu - 1) / (n + 1)) - 1) + c_s
        c_c = (4 + mu / n) / (n + 4 + 2 * mu / n)
        c_1 = 2 / ((n + 1.3) ** 2 + mu)
        c_mu = min(1 - c_1, 2 * (mu - 2 + 1 / mu) / ((n + 2) ** 2 + mu))
        chi = np.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n**2))
        step = w @ self.y[best]
        self.p_s = (1 - c_s) * self.p_s + np.sqrt(c_s * (2 - c_s) * mu) * (self.inverse_root @ step)
        self.count += 1
        norm = np.linalg.norm(self.p_s)
        h = norm / np.sqrt(1 - (1 - c_s) ** (2 * self.count)) < (1.4 + 2 / (n + 1)) * chi
        self.seen["short path" if h else "long path"] += 1
        self.p_c = (1 - c_c) * self.p_c + h * np.sqrt(c_c * (2 - c_c) * mu) * step
        delta = (1 - h) * c_c * (2 - c_c)
        rank_mu = (w[:, None, None] * self.y[best][:, :, None] * self.y[best][:, None, :]).sum(axis=0)
        self.C = (1 + c_1 * delta - c_1 - c_mu) * self.C + c_1 * np.outer(self.p_c, self.p_c) + c_mu * rank_mu
        self.m = self.m + self.sigma * step
        self.sigma *= np.exp(c_s / d_s * (norm / chi - 1))

    def generations(self):
        lam = 4 + int(3 * np.log(self.d))
        self.fresh()
        while True:
            trials = self.sample(lam)
            costs = yield trials
            self.accept_all(trials, costs)
            self.learn(costs)
            yield
