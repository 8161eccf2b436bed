"""Runs a scenario with Fogline and reads the messages of the run from its exported CSV files."""

import csv
import json
import pathlib
import subprocess
import tempfile


class Run:
    """The messages of a run: `run.TRACK` is a list of dicts, one for each step, with numbers as values."""

    def __init__(self, fogline, scenario, fields):
        with tempfile.TemporaryDirectory() as folder:
            log = f"{folder}/run.lcm"
            overrides = [word for field in fields for word in ("--set", field)]
            self._call(fogline, "run", scenario, "--transport", "direct", "--quiet", "--log", log, *overrides)
            self._call(fogline, "export", log, "--out", f"{folder}/run")
            for file in pathlib.Path(folder, "run").glob("*.csv"):
                with open(file, newline="") as text:
                    rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(text)]
                setattr(self, file.stem, rows)
            self.scenario = json.loads(pathlib.Path(folder, "run", "scenario.json").read_text())

    @staticmethod
    def _call(*command):
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


class Differences:
    """The largest difference between a peer and Fogline, and the comparisons that failed."""

    def __init__(self):
        self.failures = 0
        self.compared = 0

    def expect(self, holds, what):
        self.compared += 1
        if not holds:
            self.failures += 1
            if self.failures <= 10:
                print("DIFFERENT:", what)

    def expect_near(self, ours, theirs, tolerance, what):
        near = abs(ours - theirs) <= tolerance * max(1.0, abs(theirs))
        self.expect(near, f"{what}: Fogline {ours!r}, peer {theirs!r}")

    def exit_code(self):
        print(f"{self.compared} values compared, {self.failures} differ")
        return 1 if self.failures or not self.compared else 0
