#!/usr/bin/env python3
"""Do the JSON schema and the loader agree on what a scenario is?

Compares the verdicts of `fogline check --json` (one process for all files) with the verdicts of a
plain draft-07 validator. The files are the good and bad files of the repository, files with one
field at or just beyond an end of its range, and random mutations of the good files. The exit code
is 0 if both agree on every file, and if every default obeys the schema of its own field.
"""

import argparse
import copy
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

try:
    from jsonschema import Draft7Validator
except ImportError:
    sys.exit("python3-jsonschema is missing: apt-get install python3-jsonschema")

SEED = 7
RANDOM_MUTATIONS = 600


def load(data):
    """Parses JSON as strictly as RFC 8259 and I-JSON (RFC 7493) demand.

    Raises ValueError for other text."""

    def refuse_duplicates(pairs):
        keys = [key for key, _ in pairs]
        if len(keys) != len(set(keys)):
            raise ValueError("duplicate key")
        return dict(pairs)

    def refuse_constant(name):
        raise ValueError(f"{name} is not JSON")

    document = json.loads(
        data.decode("utf-8-sig"), object_pairs_hook=refuse_duplicates, parse_constant=refuse_constant
    )
    json.dumps(document, ensure_ascii=False).encode("utf-8")  # refuses lone surrogates
    return document


def schema_verdict(validator, path):
    """None if the schema accepts the file, otherwise the reason."""
    try:
        document = load(path.read_bytes())
    except (ValueError, RecursionError) as error:
        return f"not JSON: {error}"
    error = next(validator.iter_errors(document), None)
    return error and f"/{'/'.join(map(str, error.absolute_path))}: {error.message[:200]}"


def loader_verdicts(fogline, paths):
    """For each path None if the loader accepts the file, otherwise the reason.

    Mistakes that no schema can find do not count: mistakes in the files that a scenario names for a
    recorded leader or for SUMO (rules csv-*, sumo-*), and fields that contradict each other (rule
    impossible)."""
    names = [str(path) for path in paths]
    process = subprocess.run([fogline, "check", "--json", *names], capture_output=True, check=False)
    if process.returncode not in (0, 2):
        sys.exit(f"fogline check: exit code {process.returncode}: {process.stderr.decode()}")
    verdicts = dict.fromkeys(names)
    for mistake in json.loads(process.stdout):
        if not mistake["rule"].startswith(("csv-", "sumo-", "impossible")):
            verdicts[mistake["file"]] = f"{mistake['pointer']}: {mistake['message'][:200]}"
    return [verdicts[name] for name in names]


def leaves(schema, path=()):
    """Every field of the schema that is not a section, as (path, its schema).

    In a path, * stands for an item of a list."""
    for name, part in schema.get("properties", {}).items():
        yield from leaves(part, path + (name,))
    if schema["type"] == "array":
        yield from leaves(schema["items"], path + ("*",))
    if schema["type"] != "object":
        yield path, schema


def at_the_ends(schema):
    """Values just inside and just outside of the allowed range, and a value of each wrong type."""
    values = [None, True, -1, 0.5, 3.0, "text", "7", [], {}, [[]], [{}]]
    if "minimum" in schema:
        low, high = schema["minimum"], schema["maximum"]
        values += [low, high, float(low), float(high)]
        values += [math.nextafter(low, -math.inf), math.nextafter(high, math.inf)]
        values += [math.nextafter(low, math.inf), math.nextafter(high, -math.inf)]
        values += [low - 1, high + 1, -(10**30), 10**30, 1e300, -0.0]
    if "enum" in schema:
        values += schema["enum"] + [schema["enum"][0].upper(), schema["enum"][-1] + " "]
    if schema["type"] == "string":
        longest = schema.get("maxLength", 0)
        values += ["", "a\n", "\u0000", "\u001f", " ", "\u007f", "\u0080", "\u009f", "\u00a0"]
        values += ["\u2028", "\U0001f32b" * longest, "\U0001f32b" * (longest + 1)]
    if schema["type"] == "array" and schema["maxItems"] < 1000:
        values += [[{}] * schema["maxItems"], [{}] * (schema["maxItems"] + 1)]
    return values


def document_with(path, value):
    """The smallest scenario with this value at this path."""
    for key in reversed(path):
        value = [value] if key == "*" else {key: value}
    return {"version": 1, **value}


def boundary_documents(schema):
    for path, leaf in leaves(schema):
        for value in at_the_ends(leaf):
            yield json.dumps(document_with(path, value)).encode()


