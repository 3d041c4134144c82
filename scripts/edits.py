#!/usr/bin/env python3
"""What to build and run after an edit, with the time that it takes: the table `edits` in docs/development.md.

usage: scripts/edits.py [--update] [BUILD_FOLDER]        measures on an idle machine, in build/ci without more, and prints the table
       scripts/edits.py --check BUILD_FOLDER             the files exist, the targets too, and each command runs some test
"""

import pathlib
import re
import subprocess
import sys
import time

PROJECT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(PROJECT / "scripts" / "tables"))

import marked  # pylint: disable=wrong-import-position

PAGE = PROJECT / "docs" / "development.md"

# What is edited, an example of it, the targets to build, what ctest is to run.
EDITS = [
    ("the mesher", "src/mesh/refiner.cpp", "unit_tests", "-L ^mesh$ -L ^unit$"),
    ("its headers", "src/mesh/refiner.hpp", "unit_tests property_tests", "-L ^mesh$"),
    ("input and repair", "src/pslg/planarize.cpp", "unit_tests property_tests", "-L ^pslg$"),
    ("sizes", "src/sizing/gradation.cpp", "unit_tests property_tests", "-L ^sizing$"),
    ("a file format", "src/io/vtu_writer.cpp", "unit_tests", "-L ^io$"),
    ("decomposition", "src/decompose/decompose.cpp", "unit_tests property_tests", "-L ^decompose$"),
    ("subdomains", "migration/subdomain.cpp", "unit_tests property_tests", "-L ^migration$ -LE mpi"),
    ("the protocol", "protocol/rank_protocol.cpp", "protocol_tests", "-L ^protocol$ -LE mpi"),
    ("balancing", "balancer/controller.cpp", "unit_tests property_tests", "-L ^(balancer|policies)$ -LE mpi"),
    ("jobs and keys", "src/job/check.cpp", "unit_tests", "-L ^(job_simulated|api_simulated|config)$"),
    ("the command line", "src/cli/command_line.cpp", "unit_tests driftmesh", "-R command_line_test|cli_errors_test"),
    ("a test", "tests/unit/mesher_test.cpp", "unit_tests", "-R ^mesher_test$"),
    ("a document", "docs/glossary.md", "", "-L documents -LE long"),
]


def timed(command):
    start = time.monotonic()
    done = subprocess.run(command, cwd=PROJECT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"edits.py: {' '.join(map(str, command))} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return time.monotonic() - start


def build(folder, targets):
    return timed(["cmake", "--build", folder, "--target", *targets.split()]) if targets else 0


def ctest(folder, choice, *more):
    return ["ctest", "--test-dir", folder, "-j2", *more, *choice.split(" ")]


def measured(folder):
    everything = " ".join(sorted({target for _, _, targets, _ in EDITS for target in targets.split()}))
    build(folder, everything)
    for what, file, targets, choice in EDITS:
        (PROJECT / file).touch()
        seconds = build(folder, targets), timed(ctest(folder, choice))
        build(folder, everything)  # what this edit left to do
        shown = re.sub(r"\|", r"\\|", choice)
        yield f"| {what}: `{file}` | {f'`{targets}`' if targets else ''} | `{shown}` | {seconds[0]:.0f} | {seconds[1]:.0f} |"


def faults(folder):
    known = subprocess.run(["ninja", "-C", folder, "-t", "targets", "all"], capture_output=True, text=True, check=True).stdout
    shown = marked.lines_below(PAGE.read_text(), "scripts/edits.py").get("edits", [])
    for what, file, targets, choice in EDITS:
        if not (PROJECT / file).is_file():
            yield f"{what}: there is no {file}"
        for target in targets.split():
            if not re.search(rf"^{target}: ", known, re.MULTILINE):
                yield f"{what}: there is no target {target}"
        chosen = subprocess.run(ctest(folder, choice, "-N"), cwd=PROJECT, capture_output=True, text=True, check=True).stdout
        if "Total Tests: 0" in chosen:
            yield f"{what}: ctest {choice} runs nothing"
        if not any(f"`{file}`" in row and all(target in row for target in targets.split()) for row in shown):
            yield f"{what}: {PAGE.name} does not show it; run scripts/edits.py --update"


def main():
    options = [word for word in sys.argv[1:] if word.startswith("-")]
    folder = pathlib.Path(next((word for word in sys.argv[1:] if not word.startswith("-")), PROJECT / "build" / "ci")).resolve()
    if set(options) - {"--update", "--check"}:
        sys.exit(__doc__)
    if "--check" in options:
        found = list(faults(folder))
        print(*found, f"{len(EDITS)} edits, {len(found)} faults", sep="\n")
        sys.exit(1 if found else 0)
    table = ["| edited | build | `ctest` | build, s | tests, s |", "|---|---|---|---|---|", *measured(folder)]
    print(*table, sep="\n")
    if "--update" in options:
        PAGE.write_text(marked.with_tables(PAGE.read_text(), {"edits": table}))


if __name__ == "__main__":
    main()
