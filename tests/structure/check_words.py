#!/usr/bin/env python3
"""Checks that messages name settings as keys, which each door puts into its words once.

- A text names a key in braces, "{bounds.area}", and the key exists.
- No source below the doors spells what one door calls a key: "--area" or "MeshOptions::max_area".
- No source of a door edits a text that is finished: what an error says is not searched, replaced or erased.

usage: check_words.py PROJECT
"""

import pathlib
import re
import sys

TABLE = "src/job/key_table.cpp"
# What no key can hold: functions of the library's callers, options of its sessions and parts, and one of the commands that read meshes.
OTHERS = {"progress", "warning", "balance.own", "subdomains.given", "adaptive.shortest", "part.conserve", "part.sizes.shortest",
          "allow-outside"}

# The command line says "--area", in help and in messages of its own, also those of studies; experiments know --set.
COMMAND_LINE = ["src/app", "src/cli", "src/config", "src/study"]
LIBRARY = ["src/api"]
DOORS = ["src/app", "src/api", "src/config", "src/study", "python"]

STRING = re.compile(r'"((?:\\.|[^"\\\n])*)"')


def sources(project, folders=("src", "balancer", "migration", "protocol", "python")):
    for folder in folders:
        for path in sorted((project / folder).rglob("*.[ch]pp")):
            yield path.relative_to(project).as_posix(), re.sub(r"//[^\n]*", "", path.read_text())


def is_in(name, folders):
    return any(name.startswith(folder + "/") for folder in folders)


def problems(project):
    project = pathlib.Path(project)
    keys = set(re.findall(r'(?:key|choice|list)\(\s*"([a-z.-]+)"', (project / TABLE).read_text())) | OTHERS
    found = []
    for name, text in sources(project):
        for literal in STRING.findall(text):
            for key in re.findall(r"\{([a-z]+(?:[.-][a-z-]+)+)\}", literal):
                if key not in keys:
                    found.append(f"{name}: there is no key '{key}', which a message names")
            if name != TABLE and not is_in(name, COMMAND_LINE) and re.search(r"(?<![\w-])--[a-z]", re.sub(r"driftmesh \w+ --", "", literal)):
                found.append(f"{name}: \"{literal}\" has words of the command line; name the key, as in {{bounds.area}}")
            if not is_in(name, LIBRARY) and re.search(r"\bMeshOptions::", literal):
                found.append(f"{name}: \"{literal}\" has words of the library; name the key, as in {{bounds.area}}")
        if is_in(name, DOORS):
            for edited in re.findall(r"\b(?:message|what\(\)\)?)\.(?:replace|erase|find|insert)\(", text):
                found.append(f"{name}: {edited}...) edits a finished text; word its parts (src/base/key_text.hpp)")
            for spelled in re.findall(r"\b\w*replace\w*\([^;]*what\(\)", text):
                found.append(f"{name}: {spelled}...) edits a finished text; word its parts (src/base/key_text.hpp)")
    return found


if __name__ == "__main__":
    all_problems = problems(sys.argv[1])
    print("\n".join(all_problems) or "messages name keys, and doors word them")
    sys.exit(1 if all_problems else 0)
