"""Identifies the electrical parameters of a permanent magnet synchronous motor from a log of its drive.

>>> import fluxfit
>>> found = fluxfit.identify(fluxfit.simulate())
>>> sorted(found.parameters)
['ld', 'lq', 'psi_f', 'rs']

`identify` is the main function, `fleet` the same for many motors, `track` for a running one; `read_log`, `inspect`, `validate`,
`compare`, `simulate` are the command's other verbs, `minimize` and `Search` its optimizers for any function. Every exception is an
`Error`.
"""

from fluxfit import _fluxfit
from fluxfit._api import Study, Validation, compare, explain, identify, inspect, read_log, simulate, validate
from fluxfit._errors import DataError, Error, FileError, RequestError
from fluxfit._fleet import Fleet, fleet
from fluxfit._identification import Estimate, Identification
from fluxfit._log import Log
from fluxfit._optimize import Search, methods, minimize
from fluxfit._track import Alarm, Track, track

__version__ = _fluxfit.version()

__all__ = [
    "Alarm",
    "DataError",
    "Error",
    "Estimate",
    "FileError",
    "Fleet",
    "Identification",
    "Log",
    "RequestError",
    "Search",
    "Study",
    "Track",
    "Validation",
    "compare",
    "explain",
    "fleet",
    "identify",
    "inspect",
    "methods",
    "minimize",
    "read_log",
    "simulate",
    "track",
    "validate",
]
