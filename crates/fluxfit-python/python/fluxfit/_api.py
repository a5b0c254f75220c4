"""The functions of the package: keywords to the words of the command line, documents to Python."""

import json
import os
from collections.abc import Callable, Mapping
from typing import Any

from fluxfit import _fluxfit, _toml, _words
from fluxfit._data import logs_and_table
from fluxfit._errors import RequestError
from fluxfit._identification import Identification
from fluxfit._log import Log

Path = "str | os.PathLike[str]"
Progress = Callable[[str, "int | None", "int | None"], object]


def identify(
    data: Any,
    *,
    motor: Any = None,
    pole_pairs: "int | None" = None,
    mapping: Any = None,
    unit: "Mapping[str, str] | None" = None,
    prior: "Mapping[str, Any] | None" = None,
    fix: "Mapping[str, Any] | None" = None,
    model: str = "auto",
    method: str = "auto",
    window: Any = None,
    voltage_timing: "str | int | None" = None,
    voltage_accuracy: "float | str | None" = None,
    current_accuracy: "float | str | None" = None,
    bus_accuracy: "float | str | None" = None,
    magnet_coefficient: "float | str | None" = None,
    bounds: "Mapping[str, tuple[Any, Any]] | None" = None,
    bandwidth: "float | str | None" = None,
    control_rate: "float | str | None" = None,
    hold_out: bool = False,
    dbc: "str | os.PathLike[str] | None" = None,
    seed: int = 1,
    progress: "Progress | None" = None,
) -> Identification:
    """Identifies the parameters of a motor from a log of its drive.

    `data` is the path of a log (or a list of paths, logs of one motor), a dictionary of arrays, or a table: pandas, polars, pyarrow,
    xarray, anything with `__arrow_c_stream__`. Its columns are `t` (s), `ud`, `uq` (V), `id`, `iq` (A), `omega_e` (electrical rad/s), and
    optionally `theta_e` (electrical rad), `u_dc` (V), `temperature` (degC); others are named by `mapping`, a dictionary of channels and
    headers or the path of a mapping file, and `unit`, such as `{"omega": "rpm-mech"}` with `pole_pairs`. Columns of Arrow and contiguous
    arrays of float64 are read where they lie, without a copy of the table.

    `motor` is a motor file or a dictionary such as `{"rs": "35 mohm", "pole_pairs": 7}`, with which the answer is compared.
    `prior={"rs": (0.96, "1%")}` is a value known with a standard error, `fix={"rs": 0.96}` one known exactly; numbers are SI, texts may
    have a unit. `model` is `auto`, `steady` or `output-error`; `method` the optimizer that searches beside the exact answer. `window` is a
    pair of times in s, or several. `progress(step, done, total)` is called on the way. All other keywords are the options of the command.

    The answer is the same, to the bit, as that of `fluxfit identify`. It is computed without the interpreter's lock, on all cores.

    Raises `FileError`, `DataError` or `RequestError`. A parameter that the log does not tell is no error: its verdict says so.

    >>> import fluxfit
    >>> log = fluxfit.simulate()
    >>> found = fluxfit.identify(log, prior={"rs": (0.958, "1%")})
    >>> found.psi_f.verdict
    'identified'
    >>> found.psi_f.interval[0] < log.truth["psi_f"] < found.psi_f.interval[1]
    True
    """
    logs, table = logs_and_table(data)
    words = [
        *_words.columns(mapping, unit),
        *_words.priors(prior),
        *_words.pairs("--fix", fix),
        *_words.windows(window),
        *_words.pairs("--bounds", {name: f"{_words.text(low)}:{_words.text(high)}" for name, (low, high) in (bounds or {}).items()}),
        *_words.options(
            pole_pairs=pole_pairs,
            model=model,
            method=method,
            voltage_timing=voltage_timing,
            voltage_accuracy=voltage_accuracy,
            current_accuracy=current_accuracy,
            bus_accuracy=bus_accuracy,
            magnet_coefficient=magnet_coefficient,
            bandwidth=bandwidth,
            control_rate=control_rate,
            hold_out=hold_out,
            dbc=dbc,
            seed=seed,
        ),
    ]
    with _words.motor_file(motor) as named:
        answer = _fluxfit.identify(["identify", *words, *named, "--", *logs], table, progress)
    given = {"prior": prior, "fix": fix, "mapping": mapping, "pole_pairs": pole_pairs, "window": window, "motor": motor}
    shown = [repr(logs[0]) if table is None and len(logs) == 1 else "data" if table is not None else repr(logs)]
    shown += [f"{name}={value!r}" for name, value in given.items() if value is not None]
    shown += [f"{name}={value!r}" for name, value in (("model", model), ("method", method)) if value != "auto"]
    return Identification(answer, f"fluxfit.identify({', '.join(shown)})")


