#!/usr/bin/env python3
"""Compiles every header of the project alone, twice in a row, and with --sources every source: each includes what it needs.
Where sources are compiled together, or with a precompiled header, what one of them lacks comes from another unnoticed.

usage: check_alone.py [--sources] PROJECT_FOLDER BUILD_FOLDER

No code is made. A file is compiled with the flags that its box has in the build folder.
"""

import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

from boxes import declared_boxes


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


def compiled_alone(command, text, build):
    """The compiler's errors for the text of a source."""
    return subprocess.run([*command, "-fsyntax-only", "-x", "c++", "-"], input=text, cwd=build, capture_output=True, text=True,
                          check=False)


def main():
    root, build = (pathlib.Path(argument).resolve() for argument in sys.argv[-2:])
    flags = flags_of_boxes(build)
    all_flags = flags_of_all(flags)
    own_flags = {source: words for source, _, words in compilations(build)}
    texts = {}
    for box in declared_boxes(root):
        folder = str(box.folder.relative_to(root))
        if box.sources and folder not in flags:
            continue  # an option left it out of this build
        command = flags.get(folder, all_flags)
        for header in sorted(box.folder.glob("*.hpp")):
            texts[header] = (command, f'#include "{header}"\n' * 2)
        for source in sorted(box.folder.glob("*.cpp")) if "--sources" in sys.argv else []:
            texts[source] = (own_flags.get(source, command), f'#include "{source}"\n')
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda text: compiled_alone(*text, build), texts.values()))
    failed = [(path.relative_to(root), result.stderr) for path, result in zip(texts, results) if result.returncode != 0]
    for path, errors in failed:
        print(f"{path} does not compile alone:\n{errors}")
    print(f"{len(texts)} files, {len(failed)} of which do not compile alone")
    sys.exit(1 if failed or not texts else 0)


if __name__ == "__main__":
    main()
