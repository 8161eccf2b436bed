"""Tables of messages: pandas DataFrames, decoded with numpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterator

import numpy
import pandas

from fogline_lab.codec import Message
from fogline_lab.errors import LogError
from fogline_lab.messages import header_t
from fogline_lab.roles import STEP_CHANNELS

if TYPE_CHECKING:
    from fogline_lab.log import Log

_NUMPY = {"boolean": "?", "int8_t": "i1", "int16_t": ">i2", "int32_t": ">i4", "int64_t": ">i8",
          "float": ">f4", "double": ">f8"}
# Number of messages that are copied out of the file at once. The indices of a copy need 8 bytes for
# each byte, so a larger number costs memory and saves no time.
_AT_ONCE = 10_000


def frame_of(log: Log, channel: str) -> pandas.DataFrame:
    """The table of a channel (see fogline_lab.Log)."""
    kind = log.type_of(channel)
    if any(field.type == "string" for field in kind.FIELDS):
        table = _table_of_objects(log, channel)
    else:
        table = _table_of_numbers(log, channel, kind)
    if channel not in STEP_CHANNELS:
        return table.drop(columns="utime").reset_index(drop=True)
    # lcm-logger also records messages that were sent again, so the same step may come twice.
    table = table.drop_duplicates("step").sort_values("step", kind="stable")
    return table.drop(columns="utime").set_index("step")


def _table(columns: dict[str, Any]) -> pandas.DataFrame:
    columns = {"step": columns["step"], "utime": columns["utime"],
               "time_s": numpy.asarray(columns["utime"]) / 1e6, **columns}
    return pandas.DataFrame(columns)


# ---- types of numbers only -----------------------------------------------------------------------


def _table_of_numbers(log: Log, channel: str, kind: type[Message]) -> pandas.DataFrame:
    events = log.events_of(channel)
    begins = numpy.asarray(events.begins, dtype=numpy.int64)
    sizes = numpy.asarray(events.ends, dtype=numpy.int64) - begins
    # All lists of variable length in a message have the same length. So the size of the message
    # determines this length.
    tables = []
    for size in numpy.unique(sizes):
        group = begins[sizes == size]
        tables.append(_table_of_equals(log, channel, kind, group, int(size)))
    # A table is empty if its messages are of another run. Such a table is left out, because it may
    # have more columns than the tables of this run.
    tables = [table for table in tables if len(table)] or tables[:1]
    return pandas.concat(tables, ignore_index=True) if len(tables) > 1 else tables[0]


def _table_of_equals(log: Log, channel: str, kind: type[Message], begins: numpy.ndarray,
                     size: int) -> pandas.DataFrame:
    first = bytes(log.data[int(begins[0]) : int(begins[0]) + size])
    try:
        layout, counts = _layout(kind, kind.decode(first))
    except ValueError as error:
        raise LogError(f"{log.path}: {channel}: at byte {begins[0]}: {error}") from None
    rows = numpy.concatenate(list(_gather(log.data, begins, layout)))
    wrong = rows["fingerprint"] != int.from_bytes(kind.FINGERPRINT, "big")
    for name, count in counts.items():
        wrong |= rows[name] != count
    if wrong.any():
        at = begins[int(numpy.argmax(wrong))]
        raise LogError(f"{log.path}: {channel}: a message of another type at byte {at}")
    rows = rows[rows["run_id"] == log.run_id]
    columns: dict[str, Any] = {name: _native(rows[name]) for name in ("step", "utime")}
    for field in kind.FIELDS:
        if field.type != "header_t":
            columns.update(_columns(field.name, rows[field.name], bool(field.dims)))
    return _table(columns)


def _layout(kind: type[Message], example: Message) -> tuple[numpy.dtype, dict[str, int]]:
    """The layout of messages whose lists are as long as those of the example, and the values of the
    fields that count elements."""
    counts: dict[str, int] = {}
    parts: list[tuple] = [("fingerprint", ">u8")]
    for field in kind.FIELDS:
        if field.type == "header_t":
            parts += [(one.name, _NUMPY[one.type]) for one in header_t.FIELDS]
            continue
        shape = []
        for dim in field.dims:
            if isinstance(dim, str):
                counts[dim] = getattr(example, dim)
            shape.append(counts[dim] if isinstance(dim, str) else dim)
        parts.append((field.name, _NUMPY[field.type], tuple(shape)))
    return numpy.dtype(parts), counts


def _gather(data: Any, begins: numpy.ndarray, layout: numpy.dtype) -> Iterator[numpy.ndarray]:
    """The messages that begin at these places, as arrays of the layout."""
    everything = numpy.frombuffer(data, numpy.uint8)
    within = numpy.arange(layout.itemsize)
    for at in range(0, len(begins), _AT_ONCE):
        places = begins[at : at + _AT_ONCE, numpy.newaxis] + within
        yield everything[places].view(layout)[:, 0]


def _native(column: numpy.ndarray) -> numpy.ndarray:
    """The column in this machine's byte order."""
    return column.astype(column.dtype.newbyteorder("="))


def _columns(name: str, values: numpy.ndarray, is_list: bool) -> dict[str, numpy.ndarray]:
    if not is_list:
        return {name: _native(values)}
    rows = values.reshape(len(values), -1) if len(values) else values.reshape(0, 0)
    return {f"{name}.{i}": _native(rows[:, i]) for i in range(rows.shape[1])}


# ---- types with texts ----------------------------------------------------------------------------


def _table_of_objects(log: Log, channel: str) -> pandas.DataFrame:
    rows = [_row(message) for message in log.messages(channel)]
    names: dict[str, None] = {}
    for row in rows:
        names.update(dict.fromkeys(row))
    return _table({name: [row.get(name) for row in rows] for name in ("step", "utime", *names)})


def _row(message: Any) -> dict[str, Any]:
    row = {"step": message.header.step, "utime": message.header.utime}
    for field in message.FIELDS:
        value = getattr(message, field.name)
        if field.type == "header_t":
            continue
        if field.dims:
            row.update({f"{field.name}.{i}": one for i, one in enumerate(value)})
        else:
            row[field.name] = value
    return row
