"""Checks that Fogline's table agrees with the Octave script's table, without sensor noise.

    table_agreement.py build/bin/fogline tests/campaign/peers/paper.m scenario/paper.json

There are two cases: the paper's experiment, and thick fog that begins at once. In thick fog the host's
ACC reaches its limits, so its quadratic program has active constraints.
"""

import json
import subprocess
import sys
import tempfile

TOLERANCE_POINTS = 2.0
NO_NOISE = ["/radar/range_std_m=0", "/radar/range_rate_std_mps=0", "/lidar/range_std_m=0"]
CASES = {
    "the paper's fog": [],
    "thick fog at once": ["/fog/bias_m=15", "/fog/profile=box", "/steps=310"],
}


def run(*command):
    # Octave may print "ignoring const execution_exception& ..." at its exit. This text does not
    # mean that the script failed.
    return subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout


def overrides(case):
    return [word for value in NO_NOISE + case for word in ("--set", value)]


def main(fogline, script, scenario):
    worst = 0.0
    for name, case in CASES.items():
        with tempfile.NamedTemporaryFile(suffix=".json") as effective:
            effective.write(run(fogline, "check", "--print", scenario, *overrides(case)))
            effective.flush()
            theirs = json.loads(run("octave-cli", "--norc", script, effective.name))["rows"]
        ours = json.loads(run(fogline, "table", scenario, "--json", *overrides(case)))["rows"]
        assert len(ours) == len(theirs) >= 3, (ours, theirs)
        for a, b in zip(ours, theirs):
            assert a["threshold"] == b["threshold"]
            for measure in ("si_pct", "rhe_pct"):
                print(f"{name}, threshold {a['threshold']}: {measure} {a[measure]:.6f}, "
                      f"Octave {b[measure]:.6f}")
                worst = max(worst, abs(a[measure] - b[measure]))
    print(f"largest difference: {worst:.2g} points")
    return 0 if worst <= TOLERANCE_POINTS else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
