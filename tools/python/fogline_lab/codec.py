"""The bytes of messages, as LCM encodes them: the fingerprint of the type, then the fields, in big
endian.

The classes of `fogline_lab.messages` use these functions. Only the standard library is needed.
"""

from __future__ import annotations

import functools
import struct
from typing import Any, ClassVar, NamedTuple, Sequence, TypeVar

# A signed message has these bytes after its payload: mark, key id, sender, tag.
SIGNATURE_MARK = b"FLS1"
SIGNATURE_BYTES = 24
# Largest number of elements of a list. A message fits into one datagram, so no message has a longer
# list.
MOST_ELEMENTS = 1 << 16

_LENGTH = struct.Struct(">i")

M = TypeVar("M", bound="Message")


class Field(NamedTuple):
    """A field of a message type: name, type in LCM, and dimensions (numbers, or the name of the
    field that counts the elements)."""

    name: str
    type: str
    dims: tuple


class Message:
    """A message. Its fields have the names and units of lcmtypes/."""

    __slots__ = ()
    FINGERPRINT: ClassVar[bytes]
    FIELDS: ClassVar[tuple[Field, ...]]

    @classmethod
    def decode(cls: type[M], data: Any) -> M:
        """Makes a message from its bytes. A signature after the message is ignored.

        Raises ValueError if the bytes are not one message of this type.
        """
        if bytes(data[:8]) != cls.FINGERPRINT:
            raise ValueError(f"{cls.__name__}: the bytes are a message of another type")
        try:
            message, end = cls._read(data, 8)
        except (struct.error, ValueError, OverflowError) as error:
            raise ValueError(f"{cls.__name__}: {len(data)} bytes are no message: {error}") from None
        signed = len(data) - end == SIGNATURE_BYTES and data[end : end + 4] == SIGNATURE_MARK
        if end != len(data) and not signed:
            raise ValueError(f"{cls.__name__}: {len(data)} bytes are no message")
        return message

    def encode(self) -> bytes:
        """The bytes of the message. The fields that count elements are computed from the lists.

        Raises ValueError if a field has a value that its type cannot have.
        """
        try:
            return self._write()
        except (struct.error, TypeError, AttributeError, IndexError, OverflowError) as error:
            raise ValueError(self._fault() or f"{type(self).__name__}: {error}") from None

    @classmethod
    def _read(cls, data: Any, at: int) -> tuple[Any, int]:
        raise NotImplementedError

    def _write(self) -> bytes:
        raise NotImplementedError

    def _fault(self) -> str:
        """A text about the first field that cannot be encoded; "" if none is found."""
        for field in self.FIELDS:
            value = getattr(self, field.name)
            if _fits(value, field.type, field.dims):
                continue
            shape = "".join(f"[{dim}]" for dim in field.dims)
            return (
                f"{type(self).__name__}.{field.name}: {value!r} is no {field.type}{shape}"
            )
        return ""


_LETTERS = {"boolean": "?", "int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q",
            "float": "f", "double": "d"}


def _fits(value: Any, kind: str, dims: Sequence) -> bool:
    if dims:
        if isinstance(value, str) or not hasattr(value, "__len__"):
            return False
        right_length = isinstance(dims[0], str) or len(value) == dims[0]
        return right_length and all(_fits(one, kind, dims[1:]) for one in value)
    if kind == "string":
        return isinstance(value, str)
    if kind not in _LETTERS:
        return isinstance(value, Message)
    try:
        struct.pack(_LETTERS[kind], value)
    except (struct.error, TypeError, OverflowError):
        return False
    return True


def count(message: Message, name: str, lists: Sequence[str]) -> int:
    """The value of a field that counts the elements of these lists.

    Raises ValueError if the lists have different lengths.
    """
    lengths = {len(getattr(message, one)) for one in lists}
    if len(lengths) != 1:
        told = ", ".join(f"{one}: {len(getattr(message, one))}" for one in lists)
        raise ValueError(f"{type(message).__name__}.{name}: lists of different lengths ({told})")
    return lengths.pop()


@functools.lru_cache(maxsize=256)
def _list_of(letter: str, length: int) -> struct.Struct:
    return struct.Struct(f">{length}{letter}")


def _check_length(length: int) -> None:
    if not 0 <= length <= MOST_ELEMENTS:
        raise ValueError(f"{length} elements")


def read_numbers(letter: str, length: int, data: Any, at: int) -> tuple[list, int]:
    """`length` numbers of one type, and the place after them."""
    _check_length(length)
    numbers = _list_of(letter, length)
    return list(numbers.unpack_from(data, at)), at + numbers.size


def write_numbers(letter: str, numbers: Sequence) -> bytes:
    return _list_of(letter, len(numbers)).pack(*numbers)


def read_text(data: Any, at: int) -> tuple[str, int]:
    """A text and the place after it. Bytes that are not UTF-8 become surrogates."""
    (length,) = _LENGTH.unpack_from(data, at)
    begin, end = at + 4, at + 4 + length
    if length < 1 or end > len(data):
        raise ValueError(f"a text of {length} bytes")
    return bytes(data[begin : end - 1]).decode("utf-8", "surrogateescape"), end


def write_text(text: str) -> bytes:
    encoded = text.encode("utf-8", "surrogateescape")
    return _LENGTH.pack(len(encoded) + 1) + encoded + b"\0"


def read_texts(length: int, data: Any, at: int) -> tuple[list[str], int]:
    _check_length(length)
    texts = []
    for _ in range(length):
        text, at = read_text(data, at)
        texts.append(text)
    return texts, at


def write_texts(texts: Sequence[str]) -> bytes:
    return b"".join(write_text(text) for text in texts)
