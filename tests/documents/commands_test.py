#!/usr/bin/env python3
"""The commands of a document do what it says: they are run in order, in a folder of their own, as its reader would.

usage: commands_test.py PAGE PROJECT_FOLDER BUILD_FOLDER

Indented blocks, and those fenced as sh, are commands. Remarks on lines of their own before a block say what else is to be known:

    <!-- not run: WHY -->            what it is instead, or what runs it
    <!-- small: OLD -> NEW; ... -->  words that are replaced, so that it does not take long; all must be there
    <!-- if: COMMAND -->             it is run only where this command succeeds
    <!-- file: NAME -->              the fenced block is the content of this file

A remark <!-- before: COMMANDS --> anywhere makes what the page expects to be there, and <!-- needs: PROGRAM, MODULE or /FILE ... --> at
the top names what must be installed; otherwise the exit code is 77. In the folder, which is the home, are `examples` and `configs` of the
project, and DRIFTMESH_BUILD is the folder of the build.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from typing import NamedTuple, Optional

REMARKS = ("not run", "small", "if", "file", "before")


class Block(NamedTuple):
    text: str
    file: Optional[str] = None       # what the text is written to; commands if None
    condition: Optional[str] = None  # a command


def made_small(text, changes):
    for change in changes.split("; "):
        old, new = change.split(" -> ") if " -> " in change else (change.removesuffix(" ->"), "")
        if old not in text:
            raise ValueError(f"there is no {old!r} in\n{text}")
        text = text.replace(old, new)
    return text


def blocks_of(text):
    """What to do, in order, and how many blocks of commands are not to be run."""
    blocks, skipped, remarks = [], 0, {}

    def add(content, is_commands):
        nonlocal skipped
        if "file" in remarks:
            blocks.append(Block(content, file=remarks["file"]))
        elif is_commands and "not run" in remarks:
            skipped += 1
        elif is_commands:
            small = made_small(content, remarks["small"]) if "small" in remarks else content
            blocks.append(Block(small, condition=remarks.get("if")))
        remarks.clear()

    lines = text.splitlines() + [""]
    at = 0
    while at < len(lines):
        line, end = lines[at], at + 1
        remark = re.fullmatch(r"<!-- (?:(.*?): )?(.*) -->", line)
        if remark and remark[1] == "before":
            blocks.append(Block(remark[2] + "\n"))
        elif remark:
            if remark[1] in REMARKS:
                remarks[remark[1]] = remark[2]
        elif line.startswith("```"):
            end = lines.index("```", end) + 1
            add("\n".join(lines[at + 1:end - 1]) + "\n", line == "```sh")
        elif line.startswith("    ") and not (at and lines[at - 1]):  # otherwise a list or a paragraph goes on
            while end < len(lines) and (lines[end].startswith("    ") or not lines[end]):
                end += 1
            add("".join(f"{inner[4:]}\n" for inner in lines[at:end]), True)
        elif line:
            remarks.clear()
        at = end
    return blocks, skipped


def is_there(name):
    if name.startswith("/"):
        return pathlib.Path(name).exists()
    return shutil.which(name) or subprocess.run(["/usr/bin/python3", "-c", f"import {name}"], capture_output=True,
                                                check=False).returncode == 0


def missing(text):
    needs = re.match(r"<!-- needs: (.*?) -->", text)
    return next((name for name in (needs[1].split() if needs else []) if not is_there(name)), None)


def main():
    page, project, build = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    text = page.read_text()
    if name := missing(text):
        print(f"skipped: {name} is not installed")
        return 77
    blocks, skipped = blocks_of(text)
    ran = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        environment = dict(os.environ, PATH=f"{build}:/usr/bin:{os.environ['PATH']}", PYTHONPATH=str(build / "python"),
                           OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1",
                           OMPI_MCA_rmaps_base_oversubscribe="1", DRIFTMESH_SOURCE=str(project), DRIFTMESH_BUILD=str(build),
                           LC_ALL="C.UTF-8", HOME=name)

        def shell(commands):
            return subprocess.run(["bash", "-euo", "pipefail", "-c", commands], cwd=folder, env=environment, check=False,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=250)

        for link in ("examples", "configs"):
            (folder / link).symlink_to(project / link)
        for block in blocks:
            if block.file:
                (folder / block.file).parent.mkdir(parents=True, exist_ok=True)
                (folder / block.file).write_text(block.text)
                continue
            if block.condition and shell(block.condition).returncode != 0:
                skipped += 1
                continue
            done = shell(block.text)
            ran += 1
            if done.returncode != 0:
                print(f"{page.name}: this ended with {done.returncode}:\n{block.text}\n{done.stdout}")
                return 1
    print(f"{page.name}: {ran} blocks of commands ran, {skipped} are not to be run")
    return 0


if __name__ == "__main__":
    sys.exit(main())
