"""Exceptions of this package. Their messages are those of the program; engine/docs/guide.md lists the exit codes."""

from __future__ import annotations


class Error(Exception):
    """Base of all exceptions that this package raises on purpose. ``str(error)`` says what is wrong and what to do."""


class ProgramNotFound(Error):
    """The program ``poesy`` is not installed, or cannot be started."""


class InternalError(Error):
    """The program failed because of a bug (exit code 1), or a signal ended it."""


class StudyError(Error, ValueError):
    """The study, its data or an argument is wrong (exit code 2). Nothing was written."""


class FileError(Error, OSError):
    """A file cannot be read or written (exit code 3)."""


class DamagedFile(FileError):
    """A file exists, but it is not an intact result that this version of the package can read."""


class Interrupted(Error):
    """Another process stopped the run (exit code 4). ``run(..., resume=True)`` continues it from its checkpoint.

    Ctrl-C in Python raises ``KeyboardInterrupt`` instead, with the program's sentence as a note.
    """


class NotInResult(Error, LookupError):
    """A result of this kind does not have the requested data."""


class PoesyWarning(UserWarning):
    """A warning of the program, for instance that many samples did not converge (exit code 5)."""
