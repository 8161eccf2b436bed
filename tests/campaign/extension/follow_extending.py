#!/usr/bin/env python3
"""Adds the role of docs/extending.md to a copy of the tree, as the page says, and runs the role.

usage: follow_extending.py SOURCE_DIR FOGLINE [FOLDER]

SOURCE_DIR is the tree, FOGLINE is its program, and FOLDER is the folder for the copy (default: a
temporary folder). The test writes the files that the page shows, makes the changes that the page
shows, and executes the commands of the page. It makes no other change. Then it checks what the
page promises.
"""

import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SECTION = "## Add a role with a channel"
LEFT_OUT = {".git", "build", "node_modules", "logs"}


def blocks(page):
    """Returns (text since the previous block, kind, content) for each fenced block of SECTION."""
    section = page[page.index(SECTION):]
    found = re.split(r"^```(\w+)\n(.*?)^```\n", section, flags=re.MULTILINE | re.DOTALL)
    return list(zip(found[0::3], found[1::3], found[2::3]))


def words(line):
    return " ".join(line.split())


def apply(diff, file):
    """Replaces the old text of a diff in a file by the new text.

    Lines that begin with a space or "-" are the old text. Lines that begin with a space or "+" are
    the new text. Spaces between words do not count, so a line of the file may be aligned."""
    lines = file.read_text().splitlines()
    old = [line[1:] for line in diff.splitlines() if line[0] in " -"]
    new = [line[1:] for line in diff.splitlines() if line[0] in " +"]
    places = [i for i in range(len(lines))
              if [words(line) for line in lines[i:i + len(old)]] == [words(line) for line in old]]
    assert len(places) == 1, f"{file}: {len(places)} places for\n{diff}"
    lines[places[0]:places[0] + len(old)] = new
    file.write_text("\n".join(lines) + "\n")


def call(*command, folder, code=0):
    done = subprocess.run(command, cwd=folder, text=True, capture_output=True)
    assert done.returncode == code, f"{command}: {done.returncode}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}"
    return done


