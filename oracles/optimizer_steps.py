"""Golden courses of the search methods, computed independently of the library: tGFPA, FPA, LPSO and APSO here, each other one in its
file of optimizers/.

Written from the methods' equations with numpy arrays. Every random number is drawn here and recorded in the order in which the library asks
for it; the library, fed the same numbers, must walk the same course. The distributions themselves are therefore not checked by these numbers.

    python3 oracles/optimizer_steps.py        rewrites crates/fluxfit-optimize/tests/optimizer_steps.json; needs numpy

Order of the draws of the four (each array is recorded row after row):
    start     tgfpa logistic: b_1, one per dimension; otherwise positions; swarms then draw velocities, each component from 2 U(0,1) - 1
    flower    rand (p); tgfpa only: rand (m or q); then
              global: u, v of the Levy step per dimension; with the perturbation: T(t), j, k
              local:  epsilon, j, k; with the perturbation: G, G', j, k, l
    particle  rand of c1, rand of c2 per component

The seeds were chosen so that each course takes every branch of its method and meets the faces of the box; the script fails if one does not.
"""

import importlib
import json
import math
from pathlib import Path

import numpy as np

from search import ITERATIONS, MOTOR_BOX, OBJECTIVE, POPULATION, SHIFTED_BOX, Search

# Beside the test that reads them.
NUMBERS = Path(__file__).parent.parent / "crates/fluxfit-optimize/tests/optimizer_steps.json"

FPA = {"switch_probability": 0.8, "gamma": 0.1, "local_base": "accepted"}
TGFPA = FPA | {"plain_global": 0.2, "plain_local": 0.2, "start": "logistic"}
FLIGHT = {"cognitive": 2.0, "social": 2.0, "velocity_limit": 0.1}
LPSO = FLIGHT | {"inertia_start": 0.9, "inertia_end": 0.4}
APSO = FLIGHT | {"inertia_min": 0.4, "inertia_max": 0.9}

# Name, method, settings, box, seed.
CASES = [
    ("tgfpa defaults", "tgfpa", TGFPA, MOTOR_BOX, 13),
    (
        "tgfpa altered",
        "tgfpa",
        {"switch_probability": 0.4, "gamma": 0.5, "local_base": "accepted", "plain_global": 0.5, "plain_local": 0.5, "start": "uniform"},
        SHIFTED_BOX,
        5,
    ),
    ("fpa defaults", "fpa", FPA, MOTOR_BOX, 2),
    ("fpa altered", "fpa", {"switch_probability": 0.3, "gamma": 0.5, "local_base": "accepted"}, SHIFTED_BOX, 10),
    ("tgfpa from the last trial", "tgfpa", TGFPA | {"local_base": "last-trial"}, MOTOR_BOX, 13),
    ("lpso defaults", "lpso", LPSO, MOTOR_BOX, 18),
    (
        "lpso altered",
        "lpso",
        {"cognitive": 1.25, "social": 2.5, "velocity_limit": 0.3, "inertia_start": 0.8, "inertia_end": 0.3},
        SHIFTED_BOX,
        3,
    ),
    ("apso defaults", "apso", APSO, MOTOR_BOX, 21),
    (
        "apso altered",
        "apso",
        {"cognitive": 1.25, "social": 2.5, "velocity_limit": 0.3, "inertia_min": 0.3, "inertia_max": 1.1},
        SHIFTED_BOX,
        4,
    ),
]

# What a method's formulas say of its courses, and tests/all/laws.rs holds them to; what is not listed must not hold.
#   limit   the course does not depend on the limit of iterations
#   scale   nor on the units of the coordinates
#   shift   nor on where the box and the function lie
#   offset  nor on a constant added to the costs
#   greedy  the population keeps its size, and no candidate gets worse; strict: nor moves to a place that is only as good
LAWS = {
    "tgfpa": ["limit", "scale", "shift", "offset", "greedy", "strict"],
    "fpa": ["limit", "scale", "shift", "offset", "greedy", "strict"],
    "lpso": ["scale", "shift", "offset"],
    "apso": ["limit", "scale", "shift", "offset"],
}

