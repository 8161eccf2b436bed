"""Calls the program `fogline`, and reads its output."""

from __future__ import annotations

import json
import os
import pty
import re
import shutil
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Iterable, Mapping, Sequence, Union

from fogline_lab.errors import BadInput, CheckFailed, FoglineError, RunFailed

if TYPE_CHECKING:
    import pandas

    from fogline_lab.log import Log

# How a call shows its progress. True: the program shows its own bar on stderr. False: nothing. A
# function: it is called with two numbers, done and total. None: a bar if a person sees stderr.
Progress = Union[bool, Callable[[int, int], None], None]

# The program's bar: "[===   ]  40 %  row 40/100  800/s  3 s left". A new bar replaces the old one.
_ERASE = "\r\033[K"
_BAR = re.compile(r"\[[= ]*\] +\d+ % +\w+ (\d+)/(\d+)")


def fogline_program() -> str:
    """The path of `fogline` in the build or installation of this package, or else in PATH."""
    here = Path(__file__).resolve()
    for above in here.parents:
        program = above / "bin" / "fogline"
        if program.is_file() and os.access(program, os.X_OK):
            return str(program)
    found = shutil.which("fogline")
    if found is None:
        raise FoglineError("there is no program fogline beside this package or in PATH")
    return found


def call(*arguments: str, progress: Progress = None) -> str:
    """Runs `fogline ARGUMENTS`. Returns its output on stdout.

    Raises ProgramError (CheckFailed, BadInput or RunFailed) with the program's text.
    """
    command = [fogline_program(), *arguments]
    if progress is None:
        progress = _has_reader(sys.stderr)
    if progress is False:
        done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        out, err, code = done.stdout, done.stderr, done.returncode
    else:
        out, err, code = _call_with_terminal(command, progress)
    if code != 0:
        kind = {1: CheckFailed, 2: BadInput}.get(code, RunFailed)
        raise kind(err.strip(), command, code, out)
    return out


def call_json(verb: str, *arguments: str, progress: Progress = False) -> Any:
    """Does the same as `call` with the option --json. Returns the JSON document."""
    return json.loads(call(verb, *arguments, "--json", progress=progress))


def _has_reader(stream: Any) -> bool:
    """Whether a person sees the stream: a terminal, or the output of a notebook."""
    return "ipykernel" in sys.modules or bool(getattr(stream, "isatty", lambda: False)())


def _call_with_terminal(command: list[str], progress: Any) -> tuple[str, str, int]:
    """Gives the program a terminal as stderr, because the program shows its progress only on a
    terminal."""
    ours, its = pty.openpty()
    try:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=its, text=True,
                                   stdin=subprocess.DEVNULL)
    except BaseException:
        os.close(ours)
        raise
    finally:
        os.close(its)
    pieces: list[str] = []
    failures: list[BaseException] = []
    listener = threading.Thread(target=_listen, args=(ours, progress, pieces, failures),
                                daemon=True)
    listener.start()
    try:
        out, _ = process.communicate()
    except BaseException:
        process.terminate()
        process.wait()
        raise
    finally:
        listener.join()
        os.close(ours)
    if failures:
        raise failures[0]
    return out, "".join(pieces), process.returncode


def _listen(terminal: int, progress: Any, lines: list[str], failures: list[BaseException]) -> None:
    """Shows or reports the bars that come from a terminal, and keeps all other text. After an
    exception of `progress` this function continues to read, because the program would otherwise
    wait for ever at a full terminal."""
    shown = False
    while True:
        try:
            piece = os.read(terminal, 1 << 16)
        except OSError:  # the program has ended
            break
        if not piece:
            break
        for part in re.split(f"({re.escape(_ERASE)})", piece.decode("utf-8", "replace")):
            bar = _BAR.match(part)
            if part == _ERASE:
                continue
            if not bar:
                lines.append(part.replace("\r\n", "\n"))
            elif failures:
                continue
            elif callable(progress):
                try:
                    progress(int(bar[1]), int(bar[2]))
                except BaseException as error:  # the thread that called the program raises it later
                    failures.append(error)
            else:
                shown = True
                print(f"\r{part}", end="", file=sys.stderr, flush=True)
    if shown:
        print(file=sys.stderr)


# ---- verbs ---------------------------------------------------------------------------------------


