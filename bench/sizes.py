#!/usr/bin/env python3
"""What sizes cost: processor time for each triangle of a generated bay, by size expressions and limits on growth, against a uniform bound
on area that makes about as many triangles in the same round; prints a table in Markdown (docs/results/sizes.md). Ten of the rows
are drawn at random. Figures are medians of whole processes on one thread. A last row adapts a mesh: sizes come from the points of
the last one, through the Python package beside the program, if it was built.

usage: sizes.py [--program DRIFTMESH] [--seed N] [--repetitions N] [--update]
"""

import argparse
import json
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

PROJECT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(PROJECT / "scripts" / "tables"))
import results  # noqa: E402
from gradation import run  # noqa: E402
from table import Table  # noqa: E402

# What users ask for: expression, limit on growth, and microseconds for each triangle before sizes were compiled, if known.
ROWS = [("20+0.0009*x", 0, "0.42"), ("30+0.001*sqrt((x-40000)^2+(y-40000)^2)", 0, "0.40"), ("25+0.04*distance()", 0, "1.63"),
        ("20+0.15*distance()", 0, "3.10"), ("x<35000?20:200", 0.2, "0.98"), ("distance()<50?20:300", 0.15, "no mesh in 281 s")]


def drawn(generator):
    """A rule as a modeler could write it, with a limit on growth or without."""
    near, growth, most = generator.uniform(20, 40), generator.uniform(0.03, 0.2), generator.uniform(200, 600)
    x, y = generator.uniform(30000, 60000), generator.uniform(0, 90000)
    shore = f"{near:.0f}+{growth:.3f}*distance()"
    spot = f"{near:.0f}+{growth / 20:.4f}*hypot(x-{x:.0f}, y-{y:.0f})"
    wave = f"{3 * near:.0f}+{near:.0f}*sin(x/{generator.uniform(2000, 9000):.0f})*cos(y/{generator.uniform(2000, 9000):.0f})"
    rule = generator.choice([shore, f"min({most:.0f}, {shore})", spot, f"min({spot}, {shore})", wave, f"min({wave}, {shore})"])
    return rule, generator.choice([0, 0, round(generator.uniform(0.1, 0.3), 2)]), ""


# A front of small triangles has moved by four of them; prints processor seconds and triangles of the mesh that follows it, as lengths
# at the points of the last mesh ask for it, and of one with a uniform bound.
ADAPTED = """
import json, time
import driftmesh, numpy as np
square = driftmesh.Pslg(points=[[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
def lengths(mesh, radius):
    return np.where(abs(np.hypot(*(mesh.points - 0.5).T) - radius) < 0.01, 0.0006, 1.0)
last = driftmesh.mesh(square, triangles="20k")
for _ in range(3):
    last = driftmesh.mesh(square, size=driftmesh.size_on_mesh(last, lengths(last, 0.3), gradation=0.3), threads=1)
wanted = lengths(last, 0.3024)
times = [time.process_time()]
size = driftmesh.size_on_mesh(last, wanted, gradation=0.3)
times.append(time.process_time())
count = len(driftmesh.mesh(square, size=size, threads=1).triangles)
times.append(time.process_time())
uniform = len(driftmesh.mesh(square, triangles=count, threads=1).triangles)
times.append(time.process_time())
print(json.dumps([times[2] - times[0], count, times[3] - times[2], uniform]))
"""


def adapted(options):
    """Rounds of seconds and triangles, by the lengths at points of a mesh and by a uniform bound; none without the Python package."""
    package = pathlib.Path(options.program).resolve().parent / "python"
    if not (package / "driftmesh").is_dir():
        return []
    run_once = [sys.executable, "-c", ADAPTED]
    environment = {**os.environ, "PYTHONPATH": str(package)}
    return [json.loads(subprocess.run(run_once, env=environment, check=True, capture_output=True).stdout)
            for _ in range(options.repetitions)]


def measured(options):
    table = Table("sizes", f"Sizes in a bay, seed {options.seed}",
                  ["--size", "--gradation", "triangles", "us for each", "as many of one area", "ratio", "before"],
                  f"Processor time of whole processes on one thread, in microseconds for each triangle; medians of {options.repetitions}. "
                  "Before: before sizes were compiled, on another day, where a uniform bound took 0.17.")
    generator = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([options.program, "generate", "bay", "-o", folder / "bay.poly"], check=True, capture_output=True)
        mesh = [options.program, "mesh", folder / "bay.poly", "--threads", 1]
        for rule, growth, before in [*ROWS, *(drawn(generator) for _ in range(10))]:
            sized = [*mesh, "--size", rule, *(["--gradation", growth] if growth else [])]
            rounds = []
            for _ in range(options.repetitions):
                seconds, count = run(sized, folder)
                rounds.append((seconds / count, *run([*mesh, "--triangles", count], folder)))
            add_row(table, f"`{rule}`", growth or "", count, rounds, before)
    if rounds := [(seconds / count, *rest, count) for seconds, count, *rest in adapted(options)]:
        add_row(table, "lengths at the points of the last mesh (`size_on_mesh`; a front in a square)", 0.3, rounds[0][3], rounds, "3.9")
    return table


def add_row(table, what, growth, count, rounds, before):
    """Of rounds of seconds for each triangle, and of seconds and triangles with a uniform bound."""
    each = statistics.median(r[0] for r in rounds) * 1e6
    uniform = statistics.median(r[1] / r[2] for r in rounds) * 1e6
    table.add(what, growth, count, f"{each:.2f}", f"{uniform:.2f}", f"{each / uniform:.1f}", before)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--repetitions", type=int, default=3)
    results.add_option(parser)
    options = parser.parse_args()
    results.show("bench/sizes.py", map(measured, [options]), options)


if __name__ == "__main__":
    main()