FLOWERS = {"plain global", "plain local", "clamped", "accepted", "rejected", "best moved"}
SWARM = {"at the velocity limit", "below the velocity limit", "clamped", "own best kept", "own best moved", "best moved"}
BRANCHES = {
    "tgfpa": FLOWERS | {"t global", "gaussian local"},
    "fpa": FLOWERS,
    "lpso": SWARM,
    "apso": SWARM | {"at or below the average", "above the average"},
}


class Flowers(Search):
    """FPA, and tGFPA where the settings hold `plain_global` (m) and `plain_local` (q)."""

    def __init__(self, settings, box, seed):
        super().__init__(settings, box, seed)
        self.trials = self.x

    def start(self):
        if self.settings.get("start") != "logistic":
            return super().start()
        b = self.draws.uniform(len(self.width))
        # The library draws again near the starts that end in a fixed point; not exercised here.
        assert abs(b[:, None] - [0, 0.25, 0.5, 0.75, 1]).min() > 1e-3
        chain = [b]
        while len(chain) < POPULATION:
            chain.append(4 * chain[-1] * (1 - chain[-1]))
        return self.lower + np.array(chain) * self.width

    def levy(self):
        """Equation (5) by Mantegna's method, one step per dimension."""
        lam = 1.5
        sigma = math.gamma(1 + lam) * math.sin(math.pi * lam / 2) / (math.gamma((1 + lam) / 2) * lam * 2 ** ((lam - 1) / 2))
        u, v = self.draws.normal(len(self.width), 2).T
        return sigma ** (1 / lam) * u / abs(v) ** (1 / lam)

    def is_plain(self, setting):
        return setting not in self.settings or self.draws.uniform() < self.settings[setting]

    def move(self, i, t):
        x, draws = self.x, self.draws
        if draws.uniform() > self.settings["switch_probability"]:
            plain = self.is_plain("plain_global")
            self.seen["plain global" if plain else "t global"] += 1
            trial = x[i] + self.settings["gamma"] * self.levy() * (x[i] - self.g)
            if plain:
                return trial
            perturbation = draws.student_t(t)
            j, k = draws.partners(i, 2)
            return trial + perturbation * (x[j] - x[k])
        if self.is_plain("plain_local"):
            self.seen["plain local"] += 1
            epsilon = draws.uniform()
            j, k = draws.partners(i, 2)
            return self.base(i) + epsilon * (x[j] - x[k])
        self.seen["gaussian local"] += 1
        first, second = draws.normal(2)
        j, k, l = draws.partners(i, 3)
        return self.base(i) + first * (x[j] - x[i]) + second * (x[l] - x[k])

    def base(self, i):
        """Where a local move starts: Yang's program keeps trials that were rejected."""
        return (self.x if self.settings["local_base"] == "accepted" else self.trials)[i]

    def step(self, t):
        trials = self.clamp(np.array([self.move(i, t) for i in range(POPULATION)]))
        self.trials = trials
        costs = self.cost(trials)
        better = self.less(trials, costs, self.x, self.f)
        self.seen["accepted"] += int(better.sum())
        self.seen["rejected"] += int((~better).sum())
        self.x, self.f = np.where(better[:, None], trials, self.x), np.where(better, costs, self.f)
        self.keep_best()