def read_log(
    data: Any,
    *,
    mapping: Any = None,
    unit: "Mapping[str, str] | None" = None,
    pole_pairs: "int | None" = None,
    dbc: "str | os.PathLike[str] | None" = None,
) -> Log:
    """Reads a log as `identify` does and returns its columns in SI units.

    Raises `FileError` or `DataError`: one sentence with file, line, column and remedy.
    """
    logs, table = logs_and_table(data)
    words = [*_words.columns(mapping, unit), *_words.options(pole_pairs=pole_pairs, dbc=dbc)]
    columns, notes = _fluxfit.read_log(["identify", *words, "--", *logs], table)
    return Log(columns, notes)


def inspect(
    path: "str | os.PathLike[str]",
    *,
    mapping: Any = None,
    unit: "Mapping[str, str] | None" = None,
    pole_pairs: "int | None" = None,
    dbc: "str | os.PathLike[str] | None" = None,
) -> "dict[str, Any]":
    """How a file is read: its columns, units, ranges, and what is missing. The JSON document of `fluxfit inspect`.

    Raises `FileError` or `DataError` if the file is no table; a table that is no log is inspected all the same.
    """
    words = [*_words.columns(mapping, unit), *_words.options(pole_pairs=pole_pairs, dbc=dbc)]
    document: dict[str, Any] = json.loads(_fluxfit.inspect(["inspect", *words, "--", os.fspath(path)]))
    return document


class _Document:
    """An answer that is a JSON document."""

    def __init__(self, document: "dict[str, Any]") -> None:
        self._document = document

    def to_dict(self) -> "dict[str, Any]":
        """The JSON document."""
        return self._document


class Validation(_Document):
    """How well given parameters predict a log. `outcome` is the verdict."""

    @property
    def outcome(self) -> str:
        """The verdict, such as `agrees`."""
        return str(self._document["outcome"])

    def __repr__(self) -> str:
        return f"<Validation: {self.outcome}>"


class Study(_Document):
    """Many runs of several optimizers on one log."""

    @property
    def methods(self) -> "list[dict[str, Any]]":
        """An entry for each method."""
        methods: list[dict[str, Any]] = self._document["methods"]
        return methods

    def to_pandas(self) -> Any:
        """A DataFrame with a row for each method: seconds of a run, and the median and worst cost above the minimum. Needs pandas."""
        import pandas as pd

        rows = [
            {"method": entry["method"], "seconds_per_run": entry["seconds_per_run"], **entry["cost_above_optimum"]} for entry in self.methods
        ]
        return pd.DataFrame(rows).set_index("method")

    def __repr__(self) -> str:
        lines = [f"{entry['method']}: median {entry['cost_above_optimum']['median']:.2g} above the minimum" for entry in self.methods]
        return "\n".join([f"<Study: {self._document['runs']} runs of each method>", *lines])


