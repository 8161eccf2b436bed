"""Reads an LCM event log of a run. Needs only the standard library; tables need pandas."""

from __future__ import annotations

import json
import mmap
import os
import struct
import warnings
from typing import TYPE_CHECKING, Any, Iterator, NamedTuple

from fogline_lab import program
from fogline_lab.codec import Message
from fogline_lab.errors import CheckFailed, IncompleteLog, LogError
from fogline_lab.messages import BY_FINGERPRINT, run_t

if TYPE_CHECKING:
    import pandas

# An event: sync word, number, time in us, lengths of channel and data (LCM, eventlog.c).
_EVENT = struct.Struct(">Iqqii")
_SYNC = 0xEDA1DA01
# After its fingerprint (8 bytes), every message begins with header_t: run id, step, utime.
_HEADER = struct.Struct(">qqq")
HEADER_AT = 8
HEADER_END = HEADER_AT + _HEADER.size


class Events(NamedTuple):
    """The events of one channel, in the order of the file. `begins` and `ends` have the offsets in
    the file at which the bytes of each message begin and end. `times` has the times in us."""

    begins: list[int]
    ends: list[int]
    times: list[int]


class Log:
    """The log of a run. Open it with `read_log`.

    Each channel is a pandas DataFrame, which is an attribute with the channel's name: `log.TRACK`.
    For a channel with a message in each step, the index is the step, so columns of two channels can
    be subtracted. A step whose message is missing has no row. For other channels the index counts
    the events.

    The columns are `time_s` (simulated time, s) and the fields with the names and units of
    lcmtypes/. A list has a column for each value: `state.0`, `state.1`, ...; a matrix is written
    row by row: `covariance.0` to `covariance.8`.
    """

    def __init__(self, path: str | os.PathLike[str], run: int | None = None) -> None:
        self.path = os.fspath(path)
        try:
            with open(self.path, "rb") as file:
                empty = os.fstat(file.fileno()).st_size == 0
                # mmap cannot map an empty file.
                self._data: Any = (
                    b"" if empty else mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
                )
        except OSError as error:
            raise LogError(f"{self.path}: {error.strerror}") from None
        self._events, self.torn = _index(self._data, self.path)
        self._frames: dict[str, Any] = {}
        self.run_id = self._first_run() if run is None else run
        if run is not None and run not in self.runs:
            raise LogError(f"{self.path}: no run {run}; its runs: {self.runs}")

    # ---- the contents of the file ----------------------------------------------------------------

    @property
    def channels(self) -> list[str]:
        """The names of the channels, in the order of their first events."""
        return list(self._events)

    @property
    def runs(self) -> list[int]:
        """The ids of the runs in the file. Log reads the first run, unless `read_log` got an id."""
        ids: dict[int, None] = {}
        for name, events in self._events.items():
            if name not in ("RUN", "STATUS", "RESEND"):
                for begin in events.begins:
                    ids[_HEADER.unpack_from(self._data, begin + HEADER_AT)[0]] = None
        return list(ids)

    def messages(self, channel: str) -> Iterator[Message]:
        """The messages of a channel, of this run, in the order of the file, as objects.

        Raises LogError for a channel that the log lacks, and for messages of an unknown type.
        """
        events = self.events_of(channel)
        data, run_id = self._data, self.run_id
        kind = self.type_of(channel)
        fingerprint, read = kind.FINGERPRINT, kind._read
        for begin, end in zip(events.begins, events.ends):
            if data[begin : begin + 8] != fingerprint:
                raise LogError(f"{self.path}: {channel}: a message of another type at byte {begin}")
            try:
                message, at = read(data, begin + 8)
            except (struct.error, ValueError) as error:
                raise LogError(f"{self.path}: {channel}: at byte {begin}: {error}") from None
            if at > end:
                raise LogError(f"{self.path}: {channel}: a message is too short at byte {begin}")
            if message.header.run_id == run_id:
                yield message

    def __getattr__(self, channel: str) -> pandas.DataFrame:
        if channel.startswith("_"):
            raise AttributeError(channel)
        if channel not in self._events:
            raise AttributeError(
                f"{self.path}: no channel {channel}; its channels: {', '.join(self.channels)}"
            )
        if channel not in self._frames:
            from fogline_lab.frames import frame_of  # needs pandas

            self._frames[channel] = frame_of(self, channel)
        return self._frames[channel]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.channels]

    def __repr__(self) -> str:
        counts = ", ".join(f"{name}: {len(one.begins)}" for name, one in self._events.items())
        return f"<log {self.path}, run {self.run_id}: {counts}>"

    # ---- the run ---------------------------------------------------------------------------------

    @property
    def scenario_text(self) -> str:
        """The scenario of the run with every default, as JSON.

        Raises LogError if the log lacks a part of the scenario, because the logger started late.
        """
        parts: dict[int, str] = {}
        wanted = 1
        for message in self.messages("RUN") if "RUN" in self._events else ():
            assert isinstance(message, run_t)
            parts[message.header.step] = message.text
            wanted = message.num_parts
        missing = [str(part) for part in range(wanted) if part not in parts]
        if missing:
            raise LogError(
                f"{self.path}: the log lacks the scenario of run {self.run_id} "
                f"(part {', '.join(missing)} of {wanted})"
            )
        text = "".join(parts[part] for part in range(wanted))
        return text.encode("utf-8", "surrogateescape").decode("utf-8")

    @property
    def scenario(self) -> dict[str, Any]:
        """The scenario of the run with every default. Raises LogError if the log lacks it."""
        return json.loads(self.scenario_text)

    @property
    def metrics(self) -> dict[str, Any]:
        """The measures of the run, as `fogline metrics` computes them from the log.

        If the log is not complete, the measures are those of the steps in the log. A measure that
        needs every step is then None, and the warning IncompleteLog says what is missing.
        """
        return self._tell("metrics")["metrics"]

    @property
    def events(self) -> list[dict[str, Any]]:
        """The events of the run: step, time_s, event, transfer, from, to (`fogline events`).

        If the log is not complete, the events are those of the steps in the log. The warning
        IncompleteLog then says what is missing. If an event may have happened earlier, in a gap, it
        has earliest_step.
        """
        return self._tell("events")["events"]

    @property
    def digest(self) -> str:
        """The digest of the run. Equal digests mean equal runs (`fogline digest`).

        Raises CheckFailed if the log is not complete.
        """
        return self._ask("digest")["digest"]

    def _ask(self, verb: str) -> dict[str, Any]:
        """The result of `fogline VERB` for this run."""
        chosen = ["--run", str(self.run_id)] if self.run_id else []
        return program.call_json(verb, self.path, *chosen)[0]

    def _tell(self, verb: str) -> dict[str, Any]:
        """Does the same as _ask(), but only warns if the log is not complete."""
        try:
            return self._ask(verb)
        except CheckFailed as error:
            if not error.out:
                raise
            warnings.warn(str(error), IncompleteLog, stacklevel=3)
            return json.loads(error.out)[0]

    # ---- for fogline_lab.frames ------------------------------------------------------------------

    @property
    def data(self) -> Any:
        """The bytes of the file."""
        return self._data

    def events_of(self, channel: str) -> Events:
        """The events of a channel. Raises LogError for a channel that the log lacks."""
        if channel not in self._events:
            raise LogError(
                f"{self.path}: no channel {channel}; its channels: {', '.join(self.channels)}"
            )
        return self._events[channel]

    def type_of(self, channel: str) -> type[Message]:
        """The type of the first message of a channel.

        Raises LogError for a type that this build does not know.
        """
        begin = self._events[channel].begins[0]
        fingerprint = bytes(self._data[begin : begin + 8])
        if fingerprint not in BY_FINGERPRINT:
            raise LogError(
                f"{self.path}: {channel}: unknown message type {fingerprint.hex()}; "
                "the log is of another version, or not of Fogline"
            )
        return BY_FINGERPRINT[fingerprint]

    def _first_run(self) -> int:
        for name in ("RUN", *self._events):
            events = self._events.get(name)
            if name in ("STATUS", "RESEND") or not events:
                continue
            if bytes(self._data[events.begins[0] : events.begins[0] + 8]) in BY_FINGERPRINT:
                return _HEADER.unpack_from(self._data, events.begins[0] + HEADER_AT)[0]
        return 0


