#!/usr/bin/env python3
"""Writes the types of the package: a template, in which the options of the compiled module take their places.

usage: write_stubs.py TEMPLATE TARGET        with the package on PYTHONPATH
"""

import pathlib
import sys

from driftmesh import option_table

# What tables of keys cannot hold: functions, and objects of the package.
CALLABLES = {"warning": "Callable[[str], object]", "size": "Callable[[float, float], float]",
             "progress": "Callable[[Progress], bool | None] | bool",
             "subdomains.given": "Decomposition", "balance.own": "Policy | Plan"}


def kind_of(option):
    if option["choices"]:
        return "Literal[" + ", ".join(f'"{choice}"' for choice in option["choices"]) + "]"
    kinds = {"int": "float | str", "float": "float | str", "list[float]": "Sequence[float]", "dict[str, object]": "Mapping[str, object]"}
    return kinds.get(option["kind"], option["kind"])


def options_and_sections():
    """The lines of the options, and those of a class for each section of them."""
    kinds = {option["name"]: kind_of(option) for option in option_table()} | CALLABLES
    sections = {}
    for name, kind in kinds.items():
        section, _, member = name.rpartition(".")
        sections.setdefault(section, {})[member] = kind
    options = sections.pop("") | {section: section.title() for section in sections}
    return ([f"    {name}: {kind} | None = ...," for name, kind in options.items()],
            [line for section, members in sections.items()
             for line in (f"class {section.title()}(TypedDict, total=False):",
                          *(f"    {name}: {kind}" for name, kind in members.items()), "")])


def main():
    template, target = map(pathlib.Path, sys.argv[1:])
    options, sections = ("\n".join(lines) for lines in options_and_sections())
    target.write_text("".join({"@OPTIONS@\n": options + "\n", "@SECTIONS@\n": sections + "\n"}.get(line, line)
                              for line in template.read_text().splitlines(keepends=True)))


if __name__ == "__main__":
    main()
