"""The errors of this package. The text of an error is the output of the program, or says what is
wrong, for example with a file or a network."""

from __future__ import annotations


class FoglineError(Exception):
    """Any error of this package."""


class LogError(FoglineError, ValueError):
    """A file cannot be read as an event log, or a log lacks the requested data."""


class ProgramError(FoglineError, RuntimeError):
    """`fogline` has failed. The text is its output on stderr; `out` is its output on stdout."""

    def __init__(self, text: str, command: list[str], code: int, out: str = "") -> None:
        super().__init__(text or f"{' '.join(command)}: exit code {code}")
        self.command = command
        self.code = code
        self.out = out


class CheckFailed(ProgramError):
    """Exit code 1: a check has failed."""


class IncompleteLog(UserWarning):
    """The program has examined only a part of a run, because the log is not complete. The text says
    what is missing."""


class BadInput(ProgramError, ValueError):
    """Exit code 2: a file, a field or an option is wrong."""


class RunFailed(ProgramError):
    """Exit code 3, or any code other than 0, 1 and 2: the run has failed."""