def read_log(path: str | os.PathLike[str], run: int | None = None) -> Log:
    """Opens the log of a run.

    run: the id of a run in a file with several runs (`Log.runs`); default: the first one.

    A log may have gaps, begin late, or end within an event. A message that is missing has no row.
    Raises LogError if the file cannot be read, is no event log, or has no such run.
    """
    return Log(path, run)


def _index(data: Any, path: str) -> tuple[dict[str, Events], str]:
    """The events of each channel, and a text about bytes at the end that are no whole event; "" if
    there are no such bytes."""
    by_name: dict[bytes, Events] = {}
    at, size, torn = 0, len(data), ""
    unpack, header = _EVENT.unpack_from, _EVENT.size
    while at + header <= size:
        sync, _, time, channel_bytes, data_bytes = unpack(data, at)
        begin = at + header + channel_bytes
        end = begin + data_bytes
        if sync != _SYNC or channel_bytes < 0 or data_bytes < 0 or end > size:
            break
        name = data[at + header : begin]
        at = end
        events = by_name.get(name)
        if events is None:
            events = by_name[name] = Events([], [], [])
        # A message has at least a fingerprint and a header. Shorter ones are not of Fogline.
        if data_bytes < HEADER_END:
            continue
        events.begins.append(begin)
        events.ends.append(end)
        events.times.append(time)
    if at != size:
        if not by_name:
            raise LogError(f"{path}: not an LCM event log")
        torn = f"{size - at} bytes at the end are no whole event and were ignored"
    named = {bytes(name).decode("utf-8", "replace"): events for name, events in by_name.items()
             if events.begins}
    return named, torn
