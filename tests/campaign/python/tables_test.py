"""The tables of a log have every number of `fogline export`, even if the log has gaps. The tables
are read fast enough. `fl.table` and `fl.sweep` have the numbers of the program."""

import json
import os
import pathlib
import subprocess
import struct
import tempfile
import time
import unittest

import pandas

import fogline_lab as fl
from fogline_lab.program import call, fogline_program

SCENARIOS = pathlib.Path(os.environ["SOURCES"], "scenario")
PAPER = SCENARIOS / "paper.json"


class TablesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.path = cls.folder / "run.lcm"
        # With two following cars, some lists have more than one element.
        cls.changes = {"/followers/count": 2}
        fl.run(SCENARIOS / "dense_fog.json", set={**cls.changes, "/steps": 300},
               transport="direct", log=cls.path)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def without(self, name, drop):
        """A copy of the log without the events for which drop(channel, step) is true."""
        data, kept, at = self.path.read_bytes(), [], 0
        while at < len(data):
            _, _, _, channel, size = struct.unpack_from(">Iqqii", data, at)
            begin = at + 28 + channel
            step = struct.unpack_from(">q", data, begin + 16)[0]
            if not drop(data[at + 28 : begin].decode(), step):
                kept.append(data[at : begin + size])
            at = begin + size
        path = self.folder / name
        path.write_bytes(b"".join(kept))
        return fl.read_log(path)

    def test_each_channel_has_the_numbers_of_the_csv_export(self):
        call("export", str(self.path), "--out", str(self.folder / "csv"))
        log = fl.read_log(self.path)
        self.assertTrue(any(name.endswith(".1") for name in log.FOLLOWER_COMMAND.columns))
        for channel in fl.STEP_CHANNELS:
            csv = pandas.read_csv(self.folder / "csv" / f"{channel}.csv",
                                  float_precision="round_trip").set_index("header.step")
            table = getattr(log, channel)
            self.assertEqual(list(table.index), list(csv.index), channel)
            self.assertEqual(list(table.columns),
                             ["time_s", *csv.columns.drop(["header.run_id", "header.utime"])])
            for name in table.columns.drop("time_s"):
                self.assertTrue((table[name].astype(float) == csv[name]).all(), (channel, name))
            self.assertTrue((table["time_s"] == csv["header.utime"] / 1e6).all())

    def test_the_covariance_has_nine_columns(self):
        track = fl.read_log(self.path).TRACK
        names = [name for name in track.columns if name.startswith("covariance.")]
        self.assertEqual(names, [f"covariance.{i}" for i in range(9)])
        self.assertTrue((track["covariance.1"] == track["covariance.3"]).all())

    def test_a_missing_step_has_no_row(self):
        log = self.without("gap.lcm", lambda channel, step: channel == "RADAR" and 20 <= step < 25)
        self.assertEqual(len(log.RADAR), 295)
        self.assertEqual(len(log.LIDAR), 300)
        difference = log.RADAR["range_m"] - log.LIDAR["range_m"]
        self.assertEqual(list(difference.index[difference.isna()]), [20, 21, 22, 23, 24])

    def test_a_log_without_a_beginning_has_the_rest(self):
        log = self.without("late.lcm", lambda channel, step: channel == "RUN" or step < 100)
        self.assertEqual(list(log.TRACK.index), list(range(100, 300)))

    def test_runs_with_different_numbers_of_cars_are_kept_apart(self):
        other, both = self.folder / "other.lcm", self.folder / "both.lcm"
        fl.run(PAPER, set={"/steps": 50}, transport="direct", log=other)
        both.write_bytes(self.path.read_bytes() + other.read_bytes())
        first = fl.read_log(both)
        second = fl.read_log(both, run=first.runs[1])
        self.assertEqual((len(first.TRUTH), len(second.TRUTH)), (300, 50))
        self.assertTrue(first.TRUTH["follower_gap_m.1"].notna().all())
        self.assertTrue(second.TRUTH.notna().all(axis=None))
        self.assertNotIn("follower_gap_m.1", second.TRUTH)

    def test_channels_with_texts_are_tables_too(self):
        run = fl.read_log(self.path).RUN
        self.assertEqual("".join(run["text"].iloc[: int(run["num_parts"].iloc[0])]),
                         fl.read_log(self.path).scenario_text)

    def test_a_million_messages_are_read_within_3_s(self):
        path = self.folder / "million.lcm"
        fl.run(PAPER, set={"/steps": 111_200}, transport="direct", log=path)
        began = time.process_time()
        log = fl.read_log(path)
        rows = sum(len(getattr(log, channel)) for channel in fl.STEP_CHANNELS)
        tables_s = time.process_time() - began
        began = time.process_time()
        log = fl.read_log(path)
        objects = sum(1 for channel in fl.STEP_CHANNELS for _ in log.messages(channel))
        objects_s = time.process_time() - began
        print(f"{rows} messages: {tables_s:.2f} s as tables, {objects_s:.2f} s as objects")
        self.assertGreater(rows, 1_000_000)
        self.assertEqual(rows, objects)
        # The test measures processor time, because other programs may run at the same time.
        self.assertLess(tables_s, 3)
        self.assertLess(objects_s, 3)


class VerbsTest(unittest.TestCase):
    def test_a_table_is_that_of_the_program(self):
        words = ["table", str(PAPER), "--thresholds", "0.5,0.8", "--seeds", "1:5", "--json"]
        printed = json.loads(subprocess.run([fogline_program(), *words], capture_output=True,
                                            check=True).stdout)
        table = fl.table(PAPER, thresholds="0.5,0.8", seeds="1:5")
        self.assertEqual(list(table.index), [0.5, 0.8])
        self.assertEqual(list(table["si_pct"]), [row["si_pct"] for row in printed["rows"]])

    def test_a_sweep_has_a_row_for_each_value_and_seed(self):
        grid = {"/arbitrator/threshold": [0.5, 0.6], "/fog/bias_m": "0.2:0.3:2"}
        rows = fl.sweep(PAPER, grid=grid, seeds=range(1, 4), set={"/steps": 250})
        self.assertEqual(len(rows), 2 * 2 * 3)
        self.assertEqual(sorted(set(rows["seed"])), [1, 2, 3])
        with self.assertRaisesRegex(fl.BadInput, "/arbitrator/treshold"):
            fl.sweep(PAPER, grid={"/arbitrator/treshold": [0.5]})


if __name__ == "__main__":
    unittest.main()
