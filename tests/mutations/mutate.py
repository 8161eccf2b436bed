"""The program that tools/mutate starts. tools/mutate prints the usage."""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import signal
import sys
import threading
import time

import mutations
import workshop

DONE, CHECK_FAILED, BAD_INPUT, FAILED, INTERRUPTED = 0, 1, 2, 3, 130
LEAST_SCORE = 0.95
# Files that change no program and no test.
IRRELEVANT = re.compile(r"^(docs|tests/mutations|tests/campaign|tests/soak|\.ci)/|\.md$")


def say(text):
    print(text, file=sys.stderr, flush=True)


def pattern_of(tests):
    """A regular expression of ctest for the tests whose names begin with one of `tests`."""
    # A suite with parameters has a name in front of its own name, as in unit.Of/EveryBlameTest.
    words = [re.escape(test).replace(r"\.", r"\.([A-Za-z0-9_]+/)?", 1) for test in sorted(set(tests))]
    return "^(" + "|".join(words) + ")"


def key_of(sources, files):
    """A key that changes when a file on which a result can depend changes."""
    digest = hashlib.sha256()
    for name in sorted(files):
        if IRRELEVANT.search(name):
            continue
        digest.update(name.encode() + b"\0" + hashlib.sha256((sources / name).read_bytes()).digest())
    return digest.hexdigest()


def key_of_mutation(one):
    parts = [one.file, *one.before, "", *one.after, "", *one.tests]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


class Results:
    """The known result of each mutation. A file keeps the results for later calls."""

    def __init__(self, path, key):
        self.path = path
        self.known = {"tree": key, "sound": [], "mutations": {}}
        try:
            kept = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return
        if kept.get("tree") == key:
            self.known = kept

    def of(self, one):
        """The result of a mutation: {"kind": ..., "by": ...}; None if it is not known."""
        return self.known["mutations"].get(key_of_mutation(one))

    def add(self, one, result):
        self.known["mutations"][key_of_mutation(one)] = result
        self.save()

    def save(self):
        part = self.path.with_suffix(".part")
        part.write_text(json.dumps(self.known, indent=1), encoding="utf-8")
        part.replace(self.path)


def result_of(one, shop):
    """Puts the mistake into the copy, and runs the tests that the list names.

    If all of them pass, runs all unit and property tests, too. Takes the mistake out again."""
    take_out = shop.plant(one)
    try:
        said = shop.make(one.programs)
        if said:
            return {"kind": "broken", "by": said[-2000:]}
        failing = shop.failing(pattern_of(one.tests), workshop.LONGEST)
        if failing:
            return {"kind": "noticed", "by": failing[0]}
        said = shop.make(["unit", "property"])
        if said:
            return {"kind": "broken", "by": said[-2000:]}
        failing = shop.failing(workshop.EVERY_TEST, workshop.LONGEST_ALL)
        return {"kind": "elsewhere", "by": failing[0]} if failing else {"kind": "survived", "by": ""}
    finally:
        take_out()


def require_sound(chosen, shop, results):
    """Checks that all tests pass when the code has no mistake. Raises WorkError."""
    programs = sorted({program for one in chosen for program in one.programs} | {"unit", "property"})
    say("building without a mistake")
    said = shop.make(programs)
    if said:
        raise workshop.WorkError(f"the tree does not build:\n{said[-2000:]}")
    asked = {test for one in chosen for test in one.tests if test.startswith("integration.")}
    patterns = [workshop.EVERY_TEST] + [pattern_of([test]) for test in sorted(asked)]
    for pattern in patterns:
        if pattern in results.known["sound"]:
            continue
        say(f"testing without a mistake: {pattern}")
        failing = shop.failing(pattern, workshop.LONGEST_ALL)
        if failing:
            raise workshop.WorkError(f"{failing[0]} fails without any mistake")
        results.known["sound"].append(pattern)
        results.save()


class Counter:
    """Prints after each mutation its result, how many mutations are done, and the time left."""

    def __init__(self, total):
        self.total = total
        self.done = 0
        self.began = time.monotonic()
        self.lock = threading.Lock()

    def tell(self, one, result):
        with self.lock:
            self.done += 1
            seconds = time.monotonic() - self.began
            left = seconds * (self.total - self.done) / self.done
            kind = {
                "noticed": f"noticed by {result['by']}",
                "elsewhere": f"noticed by {result['by']} only",
                "survived": "SURVIVED",
                "broken": "does not compile",
            }[result["kind"]]
            say(f"{self.done} of {self.total}, {left / 60:.0f} min left: {one.name}: {kind}")


