"""Checks that Fogline's averaged jerk and that of an independent Octave script agree.

    jerk_agreement.py build/bin/fogline tests/campaign/peers/jerk.m scenario/paper.json scenario/dense_fog.json

The script reads only what `fogline export` writes. The cases have different lengths of a step. For
one of these lengths, a second is not a whole number of steps.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

MEASURES = ("max_abs_jerk_1s_mps3", "max_handover_jerk_1s_mps3")
RELATIVE = 1e-12  # Fogline and the script subtract the same two numbers
CASES = {
    "as in the file": [],
    "steps of 0.05 s": ["/step_s=0.05", "/steps=1000"],
    "steps of 0.02 s": ["/step_s=0.02", "/steps=2500"],
    "steps of 0.3 s": ["/step_s=0.3", "/steps=160"],
    "smooth transfers": ["/arbitrator/transfer/profile=sigmoid", "/arbitrator/transfer/duration_s=2"],
    "without traded control": ["/arbitrator/policy=none"],
}


def run(*command):
    # Octave may print "ignoring const execution_exception& ..." at its exit. This text does not
    # mean that the script failed.
    return subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout


def main(fogline, script, *scenarios):
    worst = 0.0
    compared = 0
    with tempfile.TemporaryDirectory() as scratch:
        for scenario in scenarios:
            for name, case in CASES.items():
                log = str(pathlib.Path(scratch) / "run.lcm")
                folder = str(pathlib.Path(scratch) / "run")
                overrides = [word for value in case for word in ("--set", value)]
                run(fogline, "run", scenario, "--transport", "direct", "--log", log, "--force", *overrides)
                run(fogline, "export", log, "--out", folder, "--force")
                ours = json.loads(run(fogline, "metrics", log, "--json"))[0]["metrics"]
                theirs = json.loads(run("octave-cli", "--norc", script, folder))
                for measure in MEASURES:
                    a, b = ours[measure], theirs[measure]
                    print(f"{scenario}, {name}: {measure} {a}, Octave {b}")
                    assert (a is None) == (b is None), measure
                    if a is None:
                        continue
                    compared += 1
                    worst = max(worst, abs(a - b) / max(abs(a), abs(b), sys.float_info.min))
    print(f"largest relative difference: {worst:.2g} in {compared} values")
    return 0 if worst <= RELATIVE and compared >= 10 * len(scenarios) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
