#!/usr/bin/env python3
"""What balancing.sh asks for. Tables by name; none: all.

usage: command.py experiments [--small] [--inputs FOLDER] [TABLE...]   a line for each experiment to run: name, file, settings, with tabs
       command.py write [--small] FOLDER [TABLE...]                    FOLDER/TABLE.md and .csv, and balancing.md with all
       command.py update FOLDER PROJECT ORIGIN [TABLE...]              the tables in documents and configurations, from FOLDER;
                                                                       ORIGIN: the line that says where they come from
"""

import argparse
import pathlib
import sys

from experiments import EXPERIMENTS
import results
from marked import marks_of, with_tables
from tables import TABLES

SCRIPT = "balancing.sh"
PATH = f"scripts/{SCRIPT}"


def chosen_tables(names):
    for name in names:
        if name not in TABLES:
            sys.exit(f"{SCRIPT}: there is no table '{name}'; there are {', '.join(TABLES)}")
    return {name: TABLES[name] for name in names or TABLES}


def list_experiments(options):
    needed = {name for table in chosen_tables(options.tables).values() for name in table.experiments}
    for name, experiment in EXPERIMENTS.items():
        if name not in needed:
            continue
        settings = experiment.all_settings(options.small, options.inputs)
        if settings is None:
            print(f"{SCRIPT}: {name} needs {experiment.input}, in a folder given with --inputs; left out", file=sys.stderr)
        else:
            print("\t".join([name, experiment.file, *settings]))


def made(folder, names):
    """The tables whose experiments have been run; of all that took time `costs` has what is there."""
    for name, table in chosen_tables(names).items():
        there = [(folder / experiment / "table.csv").exists() for experiment in table.experiments]
        if all(there) or (name == "costs" and any(there)):
            yield table.make(name, folder)


def write(options):
    tables = list(made(options.folder, options.tables))
    for table in tables:
        table.write(options.folder)
    caution = "Made with --small, where fixed costs prevail: the figures say nothing.\n\n" if options.small else ""
    text = "\n".join(table.markdown() for table in tables)
    (options.folder / "balancing.md").write_text(f"# Balancing\n\n{caution}{text}")


def pages(project):
    return sorted([*project.glob("docs/**/*.md"), *project.glob("*.md"), *project.glob("configs/**/*.yaml")])


def update(options):
    tables = list(made(options.folder, options.tables))
    results.update(PATH, tables, options.origin, options.project)
    lines = {table.name: table.lines() for table in tables}
    for page in pages(options.project):
        text = page.read_text()
        ours = {name: lines[name] for name, script in marks_of(text) if script == PATH and name in lines}
        if ours and (new := with_tables(text, ours)) != text:
            page.write_text(new)
            print(f"{page.relative_to(options.project)}: {', '.join(ours)}")


def main():
    parser = argparse.ArgumentParser(prog=SCRIPT)
    commands = parser.add_subparsers(required=True)
    for name, run, words in (("experiments", list_experiments, {}), ("write", write, {"folder": pathlib.Path}),
                             ("update", update, {"folder": pathlib.Path, "project": pathlib.Path, "origin": str})):
        command = commands.add_parser(name)
        command.set_defaults(run=run)
        for word, kind in words.items():
            command.add_argument(word, type=kind)
        command.add_argument("--small", action="store_true")
        command.add_argument("--inputs", type=pathlib.Path)
        command.add_argument("tables", nargs="*")
    options = parser.parse_args()
    options.run(options)


if __name__ == "__main__":
    main()
