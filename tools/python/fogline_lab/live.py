"""The messages of a running system. Needs only the standard library."""

from __future__ import annotations

import select
import socket
import time
from collections import Counter, deque
from typing import Iterable, Iterator, NamedTuple

from fogline_lab import network
from fogline_lab.codec import Message
from fogline_lab.errors import FoglineError
from fogline_lab.messages import BY_FINGERPRINT, beacon_t

BEACON_CHANNEL = "FOGLINE_BEACON"
# LCM itself sends messages on this channel.
_SELF_TEST = "LCM_SELF_TEST"
# A run announces itself with a beacon every 0.5 s. A run counts as ended if no beacon has come for
# this time (services/runtime/discovery/announcements.h).
_GONE_S = 3.0
# Longest time between two checks whether a run has ended.
_LOOK_EVERY_S = 0.25


class Heard(NamedTuple):
    """A message, and the channel on which it came."""

    channel: str
    message: Message


class Announced(NamedTuple):
    """A run that announces itself on this machine."""

    run_id: int
    url: str
    scenario: str
    began_us: int


class Live:
    """Listens to a network, and yields its messages:

        for channel, message in fl.Live():
            if channel == "TRUTH":
                print(message.header.step, message.host_gap_m)

    url: an LCM network, udpm:// or tcpq://. Without it, Live follows the newest run that is
        announced on this machine, as `fogline top` does. While no run is announced, Live listens
        to $LCM_DEFAULT_URL, or to LCM's default address if this variable is not set.
    channels: yields only messages on these channels.
    timeout_s: the iteration ends when no message has come for this time; None: it never ends.

    Live publishes no messages. So it does not ask for lost messages, and yields only those that
    reach this machine. Messages that cannot be decoded are counted by their channel in `refused`.

    Raises BadInput for a bad URL, FoglineError if the network cannot be joined or is lost.
    """

    def __init__(self, url: str | None = None, channels: Iterable[str] | None = None,
                 timeout_s: float | None = None) -> None:
        self.refused: Counter[str] = Counter()
        self.run: Announced | None = None  # the run that is followed
        self._follows = url is None
        self._url = network.network_url(url)
        self._wanted = None if channels is None else frozenset(channels)
        self._timeout_s = timeout_s
        self._heard: deque[Heard] = deque()
        self._runs: dict[int, tuple[Announced, float]] = {}  # with the time of the last beacon
        self._base: network.Multicast | network.Relay | None = network.open_network(self._url)
        self._followed: network.Multicast | network.Relay | None = None

    @property
    def url(self) -> str:
        """The URL of the network to which Live listens at present."""
        return self.run.url if self.run and self._followed else self._url

    def __enter__(self) -> Live:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Leaves the networks. The iteration then ends."""
        for one in (self._base, self._followed):
            if one is not None:
                one.close()
        self._base = self._followed = None

    def __iter__(self) -> Iterator[Heard]:
        last = time.monotonic()
        lost: FoglineError | None = None
        while True:
            while self._heard:
                yield self._heard.popleft()
                last = time.monotonic()  # the time that the caller needs does not count
            if self._base is None:
                return
            if lost is not None:
                raise lost
            left = None if self._timeout_s is None else self._timeout_s + last - time.monotonic()
            try:
                self._wait(left if left is None else max(0.0, left))
            except FoglineError as error:  # the messages that came before are yielded first
                lost = error
                continue
            # The given time may have passed while this process got no processor time. _wait() has
            # then taken the messages that came in this time, and the iteration goes on with them.
            if left is not None and left <= 0 and not self._heard:
                return

    # ----------------------------------------------------------------------------------------------

    def _wait(self, limit_s: float | None) -> None:
        """Waits for messages, and stores them."""
        wait_s = _LOOK_EVERY_S if self._follows else limit_s
        if limit_s is not None and wait_s is not None:
            wait_s = min(wait_s, limit_s)
        networks = [one for one in (self._base, self._followed) if one is not None]
        ready, _, _ = select.select([one.socket for one in networks], [], [], wait_s)
        if self._base is not None and self._base.socket in ready:
            self.refused["not LCM"] += self._base.read(self._take_from_base)
        if self._followed is not None and self._followed.socket in ready:
            try:
                self.refused["not LCM"] += self._followed.read(self._take)
            except FoglineError:  # the relay of the run has ended with the run
                self._leave()
        if self._follows:
            self._follow(time.monotonic())
        self.refused += Counter()  # removes counts of zero

    def _take_from_base(self, channel: str, payload: bytes) -> None:
        if channel == BEACON_CHANNEL and self._follows:
            self._take_beacon(payload)
        elif self._followed is None:
            self._take(channel, payload)

    def _take(self, channel: str, payload: bytes) -> None:
        of_others = channel in (BEACON_CHANNEL, _SELF_TEST)
        if of_others or (self._wanted is not None and channel not in self._wanted):
            return
        kind = BY_FINGERPRINT.get(payload[:8])
        try:
            if kind is None:
                raise ValueError
            self._heard.append(Heard(channel, kind.decode(payload)))
        except ValueError:
            self.refused[channel] += 1

    def _take_beacon(self, payload: bytes) -> None:
        """Stores an announced run. A beacon does not leave its machine, so a beacon of another host
        is refused."""
        try:
            beacon = beacon_t.decode(payload)
        except ValueError:
            self.refused[BEACON_CHANNEL] += 1
            return
        sound = beacon.header.run_id > 0 and beacon.host == socket.gethostname()
        if not sound or not network.may_be_followed(beacon.url):
            self.refused[BEACON_CHANNEL] += 1
        elif beacon.over:
            self._runs.pop(beacon.header.run_id, None)
        else:
            run = Announced(beacon.header.run_id, beacon.url, beacon.scenario, beacon.began_us)
            self._runs[run.run_id] = (run, time.monotonic())

    def _follow(self, now: float) -> None:
        """Joins the network of the newest run, and leaves the network of a run that is over."""
        self._runs = {
            run.run_id: (run, heard) for run, heard in self._runs.values() if now - heard < _GONE_S
        }
        newest = max((run for run, _ in self._runs.values()), key=lambda run: run.began_us,
                     default=None)
        if newest == self.run:
            return
        if self._followed is not None:
            # Takes the messages that the run sent before it announced its end.
            try:
                self._followed.read(self._take)
            except FoglineError:
                pass
        self._leave()
        if newest is None:
            return
        self.run = newest
        try:
            self._followed = network.open_network(newest.url)
        except FoglineError:
            self.refused[BEACON_CHANNEL] += 1

    def _leave(self) -> None:
        if self._followed is not None:
            self._followed.close()
        self._followed = None
        self.run = None
