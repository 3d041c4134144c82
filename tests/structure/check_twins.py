#!/usr/bin/env python3
"""Checks that no two files define functions or types of one name, which linkers take for the same without a word.

C++ has one definition of each function and type in a program ("one definition rule"), and nobody is told if there are two: where
one of them is inline, the linker keeps one for all callers, which one depends on what the compiler had inlined. What is defined in
unnamed namespaces or in classes, and templates, are left out, and so is what stands in for files where a library is absent
(NAME_without_LIBRARY.cpp): one program has only one of the two.

usage: check_twins.py PROJECT
"""

import collections
import pathlib
import re
import sys

# Folders whose files end up in one program.
FOLDERS = ["include", "src", "balancer", "migration", "protocol", "python", "tests/oracles", "tests/support"]

COMMENTS_AND_LITERALS = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\])'|^\s*#[^\n]*", re.DOTALL | re.MULTILINE)
NAMESPACE = re.compile(r"(?:inline\s+)?namespace\s*([\w:]*)$")
TYPE = re.compile(r"(?:struct|class|union|enum(?:\s+class)?)\s+(?:alignas\([^)]*\)\s*)?(\w+)(?!\s*::|\w)")
FUNCTION = re.compile(r"[\w>&*\]]\s+[&*]*(\w+|operator\W+)\s*\((.*)\)[^()]*$", re.DOTALL)


def types_of(parameters):
    """The types of a list of parameters: their names and default values are left out."""
    types, depth, first = [], 0, 0
    for i, char in enumerate(parameters + ","):
        depth += (char in "<({") - (char in ">)}")
        if char == "," and depth == 0:
            declared = parameters[first:i].split("=")[0].strip()
            types.append(re.sub(r"\s+", "", re.sub(r"(?<=[\s&*>])\w+$", "", declared)))
            first = i + 1
    return ",".join(types)


def definitions(text):
    """Names of types and signatures of functions that a file defines in named namespaces."""
    code, scopes, start = COMMENTS_AND_LITERALS.sub(" ", text), [], 0
    for bracket in re.finditer(r"[{};]", code):
        head, start = code[start : bracket.start()].strip(), bracket.end()
        if bracket.group() == "{":
            namespace = NAMESPACE.match(head)
            if not namespace and all(scopes) and "template" not in head and not head.startswith("static"):
                named, function = TYPE.match(head), FUNCTION.search(head)
                if named:
                    yield "::".join([*scopes, named.group(1)])
                elif function and not head.endswith("=") and "<" not in function.group(1):
                    yield "::".join([*scopes, f"{function.group(1)}({types_of(function.group(2))})"])
            scopes.append(namespace.group(1) if namespace else None)
        elif bracket.group() == "}" and scopes:
            scopes.pop()


def problems(project):
    project, files = pathlib.Path(project), collections.defaultdict(set)
    for folder in FOLDERS:
        for path in sorted(path for path in (project / folder).rglob("*.[ch]pp") if "_without_" not in path.name):
            for name in definitions(path.read_text()):
                files[name].add(path.relative_to(project).as_posix())
    return [f"{name} is defined in {' and '.join(sorted(where))}: give one another name, or put it into an unnamed namespace"
            for name, where in sorted(files.items()) if len(where) > 1], len(files)


if __name__ == "__main__":
    found, count = problems(sys.argv[1])
    print("\n".join(found) or f"{count} functions and types, each defined once")
    sys.exit(1 if found else 0)
