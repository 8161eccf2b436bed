"""Live yields what a network sends."""

import socket
import struct
import time
import unittest

import fogline_lab as fl

GROUP = "239.255.76.68"


class LiveTest(unittest.TestCase):
    def setUp(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF,
                               socket.inet_aton("127.0.0.1"))
        self.number = 0

    def tearDown(self):
        self.sender.close()

    def send(self, range_m):
        self.number += 1
        head = struct.pack(">II", 0x4C433032, self.number) + b"LIDAR\0"
        message = fl.lidar_t(valid=True, range_m=range_m).encode()
        self.sender.sendto(head + message, (GROUP, self.port))

    def test_the_time_that_the_caller_takes_is_no_silence(self):
        timeout_s = 0.1
        heard = []
        with fl.Live(f"udpm://{GROUP}:{self.port}?ttl=0", timeout_s=timeout_s) as live:
            self.send(1)
            for channel, message in live:
                heard.append((channel, message.range_m))
                if len(heard) == 3:
                    break
                self.send(len(heard) + 1)
                # The caller takes longer than timeout_s. This time must not count as silence.
                time.sleep(2 * timeout_s)
        self.assertEqual(heard, [("LIDAR", 1), ("LIDAR", 2), ("LIDAR", 3)])

    def live_after_the_end_of_a_relay(self):
        """A listener to a relay that has sent two messages, and has ended. @return the listener,
        and the port of the relay"""
        with socket.create_server(("127.0.0.1", 0)) as server:
            port = server.getsockname()[1]
            live = fl.Live(f"tcpq://127.0.0.1:{port}", timeout_s=10)
            relay, _ = server.accept()
            with relay:
                # The relay reads the subscription: magic, version, kind, size of the pattern,
                # pattern. If it ended the connection with unread bytes, the kernel would discard
                # the messages that it sends below.
                relay.recv(18, socket.MSG_WAITALL)
                relay.sendall(struct.pack(">II", 0x287617FA, 0x0100))
                for range_m in (1, 2):
                    message = fl.lidar_t(valid=True, range_m=range_m).encode()
                    relay.sendall(struct.pack(">II", 1, 5) + b"LIDAR" +
                                  struct.pack(">I", len(message)) + message)
        return live, port

    def test_yields_what_came_before_the_end_of_the_relay(self):
        live, port = self.live_after_the_end_of_a_relay()
        heard = []
        with live, self.assertRaisesRegex(fl.FoglineError, f"127.0.0.1:{port} has ended"):
            for channel, message in live:
                heard.append((channel, message.range_m))
        self.assertEqual(heard, [("LIDAR", 1), ("LIDAR", 2)])

    def test_ends_when_it_is_closed_also_after_the_end_of_the_relay(self):
        live, _ = self.live_after_the_end_of_a_relay()
        heard = []
        for _, message in live:
            heard.append(message.range_m)
            live.close()
        self.assertEqual(heard, [1, 2])


if __name__ == "__main__":
    unittest.main()
