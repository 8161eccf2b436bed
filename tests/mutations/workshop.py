"""A copy of the tree in which mutations are planted, built and tested."""

import fcntl
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time

# These tests do not run on mutations. A digest changes with every change of a run, so a failed test
# of a digest does not tell what is wrong. The other tests of this pattern do not test C++ code, or
# are separate programs.
NOT_ASKED = (
    r"[Dd]igest|^unit\.(Python|Page)\."
    r"|^property\.(ClosedLoopAllocates|ConflictMeasuresAllocate|QpAgainst)"
)
EVERY_TEST = r"^(unit|property)\."
TARGETS = {
    "unit": ["unit_tests"],
    "property": ["property_tests"],
    "integration": ["integration_tests", "fogline_programs"],
}
# A mistake may make a test hang. After this time, in s, the mistake counts as noticed.
LONGEST = 600
LONGEST_ALL = 3600


class WorkError(Exception):
    """The copy cannot be made, built or tested."""


class Stopped(Exception):
    """The work was interrupted."""


class Workshop:
    """One copy with a build folder of its own. Only one thread may use it."""

    running = set()  # the processes of all workshops
    stopping = False

    def __init__(self, folder, jobs):
        self.tree = folder / "tree"
        self.build = folder / "build"
        self.jobs = jobs
        folder.mkdir(parents=True, exist_ok=True)
        self._lock = open(folder / "lock", "w", encoding="utf-8")
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise WorkError(f"{folder}: another tools/mutate uses it") from error

    def copy_from(self, sources, files):
        """Makes the copy equal to these files. Unchanged files keep their times."""
        for old in self.tree.rglob("*"):
            if old.is_file() and not old.is_symlink() and str(old.relative_to(self.tree)) not in files:
                old.unlink()
        for name in files:
            source, copy = sources / name, self.tree / name
            content = source.read_bytes()
            if copy.is_file() and copy.read_bytes() == content:
                continue
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, copy)
        modules = self.tree / "node_modules"
        if (sources / "node_modules").is_dir() and not modules.exists():
            modules.symlink_to(sources / "node_modules")

    def configure(self):
        """Configures the build folder for many small changes of libraries."""
        options = [
            "-DFOGLINE_TESTS=ON",
            "-DFOGLINE_UNITY_TESTS_ONLY=ON",
            "-DFOGLINE_WERROR=OFF",  # a mistake may leave a variable unused
            "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG",  # compiles faster
        ]
        if shutil.which("ld.gold"):  # links unit_tests in a fraction of the time
            options += [f"-DCMAKE_{kind}_LINKER_FLAGS=-fuse-ld=gold" for kind in ("EXE", "SHARED", "MODULE")]
        code, text = self._run(["cmake", "-S", self.tree, "-B", self.build, "-G", "Ninja", *options])
        if code != 0:
            raise WorkError(f"cannot configure:\n{text}")

    def make(self, programs):
        """Builds test programs. Returns the output of the build if it fails, otherwise ""."""
        targets = [target for program in programs for target in TARGETS[program]]
        code, text = self._run(["ninja", "-C", self.build, f"-j{self.jobs}", *targets])
        return "" if code == 0 else text

    def failing(self, pattern, longest):
        """Runs the tests that match `pattern` until a test fails.

        Returns the names of the failed tests, or a text if the tests take longer than `longest` s.
        """
        command = ["ctest", "--test-dir", self.build, "-R", pattern, "-E", NOT_ASKED, "--stop-on-failure"]
        command += ["--no-tests=error", "--parallel", str(self.jobs)]
        code, text = self._run(command, longest)
        if code is None:
            return ["a test that takes too long"]
        names = re.findall(r"^\s+\d+ - (\S+) \((?!Skipped|Disabled)", text, re.M)
        if code != 0 and not names:
            raise WorkError(f"ctest fails for {pattern}:\n{text[-2000:]}")
        return names

    def plant(self, mutation):
        """Puts the mistake into the copy. Returns a function that takes it out again."""
        path = self.tree / mutation.file
        text = path.read_text(encoding="utf-8")
        path.write_text(mutation.apply(text), encoding="utf-8")
        return lambda: path.write_text(text, encoding="utf-8")

    def _run(self, command, longest=None):
        """Exit code (None after the time limit) and output of a command."""
        if Workshop.stopping:
            raise Stopped
        process = subprocess.Popen(
            [str(word) for word in command],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            start_new_session=True,
            text=True,
            errors="replace",
        )
        Workshop.running.add(process)
        try:
            text, _ = process.communicate(timeout=longest)
        except subprocess.TimeoutExpired:
            end(process)
            return None, ""
        finally:
            Workshop.running.discard(process)
        if Workshop.stopping:
            raise Stopped
        return process.returncode, text


def end(process):
    """Ends a process together with all processes that it has started."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(process.pid, number)
        except ProcessLookupError:
            return
        for _ in range(50):
            if process.poll() is not None:
                break
            time.sleep(0.1)


def stop_all():
    """Ends the commands of all workshops."""
    Workshop.stopping = True
    for process in list(Workshop.running):
        end(process)


def files_of(sources, folder):
    """The files that git tracks or would track, without the files in `folder` (the copies)."""
    command = ["git", "-C", str(sources), "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    try:
        listed = subprocess.run(command, check=True, capture_output=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        raise WorkError(f"{sources}: no git working tree") from error
    names = [os.fsdecode(name) for name in listed.split(b"\0") if name]
    paths = {name: pathlib.Path(sources, name) for name in names}
    return {name for name, path in paths.items() if path.is_file() and folder not in path.parents}
