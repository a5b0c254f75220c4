"""A log as a VESC writes it, from inspection to what it can tell: a dozen averaged rows a second, current along q only.

The log is made here, so that this runs anywhere: 60 s of an e-bike's drive at changing speed and load, with the columns of VESC Tool.
"""

# %%
import tempfile
from pathlib import Path

import numpy as np

import fluxfit

rs, ld, lq, psi_f, pole_pairs = 0.035, 180e-6, 220e-6, 0.0085, 7
rng = np.random.default_rng(1)
step = np.arange(720) // 60
speed = np.choose(step % 4, [400.0, 800.0, 1200.0, 1600.0]) + rng.normal(0, 1, 720)
i_q = np.choose(step % 3, [10.0, 25.0, 40.0]) + rng.normal(0, 0.1, 720)
i_d = rng.normal(0, 0.1, 720)
columns = {
    "ms_today": np.arange(720) * 83.0,
    "erpm": speed * 30 / np.pi,
    "d_axis_current": i_d,
    "q_axis_current": i_q,
    "vd": rs * i_d - speed * lq * i_q + rng.normal(0, 0.02, 720),
    "vq": rs * i_q + speed * (ld * i_d + psi_f) + rng.normal(0, 0.02, 720),
}
path = Path(tempfile.mkdtemp()) / "ride.csv"
np.savetxt(path, np.column_stack(list(columns.values())), delimiter=",", header=",".join(columns), comments="")

# %% [markdown]
# How is it read? Every column has its channel and its unit, or says what is missing.

# %%
inspection = fluxfit.inspect(path)
for column in inspection["columns"]:
    print(column["name"], "->", column["channel"])

# %% [markdown]
# What can it tell? The names that are not known are mapped.

# %%
mapping = {"t": "ms_today", "omega": "erpm", "id": "d_axis_current", "iq": "q_axis_current", "ud": "vd", "uq": "vq"}
found = fluxfit.identify(path, mapping=mapping, unit={"t": "ms", "omega": "rpm-elec"})
found

# %% [markdown]
# L_d needs a current along d: the remedy says how much of it.

# %%
print(found.ld.verdict, "-", found.ld.reason)
print(found.ld.remedy)
assert found.psi_f.value is not None and abs(found.psi_f.value / psi_f - 1) < 0.05
assert found.ld.verdict != "identified"
