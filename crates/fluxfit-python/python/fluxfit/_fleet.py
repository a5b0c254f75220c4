"""Many motors: one row for each motor and window, the same rows as those of `fluxfit fleet` on every engine."""

import json
import os
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from fluxfit import _fluxfit, _words
from fluxfit._data import NAME, logs_and_table
from fluxfit._errors import RequestError

# Types of pandas for the columns; counts may be missing.
DTYPES = {"text": "object", "number": "float64", "count": "Int64"}


def columns() -> "dict[str, str]":
    """The columns of the results in their order: each with `text`, `number` or `count`.

    >>> columns()["rs"], columns()["rs_verdict"], columns()["rows"]
    ('number', 'text', 'count')
    """
    return dict(_fluxfit.fleet_columns())


def asked(
    *,
    by: "str | None" = None,
    every: "str | float | None" = None,
    jobs: "int | None" = None,
    pole_pairs: "int | None" = None,
    mapping: Any = None,
    unit: "Mapping[str, str] | None" = None,
    prior: "Mapping[str, Any] | None" = None,
    fix: "Mapping[str, Any] | None" = None,
    model: str = "auto",
    method: str = "auto",
    voltage_timing: "str | int | None" = None,
    voltage_accuracy: "float | str | None" = None,
    current_accuracy: "float | str | None" = None,
    bus_accuracy: "float | str | None" = None,
    magnet_coefficient: "float | str | None" = None,
    dbc: "str | os.PathLike[str] | None" = None,
    seed: int = 1,
) -> "list[str]":
    """What is asked of every motor, as the options of the command."""
    return [
        *_words.columns(mapping, unit),
        *_words.priors(prior),
        *_words.pairs("--fix", fix),
        *_words.options(
            by=by,
            every=_words.duration(every),
            jobs=jobs,
            pole_pairs=pole_pairs,
            model=model,
            method=method,
            voltage_timing=voltage_timing,
            voltage_accuracy=voltage_accuracy,
            current_accuracy=current_accuracy,
            bus_accuracy=bus_accuracy,
            magnet_coefficient=magnet_coefficient,
            dbc=dbc,
            seed=seed,
        ),
    ]


class Fleet(Mapping[str, "np.ndarray[Any, Any]"]):
    """The rows of a fleet, by motor and window: a mapping of the columns of `fluxfit fleet` to arrays of the shape (rows,).

    Numbers are float64, NaN where there is none; texts are objects, `None` where there is none; counts are int64, or float64 where one is
    missing. `write(path)` writes the file of the command, byte for byte, `report(path)` the page; anything that takes Arrow's C stream
    takes this object.
    """

    def __init__(self, rows: "_fluxfit.FleetRows", call: str) -> None:
        self._rows = rows
        self._call = call

    @cached_property
    def _columns(self) -> "dict[str, np.ndarray[Any, Any]]":
        return {name: _array(values, columns()[name]) for name, values in self._rows.columns().items()}

    def __getitem__(self, name: str) -> "np.ndarray[Any, Any]":
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(columns())

    def __len__(self) -> int:
        return len(columns())

    @property
    def rows(self) -> int:
        """How many rows."""
        return len(self._columns["motor"])

    def to_pandas(self) -> Any:
        """The rows as a DataFrame. Needs pandas."""
        import pandas as pd

        types = {name: DTYPES[kind] for name, kind in columns().items()}
        return pd.DataFrame(self._rows.columns(), columns=list(types)).astype(types)

    def __arrow_c_stream__(self, requested_schema: Any = None) -> Any:
        """Arrow's C stream interface: `pyarrow.table(fleet)`, `polars.DataFrame(fleet)`."""
        return self._rows.__arrow_c_stream__(requested_schema)

    def write(self, path: "str | os.PathLike[str]") -> None:
        """Writes the rows as `fluxfit fleet -o` does, as Parquet or CSV by the ending of the name.

        Raises `FileError` if it cannot be written, `RequestError` if the name has another ending.
        """
        self._rows.write(path)

    def report(self, path: "str | os.PathLike[str]") -> None:
        """Writes the page of the fleet, one HTML page that opens offline: that of `fluxfit fleet --report`, with distributions, motors that
        stand apart, drift from window to window, reasons, and the worst motors first.

        Raises `FileError` if it cannot be written, `RequestError` if the name is none of a page.
        """
        self._rows.report(path, self._call)

    def __repr__(self) -> str:
        return f"<Fleet: {self._rows.count()}>"


def _array(values: "list[Any]", kind: str) -> "np.ndarray[Any, Any]":
    if kind == "number" or (kind == "count" and None in values):
        return np.array(values, dtype=np.float64)
    return np.array(values, dtype=object if kind == "text" else np.int64)


