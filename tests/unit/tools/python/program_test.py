"""Runs the program, and turns its errors into exceptions."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import fogline_lab as fl
from fogline_lab import program

PAPER = pathlib.Path(os.environ["SOURCES"], "scenario", "paper.json")
DIGEST = "90ca471057e464abfe9d7ecdf77847b16f1ad324c53bc77693fede234c4e8fd6"


class ProgramTest(unittest.TestCase):
    def test_a_run_has_the_digest_of_the_program(self):
        run = fl.run(PAPER, transport="direct")
        self.assertEqual(run.digest, DIGEST)
        self.assertEqual(run.metrics["transfers"], 2)
        with self.assertRaisesRegex(fl.FoglineError, "the run has no log"):
            run.log

    def test_set_changes_fields_of_all_kinds(self):
        run = fl.run(PAPER, set={"/arbitrator/threshold": 0.8, "/arbitrator/policy": "traded",
                                 "/human/misjudges": False, "/steps": 30}, transport="direct")
        self.assertEqual(run.result["steps"], 30)

    def test_options_are_those_of_the_command_line(self):
        words = program.options_of({"lcm_url": "udpm://", "seed": 7, "realtime": True, "view": False,
                                    "log": None, "external": ["driver", "acc"],
                                    "key": pathlib.Path("lab.key")})
        self.assertEqual(words, ["--lcm-url", "udpm://", "--seed", "7", "--realtime", "--external",
                                 "driver", "--external", "acc", "--key", "lab.key"])

    def test_an_error_has_the_text_of_the_program_and_its_code(self):
        words = ["run", str(PAPER), "--set", "/arbitrator/treshold=2", "--json"]
        shell = subprocess.run([program.fogline_program(), *words], capture_output=True, text=True)
        for progress in (False, True):
            with self.assertRaises(fl.BadInput) as caught:
                fl.run(PAPER, set={"/arbitrator/treshold": 2}, progress=progress)
            self.assertEqual(str(caught.exception), shell.stderr.strip())
            self.assertEqual(caught.exception.code, 2)
            self.assertIsInstance(caught.exception, ValueError)

    def test_a_program_that_cannot_be_started_leaves_no_open_terminal(self):
        def count():
            return len(os.listdir("/proc/self/fd"))

        before = count()
        with self.assertRaises(FileNotFoundError):
            program._call_with_terminal(["/none/fogline"], True)
        self.assertEqual(count(), before)

    def test_progress_tells_how_much_is_done(self):
        told = []
        # The program shows a progress bar after 2 s. This run takes 2.5 s, so it has a progress
        # bar.
        with tempfile.TemporaryDirectory() as folder:
            fl.run(PAPER, set={"/steps": 26}, transport="memq", pace=1, log=f"{folder}/run.lcm",
                   progress=lambda done, total: told.append((done, total)))
        self.assertTrue(told)
        self.assertEqual({total for _, total in told}, {26})
        self.assertEqual([done for done, _ in told], sorted(done for done, _ in told))

    def test_an_exception_of_the_progress_function_is_raised_after_the_run(self):
        def fail(done, total):
            raise KeyError("no bar")

        with tempfile.TemporaryDirectory() as folder:
            log = f"{folder}/run.lcm"
            with self.assertRaisesRegex(KeyError, "no bar"):
                fl.run(PAPER, set={"/steps": 26}, transport="memq", pace=1, log=log, progress=fail)
            self.assertEqual(len(list(fl.read_log(log).messages("TRUTH"))), 26)

    def test_seeds_without_an_order_are_refused(self):
        for seeds in ([1, 2], range(1, 10, 2), range(5, 5)):
            with self.assertRaises(ValueError):
                program._seeds(seeds)
        self.assertEqual(program._seeds(range(1, 11)), ["--seeds", "1:10"])


if __name__ == "__main__":
    unittest.main()