class Swarm(Search):
    """LPSO, and APSO where the settings hold `inertia_min`."""

    def __init__(self, settings, box, seed):
        super().__init__(settings, box, seed)
        self.limit = settings["velocity_limit"] * self.width
        self.v = self.limit * (2 * self.draws.uniform(*self.x.shape) - 1)
        self.own, self.f_own = self.x.copy(), self.f.copy()

    def inertia(self, t):
        """One weight per particle."""
        if "inertia_min" not in self.settings:
            return np.full(POPULATION, np.linspace(self.settings["inertia_start"], self.settings["inertia_end"], ITERATIONS)[t - 1])
        w_min, w_max = self.settings["inertia_min"], self.settings["inertia_max"]
        settled = self.f <= self.f.mean()
        self.seen["at or below the average"] += int(settled.sum())
        self.seen["above the average"] += int((~settled).sum())
        return np.where(settled, w_min + (w_max - w_min) * (self.f - self.f.min()) / (self.f.mean() - self.f.min()), w_max)

    def step(self, t):
        r1, r2 = np.moveaxis(self.draws.uniform(*self.x.shape, 2), -1, 0)
        pull = self.settings["cognitive"] * r1 * (self.own - self.x) + self.settings["social"] * r2 * (self.g - self.x)
        wanted = self.inertia(t)[:, None] * self.v + pull
        self.v = np.clip(wanted, -self.limit, self.limit)
        self.seen["at the velocity limit"] += int((self.v != wanted).sum())
        self.seen["below the velocity limit"] += int((self.v == wanted).sum())
        self.x = self.clamp(self.x + self.v)
        self.f = self.cost(self.x)
        better = self.less(self.x, self.f, self.own, self.f_own)
        self.seen["own best moved"] += int(better.sum())
        self.seen["own best kept"] += int((~better).sum())
        self.own, self.f_own = np.where(better[:, None], self.x, self.own), np.where(better, self.f, self.f_own)
        self.keep_best()


def course(name, method, settings, box, seed):
    search = (Flowers if method in ("fpa", "tgfpa") else Swarm)(settings, box, seed)
    states = [search.state()]
    for t in range(1, ITERATIONS + 1):
        search.step(t)
        states.append(search.state())
    missing = BRANCHES[method] - {branch for branch, times in search.seen.items() if times}
    assert not missing, f"{name}: never {sorted(missing)}; take another seed"
    return noted(name, method, settings, box, POPULATION, ITERATIONS, search, states)


def courses(module):
    """The cases of a method that has a file of its own; those of its rare branches say with what floor or normal numbers."""
    for name, settings, box, population, iterations, seed, branches, *rare in module.CASES:
        search = module.Method(settings, box, seed, population, iterations, **dict(*rare))
        states = search.course()
        missing = branches - {branch for branch, times in search.seen.items() if times}
        assert not missing, f"{module.KEY} {name}: never {sorted(missing)}; take another seed"
        yield noted(f"{module.KEY} {name}", module.KEY, settings, box, population, iterations, search, states)


def noted(name, method, settings, box, population, iterations, search, states):
    return {
        "name": name,
        "method": method,
        "settings": settings,
        "dimension": len(box),
        "lower": box[:, 0].tolist(),
        "upper": box[:, 1].tolist(),
        "population": population,
        "iterations": iterations,
        "floor": search.floor,
        "draws": search.draws.record,
        "states": states,
    }


def main():
    compact = {"separators": (",", ":"), "allow_nan": False}
    # One line per case, so that a difference shows which case it is in.
    paths = sorted((Path(__file__).parent / "optimizers").glob("*.py"))
    modules = [importlib.import_module(f"optimizers.{path.stem}") for path in paths]
    all_courses = [course(*case) for case in CASES] + [case for module in modules for case in courses(module)]
    laws = LAWS | {module.KEY: module.LAWS for module in modules}
    laws = ",\n".join(f"{json.dumps(key)}:{json.dumps(held, **compact)}" for key, held in laws.items())
    cases = ",\n".join(json.dumps(course, **compact) for course in all_courses)
    text = f'{{"objective":{json.dumps(OBJECTIVE, **compact)},"laws":{{\n{laws}\n}},"cases":[\n{cases}\n]}}\n'
    NUMBERS.write_text(text)


if __name__ == "__main__":
    main()
