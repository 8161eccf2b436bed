"""Receives the messages on LCM networks, by UDP multicast (udpm) or from a relay (tcpq).

Only the standard library is needed. LCM's own library for Python is not used, because Debian does
not have it. Sources: lcm_udpm.c, lcm_tcpq.c and TCPService.java of LCM 1.3.1.
"""

from __future__ import annotations

import os
import socket
import struct
from typing import Callable, NamedTuple

from fogline_lab.errors import BadInput, FoglineError

DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0"
_DEFAULT_GROUP, _DEFAULT_PORT = "239.255.76.67", 7667
_DEFAULT_RELAY_PORT = 7700

# A datagram has these parts: a mark, the number of the message, the channel, a zero byte, the
# payload. A large message comes in fragments. A fragment has these parts: a mark, the number of the
# message, the size of the whole payload, the offset of this part of the payload, the number of the
# fragment, the number of all fragments, this part of the payload. The first fragment also has the
# channel and a zero byte before the payload.
_WHOLE, _FRAGMENT = 0x4C433032, 0x4C433033
_WHOLE_HEAD, _FRAGMENT_HEAD = struct.Struct(">II"), struct.Struct(">IIIIHH")
_DATAGRAM_BYTES = 1 << 16
# Limits for messages that wait for fragments: number of messages, and bytes of one message.
_MOST_PARTIAL, _MOST_BYTES = 64, 4 << 20
# A call of read() returns after this many datagrams or pieces, even if more are waiting.
_MOST_AT_ONCE = 1000
# Size of the kernel's buffer for datagrams, in bytes (net.core.rmem_max limits it).
_RECEIVE_BYTES = 2 << 20

_RELAY_MAGIC, _CLIENT_MAGIC, _RELAY_VERSION = 0x287617FA, 0x287617FB, 0x0100
_PUBLISH, _SUBSCRIBE = 1, 2
_CONNECT_S = 5.0

IP_MULTICAST_ALL = 49  # linux/in.h; the module socket does not name it


class Address(NamedTuple):
    """The network of a URL: its kind (udpm or tcpq), its host or group, and its port."""

    kind: str
    host: str
    port: int
    ttl: int = 0


def network_url(url: str | None) -> str:
    """The URL of a network: the given one, else $LCM_DEFAULT_URL, else LCM's default."""
    return url or os.environ.get("LCM_DEFAULT_URL") or DEFAULT_URL


def address_of(url: str) -> Address:
    """The network of a URL. Raises BadInput if the URL is not a valid udpm:// or tcpq:// URL."""
    kind, found, rest = url.partition("://")
    place, _, options = rest.partition("?")
    host, _, port = place.partition(":")
    try:
        given = dict(option.split("=", 1) for option in options.split("&") if option)
        if not found or kind not in ("udpm", "tcpq"):
            raise ValueError
        number = int(port or (_DEFAULT_RELAY_PORT if kind == "tcpq" else _DEFAULT_PORT))
        if not 0 < number < 1 << 16:
            raise ValueError
        if kind == "tcpq":
            return Address(kind, host or "127.0.0.1", number)
        socket.inet_pton(socket.AF_INET, host or _DEFAULT_GROUP)
        return Address(kind, host or _DEFAULT_GROUP, number, int(given.get("ttl", 0)))
    except (ValueError, OSError):
        raise BadInput(
            f"{url}: not the URL of an LCM network, such as {DEFAULT_URL} or tcpq://host:7700",
            [], 2,
        ) from None


# A network calls this function with the channel and the payload of each message.
Receiver = Callable[[str, bytes], None]


class Fragments:
    """Assembles messages from the datagrams of LCM."""

    def __init__(self) -> None:
        self._partial: dict[tuple, tuple[str, bytearray, set[int], int]] = {}

    def take(self, datagram: bytes, sender: tuple, receiver: Receiver) -> bool:
        """Calls the receiver if a message is complete. @return False if the datagram is not LCM's.
        """
        try:
            mark, number = _WHOLE_HEAD.unpack_from(datagram)
            if mark == _WHOLE:
                end = datagram.index(b"\0", _WHOLE_HEAD.size)
                receiver(datagram[_WHOLE_HEAD.size : end].decode(), datagram[end + 1 :])
                return True
            if mark == _FRAGMENT:
                return self._take_fragment(datagram, (sender, number), receiver)
        except (struct.error, ValueError):  # too short, no 0, or no UTF-8
            pass
        return False

    def _take_fragment(self, datagram: bytes, key: tuple, receiver: Receiver) -> bool:
        _, _, size, offset, part, parts = _FRAGMENT_HEAD.unpack_from(datagram)
        body = datagram[_FRAGMENT_HEAD.size :]
        if size > _MOST_BYTES or part >= parts:
            return False
        channel, message, have, wanted = self._partial.pop(key, ("", bytearray(size), set(), parts))
        if part == 0:
            end = body.index(b"\0")
            channel, body = body[:end].decode(), body[end + 1 :]
        if len(message) != size or wanted != parts or offset + len(body) > size:
            return False
        message[offset : offset + len(body)] = body
        have.add(part)
        if len(have) == parts:
            receiver(channel, bytes(message))
        else:
            if len(self._partial) >= _MOST_PARTIAL:
                self._partial.pop(next(iter(self._partial)))  # the oldest one
            self._partial[key] = (channel, message, have, parts)
        return True


