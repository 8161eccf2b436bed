"""The errors of this package. Their texts are those of the program or the file concerned."""

from __future__ import annotations


class FoglineError(Exception):
    """Any error of this package."""


class LogError(FoglineError, ValueError):
    """A file is no event log, or a log lacks what was asked for."""


class ProgramError(FoglineError, RuntimeError):
    """`fogline` has failed. The text is what it printed on stderr, `out` what it printed on stdout.
    """

    def __init__(self, text: str, command: list[str], code: int, out: str = "") -> None:
        super().__init__(text or f"{' '.join(command)}: exit code {code}")
        self.command = command
        self.code = code
        self.out = out


class CheckFailed(ProgramError):
    """Exit code 1: a check has failed."""


class IncompleteLog(UserWarning):
    """What the program tells of a log is that of a part of the run. The text says what is missing.
    """


class BadInput(ProgramError, ValueError):
    """Exit code 2: a file, a field or an option is wrong."""


class RunFailed(ProgramError):
    """Exit code 3 or another one: the run has failed."""
