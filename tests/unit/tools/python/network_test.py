"""The datagrams of LCM, and the URLs of its networks."""

import random
import socket
import struct
import unittest
from unittest import mock

from fogline_lab import network
from fogline_lab.errors import BadInput, FoglineError

SENDER = ("127.0.0.1", 4711)


def fragments_of(channel: str, payload: bytes, number: int, size: int) -> list[bytes]:
    """A message in fragments of at most `size` bytes, as lcm_udpm.c sends them."""
    pieces = [payload[at : at + size] for at in range(0, len(payload), size)]
    datagrams, offset = [], 0
    for i, piece in enumerate(pieces):
        head = struct.pack(">IIIIHH", 0x4C433033, number, len(payload), offset, i, len(pieces))
        datagrams.append(head + (channel.encode() + b"\0" if i == 0 else b"") + piece)
        offset += len(piece)
    return datagrams


class FragmentsTest(unittest.TestCase):
    def setUp(self):
        self.heard = []
        self.fragments = network.Fragments()

    def take(self, datagram, sender=SENDER):
        return self.fragments.take(datagram, sender, lambda *heard: self.heard.append(heard))

    def test_a_small_message_is_one_datagram(self):
        self.assertTrue(self.take(struct.pack(">II", 0x4C433032, 3) + b"RADAR\0abc"))
        self.assertEqual(self.heard, [("RADAR", b"abc")])

    def test_fragments_make_a_message_in_any_order(self):
        payload = random.Random(1).randbytes(5000)
        datagrams = fragments_of("VIDEO", payload, 9, 700)
        random.Random(2).shuffle(datagrams)
        for i, datagram in enumerate(datagrams):
            self.assertEqual(self.heard, [], i)
            self.assertTrue(self.take(datagram))
        self.assertEqual(self.heard, [("VIDEO", payload)])

    def test_fragments_of_two_senders_are_kept_apart(self):
        one = fragments_of("A", b"one" * 100, 1, 200)
        two = fragments_of("B", b"two" * 100, 1, 200)
        for a, b in zip(one, two):
            self.take(a, ("127.0.0.1", 1))
            self.take(b, ("127.0.0.1", 2))
        self.assertEqual(self.heard, [("A", b"one" * 100), ("B", b"two" * 100)])

    def test_a_copy_of_a_fragment_replaces_no_other_one(self):
        datagrams = fragments_of("A", b"x" * 300, 1, 100)
        for datagram in (datagrams[0], datagrams[0], datagrams[1]):
            self.take(datagram)
        self.assertEqual(self.heard, [])
        self.take(datagrams[2])
        self.assertEqual(self.heard, [("A", b"x" * 300)])

    def test_messages_that_lost_a_fragment_take_no_more_memory_than_the_limit(self):
        for number in range(1000):
            self.take(fragments_of("A", b"x" * 300, number, 100)[0])
        self.assertLessEqual(len(self.fragments._partial), 64)

    def test_other_datagrams_are_refused(self):
        whole = fragments_of("A", b"x" * 300, 1, 100)
        wrong = [b"", b"LC02", b"LC02" + bytes(4) + b"no end", b"LC99" + bytes(20),
                 struct.pack(">IIIIHH", 0x4C433033, 1, 300, 0, 7, 3) + b"A\0x",
                 struct.pack(">IIIIHH", 0x4C433033, 1, 300, 290, 1, 3) + b"x" * 100,
                 struct.pack(">IIIIHH", 0x4C433033, 1, 1 << 31, 0, 0, 3) + b"A\0x"]
        for datagram in wrong:
            self.assertFalse(self.take(datagram), datagram)
        for datagram in whole:
            self.take(datagram)
        self.assertEqual(len(self.heard), 1)


class FloodTest(unittest.TestCase):
    def test_a_sender_that_never_pauses_does_not_keep_the_reader(self):
        class Flood:
            def recvfrom(self, _):
                return struct.pack(">II", 0x4C433032, 3) + b"RADAR\0abc", SENDER

        network_ = network.Multicast.__new__(network.Multicast)
        network_.socket, network_._fragments = Flood(), network.Fragments()
        heard = []
        self.assertEqual(network_.read(lambda *message: heard.append(message)), 0)
        self.assertGreater(len(heard), 100)


class RelayTest(unittest.TestCase):
    def test_a_relay_that_ends_at_once_leaves_no_open_socket(self):
        ours, its = socket.socketpair()
        its.close()
        with mock.patch.object(network.socket, "create_connection", return_value=ours):
            with self.assertRaisesRegex(FoglineError, "the relay at 127.0.0.1:7700 is lost: "):
                network.open_network("tcpq://127.0.0.1:7700")
        self.assertEqual(ours.fileno(), -1)


class UrlTest(unittest.TestCase):
    def test_missing_parts_are_those_of_lcm(self):
        self.assertEqual(network.address_of("udpm://"), ("udpm", "239.255.76.67", 7667, 0))
        self.assertEqual(network.address_of("udpm://239.1.2.3:99?ttl=1&recv_buf_size=5"),
                         ("udpm", "239.1.2.3", 99, 1))
        self.assertEqual(network.address_of("tcpq://"), ("tcpq", "127.0.0.1", 7700, 0))
        self.assertEqual(network.address_of("tcpq://lab1:80"), ("tcpq", "lab1", 80, 0))

    def test_what_is_no_network_is_refused_by_name(self):
        for url in ("", "lab1", "http://lab1", "udpm://lab1", "udpm://239.1.2.3:0",
                    "udpm://239.1.2.3:x", "udpm://239.1.2.3:70000", "udpm://239.1.2.3?ttl",
                    "tcpq://lab1:99999"):
            with self.assertRaises(BadInput) as caught:
                network.address_of(url)
            self.assertIn(f"{url}: not the URL of an LCM network", str(caught.exception))

    def test_an_announcement_leads_only_to_networks_of_this_machine(self):
        for url in ("udpm://239.255.76.67:7700?ttl=0", "udpm://239.255.76.67:7700?ttl=1",
                    "tcpq://127.0.0.1:7700"):
            self.assertTrue(network.may_be_followed(url), url)
        for url in ("udpm://239.255.76.67:7700?ttl=2", "udpm://192.168.0.1:7700?ttl=0",
                    "tcpq://lab1:7700", "tcpq://198.51.100.7:7700", "tcpq://0.0.0.0:7700",
                    "memq://", "nonsense"):
            self.assertFalse(network.may_be_followed(url), url)


if __name__ == "__main__":
    unittest.main()
