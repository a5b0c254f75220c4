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
            *_words.options(pole_pairs=pole_pairs, every=window, model=model, method=method, seed=seed),
        ]
        self.words = ["fleet", *words, "-o", OUTPUT, "--", "data"]

    def rows(self, motor: Any, table: Any) -> "list[dict[str, Any]]":
        """The rows of one motor: a dictionary for each window. What fails is a row with its reason in `error`.

        Raises `RequestError` only if what is asked makes no sense for any motor.
        """
        _, held = logs_and_table(table)
        # Both engines tell a whole number from a text; the results name motors by text, as the command does.
        name = "" if motor is None or motor != motor else str(motor)
        found: list[dict[str, Any]] = json.loads(_fluxfit.fleet_rows(self.words, name, self.source, held))
        return found
