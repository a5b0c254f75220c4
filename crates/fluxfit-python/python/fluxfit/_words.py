"""Keywords as the words of the command line: one parser reads both, so that a unit or a name is the same everywhere."""

import contextlib
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from fluxfit import _toml
from fluxfit._errors import RequestError


def text(value: Any) -> str:
    """A number with all its digits, a path, or what is written already."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, bool) or not hasattr(value, "__float__"):
        raise RequestError(f"{value!r} is no value; give a number in SI units, or a text with its unit such as '5.25 mH'")
    return repr(int(value)) if isinstance(value, int) else repr(float(value))


def duration(value: Any) -> "str | None":
    """A number of seconds, or what is written already with its unit.

    >>> duration(3600), duration("1h"), duration(None)
    ('3600s', '1h', None)
    """
    return value if value is None or isinstance(value, str) else f"{text(value)}s"


def pairs(option: str, entries: "Mapping[str, Any] | None") -> list[str]:
    """`--fix=rs=0.96` of each entry."""
    return [f"{option}={name}={text(value)}" for name, value in (entries or {}).items()]


def priors(entries: "Mapping[str, Any] | None") -> list[str]:
    """`--prior=rs=0.96±1%` of each entry: a value with its standard error, or a text."""
    words = []
    for name, value in (entries or {}).items():
        if isinstance(value, (tuple, list)):
            if len(value) != 2:
                raise RequestError(f"prior={{{name!r}: ...}} needs a value and a standard error, such as (0.96, '1%')")
            value = f"{text(value[0])}±{text(value[1])}"
        elif not isinstance(value, str):
            raise RequestError(f"prior={{{name!r}: {value!r}}} has no standard error; give (value, error), or fix={{{name!r}: {value!r}}}")
        words.append(f"--prior={name}={value}")
    return words


def windows(given: Any) -> list[str]:
    """`--window=0.48:0.595` of one pair of times, or of several."""
    if given is None:
        return []
    several = given if given and isinstance(given[0], Sequence) and not isinstance(given[0], str) else [given]
    return [f"--window={text(start)}:{text(end)}" for start, end in several]


def options(**given: Any) -> list[str]:
    """`--pole-pairs=4` of each keyword that is given; `True` is an option without a value."""
    words = []
    for name, value in given.items():
        option = "--" + name.replace("_", "-")
        if value is True:
            words.append(option)
        elif value is not None and value is not False:
            words.append(f"{option}={text(value)}")
    return words


def columns(mapping: Any, unit: "Mapping[str, str] | None") -> list[str]:
    """Names and units of columns: a mapping file, or a dictionary of channels and headers."""
    named = pairs("--map", mapping) if isinstance(mapping, Mapping) else []
    file = [f"--mapping={os.fspath(mapping)}"] if mapping is not None and not isinstance(mapping, Mapping) else []
    return [*named, *file, *pairs("--unit", unit)]


@contextlib.contextmanager
def motor_file(motor: Any) -> "Iterator[list[str]]":
    """`--motor=FILE` of a path, or of a dictionary, which is written into a file for the while."""
    if motor is None:
        yield []
        return
    if not isinstance(motor, Mapping):
        yield [f"--motor={os.fspath(motor)}"]
        return
    handle, path = tempfile.mkstemp(prefix="fluxfit-motor-", suffix=".toml")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(motor_text(motor))
        yield [f"--motor={path}"]
    finally:
        os.unlink(path)


def motor_text(motor: Mapping[str, Any]) -> str:
    """A motor file: the parameters may stand below `motor` or alone."""
    tables = {name: value for name, value in motor.items() if isinstance(value, Mapping)}
    if "motor" not in tables:
        tables = {"motor": {name: value for name, value in motor.items() if name not in tables}, **tables}
    return _toml.dumps(tables)
