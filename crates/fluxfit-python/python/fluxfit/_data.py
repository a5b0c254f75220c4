"""What may stand for a log: paths, and tables in memory."""

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from fluxfit._errors import DataError, RequestError

# What a table in memory is called in messages.
NAME = "data"


def logs_and_table(data: Any) -> tuple[list[str], Any]:
    """The names of the logs, and the table in memory, if there is one: a dictionary of arrays, or an object with Arrow's interface."""
    if isinstance(data, (str, os.PathLike)):
        return [_path(data)], None
    if isinstance(data, (list, tuple)) and data and all(isinstance(item, (str, os.PathLike)) for item in data):
        return [_path(item) for item in data], None
    if isinstance(data, Mapping):
        return [NAME], _arrays(data)
    if hasattr(data, "data_vars"):  # xarray's Dataset
        return [NAME], _arrays({str(name): data[name].to_numpy() for name in data.variables if data[name].ndim == 1})
    if hasattr(data, "columns") and hasattr(data, "to_numpy") and not _has_pyarrow():  # pandas without pyarrow
        return [NAME], _arrays({str(name): data[name].to_numpy() for name in data.columns})
    if hasattr(data, "__arrow_c_stream__"):
        return [NAME], data
    names = getattr(getattr(data, "dtype", None), "names", None)
    if names:  # a structured array
        return [NAME], _arrays({name: data[name] for name in names})
    raise RequestError(
        f"{type(data).__name__} is nothing that a log can be read from; give a path, a dictionary of arrays, or a table of pandas, polars or pyarrow"
    )


def _path(path: "str | os.PathLike[str]") -> str:
    return os.fspath(path)


def _has_pyarrow() -> bool:
    try:
        import pyarrow  # noqa: F401
    except ImportError:
        return False
    return True


def _arrays(columns: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """Contiguous arrays of floats; those that are so already are not copied. Columns of text are left out."""
    arrays = {}
    for name, values in columns.items():
        array = np.asarray(values)
        if array.ndim != 1:
            raise DataError(f"{NAME}, column '{name}': an array of {array.ndim} dimensions is no column; give one value for each row")
        if array.dtype.kind in "mM":
            if array.size:
                array = (array - array[0]) / np.timedelta64(1, "s")
            else:
                array = np.empty(0)
        elif array.dtype.kind not in "fiub":
            continue
        arrays[str(name)] = np.ascontiguousarray(array, dtype=np.float64)
    return arrays
