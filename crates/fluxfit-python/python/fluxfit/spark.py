"""Fleets on Spark: a table of many motors in, the rows of `fluxfit fleet` out.

The table is grouped by motor (`applyInPandas`): each motor's rows come to one worker, in the memory of which they must fit. A task that is
run again, because its executor was lost, gives the same rows: they depend on the motor's rows and on what is asked alone.
"""

from collections.abc import Callable
from typing import Any

from fluxfit._fleet import Request, columns

# Types of Spark for the columns.
TYPES = {"text": "string", "number": "double", "count": "bigint"}


def schema() -> str:
    """The schema of the results, as Spark writes it.

    >>> schema().split(", ")[:2]
    ['motor string', 'window_start double']
    """
    return ", ".join(f"{name} {TYPES[kind]}" for name, kind in columns().items())


def fleet(frame: Any, by: str, *, sort: "str | None" = None, **request: Any) -> Any:
    """Identifies every motor of a Spark DataFrame.

    `by` is the column that names the motor; `sort` is the column of time by which a motor's rows are put in order after the shuffle,
    which keeps no order (without it, a column `t` is taken where there is one). Further keywords: `every`, `source`, and those of
    `identify`.

    Returns a lazy DataFrame with a row for each motor and window (`schema()`); what fails is a row with its reason in `error`.
    """
    time = sort or ("t" if "t" in frame.columns else None)
    return frame.groupBy(by).applyInPandas(_rows_of(by, time, Request(by=by, **request)), schema())


def _rows_of(by: str, time: "str | None", asked: Request) -> "Callable[[Any, Any], Any]":
    def rows(key: Any, table: Any) -> Any:
        import pandas as pd

        ordered = table.drop(columns=by)
        if time is not None:
            ordered = ordered.sort_values(time, kind="stable")
        found = asked.rows(key[0], {name: ordered[name].to_numpy() for name in ordered.columns})
        return pd.DataFrame(found, columns=list(columns()))

    return rows
