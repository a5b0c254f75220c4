"""What several tests share."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fluxfit

ROOT = Path(__file__).resolve().parents[3]
LOGS = ROOT / "examples" / "logs"


@pytest.fixture(scope="session")
def rig() -> Path:
    """An example log of the repository."""
    return LOGS / "paper_rig_pwm_noise.csv"


@pytest.fixture(scope="session")
def columns(rig: Path) -> dict[str, np.ndarray]:
    """Its columns, read by numpy and not by this package."""
    table = np.genfromtxt(rig, delimiter=",", names=True)
    return {name: np.ascontiguousarray(table[name]) for name in table.dtype.names or ()}


@pytest.fixture(scope="session")
def steady() -> "fluxfit.Log":
    """A log of operating points that is identified at once: the motor's equations (1) of the paper, evaluated here."""
    rs, ld, lq, psi_f, omega = 0.958, 5.25e-3, 12e-3, 0.1827, 400.0
    i_d: Any = np.repeat([0.0, -2.0, 0.0], 100)
    i_q: Any = np.repeat([9.0, 8.5, 4.0], 100)
    return fluxfit.Log(
        {
            "t": np.arange(300, dtype=np.float64) * 1e-3,
            "ud": rs * i_d - omega * lq * i_q,
            "uq": rs * i_q + omega * (ld * i_d + psi_f),
            "id": i_d,
            "iq": i_q,
            "omega_e": np.full(300, omega),
        },
        [],
        {"rs": rs, "ld": ld, "lq": lq, "psi_f": psi_f},
    )