def copy_tree(source, tree):
    if tree.exists():
        shutil.rmtree(tree / "build" / "bin", ignore_errors=True)
    for part in source.iterdir():
        if part.name in LEFT_OUT:
            continue
        if part.is_dir():
            shutil.copytree(part, tree / part.name, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            tree.mkdir(parents=True, exist_ok=True)
            shutil.copy2(part, tree)
    if (source / "node_modules").exists() and not (tree / "node_modules").exists():
        (tree / "node_modules").symlink_to(source / "node_modules")
    (tree / "logs").mkdir(exist_ok=True)


def follow(page, tree):
    """Does what the page says.

    @return what the commands print, and the files that the page shows as a whole"""
    printed, written, file = [], {}, None
    for text, kind, content in blocks(page):
        named = [name for name in re.findall(r"`([\w./]+\.\w+)`", text) if "/" in name]
        if named:
            file = tree / named[-1]
        if kind == "diff":
            apply(content, file)
        elif kind == "bash":
            done = call("bash", "-ec", content, folder=tree)
            printed.append(done.stdout)
        else:
            assert words(text).endswith(f"Write `{named[-1]}`:"), text
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(content)
            written[file] = content
    return printed, written


def check(tree, printed, written):
    for file, content in written.items():
        assert file.read_text() == content, f"{file} is not formatted"
    # docs/architecture.md has both tables with the new role and the new channel. README.md has only
    # the table of roles.
    graph = call("build/bin/fogline", "graph", "--markdown", folder=tree).stdout
    assert "`fogline-thermal`" in graph and "| THERMAL |" in graph
    assert graph in (tree / "docs/architecture.md").read_text()
    assert graph.split("\n\n")[0] in (tree / "README.md").read_text()
    # All transports give the same digest. `fogline replay` computes the thermal camera again from a
    # log.
    digests = re.findall(r"\b[0-9a-f]{64}\b", printed[-1])
    # Four digests are of the runs, and four are of the logs of these runs.
    assert len(digests) == 4 + 4 and len(set(digests)) == 1, printed[-1]
    assert re.search(r"^thermal +same: 500 steps$", printed[-1], re.MULTILINE), printed[-1]
    # `fogline metrics` reads a log with the new channel, and `fogline export` writes the channel's
    # messages.
    assert "logs/direct.lcm" in printed[-1]
    with open(tree / "logs/direct/THERMAL.csv", newline="") as text:
        rows = list(csv.DictReader(text))
    assert len(rows) == 500
    deviation = {sensor: [float(row[f"{sensor}_deviation"]) for row in rows] for sensor in ("radar", "lidar")}
    in_fog = {sensor: sum(values[200:290]) / 90 for sensor, values in deviation.items()}
    assert in_fog["lidar"] < -2 and abs(in_fog["radar"]) < 1, f"the witness blames the wrong sensor: {in_fog}"


def check_order(tree):
    """Checks two wrong orders, which the compiler must refuse.

    In the first, the row of the role thermal is above the row of a role whose message thermal
    reads. In the second, the channel is not in the order of the roles."""
    graph = (tree / "services/graph.h").read_text()
    row = re.search(r"  ROLE\(thermal,.*\n", graph).group()
    lidar = graph.index("  ROLE(lidar,")
    too_high = graph.replace(row, "").replace("  ROLE(lidar,", row + "  ROLE(lidar,", 1)
    channel = re.search(r"    Channel<thermal_t>\{.*?\},\n(?=    Channel)", graph, re.DOTALL).group()
    last = graph.index("    Channel<follower_command_t>")
    too_low = (graph[:last] + channel + graph[last:]).replace(channel, "", 1)
    assert lidar < graph.index(row) and too_low != graph
    for wrong, why in ((too_high, "move the reader's row in FOGLINE_ROLES down"), (too_low, "not in the order of their roles")):
        header = tree / "build" / "wrong_order.h"
        header.write_text(wrong)
        refused = call("g++", "-std=c++20", "-fsyntax-only", "-x", "c++", f"-I{tree}", f"-I{tree}/build/lcmtypes/cpp",
                       str(header), folder=tree, code=1)
        assert why in refused.stderr, refused.stderr


def check_older_logs(tree, older):
    """Checks how each program reads the logs of the other program."""
    new = str(tree / "build/bin/fogline")
    call(older, "run", "scenario/paper.json", "--transport", "direct", "--log", "logs/older.lcm", folder=tree)
    for verb in ("metrics", "digest", "events"):
        before = call(older, verb, "logs/older.lcm", folder=tree).stdout
        assert call(new, verb, "logs/older.lcm", folder=tree).stdout == before, verb
    replayed = call(new, "replay", "logs/older.lcm", "--all", folder=tree)
    assert "the log has no THERMAL, which the role thermal needs here" in replayed.stderr
    assert "arbitrator  same: 500 steps" in replayed.stdout
    call(new, "replay", "logs/older.lcm", "--role", "thermal", folder=tree, code=2)
    call(new, "export", "logs/older.lcm", "--out", "logs/older", folder=tree)
    assert not (tree / "logs/older/THERMAL.csv").exists()
    refused = call(older, "metrics", "logs/direct.lcm", folder=tree, code=2)
    assert "the log has the channel THERMAL (thermal_t from thermal)" in refused.stderr, refused.stderr


def main():
    source, fogline = pathlib.Path(sys.argv[1]).resolve(), str(pathlib.Path(sys.argv[2]).resolve())
    with tempfile.TemporaryDirectory() as temporary:
        tree = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else temporary).resolve()
        copy_tree(source, tree)
        for name in ("direct", "older"):
            shutil.rmtree(tree / "logs" / name, ignore_errors=True)
        os.environ.pop("LCM_DEFAULT_URL", None)
        printed, written = follow((source / "docs/extending.md").read_text(), tree)
        assert len(written) >= 6 and len(printed) == 2
        check(tree, printed, written)
        check_order(tree)
        check_older_logs(tree, fogline)
    print("the role of docs/extending.md runs on every transport")


if __name__ == "__main__":
    main()
