"""The rows of a fleet, as every engine makes them: one motor's table in, its rows out, the same as those of `fluxfit fleet`."""

import json
from collections.abc import Mapping
from typing import Any

from fluxfit import _fluxfit, _words
from fluxfit._data import logs_and_table

# What the words need and no engine uses: the engine writes the results.
OUTPUT = "results.csv"


def columns() -> "dict[str, str]":
    """The columns of the results in their order: each with `text`, `number` or `count`.

    >>> columns()["rs"], columns()["rs_verdict"], columns()["rows"]
    ('number', 'text', 'count')
    """
    return dict(_fluxfit.fleet_columns())


class Request:
    """What is asked of each motor: the keywords of `identify`, which is pickled and sent to workers."""

    def __init__(
        self,
        *,
        by: "str | None" = None,
        every: "str | float | None" = None,
        source: str = "table",
        pole_pairs: "int | None" = None,
        mapping: Any = None,
        unit: "Mapping[str, str] | None" = None,
        prior: "Mapping[str, Any] | None" = None,
        fix: "Mapping[str, Any] | None" = None,
        model: str = "auto",
        method: str = "auto",
        seed: int = 1,
    ) -> None:
        self.source = source
        window = f"{every!r}s" if isinstance(every, (int, float)) else every
        words = [
            *_words.columns(mapping, unit),
            *_words.priors(prior),
            *_words.pairs("--fix", fix),
            *_words.options(by=by, pole_pairs=pole_pairs, every=window, model=model, method=method, seed=seed),
        ]
        self.words = ["fleet", *words, "-o", OUTPUT, "--", "data"]

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
