"""Prints for each folder of sources the share of its lines that unit and property tests execute.

Runs the two test programs of build-coverage/ (tools/build --coverage), and reads the counters of
the compiler with gcovr. Counts only the code that the test programs link. So it does not count
main() and the verbs of a program: integration tests test them by starting the program.
"""

import collections
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build-coverage"
PROGRAMS = ["unit_tests", "property_tests"]
SOURCES = ["common", "scenario", "services", "tools"]
LEAST_PCT = 85
# The build folders of programs, whose code the test programs do not link. The build folder of a
# library has an underscore after "fogline".
NOT_LINKED = r".*/fogline(-[a-z]+)?\.dir"


def run_tests():
    """Deletes the counts of earlier calls, and runs the test programs.

    Ends this program if a test fails."""
    for counts in BUILD.rglob("*.gcda"):
        counts.unlink()
    for program in PROGRAMS:
        log = BUILD / f"{program}.log"
        print(f"{program} ...", flush=True)
        with log.open("w") as out:
            result = subprocess.run([BUILD / "bin" / program, "--gtest_brief=1"], cwd=ROOT, stdout=out,
                                    stderr=subprocess.STDOUT, check=False)
        if result.returncode != 0:
            print(log.read_text(errors="replace")[-4000:], file=sys.stderr)
            print(f"tools/test: error: {program} failed; all of its output is in {log}", file=sys.stderr)
            sys.exit(3)


def executed_lines():
    """Returns {folder: [executed lines, all lines]} of the sources."""
    filters = [word for folder in SOURCES for word in ("--filter", f"{ROOT}/{folder}/")]
    report = subprocess.run(
        ["gcovr", "--root", ROOT, "--json", "--exclude-directories", NOT_LINKED, *filters, BUILD],
        check=True, stdout=subprocess.PIPE)
    lines = collections.defaultdict(lambda: [0, 0])
    for file in json.loads(report.stdout)["files"]:
        of_folder = lines[str(pathlib.PurePath(file["file"]).parent)]
        for line in file["lines"]:
            if line.get("gcovr/noncode"):
                continue
            of_folder[0] += line["count"] > 0
            of_folder[1] += 1
    return lines


def print_table(lines):
    """Prints the share of each folder. Returns the folders below LEAST_PCT."""
    below = []
    print(f"{'folder':<44}{'lines':>8}{'executed':>10}")
    for folder, (executed, count) in sorted(lines.items()):
        pct = 100 * executed / count
        below += [folder] if pct < LEAST_PCT else []
        print(f"{folder:<44}{count:>8}{pct:>8.1f} %")
    executed, count = (sum(column) for column in zip(*lines.values()))
    print(f"{'all':<44}{count:>8}{100 * executed / count:>8.1f} %")
    return below


def main():
    try:
        run_tests()
        below = print_table(executed_lines())
    except subprocess.CalledProcessError as error:
        sys.exit(error.returncode)
    except KeyboardInterrupt:
        sys.exit(130)
    if below:
        print(f"below {LEAST_PCT} %: {', '.join(below)}", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()
