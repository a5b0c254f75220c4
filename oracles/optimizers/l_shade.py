"""L-SHADE. Draws per candidate: the pair, the Cauchy number (again while F <= 0), the normal number of CR unless it is 0 for ever, pbest,
r1, r2 (only the one taken), the forced coordinate, one number per coordinate; on acceptance, in a full archive, the row of each parent."""

import numpy as np
from search import MOTOR_BOX, SHIFTED_BOX, Generations

KEY = "l-shade"
LAWS = ["scale", "shift", "offset"]
ALL = {
    "crossed", "kept coordinate", "below the box", "above the box", "accepted", "rejected", "best moved", "F drawn again", "F cut at 1",
    "CR cut", "r2 from the archive", "r2 from the population", "archive full", "archive cut", "shrunk",
    "a generation goes on in the next iteration",
}  # fmt: skip
CASES = [
    ("defaults", {}, MOTOR_BOX, 40, 9, 27, ALL),
    ("altered", {}, SHIFTED_BOX, 50, 9, 42, ALL),
    ("few crossed", {}, MOTOR_BOX, 40, 20, 17, {"CR 0 from now on", "CR 0 for ever", "CR stays 0"}, {"normals": lambda numbers: numbers - 3.5}),
]


class Method(Generations):
    def generations(self):
        first = 18 * self.d
        trials = self.uniform_start(first)
        costs = yield trials
        self.accept_all(trials, costs)
        yield
        m_f, m_cr, slot, archive = np.full(6, 0.5), np.full(6, 0.5), 0, []
        total = self.population * (1 + self.iterations)
        while True:
            count = len(self.x)
            assert np.diff(np.sort(self.f)).min() > 1e-9, "two costs are too close to compare; take another seed"
            order = np.argsort(self.f)
            trials, tried = [], []
            for i in range(count):
                pair = self.draws.index(6)
                factor = 0.0
                while factor <= 0:
                    factor = m_f[pair] + 0.1 * float(self.draws.student_t(1))
                    self.seen["F drawn again"] += factor <= 0
                self.seen["F cut at 1"] += factor > 1
                factor = min(factor, 1.0)
                if np.isnan(m_cr[pair]):
                    crossover = 0.0
                    self.seen["CR 0 for ever"] += 1
                else:
                    wanted = m_cr[pair] + 0.1 * float(self.draws.normal())
                    crossover = min(max(wanted, 0.0), 1.0)
                    self.seen["CR cut"] += crossover != wanted
                pbest = self.x[order[self.draws.index(max(2, round(0.11 * count)))]]
                (r1,) = self.draws.partners(i, 1, count)
                others = [k for k in range(count + len(archive)) if k not in (i, r1)]
                r2 = int(self.draws._noted(self.draws.generator.choice(others)))
                self.seen["r2 from the archive" if r2 >= count else "r2 from the population"] += 1
                other = self.x[r2] if r2 < count else archive[r2 - count]
                forced = self.draws.index(self.d)
                crossed = self.draws.uniform(self.d) < crossover
                crossed[forced] = True
                v = self.x[i] + factor * (pbest - self.x[i]) + factor * (self.x[r1] - other)
                v = np.where(crossed, v, self.x[i])
                below, above = v < self.lower, v > self.upper
                for branch, hit in (("crossed", crossed), ("kept coordinate", ~crossed), ("below the box", below), ("above the box", above)):
                    self.seen[branch] += int(hit.sum())
                v = np.where(below, (self.lower + self.x[i]) / 2, v)
                trials.append(np.where(above, (self.upper + self.x[i]) / 2, v))
                tried.append((factor, crossover))
            trials = np.array(trials)
            costs = yield trials
            parents, f_parents = self.x.copy(), self.f.copy()
            better = self.accept_better(trials, costs)
            capacity = round(2.6 * count)
            for parent in parents[better]:
                if len(archive) < capacity:
                    archive.append(parent)
                else:
                    self.seen["archive full"] += 1
                    archive[self.draws.index(capacity)] = parent
            if better.any():
                w = (f_parents - costs)[better]
                w = w / w.sum()
                s_f, s_cr = np.array(tried)[better].T
                m_f[slot] = (w * s_f**2).sum() / (w * s_f).sum()
                self.seen["CR stays 0"] += bool(np.isnan(m_cr[slot]) and s_cr.max() > 0)
                self.seen["CR 0 from now on"] += bool(not np.isnan(m_cr[slot]) and s_cr.max() == 0)
                m_cr[slot] = np.nan if np.isnan(m_cr[slot]) or s_cr.max() == 0 else (w * s_cr**2).sum() / (w * s_cr).sum()
                slot = (slot + 1) % 6
            wanted = max(4, round((4 - first) / total * self.evaluations + first))
            if wanted < count:
                self.seen["shrunk"] += 1
                kept = np.argsort(self.f)[:wanted]
                self.x, self.f = self.x[kept], self.f[kept]
                self.seen["archive cut"] += len(archive) > round(2.6 * wanted)
                archive = archive[: round(2.6 * wanted)]
            yield
