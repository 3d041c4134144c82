#!/usr/bin/env python3
"""What it costs to limit the growth of sizes: processor time for each triangle with --gradation against without, by rules of coastal
modelers on examples/coast/bay.geojson and a raster made here; prints a table in Markdown
(docs/results/gradation.md). Both alternate; figures are medians.

usage: gradation.py [--program DRIFTMESH] [--finer FACTOR] [--gradation G] [--repetitions N] [--update]
"""

import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

PROJECT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(PROJECT / "scripts" / "tables"))
import results  # noqa: E402
from table import Table  # noqa: E402

TIDE, SLOPE, COAST, CFL = ("44714*sqrt(9.81*depth)/400", "0.4*depth/max(slope(depth), 0.001)", "400 + 0.1*distance(1, 2)",
                           "8*sqrt(9.81*depth)/0.5")
RULES = {"wave length": TIDE, "distance to the coast": COAST, "steep, near the coast": "min(2000, 100 + distance(1, 2))",
         "slope of the bottom": f"max({CFL}, {SLOPE})", "all of the tutorial": f"max({CFL}, min({TIDE}, {SLOPE}, {COAST}))"}


def write_depths(path):
    """A channel, and a trench across it, as in docs/tutorials/coast.md."""
    west, south, step, columns, rows = -76.0, 36.89, 0.002, 190, 415
    lines = [f"ncols {columns}", f"nrows {rows}", f"xllcenter {west}", f"yllcenter {south}", f"cellsize {step}"]
    for j in reversed(range(rows)):
        y = south + step * j
        channel = -75.80 + 0.05 * math.sin(9 * (y - south))
        depths = [3 + 17 * math.exp(-((x - channel) / 0.06) ** 2) + 30 * math.exp(-((y - 37.3 - 0.1 * (x + 75.8)) / 0.0008) ** 2)
                  for x in (west + step * i for i in range(columns))]
        lines.append(" ".join(f"{depth:.2f}" for depth in depths))
    path.write_text("\n".join(lines) + "\n")


def run(command, folder):
    """Processor seconds of the process and triangles of its mesh."""
    record = folder / "record.json"
    process = subprocess.Popen([*map(str, command), "--json", record, "--quiet"])
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{command} ended with {process.returncode}")
    return usage.ru_utime + usage.ru_stime, json.loads(record.read_text())["mesh"]["triangles"]


def measured(options):
    finer = "" if options.finer == 1 else f", lengths divided by {options.finer:g}"
    table = Table("gradation" if options.finer == 1 else f"gradation-{options.finer:g}", f"--gradation {options.gradation:g}{finer}",
                  ["rule", "triangles", "microseconds for each", "with --gradation, triangles", "microseconds for each", "ratio"],
                  f"Processor time of whole processes in one piece; medians of {options.repetitions}.")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_depths(folder / "depth.asc")
        for title, rule in RULES.items():
            plain = [options.program, "mesh", PROJECT / "examples/coast/bay.geojson", "--raster", f"depth={folder / 'depth.asc'}",
                     "--size", f"({rule})/{options.finer}", "--subdomains", 1, "--threads", 1]
            pairs = [(run(plain, folder), run([*plain, "--gradation", options.gradation], folder)) for _ in range(options.repetitions)]
            (_, count), (_, graded_count) = pairs[0]
            seconds, graded = (statistics.median(pair[k][0] for pair in pairs) for k in (0, 1))
            each, graded_each = seconds / count * 1e6, graded / graded_count * 1e6
            table.add(title, count, f"{each:.2f}", graded_count, f"{graded_each:.2f}", f"{graded_each / each:.1f}")
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh")
    parser.add_argument("--finer", type=float, default=1, help="divides all lengths")
    parser.add_argument("--gradation", type=float, default=0.3)
    parser.add_argument("--repetitions", type=int, default=3)
    results.add_option(parser)
    options = parser.parse_args()
    results.show("bench/gradation.py", map(measured, [options]), options)


if __name__ == "__main__":
    main()