class Multicast:
    """Listens to a multicast group. Sends nothing."""

    def __init__(self, address: Address) -> None:
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._fragments = Fragments()
        try:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _RECEIVE_BYTES)
            self.socket.setsockopt(socket.IPPROTO_IP, IP_MULTICAST_ALL, 0)
            self.socket.bind((address.host, address.port))
            self._join(address.host)
            self.socket.setblocking(False)
        except OSError as error:
            self.socket.close()
            raise FoglineError(
                f"cannot listen to {address.host}:{address.port}: {error.strerror}"
            ) from None

    def _join(self, group: str) -> None:
        """Joins the group on loopback, where the traffic of this machine is, and on the interface
        of the route to the group. One of the two is enough. Raises OSError if both fail."""
        failures = []
        for interface in ("127.0.0.1", "0.0.0.0"):
            membership = socket.inet_aton(group) + socket.inet_aton(interface)
            try:
                self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
            except OSError as error:
                failures.append(error)
        # If the route leads over loopback, the second call fails: the group is joined already.
        if len(failures) == 2:
            raise failures[0]

    def read(self, receiver: Receiver) -> int:
        """Calls the receiver with each message. @return the number of datagrams that are not LCM's
        """
        strange = 0
        for _ in range(_MOST_AT_ONCE):
            try:
                datagram, sender = self.socket.recvfrom(_DATAGRAM_BYTES)
            except BlockingIOError:
                break
            strange += not self._fragments.take(datagram, sender, receiver)
        return strange

    def close(self) -> None:
        self.socket.close()


class Relay:
    """Listens to all channels of a relay. Sends only the subscription."""

    def __init__(self, address: Address) -> None:
        where = f"{address.host}:{address.port}"
        try:
            self.socket = socket.create_connection((address.host, address.port), _CONNECT_S)
        except OSError as error:
            raise FoglineError(f"no relay at {where}: {error.strerror or error}") from None
        pattern = b".*"
        try:
            self.socket.sendall(struct.pack(">IIII", _CLIENT_MAGIC, _RELAY_VERSION, _SUBSCRIBE,
                                            len(pattern)) + pattern)
            self.socket.setblocking(False)
        except OSError as error:
            self.socket.close()
            raise FoglineError(f"the relay at {where} is lost: {error.strerror or error}") from None
        self._where = where
        self._received = bytearray()
        self._greeted = False

    def read(self, receiver: Receiver) -> int:
        """Calls the receiver with each message. @return 0. If the relay has ended, raises
        FoglineError after all messages that came before its end."""
        end = self._receive()
        while self._take(receiver):
            pass
        if end is not None:
            raise FoglineError(f"the relay at {self._where} {end}")
        return 0

    def _receive(self) -> str | None:
        """Stores the bytes that have come. @return why no more bytes will come; None if more may
        come"""
        for _ in range(_MOST_AT_ONCE):
            try:
                piece = self.socket.recv(1 << 16)
            except BlockingIOError:
                break
            except OSError as error:
                return f"is lost: {error.strerror}"
            if not piece:
                return "has ended"
            self._received += piece
        return None

    def _take(self, receiver: Receiver) -> bool:
        """If the first message is complete, calls the receiver with it.

        @return whether the first message was complete"""
        if not self._greeted:
            if len(self._received) < 8:
                return False
            magic, _ = struct.unpack_from(">II", self._received)
            self._greeted = magic == _RELAY_MAGIC
            if not self._greeted:
                raise FoglineError(f"{self._where} is no relay of LCM")
            del self._received[:8]
        if len(self._received) < 8:
            return False
        kind, name_bytes = struct.unpack_from(">II", self._received)
        if kind != _PUBLISH or name_bytes > _MOST_BYTES:
            raise FoglineError(f"the relay at {self._where} sends something else than messages")
        begin = 8 + name_bytes + 4
        if len(self._received) < begin:
            return False
        (payload_bytes,) = struct.unpack_from(">I", self._received, begin - 4)
        if payload_bytes > _MOST_BYTES:
            raise FoglineError(
                f"the relay at {self._where} sends a message of {payload_bytes} bytes"
            )
        if len(self._received) < begin + payload_bytes:
            return False
        name = bytes(self._received[8 : begin - 4]).decode("utf-8", "replace")
        payload = bytes(self._received[begin : begin + payload_bytes])
        del self._received[: begin + payload_bytes]
        receiver(name, payload)
        return True

    def close(self) -> None:
        self.socket.close()


def open_network(url: str) -> Multicast | Relay:
    """Joins a network to listen. Raises BadInput for a bad URL, FoglineError if joining fails."""
    address = address_of(url)
    return Multicast(address) if address.kind == "udpm" else Relay(address)


def may_be_followed(url: str) -> bool:
    """Whether a program may join a network that it knows only from a message. It may join a
    multicast group whose traffic does not pass the next router, and a relay of this machine."""
    try:
        address = address_of(url)
        packed = socket.inet_pton(socket.AF_INET, address.host)
    except (BadInput, OSError):
        return False
    if address.kind == "udpm":
        return packed[0] >> 4 == 14 and address.ttl <= 1  # 224.0.0.0/4
    if packed[0] == 127:
        return True
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind((address.host, 0))  # succeeds only for an address of this machine
        except OSError:
            return False
    return packed != b"\0\0\0\0"
