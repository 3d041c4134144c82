#!/usr/bin/env python3
"""Runs the benchmark programs of a build, and prints their tables in Markdown (docs/results/programs.md).

usage: programs.py [TABLE...] [--build FOLDER] [--data FOLDER] [--update]
"""

import argparse
import json
import pathlib
import subprocess
import sys
from typing import Callable, NamedTuple

PROJECT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(PROJECT / "scripts" / "tables"))
import results  # noqa: E402
from table import Table  # noqa: E402


def markdown(output):
    """The columns and rows of the first table in a program's output."""
    lines = output.splitlines()
    begin = next(i for i, line in enumerate(lines) if line.startswith("|"))
    end = next((i for i in range(begin, len(lines)) if not lines[i].startswith("|")), len(lines))
    columns, _, *rows = ([cell.strip() for cell in line[1:-1].split("|")] for line in lines[begin:end])
    return columns, rows


def google_benchmark(output):
    found = json.loads(output)["benchmarks"]
    counters = sorted({key for each in found for key in each if key.endswith("per_second")})
    return (["benchmark", "processor time", *counters],
            [[each["name"], f"{each['cpu_time']:.4g} {each['time_unit']}", *(f"{each[key]:.4g}" if key in each else "" for key in counters)]
             for each in found])


class Program(NamedTuple):
    name: str         # after driftmesh_bench
    words: list
    read: Callable    # (columns, rows) from its output
    title: str
    notes: str


def suite(name, title, notes):
    return Program("", [name, "--data", "DATA"], markdown, title, notes)


JSON = ["--benchmark_format=json"]
TABLES = {
    "models": suite("models", "Whole meshes of about 10.9 million triangles", "Medians of three."),
    "cut": suite("cut", "The same, cut into parts", "As one rank refines its subdomains: one after the other, and all kept in memory."),
    "cgal": suite("cgal", "Against CGAL's Delaunay_mesher_2, at about a million triangles",
                  "CGAL gets the same bounds through a criteria class of its documented kind, with oversized triangles first."),
    "growth": suite("growth", "From 1 to 100 million triangles", "Medians of three."),
    "cdt": suite("cdt", "The triangulation alone", "Medians of three."),
    "kernel": Program("_kernel", JSON, google_benchmark, "Refinement in and out of the caches", ""),
    "work": Program("_costs", [], markdown, "What a rank's work costs", "Processor time of one thread, the least of five."),
    "migration": Program("_migration", [], markdown, "Moving and sleeping compared with refining",
                         "Pipe in 16 subdomains, each packed and unpacked right after it was refined; with freed memory kept."),
    "output": Program("_output", JSON, google_benchmark, "Ten million triangles written, read and drawn", ""),
    "planning": Program("_balancer", JSON, google_benchmark, "What rank 0 takes to plan", "With the removal of needless moves."),
    "forecast": Program("_forecast", ["-n", "200"], markdown, "Triangles made over those forecast",
                        "200 subdomains; by the forecast by which the domain was cut, and by that of each subdomain when it starts, with "
                        "the coefficients of variation over subdomains in percent."),
}


def made(name, options):
    program = TABLES[name]
    words = [str(options.data) if word == "DATA" else word for word in program.words]
    done = subprocess.run([options.build / "bench" / f"driftmesh_bench{program.name}", *words], check=True, stdout=subprocess.PIPE, text=True)
    columns, rows = program.read(done.stdout)
    return Table(name, program.title, columns, program.notes, rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=f"{', '.join(TABLES)}; by default all")
    parser.add_argument("--build", type=pathlib.Path, default=PROJECT / "build/bench", help="folder of the build; default: build/bench")
    parser.add_argument("--data", type=pathlib.Path, default=PROJECT.parent / "shared/data",
                        help="folder of the published models; missing ones are replaced by generated inputs")
    results.add_option(parser)
    options = parser.parse_args()
    if unknown := set(options.tables) - set(TABLES):
        parser.error(f"there is no table '{min(unknown)}'; choose from {', '.join(TABLES)}")
    options.program = options.build / "driftmesh"
    results.show("bench/programs.py", (made(name, options) for name in options.tables or TABLES), options)


if __name__ == "__main__":
    main()
