"""Drift of R_s and psi_f over a day: the winding and the magnets warm up, and each hour of the log is identified by itself.

The hours are rows of a fleet of one motor: the same that `fluxfit fleet --every 1h` writes.
"""

# %%
import numpy as np

from fluxfit._fleet import Request

hours = 24
warmth = 40 * (1 - np.exp(-np.arange(hours) / 4))  # K above the morning
true_rs = 0.958 * (1 + 0.0039 * warmth)
true_psi_f = 0.1827 * (1 - 0.0012 * warmth)

rng = np.random.default_rng(1)
tables = []
for hour in range(hours):
    i_d, i_q = np.repeat([0.0, -2.0, 0.0], 100), np.repeat([9.0, 8.5, 4.0], 100)
    ud = true_rs[hour] * i_d - 400 * 12e-3 * i_q + rng.normal(0, 0.05, 300)
    uq = true_rs[hour] * i_q + 400 * (5.25e-3 * i_d + true_psi_f[hour]) + rng.normal(0, 0.05, 300)
    tables.append(np.column_stack([3600 * hour + np.arange(300) * 1e-3, ud, uq, i_d, i_q, np.full(300, 400.0)]))
day = dict(zip(("t", "ud", "uq", "id", "iq", "omega_e"), np.concatenate(tables).T))

# %%
rows = Request(every="1h").rows("rig", day)
for row in rows:
    print(f"{row['window_start'] / 3600:4.0f} h  R_s {row['rs']:.4f} ohm ({row['rs_verdict']})  psi_f {row['psi_f']:.5f} Wb")

# %% [markdown]
# Nearly every interval holds the true value of its hour, and the drift of both is seen.

# %%
inside = [row["rs_low"] < true < row["rs_high"] for row, true in zip(rows, true_rs)]
assert len(rows) == hours and sum(inside) >= 21
assert rows[-1]["rs"] / rows[0]["rs"] > 1.12 and rows[-1]["psi_f"] < 0.97 * rows[0]["psi_f"]
