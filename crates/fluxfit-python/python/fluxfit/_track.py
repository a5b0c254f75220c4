"""The parameters of a running motor over time."""

import json
import os
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from fluxfit import _fluxfit, _words
from fluxfit._api import read_log
from fluxfit._identification import PARAMETERS
from fluxfit._log import Array, Log

# Rows of a log that are taken at a time.
ROWS = 4096


class Alarm(NamedTuple):
    """A parameter that has left its band (`track(..., alarm=...)`)."""

    parameter: str  #: `rs`, `ld`, `lq` or `psi_f`
    t: float  #: when, s
    value: float  #: its value then, SI
    start: float  #: the value around which the band lies, SI
    sentence: str  #: the command's

    def __str__(self) -> str:
        return self.sentence


class Track(Iterator["dict[str, Any]"]):
    """What is known of a running motor, time after time: each item is a document `fluxfit.track/1` (the line of `fluxfit track --json`).

    Rows are taken from the source as items are asked for. The last item is the state at the end (`"last": True`).
    """

    def __init__(self, blocks: "Iterator[Mapping[str, Any]]", tracker: "_fluxfit.Tracker") -> None:
        self._blocks = blocks
        self._tracker = tracker
        self._due: list[str] = []
        self._is_over = False

    def __next__(self) -> "dict[str, Any]":
        while not self._due:
            if self._is_over:
                raise StopIteration
            block = next(self._blocks, None)
            if block is None:
                self._is_over, self._due = True, [self._tracker.document()]
            else:
                self._due = self._tracker.take(_columns(block))[::-1]
        document: dict[str, Any] = json.loads(self._due.pop())
        return document

    @property
    def alarms(self) -> "list[Alarm]":
        """The parameters that have left their band in the rows that were taken so far, once for each band; of a log, rows are taken some
        thousand at a time."""
        return [Alarm(*alarm) for alarm in self._tracker.alarms()]

    def to_arrays(self) -> "dict[str, np.ndarray[Any, Any]]":
        """What is left, as arrays of the shape (times,): `t` (s), `steps` (how many steps of parameters were found so far), and of `rs`,
        `ld`, `lq`, `psi_f` the value, `_low`, `_high` (SI, NaN where there is none) and `_verdict`."""
        documents = list(self)
        arrays: dict[str, np.ndarray[Any, Any]] = {"t": np.array([document["t"] for document in documents], dtype=np.float64)}
        arrays["steps"] = np.array([document["steps"] for document in documents], dtype=np.int64)
        for name in PARAMETERS:
            entries = [document[name] for document in documents]
            ends = np.array([entry["ci95"] or (None, None) for entry in entries], dtype=np.float64).reshape(-1, 2)
            arrays[name] = np.array([entry["value"] for entry in entries], dtype=np.float64)
            arrays[f"{name}_low"], arrays[f"{name}_high"] = ends[:, 0], ends[:, 1]
            arrays[f"{name}_verdict"] = np.array([entry["verdict"] for entry in entries], dtype=object)
        return arrays

    def save_state(self, path: "str | os.PathLike[str]") -> None:
        """Saves what is known, for `track(..., resume=path)`.

        Raises `FileError` if it cannot be written.
        """
        self._tracker.save(path)


def _columns(block: Mapping[str, Any]) -> "dict[str, Array]":
    return {name: np.atleast_1d(np.asarray(block[name], dtype=np.float64)) for name in block}


def _parts(log: Log) -> "Iterator[Mapping[str, Any]]":
    for start in range(0, log.rows, ROWS):
        yield {name: log[name][start : start + ROWS] for name in log}


def track(
    data: Any,
    *,
    every: "str | float" = 0.1,
    method: str = "ekf-tracking",
    voltage_timing: "str | int | None" = None,
    motor: Any = None,
    start: "Mapping[str, Any] | None" = None,
    prior: "Mapping[str, Any] | None" = None,
    fix: "Mapping[str, Any] | None" = None,
    faults: "str | os.PathLike[str] | None" = None,
    reference_temperature: "float | None" = None,
    magnet_coefficient: "float | str | None" = None,
    resume: "str | os.PathLike[str] | None" = None,
    alarm: "Mapping[str, Any] | None" = None,
    mapping: Any = None,
    unit: "Mapping[str, str] | None" = None,
    pole_pairs: "int | None" = None,
    dbc: "str | os.PathLike[str] | None" = None,
) -> Track:
    """Follows the parameters of a running motor.

    `data` is a log, as in `identify`, or an iterator over samples or blocks: mappings of `t` (s), `ud`, `uq` (V), `id`, `iq` (A), `omega_e`
    (electrical rad/s), and optionally `theta_e` (rad), `u_dc` (V), `temperature` (degC), to a number or an array of the shape (rows,). An
    item is told every `every` seconds of the log's time; of an iterator that waits for samples, as soon as it is due.

    `method` is the estimator, `start` the values to begin with; all other keywords are the options of `fluxfit track`, and the items are
    the lines of its `--json`, to the bit. `alarm={"rs": "+20%"}` is a band around the start of a parameter; which one was left, and when,
    is in `Track.alarms`. `steps` of an item counts the steps of parameters that were found.

    Raises `FileError`, `DataError` or `RequestError`.

    >>> import fluxfit
    >>> log = fluxfit.simulate()
    >>> now = fluxfit.track(log, every="300ms").to_arrays()
    >>> now["t"].round(1).tolist(), now["psi_f_verdict"][-1]
    ([0.0, 0.3, 0.6, 0.9, 0.9], 'identified')
    >>> samples = ({name: log[name][row] for name in log} for row in range(2000))
    >>> [document["rows"] for document in fluxfit.track(samples)]
    [1, 1001, 2000]
    """
    is_stream = isinstance(data, Iterable) and hasattr(data, "__next__") and not hasattr(data, "__arrow_c_stream__")
    if is_stream:
        blocks: Iterator[Mapping[str, Any]] = data
    else:
        log = data if isinstance(data, Log) else read_log(data, mapping=mapping, unit=unit, pole_pairs=pole_pairs, dbc=dbc)
        blocks = _parts(log)
    words = [
        *_words.columns(mapping, unit),
        *_words.pairs("--start", start),
        *_words.priors(prior),
        *_words.pairs("--fix", fix),
        *_words.pairs("--alarm", alarm),
        *_words.options(
            every=_words.duration(every),
            method=method,
            voltage_timing=voltage_timing,
            faults=faults,
            reference_temperature=reference_temperature,
            magnet_coefficient=magnet_coefficient,
            resume=resume,
            pole_pairs=pole_pairs,
            dbc=dbc,
        ),
    ]
    with _words.motor_file(motor) as named:
        tracker = _fluxfit.Tracker(["track", *words, *named, "--", "data"])
    return Track(blocks, tracker)
