"""Writes fogline_lab/messages.py: each message type of lcmtypes/ as a class in Python.

usage: generate_messages.py OUT TYPES FILE.lcm...

TYPES is the folder in which `lcm-gen -p` has made the same types. LCM's fingerprints come from
there, so this script does not repeat LCM's rule for them.
"""

import importlib
import pathlib
import re
import sys
import textwrap
from typing import NamedTuple

# For each number type of LCM: the letter of Python's module struct, the type in Python, and the
# value in a new message.
NUMBERS = {
    "boolean": ("?", "bool", "False"),
    "int8_t": ("b", "int", "0"),
    "int16_t": ("h", "int", "0"),
    "int32_t": ("i", "int", "0"),
    "int64_t": ("q", "int", "0"),
    "float": ("f", "float", "0.0"),
    "double": ("d", "float", "0.0"),
}


class Field(NamedTuple):
    """A member of a message. A dimension is a number, or the name of the field with the number."""

    name: str
    type: str
    dims: tuple
    comment: str

    @property
    def counted(self) -> bool:
        return any(isinstance(dim, str) for dim in self.dims)


class Struct(NamedTuple):
    name: str
    comment: str
    constants: list
    fields: list


def read_struct(path: pathlib.Path) -> Struct:
    """Reads a file with one struct. A comment belongs to the line below it."""
    name, about, constants, fields, comment = "", "", [], [], []
    for line in path.read_text().splitlines():
        code, _, remark = (part.strip() for part in line.partition("//"))
        if remark:
            comment.append(remark)
        if code in ("", "}", "package fogline;"):
            pass
        elif match := re.fullmatch(r"struct (\w+) \{", code):
            name, about = match[1], " ".join(comment)
        elif match := re.fullmatch(r"const (\w+) (\w+) = (-?\w+);", code):
            constants.append((match[2], match[3], " ".join(comment)))
        elif match := re.fullmatch(r"(\w+) (\w+)((?:\[\w+\])*);", code):
            dims = re.findall(r"\w+", match[3])
            dims = tuple(int(dim) if dim.isdigit() else dim for dim in dims)
            fields.append(Field(match[2], match[1], dims, " ".join(comment)))
        else:
            sys.exit(f"{path}: cannot read the line {line!r}")
        if code:
            comment = []
    return Struct(name, about, constants, fields)


def python_type(field: Field) -> str:
    inner = NUMBERS[field.type][1] if field.type in NUMBERS else field.type
    inner = {"string": "str"}.get(inner, inner)
    return "list[" * len(field.dims) + inner + "]" * len(field.dims)


def default(field: Field) -> str:
    if field.counted:
        return "field(default_factory=list)"
    if field.type in NUMBERS and not field.dims:
        return NUMBERS[field.type][2]
    if field.type == "string" and not field.dims:
        return '""'
    if not field.dims:
        return f"field(default_factory={field.type})"
    value = NUMBERS[field.type][2]
    for dim in reversed(field.dims):
        value = f"[{value}] * {dim}" if "[" not in value else f"[{value} for _ in range({dim})]"
    return f"field(default_factory=lambda: {value})"


class Coder:
    """Makes the text of `_read` and `_write` of one struct.

    Adjacent numbers are one *run* if their count is fixed. One call of struct handles a whole run.
    """

    def __init__(self, struct: Struct, structs: dict):
        self.struct = struct
        self.structs = structs
        self.formats: list[str] = []  # of the runs
        self.reads: list[str] = []
        self.writes: list[str] = []
        self.values: list[str] = []  # arguments of the constructor
        self.run: list[str] = []  # values that the open run writes
        self.format = ""  # of the open run
        self.length = 0  # numbers in the open run
        counts: dict[str, list[str]] = {}
        for field in struct.fields:
            for dim in field.dims:
                if isinstance(dim, str):
                    counts.setdefault(dim, []).append(field.name)
        self.counts = counts
        for field in struct.fields:
            self.add(field)
        self.close()

    def take(self, count: int) -> range:
        """Places of the next `count` numbers of the open run."""
        self.length += count
        return range(self.length - count, self.length)

    def add(self, field: Field) -> None:
        run = f"v{len(self.formats)}"
        if field.counted or field.type == "string":
            self.close()
            return self.add_list(field)
        if field.type in self.structs:
            inner = self.structs[field.type].fields
            self.format += "".join(NUMBERS[one.type][0] for one in inner)
            places = self.take(len(inner))
            arguments = ", ".join(f"{run}[{place}]" for place in places)
            self.values.append(f"{field.type}({arguments})")
            self.run += [f"self.{field.name}.{one.name}" for one in inner]
            return None
        letter = NUMBERS[field.type][0]
        if not field.dims:
            self.format += letter
            (place,) = self.take(1)
            self.values.append(f"{run}[{place}]")
            lists = self.counts.get(field.name)
            self.run.append(
                f"count(self, {field.name!r}, {tuple(lists)!r})" if lists else f"self.{field.name}"
            )
            return None
        rows = field.dims[0] if len(field.dims) == 2 else 1
        width = field.dims[-1]
        self.format += f"{rows * width}{letter}"
        lists = []
        for row in range(rows):
            places = self.take(width)
            lists.append(f"list({run}[{places.start}:{places.stop}])")
            self.run.append(f"*self.{field.name}" + (f"[{row}]" if len(field.dims) == 2 else ""))
        self.values.append(lists[0] if len(field.dims) == 1 else "[" + ", ".join(lists) + "]")
        return None

    def add_list(self, field: Field) -> None:
        """Adds a text, or a list whose length is in another field."""
        if not field.dims:
            read, write = "read_text(data, at)", f"write_text(self.{field.name})"
        else:
            index = [one.name for one in self.struct.fields].index(field.dims[0])
            count = self.values[index]
            if field.type == "string":
                read = f"read_texts({count}, data, at)"
                write = f"write_texts(self.{field.name})"
            else:
                letter = NUMBERS[field.type][0]
                read = f"read_numbers({letter!r}, {count}, data, at)"
                write = f"write_numbers({letter!r}, self.{field.name})"
        self.reads.append(f"{field.name}, at = {read}")
        self.values.append(field.name)
        self.writes.append(write)

    def close(self) -> None:
        """Ends the open run."""
        if not self.format:
            return
        name = f"_{self.struct.name}_{len(self.formats)}"
        self.reads += [
            f"v{len(self.formats)} = {name}.unpack_from(data, at)",
            f"at += {name}.size",
        ]
        self.writes.append(f"{name}.pack({', '.join(self.run)})")
        self.formats.append(f'{name} = Struct(">{self.format}")')
        self.run, self.format, self.length = [], "", 0


