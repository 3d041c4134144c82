"""Pages of results (docs/results): a section for each table, with where its figures come from. All else on a page is written by
hand and stays.

    ## TITLE

    *DATE, commit COMMIT; CORES cores, PROCESSOR, COMPILER*

    <!-- table: NAME, by SCRIPT -->

    | column | ...

    NOTES
"""

import datetime
import os
import pathlib
import re
import subprocess
import sys

from marked import mark_of, marks_of

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDER = "docs/results"
ORIGIN = re.compile(r"\*(\d{4}-\d\d-\d\d), commit ([0-9a-f]{7,}(?:-dirty)?); (.+)\*")


def origin(program):
    """The line that says when, of which sources and on which machine `program` was measured."""
    version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout
    compiler = re.search(r"^compiler: (.*)$", version, re.MULTILINE)[1]
    commit = subprocess.run(["git", "-C", PROJECT, "describe", "--always", "--dirty", "--exclude=*"], check=True, capture_output=True,
                            text=True).stdout.strip()
    return f"*{datetime.date.today()}, commit {commit}; {os.cpu_count()} cores, {processor()}, {compiler}*"


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return next((line.split(":", 1)[1].strip() for line in file if line.startswith("model name")), "unknown processor")


def section(table, script, where_from):
    parts = [f"## {table.title}", where_from, mark_of(table.name, script), "\n".join(table.lines()), table.notes]
    return "\n\n".join(part for part in parts if part) + "\n"


def sections_of(text):
    """What comes before the first section, and the sections."""
    start, *sections = re.split(r"^(?=## )", text, flags=re.MULTILINE)
    return start, sections


def with_sections(text, script, tables, where_from):
    """The text of a page with these tables in place of those with the same names, new ones at its end."""
    start, sections = sections_of(text)
    made = {table.name: section(table, script, where_from) for table in tables}
    kept = []
    for old in sections:
        name = next((name for name, _ in marks_of(old)), None)
        kept.append(made.pop(name, old))
    return "\n".join(part.rstrip("\n") + "\n" for part in [start, *kept, *made.values()])


def update(script, tables, where_from, project=PROJECT):
    """Writes tables into the page of results of a script; says so if that changed it."""
    page = project / FOLDER / f"{pathlib.Path(script).stem}.md"
    old = page.read_text()
    new = with_sections(old, script, tables, where_from)
    if new != old:
        page.write_text(new)
        print(f"{page.relative_to(project)}: {', '.join(table.name for table in tables)}")


def add_option(parser):
    parser.add_argument("--update", action="store_true", help=f"also write the tables into {FOLDER}, with date, commit and machine")


def show(script, tables, options):
    """Prints the tables of suites, each as soon as it is there, and with --update also writes it into the page of results."""
    where_from = origin(options.program) if options.update else None  # before anything here has changed
    for table in tables:
        print(table.markdown(), flush=True)
        if where_from:
            update(script, [table], where_from)


if __name__ == "__main__":  # for scripts of the shell: results.py DRIFTMESH prints the line of its origin
    print(origin(sys.argv[1]))
