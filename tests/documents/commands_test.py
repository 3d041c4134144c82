#!/usr/bin/env python3
"""The commands of a document do what it says: they are run in order, in a folder of their own, as its reader would.

usage: commands_test.py PAGE PROJECT_FOLDER BUILD_FOLDER

Indented blocks are commands. A remark before a block says what else it is: <!-- not run: why -->, or <!-- file: NAME --> before
a fenced block that is written to that file. In the folder are `examples` and `configs` of the project. Without a program that a
remark <!-- needs: PROGRAM or MODULE ... --> at the top names, the exit code is 77.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

def blocks_of(text):
    """What to do, in order: a file's name and content, or None and commands; and how many blocks are not to be run."""
    blocks, skipped, remark = [], 0, ""
    lines = text.splitlines() + [""]
    at = 0
    while at < len(lines):
        line, end = lines[at], at + 1
        if line.startswith("<!-- ") and line.endswith(" -->"):
            remark = line[5:-4]
        elif line.startswith("```"):
            end = lines.index("```", end) + 1
            if remark.startswith("file: "):
                blocks.append((remark.removeprefix("file: "), "\n".join(lines[at + 1:end - 1]) + "\n"))
            remark = ""
        elif line.startswith("    ") and not (at and lines[at - 1]):  # otherwise a list or a paragraph goes on
            while end < len(lines) and (lines[end].startswith("    ") or not lines[end]):
                end += 1
            if remark.startswith("not run: "):
                skipped += 1
            else:
                blocks.append((None, "".join(f"{inner[4:]}\n" for inner in lines[at:end])))
            remark = ""
        elif line:
            remark = ""
        at = end
    return blocks, skipped


def missing(text):
    needs = re.match(r"<!-- needs: (.*?) -->", text)
    for name in needs[1].split() if needs else []:
        if not shutil.which(name) and subprocess.run(["/usr/bin/python3", "-c", f"import {name}"], capture_output=True,
                                                     check=False).returncode != 0:
            return name
    return None


def main():
    page, project, build = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    text = page.read_text()
    if name := missing(text):
        print(f"skipped: {name} is not installed")
        return 77
    blocks, skipped = blocks_of(text)
    environment = dict(os.environ, PATH=f"{build}:/usr/bin:{os.environ['PATH']}", PYTHONPATH=str(build / "python"),
                       OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1",
                       OMPI_MCA_rmaps_base_oversubscribe="1", DRIFTMESH_SOURCE=str(project), LC_ALL="C.UTF-8")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for link in ("examples", "configs"):
            (folder / link).symlink_to(project / link)
        for file, content in blocks:
            if file:
                (folder / file).parent.mkdir(parents=True, exist_ok=True)
                (folder / file).write_text(content)
                continue
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", content], cwd=folder, env=environment, check=False,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=250)
            if done.returncode != 0:
                print(f"{page.name}: this ended with {done.returncode}:\n{content}\n{done.stdout}")
                return 1
    commands = sum(1 for file, _ in blocks if file is None)
    print(f"{page.name}: {commands} blocks of commands ran, {skipped} are not to be run")
    return 0 if commands > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
