"""Logs: read from files or simulated."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[np.float64]]


class Log(Mapping[str, Array]):
    """The columns of a log by their names, in SI units: `t` (s), `ud`, `uq` (V), `id`, `iq` (A), `omega_e` (electrical rad/s), and where
    the log has them `theta_e` (electrical rad), `u_dc` (V) and `temperature` (degC). All have the shape (rows,).

    `notes` says what was read as what and what was inferred; `truth` are the true parameters of a simulated log.
    """

    def __init__(self, columns: Mapping[str, Array], notes: "list[str]", truth: "dict[str, Any] | None" = None) -> None:
        self._columns = dict(columns)
        self.notes = notes
        self.truth = truth

    def __getitem__(self, name: str) -> Array:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        """How many rows."""
        return len(self._columns["t"])

    def to_pandas(self) -> Any:
        """The columns as a DataFrame. Needs pandas."""
        import pandas as pd

        return pd.DataFrame(self._columns)

    def __repr__(self) -> str:
        t = self._columns["t"]
        return f"<Log: {self.rows} rows, {t[-1] - t[0]:.6g} s, columns {', '.join(self._columns)}>"
