"""A role of a run as a class in Python."""

from __future__ import annotations

import json
import os
import sys
import traceback
from typing import Any, ClassVar, Mapping, Sequence

from fogline_lab.codec import Message
from fogline_lab.errors import FoglineError
from fogline_lab.messages import accel_command_t, driver_command_t, driver_input_t, header_t


class Role:
    """A role of a run. `fogline_lab.roles` has a class for each role that computes steps.

    Derive a class from one of them, and pass it to `serve`:

        class MyDriver(fl.Driver):
            def step(self, truth):
                return 0.1 * (truth.host_gap_m - 30)

        fl.serve(MyDriver)

    A class makes its outputs only from its inputs and from `self`. It uses no clock, no files and
    no random numbers from other sources. Then a process that is started again in the middle of a
    run makes the same outputs again.
    """

    ROLE: ClassVar[str] = ""  # name of the role
    READS: ClassVar[tuple[type[Message], ...]] = ()  # arguments of step()
    WRITES: ClassVar[tuple[type[Message], ...]] = ()  # results of step()
    ON_DEMAND: ClassVar[type[Message] | None] = None  # argument of on_demand()
    BEGINS: ClassVar[bool] = False  # whether the role begins the steps

    def __init__(self, scenario: Mapping[str, Any]) -> None:
        """scenario: the scenario of the run, with every default (scenario["driver"]["headway_s"]).
        """
        self.scenario = scenario

    def step(self, *messages: Any) -> Any:
        """Computes a step. The arguments are the messages that the role reads, one of each channel.
        The result is the message that the role writes (a tuple if it writes two). This package
        fills in the header of the result.

        A driver and an ACC may return a number: the acceleration in m/s2.
        """
        raise NotImplementedError(f"{type(self).__name__} has no step()")

    @classmethod
    def uses_on_demand(cls, scenario: Mapping[str, Any]) -> bool:
        """Whether the role also reads its channel on demand (ON_DEMAND) in this scenario."""
        return False

    def on_demand(self, message: Any) -> None:
        """Takes the message on demand. Called before step() (services/algorithm.h says when)."""

    @classmethod
    def uses_live(cls, scenario: Mapping[str, Any]) -> bool:
        """Whether a driver in real time takes the inputs of a person (DRIVER_INPUT)."""
        return False

    def live(self, input: driver_input_t | None) -> None:
        """Takes the newest input of the person before each step(); None: no person is there."""


def serve(role: type[Role], arguments: Sequence[str] | None = None) -> None:
    """Takes part in a run as this role. Ends the program with the exit codes of the C++ roles: 0
    stopped by the runner, 2 bad usage, 3 failed, 130 interrupted.

    arguments: the command line (--lcm-url, --key, --run-id, --wait, --help); default: that of the
        program.

    Lockstep, repair, real time and signatures are as in every other role, because the process runs
    the same code. An exception in step() ends the run, and the run names the exception.

    Raises FoglineError if this build has no extension module for roles, TypeError if the class is
    derived from none of the roles.
    """
    if not (isinstance(role, type) and issubclass(role, Role) and role.ROLE):
        raise TypeError(f"{role!r} is derived from none of the roles, such as fl.Driver")
    words = sys.argv[1:] if arguments is None else arguments
    sys.exit(_runtime().serve(role.ROLE, _Factory(role), list(words)))


def _runtime() -> Any:
    """The extension module. It has its own versions of two functions for sockets. LCM's library
    uses these versions only if the module is loaded with RTLD_DEEPBIND."""
    flags = sys.getdlopenflags()
    sys.setdlopenflags(flags | os.RTLD_DEEPBIND)
    try:
        from fogline_lab import _runtime as module
    except ImportError as error:
        raise FoglineError(
            "this build of fogline_lab cannot run a role, because its extension module is missing "
            f"({error}); install pybind11-dev and python3-dev, and build again"
        ) from None
    finally:
        sys.setdlopenflags(flags)
    return module