def wrapped(text: str, indent: str) -> list[str]:
    return textwrap.wrap(text, 96, initial_indent=indent, subsequent_indent=indent)


def class_text(struct: Struct, structs: dict, fingerprint: str) -> str:
    coder = Coder(struct, structs)
    lines = [*coder.formats, "", "", "@dataclass(slots=True)", f"class {struct.name}(Message):"]
    about = wrapped(struct.comment or "A message.", "    ")
    about[0] = '    """' + about[0].strip()
    lines += about
    remarks = [(one.name, one.comment) for one in struct.fields if one.comment]
    remarks += [(name, remark) for name, _, remark in struct.constants if remark]
    for name, remark in remarks:
        lines += ["", f"    {name}:", *wrapped(remark, "        ")]
    lines += ['    """', ""]
    lines += [f'    FINGERPRINT: ClassVar[bytes] = bytes.fromhex("{fingerprint}")']
    lines += ["    FIELDS: ClassVar[tuple[Field, ...]] = ("]
    for one in struct.fields:
        lines.append(f"        Field({one.name!r}, {one.type!r}, {one.dims!r}),")
    lines += ["    )"]
    lines += [f"    {name}: ClassVar[int] = {value}" for name, value, _ in struct.constants]
    lines += [""]
    lines += [f"    {one.name}: {python_type(one)} = {default(one)}" for one in struct.fields]
    lines += ["", "    @classmethod"]
    lines += [f'    def _read(cls, data, at: int) -> tuple["{struct.name}", int]:']
    lines += [f"        {read}" for read in coder.reads]
    lines += [f"        return cls({', '.join(coder.values)}), at"]
    lines += ["", "    def _write(self) -> bytes:", "        return b''.join((self.FINGERPRINT,"]
    lines += [f"            {write}," for write in coder.writes]
    lines += ["        ))", "", ""]
    return "\n".join(lines)


def main() -> None:
    out, types, *files = sys.argv[1:]
    sys.path.insert(0, types)
    structs = {}
    for file in files:
        struct = read_struct(pathlib.Path(file))
        structs[struct.name] = struct
    # header_t comes first, because other structs contain it. It has only numbers.
    order = sorted(structs.values(), key=lambda one: (one.name != "header_t", one.name))
    text = (
        '"""The messages of a run. Made from lcmtypes/*.lcm; do not edit."""\n\n'
        "from dataclasses import dataclass, field\n"
        "from struct import Struct\n"
        "from typing import ClassVar\n\n"
        "from fogline_lab.codec import (Field, Message, count, read_numbers, read_text,\n"
        "                               read_texts, write_numbers, write_text, write_texts)\n\n"
    )
    names = ",\n    ".join(one.name for one in order)
    for struct in order:
        made = importlib.import_module(f"fogline.{struct.name}")
        fingerprint = getattr(made, struct.name)._get_packed_fingerprint().hex()
        text += class_text(struct, structs, fingerprint)
    text += f"TYPES: tuple[type[Message], ...] = (\n    {names},\n)\n"
    text += "__all__ = ['TYPES', *(one.__name__ for one in TYPES)]\n"
    text += "BY_FINGERPRINT: dict[bytes, type[Message]] = {one.FINGERPRINT: one for one in TYPES}\n"
    pathlib.Path(out).write_text(text)


if __name__ == "__main__":
    main()
