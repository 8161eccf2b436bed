"""Fogline for Python: logs as tables, runs and sweeps, live messages, and roles of a run.

    import fogline_lab as fl

    run = fl.run("scenario/paper.json", set={"/arbitrator/threshold": 0.8})
    run.log.TRACK[["time_s", "state.0"]]

Reading a log and listening to a network need only the standard library. pandas is imported only
when the caller asks for a table. docs/python.md is a tutorial.
"""

from fogline_lab.errors import (BadInput, CheckFailed, FoglineError, IncompleteLog, LogError,
                                ProgramError, RunFailed)
from fogline_lab.live import Heard, Live
from fogline_lab.log import Log, read_log
from fogline_lab.messages import *  # noqa: F403 - every message type
from fogline_lab.program import Run, run, sweep, table
from fogline_lab.role import Role, serve
from fogline_lab.roles import *  # noqa: F403 - a class for each role
