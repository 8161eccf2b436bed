"""Reads logs of real runs with the standard library alone, also logs with gaps."""

import os
import pathlib
import struct
import tempfile
import unittest

import fogline_lab as fl
from fogline_lab.program import call

STEPS = 40
PAPER = pathlib.Path(os.environ["SOURCES"], "scenario", "paper.json")


def events_of(path):
    """The bytes of each event of a log, and its channel and step."""
    data = pathlib.Path(path).read_bytes()
    at = 0
    while at < len(data):
        _, _, _, name, size = struct.unpack_from(">Iqqii", data, at)
        begin = at + 28 + name
        step = struct.unpack_from(">q", data, begin + 16)[0]
        yield data[at : begin + size], data[at + 28 : begin].decode(), step
        at = begin + size


class LogTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.log = f"{cls.folder.name}/run.lcm"
        cls.run_ = fl.run(PAPER, set={"/steps": STEPS}, transport="direct", log=cls.log)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def write(self, name, events):
        path = f"{self.folder.name}/{name}"
        pathlib.Path(path).write_bytes(b"".join(events))
        return path

    def test_has_a_message_of_each_channel_in_each_step(self):
        log = fl.read_log(self.log)
        for channel in fl.STEP_CHANNELS:
            messages = list(log.messages(channel))
            self.assertEqual([one.header.step for one in messages], list(range(STEPS)), channel)
            self.assertEqual({one.header.run_id for one in messages}, {log.run_id})
        self.assertTrue(list(log.messages("TRUTH"))[-1].last)
        self.assertEqual(log.torn, "")
        self.assertEqual(log.runs, [log.run_id])

    def test_tells_scenario_digest_measures_and_events_as_the_program_does(self):
        log = fl.read_log(self.log)
        self.assertEqual(log.scenario["steps"], STEPS)
        self.assertEqual(
            log.scenario_text, call("check", "--print", str(PAPER), "--set", f"/steps={STEPS}"))
        self.assertEqual(log.digest, self.run_.digest)
        self.assertEqual(log.metrics, self.run_.metrics)
        self.assertEqual(log.events[0]["event"], "activation of the automation")

    def test_a_lost_message_is_a_missing_one_and_nothing_else(self):
        kept = [event for event, channel, step in events_of(self.log)
                if not (channel == "RADAR" and step == 20)]
        log = fl.read_log(self.write("gap.lcm", kept))
        self.assertEqual([one.header.step for one in log.messages("RADAR")],
                         [step for step in range(STEPS) if step != 20])
        self.assertEqual(len(list(log.messages("LIDAR"))), STEPS)

    def test_a_log_with_a_gap_tells_its_measures_and_events_and_what_is_missing(self):
        kept = [event for event, channel, step in events_of(self.log)
                if not (channel == "HOST_COMMAND" and step == 20)]
        log = fl.read_log(self.write("gap.lcm", kept))
        with self.assertWarnsRegex(fl.IncompleteLog, "step 20 lacks HOST_COMMAND") as caught:
            measures = log.metrics
        self.assertEqual(caught.filename, __file__)
        self.assertIsNone(measures["human_time_s"])
        self.assertEqual(measures["min_follower_gap_m"], self.run_.metrics["min_follower_gap_m"])
        with self.assertWarns(fl.IncompleteLog):
            self.assertEqual(log.events[0]["event"], "activation of the automation")
        with self.assertRaisesRegex(fl.CheckFailed, "step 20 lacks HOST_COMMAND") as failure:
            log.digest
        self.assertIn('"complete": false', failure.exception.out)

    def test_a_log_that_begins_late_lacks_only_its_scenario(self):
        kept = [event for event, channel, step in events_of(self.log)
                if channel != "RUN" and step >= 10]
        log = fl.read_log(self.write("late.lcm", kept))
        self.assertEqual(len(list(log.messages("TRACK"))), STEPS - 10)
        with self.assertRaisesRegex(fl.LogError, r"late\.lcm: the log lacks the scenario of run"):
            log.scenario

    def test_a_log_of_two_runs_is_read_run_by_run(self):
        other = f"{self.folder.name}/other.lcm"
        second_run = fl.run(PAPER, set={"/steps": 15}, transport="direct", log=other)
        both = self.write("both.lcm", [pathlib.Path(self.log).read_bytes(),
                                       pathlib.Path(other).read_bytes()])
        first = fl.read_log(both)
        self.assertEqual(len(first.runs), 2)
        self.assertEqual(len(list(first.messages("TRACK"))), STEPS)
        second = fl.read_log(both, run=first.runs[1])
        self.assertEqual(len(list(second.messages("TRACK"))), 15)
        self.assertEqual(second.scenario["steps"], 15)
        alone = fl.read_log(other)
        self.assertEqual(second.metrics, second_run.metrics)
        self.assertEqual(second.events, alone.events)
        self.assertNotEqual(second.metrics, first.metrics)
        with self.assertRaisesRegex(fl.LogError, "no run 5; its runs: "):
            fl.read_log(both, run=5)

    def test_a_torn_end_is_named_and_left_out(self):
        whole = pathlib.Path(self.log).read_bytes()
        log = fl.read_log(self.write("torn.lcm", [whole, whole[:50]]))
        self.assertEqual(len(list(log.messages("TRACK"))), STEPS)
        self.assertEqual(log.torn, "50 bytes at the end are no whole event and were ignored")

    def test_a_message_that_is_too_short_hides_no_other_one(self):
        whole = pathlib.Path(self.log).read_bytes()
        short = struct.pack(">Iqqii", 0xEDA1DA01, 0, 0, 5, 3) + b"TRACK" + b"abc"
        other = struct.pack(">Iqqii", 0xEDA1DA01, 0, 0, 3, 3) + b"CAN" + b"abc"
        log = fl.read_log(self.write("short.lcm", [short, whole, other]))
        self.assertEqual(len(list(log.messages("TRACK"))), STEPS)
        self.assertEqual(log.torn, "")
        self.assertNotIn("CAN", log.channels)

    def test_an_empty_log_has_no_channels(self):
        self.assertEqual(fl.read_log(self.write("empty.lcm", [])).channels, [])

    def test_refuses_what_it_cannot_read_by_name(self):
        with self.assertRaisesRegex(fl.LogError, r"nothing\.lcm: No such file or directory"):
            fl.read_log("nothing.lcm")
        with self.assertRaisesRegex(fl.LogError, r"paper\.json: not an LCM event log"):
            fl.read_log(PAPER)
        log = fl.read_log(self.log)
        with self.assertRaisesRegex(fl.LogError, "no channel SONAR; its channels: RUN, .*TRUTH"):
            list(log.messages("SONAR"))
        with self.assertRaisesRegex(AttributeError, "no channel SONAR; its channels: RUN, .*TRUTH"):
            log.SONAR

    def test_messages_of_an_unknown_type_are_refused_by_channel(self):
        altered = bytearray(pathlib.Path(self.log).read_bytes())
        in_graph = altered.index(fl.lidar_t.FINGERPRINT)
        altered[altered.index(fl.lidar_t.FINGERPRINT, in_graph + 8)] ^= 1  # the first message
        log = fl.read_log(self.write("altered.lcm", [bytes(altered)]))
        with self.assertRaisesRegex(fl.LogError, "LIDAR: unknown message type"):
            list(log.messages("LIDAR"))
        self.assertEqual(len(list(log.messages("RADAR"))), STEPS)

    def test_needs_no_package_but_those_of_python(self):
        script = (f"import fogline_lab as fl, sys\n"
                  f"list(fl.read_log({self.log!r}).messages('TRACK'))\n"
                  f"sys.exit(bool({{'pandas', 'numpy'}} & sys.modules.keys()))")
        self.assertEqual(os.spawnl(os.P_WAIT, "/usr/bin/python3", "python3", "-B", "-c", script), 0)


if __name__ == "__main__":
    unittest.main()
