"""Exceptions and warnings. Their messages say what failed, where, and what to do next."""

import warnings


class Error(Exception):
    """Base of all errors of driftmesh."""

    file = None  # the file concerned, if it is known
    line = None  # and the line of the (first) problem in it


class InputError(Error, ValueError):
    """The input is wrong, and what is meant is not clear enough to repair it."""


class FileError(Error, OSError):
    """A file could not be opened, read, written or renamed."""


class LimitError(Error):
    """A limit on triangles, memory or depth was reached."""


class Cancelled(Error):
    """The progress callable ended the work; or, on many ranks, another rank did."""


class InputWarning(UserWarning):
    """Something that the author of an input may not have meant."""


def warn(message):
    warnings.warn(message, InputWarning, stacklevel=2)


for _class in (Error, InputError, FileError, LimitError, Cancelled, InputWarning):
    _class.__module__ = "driftmesh"
