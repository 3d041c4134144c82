#!/usr/bin/env python3
"""Compiles every header of the project alone, and with --sources every source: each includes what it needs.
Where sources are compiled together, or with a precompiled header, what one of them lacks comes from another unnoticed.

usage: check_alone.py [--sources] PROJECT_FOLDER BUILD_FOLDER

No code is made. A file is compiled with the flags that its box has in the build folder.

One compilation is enough for a chain of headers in which each includes the one before, be it through others. The first is
alone. All that stands before a later one is among what it includes itself, so nothing that it declares sees more than it
would alone; and what it includes has a chain, too. That asks for includes at its top: a header that declares something
before an include begins a chain. The flags are those of the last; what those of the others may lack, check_includes.py sees.
"""

import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

from boxes import INCLUDE_ROOTS, declared_boxes


def compilations(build):
    """[source, output, the compiler and its flags] for each entry of the compilation database."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        words = shlex.split(entry["command"])
        output = words.index("-o")
        compiler = next(place for place, word in enumerate(words) if not re.search(r"ccache|distcc", word))
        yield pathlib.Path(entry["file"]), words[output + 1], words[compiler:output]


def flags_of_boxes(build):
    """{folder of a box relative to the project: the compiler and its flags}"""
    flags = {}
    for _, output, words in compilations(build):
        if match := re.match(r"(.*)/CMakeFiles/dm_", output):
            flags.setdefault(match.group(1), words)
    return flags


def flags_of_all(flags):
    """A compiler with the include folders of every box, for boxes that consist of headers and have no flags of their own."""
    words = [word for command in flags.values() for word in command]
    folders = {word for word in words if word.startswith("-I")}
    foreign = {folder for mark, folder in zip(words, words[1:]) if mark == "-isystem"}
    return next(iter(flags.values())) + sorted(folders) + [word for folder in sorted(foreign) for word in ("-isystem", folder)]


def compiled(command, files, build):
    """What became of a compilation that includes these files, and then again if they are headers."""
    text = "".join(f'#include "{path}"\n' for path in files) * (2 if files[0].suffix == ".hpp" else 1)
    return subprocess.run([*command, "-fsyntax-only", "-x", "c++", "-"], input=text, cwd=build, capture_output=True, text=True,
                          check=False)


def reached(headers, root):
    """{header: those of the others that it includes, be it through others}"""
    includes = {header: re.findall(r'^\s*#\s*include\s*["<]([^">]+)', header.read_text(), re.MULTILINE) for header in headers}
    direct = {header: {path for name in names for top in INCLUDE_ROOTS if (path := root / top / name) in includes}
              for header, names in includes.items()}
    found = {}

    def visit(header):
        if header not in found:
            found[header] = set()
            found[header] = direct[header].union(*map(visit, direct[header])) - {header}
        return found[header]

    return {header: visit(header) for header in headers}


def declares_before_an_include(header):
    """Whether there is a line of code above the last include."""
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", header.read_text(), flags=re.DOTALL)
    *parts, _ = re.split(r"^\s*#\s*include\b.*$", text, flags=re.MULTILINE)
    return any(re.search(r"^\s*[^#\s]", part, re.MULTILINE) for part in parts)


def chains(headers, root):
    """All headers in lists, in which each includes the one before."""
    within = reached(headers, root)
    left = set(headers)
    for header in sorted(headers, key=lambda header: (-len(within[header]), header)):
        chain = []
        while header in left:
            left.remove(header)
            chain.insert(0, header)
            if not declares_before_an_include(header):
                header = max(within[header] & left, key=lambda other: (len(within[other]), other), default=header)
        if chain:
            yield chain


def errors(commands, files, build):
    """[file, the compiler's errors] for those of a chain's files that do not compile alone."""
    if (result := compiled(commands[files[-1]], files, build)).returncode == 0:
        return []
    if len(files) == 1:
        return [(files[0], result.stderr)]
    return [failed for path in files for failed in errors(commands, [path], build)] or [(files[-1], result.stderr)]


def main():
    root, build = (pathlib.Path(argument).resolve() for argument in sys.argv[-2:])
    flags = flags_of_boxes(build)
    all_flags = flags_of_all(flags)
    own_flags = {source: words for source, _, words in compilations(build)}
    headers, sources = {}, {}
    for box in declared_boxes(root):
        folder = str(box.folder.relative_to(root))
        if box.sources and folder not in flags:
            continue  # an option left it out of this build
        command = flags.get(folder, all_flags)
        headers.update({header: command for header in sorted(box.folder.glob("*.hpp"))})
        for source in sorted(box.folder.glob("*.cpp")) if "--sources" in sys.argv else []:
            sources[source] = own_flags.get(source, command)
    commands = headers | sources
    together = [*chains(headers, root), *([source] for source in sources)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        failed = [each for found in pool.map(lambda files: errors(commands, files, build), together) for each in found]
    for path, message in failed:
        print(f"{path.relative_to(root)} does not compile alone:\n{message}")
    print(f"{len(commands)} files, {len(failed)} of which do not compile alone")
    sys.exit(1 if failed or not commands else 0)


if __name__ == "__main__":
    main()
