"""Fleets on Dask: a table of many motors in, the rows of `fluxfit fleet` out.

The table is shuffled by motor, so that each motor's rows come together in one partition; then each partition is cut into its motors. A
task that is run again, because its worker was lost, gives the same rows: they depend on the motor's rows and on what is asked alone.

A motor with very many rows is read as a log of a file is: the half million rows that differ most (`docs/log.md`), in the memory of one
worker.
"""

from typing import Any

from fluxfit._fleet import DTYPES, Request, columns

def fleet(frame: Any, by: str, *, sort: "str | None" = None, **request: Any) -> Any:
    """Identifies every motor of a Dask DataFrame.

    `by` is the column that names the motor; `sort` is the column of time by which a motor's rows are put in order after the shuffle,
    which keeps no order (without it, a column `t` is taken where there is one). Further keywords: `every`, `source`, and those of
    `identify` (`pole_pairs`, `mapping`, `unit`, `prior`, `fix`, `model`, `method`, `seed`).

    Returns a lazy DataFrame with a row for each motor and window; `fluxfit._fleet.columns()` lists its columns. What fails is a row with
    its reason in `error`.

    Raises `RequestError` when it is computed, if what is asked makes no sense for any motor.
    """
    asked = Request(by=by, **request)
    time = sort or ("t" if "t" in frame.columns else None)
    together = frame.shuffle(on=by)
    return together.map_partitions(_partition, by, time, asked, meta=_frame([]))


def files(paths: "list[str]", **request: Any) -> Any:
    """Identifies every log of a list, one motor each, on the workers of Dask; the workers must see the files.

    Returns a lazy DataFrame with a partition for each log.
    """
    import dask.dataframe as dd
    from dask.delayed import delayed

    asked = Request(**request)
    return dd.from_delayed([delayed(_file)(path, asked) for path in paths], meta=_frame([]))


def _file(path: str, asked: Request) -> Any:
    from fluxfit import Error, read_log

    asked.source = path
    try:
        table: Any = dict(read_log(path))
    except Error as error:
        return _frame([dict.fromkeys(columns()) | {"motor": path, "source": path, "error": str(error)}])
    return _frame(asked.rows(path, table))


def _partition(frame: Any, by: str, time: "str | None", asked: Request) -> Any:
    rows: list[dict[str, Any]] = []
    for motor, table in frame.groupby(by, sort=True, dropna=False, observed=True):
        ordered = table.drop(columns=by)
        if time is not None:
            ordered = ordered.sort_values(time, kind="stable")
        rows += asked.rows(motor, {name: ordered[name].to_numpy() for name in ordered.columns})
    return _frame(rows)


def _frame(rows: "list[dict[str, Any]]") -> Any:
    import pandas as pd

    types = {name: DTYPES[kind] for name, kind in columns().items()}
    return pd.DataFrame(rows, columns=list(types)).astype(types)