# The message of a step that returns only an acceleration. The input_sequence is -1, because the
# command is not made from the input of a person (driver_command_t).
def _command_of(role: Role, acceleration_mps2: float) -> Message:
    kind = role.WRITES[0]
    if kind is driver_command_t:
        return driver_command_t(acceleration_mps2=acceleration_mps2, input_sequence=-1,
                                readiness=role.scenario["driver"]["readiness"])
    if kind is accel_command_t:
        return accel_command_t(acceleration_mps2=acceleration_mps2)
    raise TypeError(f"returned {acceleration_mps2!r} in place of {_names(role.WRITES)}")


def _names(kinds: Sequence[type[Message]]) -> str:
    return ", ".join(kind.__name__ for kind in kinds)


class RoleFailed(Exception):
    """An exception in a role, with the text that the run shows."""


class _Factory:
    """Makes instances of a role. Called by the extension module."""

    def __init__(self, role: type[Role]) -> None:
        self._role = role

    def make(self, scenario: str) -> _Instance:
        return self._told("__init__", lambda: _Instance(self._role(json.loads(scenario))))

    def uses_on_demand(self, scenario: str) -> bool:
        return self._told(
            "uses_on_demand", lambda: bool(self._role.uses_on_demand(json.loads(scenario)))
        )

    def uses_live(self, scenario: str) -> bool:
        return self._told("uses_live", lambda: bool(self._role.uses_live(json.loads(scenario))))

    def _told(self, name: str, call: Any) -> Any:
        try:
            return call()
        except Exception as error:
            raise _failure(f"{self._role.__name__}.{name}()", error) from error


def _failure(where: str, error: BaseException) -> RoleFailed:
    traceback.print_exception(error)
    return RoleFailed(f"{where}: {type(error).__name__}: {error}")


class _Instance:
    """A role of a run. Takes and returns the bytes of messages. Called by the extension module."""

    def __init__(self, role: Role) -> None:
        self._role = role
        self._name = type(role).__name__
        self._step_us = round(role.scenario["step_s"] * 1e6) if role.BEGINS else 0

    def start(self, run_id: int) -> tuple[bytes, ...]:
        header = header_t(run_id, 0, 0)
        try:
            return self._encoded(self._role.start(), header)  # type: ignore[attr-defined]
        except BaseException as error:
            raise _failure(f"{self._name}.start()", error) from error

    def step(self, *payloads: bytes) -> tuple[bytes, ...]:
        role = self._role
        inputs = [kind.decode(payload) for kind, payload in zip(role.READS, payloads)]
        # A copy, because a step may change its inputs.
        first = inputs[0].header
        header = header_t(first.run_id, first.step, first.utime)
        if role.BEGINS:  # the inputs of this role are those of the previous step
            header.step += 1
            header.utime = header.step * self._step_us
        try:
            return self._encoded(role.step(*inputs), header)
        except BaseException as error:
            raise _failure(f"step {header.step}: {self._name}.step()", error) from error

    def on_demand(self, payload: bytes) -> None:
        assert self._role.ON_DEMAND is not None
        try:
            self._role.on_demand(self._role.ON_DEMAND.decode(payload))
        except BaseException as error:
            raise _failure(f"{self._name}.on_demand()", error) from error

    def live(self, payload: bytes | None) -> None:
        try:
            self._role.live(None if payload is None else driver_input_t.decode(payload))
        except BaseException as error:
            raise _failure(f"{self._name}.live()", error) from error

    def _encoded(self, result: Any, header: header_t) -> tuple[bytes, ...]:
        kinds = self._role.WRITES
        if len(kinds) == 1:
            if not isinstance(result, Message) and hasattr(result, "__float__"):
                result = _command_of(self._role, float(result))
            result = (result,)
        if not isinstance(result, tuple) or tuple(map(type, result)) != kinds:
            shown = result[0] if len(kinds) == 1 else result
            raise TypeError(f"returned {shown!r} in place of {_names(kinds)}")
        for message in result:
            message.header = header
        # The runtime refuses numbers that are not finite (step_node.h).
        return tuple(message.encode() for message in result)