def places(node):
    """Every pair of a container in a document and a key or index in it."""
    if isinstance(node, (dict, list)):
        items = list(node.items()) if isinstance(node, dict) else list(enumerate(node))
        for key, child in items:
            yield node, key
            yield from places(child)


def mutate(document, fragments, rng):
    """A copy of the document in which one to three values or keys are changed, added or removed."""
    document = copy.deepcopy(document)
    for _ in range(rng.randint(1, 3)):
        spots = list(places(document))
        if not spots:
            break
        node, key = rng.choice(spots)
        action = rng.randrange(5)
        if action == 0:
            del node[key]
        elif action == 1 and isinstance(node, dict):
            node[rng.choice(fragments)[0]] = node.pop(key)
        elif action == 2 and isinstance(node, dict):
            name, value = rng.choice(fragments)
            node[name] = copy.deepcopy(value)
        elif action == 3 and isinstance(node[key], (int, float)):
            node[key] = node[key] * rng.choice([0, -1, 0.5, 1.0, 10, 1e6])
        else:
            node[key] = copy.deepcopy(rng.choice(fragments)[1])
    return document


def mutate_bytes(data, rng):
    data = bytearray(data)
    for _ in range(rng.randint(1, 3)):
        at = rng.randrange(len(data))
        if rng.random() < 0.5:
            data[at : at + rng.randint(0, 2)] = rng.choice(b'0123456789{}[]",:-.eE\\u \n').to_bytes(1, "big")
        else:
            data[at : at + 1] = rng.randbytes(rng.randint(0, 2))
    return bytes(data)


def random_documents(schema, goods):
    rng = random.Random(SEED)
    documents = [load(data) for data in goods]
    fragments = [(path[-1], leaf.get("default")) for path, leaf in leaves(schema)]
    for document in documents:
        fragments += [(str(key), node[key]) for node, key in places(document)]
    for _ in range(RANDOM_MUTATIONS // 2):
        mutated = mutate(rng.choice(documents), fragments, rng)
        yield json.dumps(mutated, ensure_ascii=rng.random() < 0.5).encode()
    for _ in range(RANDOM_MUTATIONS // 2):
        yield mutate_bytes(rng.choice(goods), rng)


def check_defaults(schema):
    fields = 0
    for path, leaf in leaves(schema):
        if "default" in leaf:
            fields += 1
            Draft7Validator(leaf).validate(leaf["default"])
        elif path[-1] not in ("*", "$schema"):
            sys.exit(f"/{'/'.join(path)} has no default in the schema")
    print(f"{fields} defaults obey the schema of their own field")


def compare(fogline, validator, what, paths, at_least):
    """The number of files on which schema and loader disagree.

    Prints both reasons for each such file on stderr."""
    disagreements = accepted = 0
    for path, loader in zip(paths, loader_verdicts(fogline, paths)):
        schema = schema_verdict(validator, path)
        if (schema is None) != (loader is None):
            disagreements += 1
            text = path.read_bytes()[:2000]
            print(f"{path}\n  schema: {schema}\n  loader: {loader}\n  {text}", file=sys.stderr)
        accepted += loader is None
    refused = len(paths) - accepted
    print(f"{what}: {len(paths)} files compared, {accepted} accepted, {refused} refused")
    if accepted < at_least or refused < at_least:
        sys.exit(f"{what}: at least {at_least} of each are needed for a comparison that tells")
    return disagreements


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fogline", required=True, help="the program")
    parser.add_argument("--scenarios", required=True, type=pathlib.Path, help="the folder scenario/")
    arguments = parser.parse_args()

    schema_path = arguments.scenarios / "scenario.schema.json"
    schema = json.loads(schema_path.read_text(encoding="utf-8"))
    Draft7Validator.check_schema(schema)
    check_defaults(schema)
    validator = Draft7Validator(schema)

    good = sorted(path for path in arguments.scenarios.glob("*.json") if path != schema_path)
    bad = sorted((arguments.scenarios / "bad").glob("*.json"))
    disagreements = compare(arguments.fogline, validator, "repository", good + bad, 3)

    with tempfile.TemporaryDirectory() as folder:
        goods = [path.read_bytes() for path in good]
        for what, documents in (
            ("ends of ranges", boundary_documents(schema)),
            ("random mutations", random_documents(schema, goods)),
        ):
            paths = []
            for data in documents:
                paths.append(pathlib.Path(folder) / f"{what.replace(' ', '_')}_{len(paths)}.json")
                paths[-1].write_bytes(data)
            disagreements += compare(arguments.fogline, validator, what, paths, 50)
    print(f"{disagreements} disagreements")
    return 1 if disagreements else 0


if __name__ == "__main__":
    sys.exit(main())
