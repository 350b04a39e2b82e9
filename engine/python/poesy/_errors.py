"""What can go wrong, each with the program's own sentence. The exit codes are those of engine/docs/guide.md."""

from __future__ import annotations


class Error(Exception):
    """Base of everything that this package raises on purpose. ``str(error)`` says what is wrong and what to do."""


class ProgramNotFound(Error):
    """The program ``poesy`` is not there, or cannot be started."""


class InternalError(Error):
    """The program failed for a reason of its own: exit code 1, or a signal ended it."""


class StudyError(Error, ValueError):
    """The study, its data or an argument is wrong: exit code 2. Nothing was written."""


class FileError(Error, OSError):
    """A file cannot be read or written: exit code 3."""


class DamagedFile(FileError):
    """A file is there, but it is not an intact result that this version can read."""


class Interrupted(Error):
    """The run was stopped from outside: exit code 4. Its checkpoint is kept, so ``run(..., resume=True)`` goes on.

    Ctrl-C in Python is not this: it stays a ``KeyboardInterrupt``, with the program's sentence as a note.
    """


class NotInResult(Error, LookupError):
    """A result of this kind does not have what was asked for."""


class PoesyWarning(UserWarning):
    """What the program warns of while it goes on, for instance many samples that did not converge (exit code 5)."""
