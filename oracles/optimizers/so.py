"""Snakes. Draws: fight or mate, where it is neither to explore nor to eat; mating: whether the worst are drawn anew; then per snake: exploring,
per component the member, r, the sign; eating: the sign, then r per component; else r per component, or the new place."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "so"
LAWS = ["scale", "greedy", "strict"]
ALL = {"explore", "eat", "fight", "mate", "hatch", "no egg", "clamped", "accepted", "rejected", "best moved"}
CASES = [
    ("defaults", {"c1": 0.5, "c2": 0.05, "c3": 2.0}, MOTOR_BOX, 6, 9, 1, ALL),
    ("altered", {"c1": 0.6, "c2": 0.5, "c3": 1.5}, SHIFTED_BOX, 7, 9, 1, ALL - {"explore"}),
]

EPS = np.finfo(float).eps


class Snakes(Generations):
    def crawl(self):
        s, draws, x, f = self.settings, self.draws, self.x, self.f
        heat, food = np.exp(-self.u), s["c1"] * np.exp(self.u - 1)
        half = self.population // 2
        halves = [np.arange(half), np.arange(half, self.population)]
        assert abs(food - 0.25) > 1e-6 and abs(heat - 0.6) > 1e-6
        mode, egg = "explore" if food < 0.25 else "eat" if heat > 0.6 else None, False
        if mode is None:
            mode = "fight" if draws.uniform() > 0.6 else "mate"
            if mode == "mate":
                egg = draws.uniform() < 0.5
                self.seen["hatch" if egg else "no egg"] += 1
        self.seen[mode] += 1
        trials = []
        for i in range(self.population):
            own, other = (halves[0], halves[1]) if i < half else (halves[1], halves[0])
            if mode == "explore":
                trial = np.empty(self.d)
                for d in range(self.d):
                    member = own[draws.index(len(own))]
                    step = s["c2"] * np.exp(-f[member] / (f[i] + EPS)) * (self.width[d] * draws.uniform() + self.lower[d])
                    trial[d] = x[member, d] + draws.sign() * step
            elif mode == "eat":
                sign = draws.sign()
                trial = self.g + sign * s["c3"] * heat * draws.uniform(self.d) * (self.g - x[i])
            elif egg and i == own[np.argmax(f[own])]:
                trial = self.lower + draws.uniform(self.d) * self.width
            else:
                mate = other[np.argmin(f[other])] if mode == "fight" else other[(i - own[0]) % len(other)]
                trial = x[i] + s["c3"] * np.exp(-f[mate] / (f[i] + EPS)) * draws.uniform(self.d) * (food * x[mate] - x[i])
            trials.append(trial)
        return self.clamp(np.array(trials))


class Method(Snakes):
    def generations(self):
        trials = self.uniform_start()
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        while True:
            trials = self.crawl()
            costs = yield trials
            self.accept_better(trials, costs)
            yield
