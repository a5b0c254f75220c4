"""The exceptions of the package: one tree, each with one sentence that says what, where, and what to do."""


class Error(Exception):
    """Whatever this package refuses. A log that cannot tell a parameter is no error: its verdict says so."""


class FileError(Error, OSError):
    """A file that cannot be opened, read or written."""


class DataError(Error, ValueError):
    """A log, a table or another file whose content cannot be used: a missing column, a value that is no number, columns that
    contradict each other, a log without an operating point."""


class RequestError(Error, ValueError):
    """What was asked for makes no sense: an unknown method, a parameter out of its range, two keywords that exclude each other."""