class Run:
    """The result of a run: everything that `fogline run --json` prints."""

    def __init__(self, result: dict[str, Any]) -> None:
        self.result = result

    @property
    def digest(self) -> str:
        return self.result["digest"]

    @property
    def metrics(self) -> dict[str, Any]:
        return self.result["metrics"]

    @property
    def log(self) -> Log:
        """The log of the run. Raises FoglineError if it has none (transport "direct")."""
        from fogline_lab.log import read_log

        if not self.result.get("log"):
            raise FoglineError("the run has no log; give it one: run(..., log='run.lcm')")
        return read_log(self.result["log"])

    def __repr__(self) -> str:
        told = {name: self.result[name] for name in ("scenario", "seed", "steps", "digest")}
        return f"<run {told}>"


def options_of(options: Mapping[str, Any]) -> list[str]:
    """Options of a command line: `lcm_url="udpm://..."` becomes `--lcm-url udpm://...`.

    A list repeats its option. True becomes an option without a value. False and None are left
    out."""
    words: list[str] = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words.append(option)
            continue
        several = value if isinstance(value, (list, tuple)) else [value]
        for one in several:
            words += [option, os.fspath(one) if isinstance(one, os.PathLike) else _word(one)]
    return words


def _word(value: Any) -> str:
    """A value for the command line: a text without a change, any other value as JSON."""
    return value if isinstance(value, str) else json.dumps(value, default=_plain)


def _plain(value: Any) -> Any:
    return value.item() if hasattr(value, "item") else str(value)  # a number of numpy


def _sets(changes: Mapping[str, Any] | None) -> list[str]:
    words = []
    for pointer, value in (changes or {}).items():
        words += ["--set", f"{pointer}={_word(value)}"]
    return words


def run(scenario: str | os.PathLike[str], set: Mapping[str, Any] | None = None,
        progress: Progress = None, **options: Any) -> Run:
    """Runs a scenario once (`fogline run`).

    set: fields of the scenario to change: {"/arbitrator/threshold": 0.8}.
    progress: True shows a bar, False shows none, a function is called with done and total steps;
        default: a bar if a person sees stderr. An exception of the function is raised after the
        run.
    options: the options of `fogline run`, with _ for -: seed=7, transport="direct",
        log="run.lcm", external="driver", lcm_url="udpm://...", realtime=True.

    Raises BadInput or RunFailed with the text of the program.
    """
    words = [os.fspath(scenario), *_sets(set), *options_of(options)]
    return Run(call_json("run", *words, progress=progress))


def table(scenario: str | os.PathLike[str], set: Mapping[str, Any] | None = None,
          progress: Progress = None, **options: Any) -> pandas.DataFrame:
    """The paper's table (`fogline table`), a row for each threshold.

    options: the options of `fogline table`: thresholds="0.2,0.5,0.8", seeds="1:200".
    """
    import pandas

    words = [os.fspath(scenario), *_sets(set), *options_of(options)]
    rows = call_json("table", *words, progress=progress)["rows"]
    return pandas.json_normalize(rows).set_index("threshold")


def sweep(scenario: str | os.PathLike[str], grid: Mapping[str, Any] | None = None,
          set: Mapping[str, Any] | None = None, seeds: str | range | None = None,
          progress: Progress = None, out: str | os.PathLike[str] | None = None,
          **options: Any) -> pandas.DataFrame:
    """Runs a scenario over a grid of fields and a range of seeds, on all cores (`fogline sweep`).

    grid: values of fields: {"/arbitrator/threshold": [0.2, 0.5, 0.8]}, or as the program takes
        them: {"/fog/bias_m": "0.2:0.4:21"}.
    seeds: range(1, 101) or "1:100"; default: the scenario's own seed.
    out: the CSV file. If it has a part of the rows of this sweep, the sweep continues after them.
        Default: a temporary file.

    Returns a row for each run and a column for each measure.
    """
    import pandas

    words = [os.fspath(scenario), *_sets(set), *_grid(grid), *_seeds(seeds), *options_of(options)]
    with tempfile.TemporaryDirectory() as folder:
        file = os.fspath(out) if out is not None else str(Path(folder) / "sweep.csv")
        call_json("sweep", *words, "--out", file, progress=progress)
        return pandas.read_csv(file, float_precision="round_trip")  # every number is exact


def _grid(grid: Mapping[str, Any] | None) -> Iterable[str]:
    for pointer, values in (grid or {}).items():
        text = values if isinstance(values, str) else ",".join(_word(one) for one in values)
        yield from ("--grid", f"{pointer}={text}")


def _seeds(seeds: str | range | Sequence[int] | None) -> list[str]:
    if seeds is None:
        return []
    if isinstance(seeds, str):
        return ["--seeds", seeds]
    if not isinstance(seeds, range) or seeds.step != 1 or not len(seeds):
        raise ValueError(f"seeds: {seeds!r} is neither a text 'A:B' nor a range without gaps")
    return ["--seeds", f"{seeds[0]}:{seeds[-1]}"]