def fleet(
    data: Any,
    by: "str | None" = None,
    *,
    every: "str | float | None" = None,
    output: "str | os.PathLike[str] | None" = None,
    jobs: "int | None" = None,
    source: str = "table",
    motor: Any = None,
    pole_pairs: "int | None" = None,
    mapping: Any = None,
    unit: "Mapping[str, str] | None" = None,
    prior: "Mapping[str, Any] | None" = None,
    fix: "Mapping[str, Any] | None" = None,
    model: str = "auto",
    method: str = "auto",
    voltage_timing: "str | int | None" = None,
    voltage_accuracy: "float | str | None" = None,
    current_accuracy: "float | str | None" = None,
    bus_accuracy: "float | str | None" = None,
    magnet_coefficient: "float | str | None" = None,
    dbc: "str | os.PathLike[str] | None" = None,
    seed: int = 1,
    progress: "Callable[[str, int | None, int | None], object] | None" = None,
) -> Fleet:
    """Identifies many motors: a row for each, or for each window of time.

    `data` are paths of logs, or a table in memory as in `identify`. `by` is the column that names the motor of each row, as text or as a
    whole number; the rows of a motor stand together. Without it, each log is a motor. `every` cuts each motor's rows into windows (s, or
    a text such as `"1h"`). `jobs` motors are identified at once (default: the number of cores). All other keywords are those of
    `identify`, for every motor.

    `output` names a file that the results of logs are written to, Parquet or CSV; killed and started again, the same call goes on where it
    was. The rows of a table in memory are written by `Fleet.write`; `source` is what they call the table.

    The rows are those of `fluxfit fleet`, byte for byte. A motor that fails is a row with its reason in `error`. `progress("motors", done,
    total)` is called after each motor; `total` is `None` as long as it is not known. Ctrl-C ends the call with `KeyboardInterrupt`; of a
    table in memory, the motors in work are finished first.

    Raises `RequestError`, or `DataError` for a table in memory that has no column `by`.

    >>> import fluxfit, numpy as np
    >>> one, other = fluxfit.simulate(), fluxfit.simulate(draw=1)
    >>> table = {name: np.concatenate([one[name], other[name]]) for name in one}
    >>> table["motor"] = np.repeat(["a", "b"], [one.rows, other.rows])
    >>> found = fluxfit.fleet(table, "motor")
    >>> found
    <Fleet: 2 motors, 2 rows: 2 with all 4 parameters identified, 0 with fewer, 0 without an answer>
    >>> list(found["motor"]), found["lq_verdict"][0]
    (['a', 'b'], 'identified')
    """
    words = asked(
        by=by,
        every=every,
        jobs=jobs,
        pole_pairs=pole_pairs,
        mapping=mapping,
        unit=unit,
        prior=prior,
        fix=fix,
        model=model,
        method=method,
        voltage_timing=voltage_timing,
        voltage_accuracy=voltage_accuracy,
        current_accuracy=current_accuracy,
        bus_accuracy=bus_accuracy,
        magnet_coefficient=magnet_coefficient,
        dbc=dbc,
        seed=seed,
    )
    logs, table = logs_and_table(data)
    runs = None
    if table is not None:
        if by is None:
            raise RequestError("a table of many motors needs by=COLUMN, the column that names the motor of each row")
        if output is not None:
            raise RequestError("output is for logs; write the rows of a table in memory with Fleet.write")
        if isinstance(table, dict):
            table, runs = {name: values for name, values in table.items() if name != by}, _runs(data, by)
    with _words.motor_file(motor) as named:
        rows = _fluxfit.fleet(["fleet", *words, *named, "--", *logs], table, by, runs, source, output, progress)
    given = {"every": every, "output": output, "motor": motor, "pole_pairs": pole_pairs, "mapping": mapping, "prior": prior, "fix": fix}
    shown = [repr(logs[0]) if table is None and len(logs) == 1 else "data" if table is not None else repr(logs)]
    shown += [repr(by)] if by is not None else []
    shown += [f"{name}={value!r}" for name, value in given.items() if value is not None]
    shown += [f"{name}={value!r}" for name, value in (("model", model), ("method", method)) if value != "auto"]
    return Fleet(rows, f"fluxfit.fleet({', '.join(shown)})")


def _runs(data: Any, by: str) -> "list[tuple[str | None, int]] | None":
    """The names of the motors with their numbers of rows, one after the other; `None` if there is no such column."""
    try:
        names = np.asarray(data[by])
    except (KeyError, ValueError):
        return None
    if names.dtype.kind not in "iuU":
        names = names.astype(str) if names.dtype.kind == "S" else np.array([_name(name) for name in names], dtype=str)
    starts = np.flatnonzero(np.concatenate([[True], names[1:] != names[:-1]])) if names.size else np.empty(0, dtype=int)
    return [(_name(names[start]) or None, int(rows)) for start, rows in zip(starts, np.diff(np.append(starts, names.size)))]


class Request:
    """What is asked of each motor on a cluster: the keywords of `fleet`, which are pickled and sent to workers."""

    def __init__(self, *, source: str = "table", **keywords: Any) -> None:
        self.source = source
        self.words = ["fleet", *asked(**keywords), "--", NAME]

    def rows(self, motor: Any, table: Any) -> "list[dict[str, Any]]":
        """The rows of one motor: a dictionary for each window. What fails is a row with its reason in `error`.

        Raises `RequestError` only if what is asked makes no sense for any motor.
        """
        _, held = logs_and_table(table)
        found: list[dict[str, Any]] = json.loads(_fluxfit.fleet_rows(self.words, _name(motor), self.source, held))
        return found


def _name(motor: Any) -> str:
    """A motor as text, as the command names it; nothing for a missing value of pandas or numpy.

    >>> [_name(motor) for motor in ("m1", 7, 7.0, None, float("nan"))]
    ['m1', '7', '7', '', '']
    """
    try:
        is_missing = motor is None or bool(motor != motor)
    except TypeError:  # pandas' NA is neither equal nor unequal to itself
        is_missing = True
    if is_missing:
        return ""
    # Whole numbers are floats beside missing ones.
    return str(int(motor)) if isinstance(motor, float) and motor.is_integer() else str(motor)
