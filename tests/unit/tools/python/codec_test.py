"""The messages of fogline_lab are those of LCM's own types for Python (lcm-gen -p)."""

import os
import random
import sys
import unittest

from fogline_lab import messages
from fogline_lab.codec import Message

sys.path.insert(0, os.environ["LCM_TYPES"])
import fogline  # noqa: E402 - made by lcm-gen

random.seed(17)
INTEGERS = {"int8_t": 7, "int16_t": 15, "int32_t": 31, "int64_t": 63}
LONGEST = 4


def random_value(kind):
    if kind == "boolean":
        return random.random() < 0.5
    if kind == "string":
        return "".join(random.choices("aZ0 ö字", k=random.randrange(9)))
    if kind in INTEGERS:
        return random.randrange(-(2 ** INTEGERS[kind]), 2 ** INTEGERS[kind])
    return random.uniform(-1e9, 1e9)


def random_message(kind: type[Message]) -> Message:
    """A message with random values in all fields. All lists of one count have one length."""
    counts = {dim: random.randrange(LONGEST) for field in kind.FIELDS for dim in field.dims
              if isinstance(dim, str)}
    message = kind()
    for field in kind.FIELDS:
        if field.name in counts:
            value = counts[field.name]
        elif field.type == "header_t":
            value = random_message(messages.header_t)
        else:
            value = None
            shape = [counts.get(dim, dim) for dim in field.dims]
            if not shape:
                value = random_value(field.type)
            elif len(shape) == 1:
                value = [random_value(field.type) for _ in range(shape[0])]
            else:
                value = [[random_value(field.type) for _ in range(shape[1])]
                         for _ in range(shape[0])]
        setattr(message, field.name, value)
    return message


def as_lcm_has_it(message: Message):
    other = getattr(fogline, type(message).__name__)()
    for field in message.FIELDS:
        value = getattr(message, field.name)
        setattr(other, field.name, as_lcm_has_it(value) if isinstance(value, Message) else value)
    return other


class CodecTest(unittest.TestCase):
    def test_every_type_has_the_bytes_of_lcms_own_type(self):
        self.assertGreaterEqual(len(messages.TYPES), 17)
        for kind in messages.TYPES:
            for _ in range(50):
                message = random_message(kind)
                theirs = as_lcm_has_it(message).encode()
                self.assertEqual(message.encode(), theirs, kind)
                self.assertEqual(kind.decode(theirs), message)

    def test_a_signature_after_a_message_is_ignored(self):
        message = random_message(messages.track_t)
        signed = message.encode() + b"FLS1" + bytes(20)
        self.assertEqual(messages.track_t.decode(signed), message)

    def test_bytes_that_are_no_message_are_refused(self):
        for kind in messages.TYPES:
            whole = random_message(kind).encode()
            for size in range(len(whole)):
                with self.assertRaises(ValueError):
                    kind.decode(whole[:size])
            for after in (b"\0", b"FLS1", bytes(24)):
                with self.assertRaises(ValueError):
                    kind.decode(whole + after)
        with self.assertRaisesRegex(ValueError, "ego_t: the bytes are a message of another type"):
            messages.ego_t.decode(messages.radar_t().encode())

    def test_random_bytes_cause_no_other_error(self):
        for kind in messages.TYPES:
            for _ in range(200):
                try:
                    kind.decode(kind.FINGERPRINT + random.randbytes(random.randrange(120)))
                except ValueError:
                    pass

    def test_a_value_that_the_type_cannot_have_is_named(self):
        cases = {
            "track_t.state: [1, 2] is no double[3]": messages.track_t(state=[1, 2]),
            "radar_t.range_m: 'far' is no double": messages.radar_t(range_m="far"),
            "arbitration_t.mode: 200 is no int8_t": messages.arbitration_t(mode=200),
            "run_t.text: 5 is no string": messages.run_t(text=5),
            "ego_t.header: None is no header_t": messages.ego_t(header=None),
        }
        for text, message in cases.items():
            with self.assertRaises(ValueError) as caught:
                message.encode()
            self.assertEqual(str(caught.exception), text)

    def test_a_field_that_counts_follows_its_lists(self):
        command = messages.follower_command_t(acceleration_mps2=[1.0, 2.0],
                                              safe_distance_m=[3.0, 4.0])
        self.assertEqual(messages.follower_command_t.decode(command.encode()).num_followers, 2)
        command.safe_distance_m.pop()
        with self.assertRaisesRegex(ValueError, "lists of different lengths"):
            command.encode()

if __name__ == "__main__":
    unittest.main()