def work_on(todo, shops, results):
    """Finds the result of each mutation.

    Each workshop repeatedly takes all mutations of the next file."""
    counter = Counter(len(todo))
    by_file = {}
    for one in todo:
        by_file.setdefault(one.file, []).append(one)
    groups = list(by_file.values())
    lock = threading.Lock()

    def work(shop):
        while True:
            with lock:
                group = groups.pop(0) if groups else None
            if group is None:
                return
            for one in group:
                result = result_of(one, shop)
                with lock:
                    results.add(one, result)
                counter.tell(one, result)

    with concurrent.futures.ThreadPoolExecutor(len(shops)) as pool:
        futures = [pool.submit(work, shop) for shop in shops]
        try:
            for future in concurrent.futures.as_completed(futures):
                future.result()
        except BaseException:
            workshop.stop_all()
            raise


def report(chosen, results):
    """Prints the score and the survivors. Returns the exit code."""
    kinds = {"noticed": [], "elsewhere": [], "survived": [], "broken": []}
    for one in chosen:
        kinds[results.of(one)["kind"]].append(one)
    noticed = len(kinds["noticed"]) + len(kinds["elsewhere"])
    score = noticed / len(chosen)
    print(
        f"{noticed} of {len(chosen)} mutations noticed ({100 * score:.1f} %), "
        f"{len(kinds['elsewhere'])} of them by other tests than the list names"
    )
    for one in kinds["elsewhere"]:
        print(f"  {one.place}: {one.name}: {results.of(one)['by']}")
    for one in kinds["survived"]:
        print(f"survivor: {one.file}: {one.name}: {one.equivalent or 'NOT EXPLAINED'}")
    for one in chosen:
        if one.equivalent and one not in kinds["survived"]:
            print(f"  {one.place}: {one.name}: counts as equivalent, but {results.of(one)['by']} notices it")
    for one in kinds["broken"]:
        say(f"{one.place}: error: {one.name} does not compile:\n{results.of(one)['by']}")
    if kinds["broken"]:
        return BAD_INPUT
    explained = all(one.equivalent for one in kinds["survived"])
    return DONE if explained and score >= LEAST_SCORE else CHECK_FAILED


def run(chosen, options):
    files = workshop.files_of(mutations.SOURCES, options.folder)
    options.folder.mkdir(parents=True, exist_ok=True)
    results = Results(options.folder / "results.json", key_of(mutations.SOURCES, files))
    todo = [one for one in chosen if results.of(one) is None]
    if todo:
        each = max(1, (os.cpu_count() or 1) // options.jobs)
        shops = [workshop.Workshop(options.folder / str(i + 1), each) for i in range(options.jobs)]
        for shop in shops:
            shop.copy_from(mutations.SOURCES, files)
            shop.configure()
        require_sound(chosen, shops[0], results)
        work_on(todo, shops, results)
    return report(chosen, results)


def stop(*_):
    workshop.stop_all()
    raise KeyboardInterrupt


class Parser(argparse.ArgumentParser):
    def error(self, message):
        say(f"tools/mutate: error: {message}; see tools/mutate --help")
        sys.exit(BAD_INPUT)


def regular_expression(text):
    try:
        return re.compile(text)
    except re.error as error:
        raise argparse.ArgumentTypeError(f"{text!r} is no regular expression: {error}") from error


def main():
    parser = Parser(add_help=False, allow_abbrev=False)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--only", type=regular_expression, default=re.compile(""))
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--folder", type=pathlib.Path, default=mutations.SOURCES / "build" / "mutate")
    options = parser.parse_args()
    try:
        all_mutations = mutations.read_all()
        errors = mutations.errors_in(all_mutations)
    except mutations.ListError as error:
        errors = [str(error)]
    if errors:
        for error in errors:
            say(f"tools/mutate: error: {error}")
        return BAD_INPUT
    if options.check:
        print(f"{len(all_mutations)} mutations fit their files")
        return DONE
    chosen = [one for one in all_mutations if options.only.search(f"{one.file} {one.name}")]
    if not chosen or options.jobs < 1:
        say("tools/mutate: error: no such mutation" if not chosen else "tools/mutate: error: --jobs is below 1")
        return BAD_INPUT
    if options.list:
        for one in chosen:
            print(f"{one.file} {one.name}")
        return DONE
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, stop)
    try:
        options.folder = options.folder.resolve()
        return run(chosen, options)
    except (KeyboardInterrupt, workshop.Stopped):
        say("interrupted; the next call goes on from here")
        return INTERRUPTED
    except workshop.WorkError as error:
        say(f"tools/mutate: error: {error}")
        return FAILED


if __name__ == "__main__":
    sys.exit(main())
