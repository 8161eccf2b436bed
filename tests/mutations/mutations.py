"""The list of mutations: its format (README.md), and the check that it fits the sources."""

import dataclasses
import pathlib
import re

FOLDER = pathlib.Path(__file__).resolve().parent
SOURCES = FOLDER.parent.parent
FEWEST = 150  # mutations that the list must have
KEYS = ("name", "file", "tests", "equivalent")
PROGRAMS = ("unit", "property", "integration")


class ListError(Exception):
    """A mistake in the list itself."""


@dataclasses.dataclass
class Mutation:
    """A mistake that a person could make in one file."""

    place: str  # the line of the list at which the mutation begins, as "FILE:LINE"
    name: str = ""
    file: str = ""  # relative to the folder of the sources
    tests: list = dataclasses.field(default_factory=list)  # beginnings of names of tests
    equivalent: str = ""  # why no test can notice it; "" if a test must notice it
    before: list = dataclasses.field(default_factory=list)  # lines of the source
    after: list = dataclasses.field(default_factory=list)

    @property
    def programs(self):
        """The test programs that have the expected tests."""
        return sorted({test.split(".")[0] for test in self.tests})

    def apply(self, text):
        """Returns the text of the file with the mistake in it."""
        before = "\n".join(self.before)
        count = text.count(before) if before else 0
        if count != 1:
            raise ListError(f"{self.place}: {self.name}: the original occurs {count} times in {self.file}")
        return text.replace(before, "\n".join(self.after))


def read_file(path):
    """The mutations of one file of the list. Raises ListError."""
    mutations = []
    ended = True  # whether the next line begins a mutation
    for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
        place = f"{path.relative_to(SOURCES)}:{number}"
        if not line.strip():
            ended = True
            continue
        if line.startswith("#"):
            continue
        if ended:
            mutations.append(Mutation(place))
            ended = False
        _take(line, mutations[-1], place)
    return mutations


def _take(line, mutation, place):
    if line == "+" or line.startswith("+ "):
        mutation.after.append(line[2:])
        return
    if line.startswith("- "):
        mutation.before.append(line[2:])
        return
    key, colon, value = line.partition(":")
    value = value.strip()
    if key not in KEYS or not colon or not value:
        raise ListError(f"{place}: {line[:60]!r} is neither a change nor one of {', '.join(KEYS)}")
    if key == "tests":
        mutation.tests += value.split()
    elif key == "equivalent":
        mutation.equivalent += (" " if mutation.equivalent else "") + value
    else:
        setattr(mutation, key, value)


def read_all(folder=FOLDER):
    """All mutations, in the order of their files in the tree. Raises ListError."""
    mutations = [one for path in sorted(folder.glob("*.txt")) for one in read_file(path)]
    # Mutations of one file follow each other, so that few files are compiled twice.
    return sorted(mutations, key=lambda one: one.file)


def errors_in(mutations, sources=SOURCES):
    """What is wrong with the list; an empty list if nothing is wrong."""
    errors = []
    if len(mutations) < FEWEST:
        errors.append(f"the list has {len(mutations)} mutations instead of {FEWEST} at least")
    suites = _suites(sources)
    names = {}
    for one in mutations:
        if one.name in names:
            errors.append(f"{one.place}: {one.name} is also the name at {names[one.name]}")
        names[one.name] = one.place
        errors += _errors_of(one, sources, suites)
    return errors


def _errors_of(one, sources, suites):
    if not re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", one.name):
        return [f"{one.place}: the name {one.name!r} is not made of small letters, digits and -"]
    errors = []
    try:
        text = (sources / one.file).read_text(encoding="utf-8")
        if one.apply(text) == text:
            errors.append(f"{one.place}: {one.name}: changes nothing")
    except OSError as error:
        errors.append(f"{one.place}: {one.name}: {one.file}: {error.strerror}")
    except ListError as error:
        errors.append(str(error))
    if not one.tests:
        errors.append(f"{one.place}: {one.name}: names no tests")
    for test in one.tests:
        match = re.match(r"(\w+)\.(\w+)\.", test + ".")
        if not match or match[1] not in PROGRAMS:
            errors.append(f"{one.place}: {one.name}: {test} does not begin with PROGRAM.SUITE")
        elif match[2] not in suites[match[1]]:
            errors.append(f"{one.place}: {one.name}: there is no suite {match[2]} in tests/{match[1]}")
    return errors


def _suites(sources):
    """The names of the test suites, by program."""
    suites = {}
    for program in PROGRAMS:
        names = set()
        for path in (sources / "tests" / program).rglob("*_test.cc"):
            names |= set(re.findall(r"^TEST(?:_[FP])?\((\w+),", path.read_text(encoding="utf-8"), re.M))
        suites[program] = names
    return suites
