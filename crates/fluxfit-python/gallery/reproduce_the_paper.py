"""The paper reproduced: its rig is simulated and identified, and its four optimizers are compared on the same fitness.

Gao, Wang, Jiang and Hu, "Parameters Identification of PMSM Based on Improved Flower Pollination Algorithm", 2023.
"""

# %%
import fluxfit

log = fluxfit.simulate()
log

# %% [markdown]
# The parameters, by the exact answer.

# %%
found = fluxfit.identify(log)
found

# %% [markdown]
# Each interval holds the true value of the simulation.

# %%
for name, estimate in found.parameters.items():
    assert estimate.interval is not None and log.truth is not None
    low, high = estimate.interval
    print(f"{name:6}{low:.6g} .. {high:.6g}, true {log.truth[name]:.6g}")
    assert low < log.truth[name] < high

# %% [markdown]
# The paper's methods search for the minimum that least squares gives exactly: how far from it do they end?

# %%
study = fluxfit.compare(log, methods=["tgfpa", "fpa", "lpso", "apso"], runs=20)
study

# %%
ends = {entry["method"]: entry["cost_above_optimum"]["median"] for entry in study.methods}
assert ends["tgfpa"] < ends["fpa"] and ends["tgfpa"] < ends["lpso"]