def validate(
    data: Any,
    motor: Any,
    *,
    mapping: Any = None,
    unit: "Mapping[str, str] | None" = None,
    pole_pairs: "int | None" = None,
    model: str = "auto",
    window: Any = None,
    voltage_accuracy: "float | str | None" = None,
) -> Validation:
    """Tests given parameters on another log.

    `motor` is an `Identification`, its dictionary, a dictionary of all four parameters, or a file of either. `data` as in `identify`.

    Raises `FileError`, `DataError`, or `RequestError`.
    """
    logs, table = logs_and_table(data)
    words = [
        *_words.columns(mapping, unit),
        *_words.windows(window),
        *_words.options(pole_pairs=pole_pairs, model=model, voltage_accuracy=voltage_accuracy),
    ]
    given = None
    if isinstance(motor, Identification):
        given = motor.to_json()
    elif isinstance(motor, Mapping):
        given = json.dumps(motor) if "schema" in motor else _words.motor_text(motor)
    # A file is named by the command's option; what is in memory takes its place.
    named = [f"--motor={os.fspath(motor)}" if given is None else "--motor=motor"]
    return Validation(json.loads(_fluxfit.validate(["validate", *words, *named, "--", *logs], table, given)))


def compare(
    data: Any,
    *,
    methods: "list[str] | str | None" = None,
    runs: int = 50,
    population: int = 50,
    iterations: int = 300,
    model: str = "steady",
    motor: Any = None,
    mapping: Any = None,
    unit: "Mapping[str, str] | None" = None,
    pole_pairs: "int | None" = None,
    window: Any = None,
    bounds: "Mapping[str, tuple[Any, Any]] | None" = None,
    truth: "str | os.PathLike[str] | None" = None,
    seed: int = 1,
) -> Study:
    """Compares optimizers: many runs of each on the fitness of a log, against its minimum. `methods` are keys, or `"all"`.

    Raises `FileError`, `DataError`, or `RequestError`.
    """
    logs, table = logs_and_table(data)
    asked = [methods] if isinstance(methods, str) else methods
    words = [
        *_words.columns(mapping, unit),
        *_words.windows(window),
        *_words.pairs("--bounds", {name: f"{_words.text(low)}:{_words.text(high)}" for name, (low, high) in (bounds or {}).items()}),
        *_words.options(
            methods=None if asked is None else ",".join(asked),
            runs=runs,
            population=population,
            iterations=iterations,
            model=model,
            pole_pairs=pole_pairs,
            truth=truth,
            seed=seed,
        ),
    ]
    with _words.motor_file(motor) as named:
        return Study(json.loads(_fluxfit.compare(["compare", *words, *named, "--", *logs], table)))


def simulate(scenario: Any = None, *, seed: "int | None" = None, draw: int = 0) -> Log:
    """Simulates a motor in a drive and returns its log, whose `truth` are the true parameters.

    `scenario` is the path of a scenario file, its text, or a dictionary with the same keys; without one it is the paper's rig. `seed`
    takes the place of the scenario's; each `draw` is an independent realization of the noise.

    Raises `FileError`, `DataError` for a scenario that cannot be simulated.

    >>> import fluxfit
    >>> fluxfit.simulate().truth["pole_pairs"]
    4
    """
    path = text = None
    if isinstance(scenario, Mapping):
        text = _toml.dumps(scenario)
    elif isinstance(scenario, str) and "\n" in scenario:
        text = scenario
    elif scenario is not None:
        path = os.fspath(scenario)
    if seed is not None and not 0 <= seed < 2**32:
        raise RequestError(f"seed={seed} is out of range; it must be from 0 to 4294967295")
    columns, truth = _fluxfit.simulate(path, text, seed, draw)
    return Log(columns, [], json.loads(truth))


def explain(code: str) -> str:
    """The page of a code of a warning or a finding.

    Raises `RequestError` if there is no such code.

    >>> import fluxfit
    >>> "residuals" in fluxfit.explain("misfit") or "contradict" in fluxfit.explain("misfit")
    True
    """
    return _fluxfit.explain(code)
