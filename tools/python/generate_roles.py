"""Writes fogline_lab/roles.py: a class for each role of the graph that computes steps.

usage: generate_roles.py OUT GRAPH

GRAPH is the output of `fogline graph --json`, so the roles come from the table in services/graph.h.
"""

import json
import pathlib
import sys


def argument(channel: dict) -> str:
    """The name of an argument for a message of a channel."""
    return channel["name"].lower()


def takes(names: str, role: str) -> bool:
    return role in names.split(", ")


def class_text(role: dict, channels: list, begins: bool) -> str:
    name = role["name"]
    reads = [one for one in channels if takes(one["to"], name)]
    writes = [one for one in channels if one["from"] == name]
    if not reads or not writes:
        return ""  # the recorder computes no steps
    on_demand = [one for one in channels if takes(one["on_demand"], name)]
    if len(on_demand) > 1:
        sys.exit(f"{name} reads more than one channel on demand")
    types = {
        "READS": ", ".join(one["type"] for one in reads) + ",",
        "WRITES": ", ".join(one["type"] for one in writes) + ",",
    }
    result = writes[0]["type"]
    if len(writes) > 1:
        result = f"tuple[{', '.join(one['type'] for one in writes)}]"
    elif result in ("driver_command_t", "accel_command_t"):
        result += " | float"
    arguments = ", ".join(f"{argument(one)}: {one['type']}" for one in reads)
    lines = [
        f"class {name.title()}(Role):",
        f'    """The {name}: {role["purpose"]}.',
        "",
        *[f"    Reads {one['name']}: {one['what']}." for one in reads],
        *[f"    Writes {one['name']}: {one['what']}." for one in writes],
        *[f"    On demand it reads {one['name']}: {one['what']}." for one in on_demand],
        '    """',
        "",
        f'    ROLE = "{name}"',
        *[f"    {key} = ({value})" for key, value in types.items()],
        *[f"    ON_DEMAND = {one['type']}" for one in on_demand],
    ]
    if begins:
        lines += [
            "    BEGINS = True",
            "",
            f"    def start(self) -> {result}:",
            '        """Makes the messages of step 0."""',
            '        raise NotImplementedError(f"{type(self).__name__} has no start()")',
        ]
    lines += [
        "",
        f"    def step(self, {arguments}) -> {result}:",
        '        raise NotImplementedError(f"{type(self).__name__} has no step()")',
    ]
    return "\n".join(lines) + "\n\n\n"


def main() -> None:
    out, graph_file = sys.argv[1:]
    graph = json.loads(pathlib.Path(graph_file).read_text())
    channels = [one for one in graph["channels"] if one["per_step"]]
    # The world comes first in the order of evaluation, so it begins the steps.
    texts = [
        class_text(role, channels, begins=place == 0) for place, role in enumerate(graph["roles"])
    ]
    types = ",\n                                  ".join(one["type"] for one in channels)
    names = [one["name"] for one in channels]
    pathlib.Path(out).write_text(
        '"""The roles of a run. Made from services/graph.h; do not edit."""\n\n'
        f"from fogline_lab.messages import ({types})\n"
        "from fogline_lab.role import Role\n\n"
        "# The channels with a message in each step.\n"
        f"STEP_CHANNELS: tuple[str, ...] = {tuple(names)!r}\n\n\n"
        + "".join(texts)
        + "ROLES: tuple[type[Role], ...] = ("
        + "".join(f"{role['name'].title()}, " for role, text in zip(graph["roles"], texts) if text)
        + ")\n"
        + "__all__ = ['ROLES', 'STEP_CHANNELS', *(one.__name__ for one in ROLES)]\n"
    )


if __name__ == "__main__":
    main()
