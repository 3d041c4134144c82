#!/usr/bin/env python3
"""What sizes cost: processor time for each triangle of a generated bay, by size expressions and limits on growth, against a uniform bound
on area that makes about as many triangles in the same round; prints a table in Markdown (docs/results/sizes.md). Ten of the rows
are drawn at random. Figures are medians of whole processes on one thread. A second table adapts a mesh: sizes come from the points of
the last one, through the Python package beside the program, if it was built. A third one gives the same fields to Gmsh, if it is installed.

usage: sizes.py [SUITE ...] [--program DRIFTMESH] [--seed N] [--repetitions N] [--update]
"""

import argparse
import json
import os
import pathlib
import random
import shutil
import statistics
import struct
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
    """Rounds of seconds and triangles, by the lengths at points of a mesh and by a uniform bound."""
    package = pathlib.Path(options.program).resolve().parent / "python"
    run_once = [sys.executable, "-c", ADAPTED]
    environment = {**os.environ, "PYTHONPATH": str(package)}
    return [json.loads(subprocess.run(run_once, env=environment, check=True, capture_output=True).stdout)
            for _ in range(options.repetitions)]


# The same fields for both, as Gmsh's MathEval and Distance have them: F1 is the distance to all segments.
SHARED = [("40+0.0018*x", "40+0.0018*x"), ("60+0.002*sqrt((x-40000)^2+(y-40000)^2)", "60+0.002*Sqrt((x-40000)^2+(y-40000)^2)"),
          ("50+0.08*distance()", "50+0.08*F1"), ("40+0.3*distance()", "40+0.3*F1")]


def rings_of(poly):
    """Points of a .poly without attributes, and its rings of segments as lists of points."""
    rows = [line.split() for line in poly.read_text().splitlines() if line.strip() and not line.startswith("#")]
    count = int(rows[0][0])
    points = {int(row[0]): (row[1], row[2]) for row in rows[1:count + 1]}
    segments = rows[count + 2:count + 2 + int(rows[count + 1][0])]
    around = {point: [] for point in points}
    for row in segments:
        a, b = int(row[1]), int(row[2])
        around[a].append(b)
        around[b].append(a)
    rings, left = [], set(points)
    while left:
        ring = [left.pop()]
        while following := next((point for point in around[ring[-1]] if point in left), None):
            left.remove(following)
            ring.append(following)
        rings.append(ring)
    return points, rings


def write_geo(path, poly, field):
    """The outline with the largest box, without the others, and the field as Gmsh's background."""
    points, rings = rings_of(poly)
    rings.sort(key=lambda ring: max(float(points[p][0]) for p in ring) - min(float(points[p][0]) for p in ring), reverse=True)
    lines, first = [f"Point({p}) = {{{x}, {y}, 0}};" for p, (x, y) in points.items()], 1
    for k, ring in enumerate(rings, 1):
        lines += [f"Line({first + i}) = {{{a}, {b}}};" for i, (a, b) in enumerate(zip(ring, ring[1:] + ring[:1]))]
        lines.append(f"Curve Loop({k}) = {{{first}:{first + len(ring) - 1}}};")
        first += len(ring)
    lines += [f"Plane Surface(1) = {{1:{len(rings)}}};", "Field[1] = Distance;", f"Field[1].CurvesList = {{1:{first - 1}}};",
              "Field[1].NumPointsPerCurve = 3;", "Field[2] = MathEval;", f'Field[2].F = "{field}";', "Background Field = 2;",
              "Mesh.MeshSizeExtendFromBoundary = 0;", "Mesh.MeshSizeFromPoints = 0;", "Mesh.Algorithm = 5;"]
    path.write_text("\n".join(lines) + "\n")


def run_gmsh(folder):
    """Processor seconds, and the file."""
    log = folder / "gmsh.log"
    with open(log, "w") as out:
        process = subprocess.Popen(["gmsh", "-2", "-nt", "1", "-bin", folder / "bay.geo", "-o", folder / "gmsh.msh"], stdout=out, stderr=out)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"gmsh ended with {process.returncode}: {log.read_text()[-500:]}")
    return usage.ru_utime + usage.ru_stime, folder / "gmsh.msh"


def triangles_in(msh):
    """Of a binary .msh of version 4.1: the elements of its blocks of dimension 2."""
    data = msh.read_bytes()
    at = data.index(b"$Elements\n") + len(b"$Elements\n")
    blocks, total = struct.unpack_from("<QQ", data, at)[0], 0
    at += 32
    nodes = {15: 1, 1: 2, 2: 3}  # by type
    for _ in range(blocks):
        dimension, _, kind, count = struct.unpack_from("<iiiQ", data, at)
        total += count if dimension == 2 else 0
        at += 20 + count * 8 * (1 + nodes[kind])
    return total


def beside_gmsh(options):
    table = Table("sizes-gmsh", "The same fields in Gmsh",
                  ["--size", "triangles", "us for each", "Gmsh: triangles", "us for each", "ratio"],
                  f"Debian's Gmsh, `-2 -nt 1`, algorithm 5 (Delaunay), with the field as MathEval and Distance. Processor time of whole processes on "
                  f"one thread; medians of {options.repetitions}.")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([options.program, "generate", "bay", "-o", folder / "bay.poly"], check=True, capture_output=True)
        for rule, field in SHARED:
            write_geo(folder / "bay.geo", folder / "bay.poly", field)
            own, theirs = [], []
            for _ in range(options.repetitions):
                seconds, count = run([options.program, "mesh", folder / "bay.poly", "--threads", 1, "--size", rule, "-o", folder / "bay.msh"], folder)
                own.append(seconds / count * 1e6)
                seconds, msh = run_gmsh(folder)
                made = triangles_in(msh)
                theirs.append(seconds / made * 1e6)
            each, each_there = statistics.median(own), statistics.median(theirs)
            table.add(f"`{rule}`", count, f"{each:.2f}", made, f"{each_there:.2f}", f"{each_there / each:.0f}")
    return table


def on_mesh(options):
    table = Table("sizes-on-mesh", "Sizes at the points of the last mesh", COLUMNS,
                  f"`size_on_mesh` with a gradation: a front in a square has moved. Otherwise as above; medians of {options.repetitions}.")
    rounds = [(seconds / count, *rest, count) for seconds, count, *rest in adapted(options)]
    add_row(table, "lengths at the points of the last mesh", 0.3, rounds[0][3], rounds, "3.9")
    return table


def has_package(options):
    return (pathlib.Path(options.program).resolve().parent / "python" / "driftmesh").is_dir()


COLUMNS = ["--size", "--gradation", "triangles", "us for each", "as many of one area", "ratio", "before"]


def measured(options):
    table = Table("sizes", f"Sizes in a bay, seed {options.seed}",
                  COLUMNS,
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
    return table


def add_row(table, what, growth, count, rounds, before):
    """Of rounds of seconds for each triangle, and of seconds and triangles with a uniform bound."""
    each = statistics.median(r[0] for r in rounds) * 1e6
    uniform = statistics.median(r[1] / r[2] for r in rounds) * 1e6
    table.add(what, growth, count, f"{each:.2f}", f"{uniform:.2f}", f"{each / uniform:.1f}", before)


# By name: what measures, and whether it can here.
SUITES = {"sizes": (measured, lambda options: True), "on-mesh": (on_mesh, has_package),
          "gmsh": (beside_gmsh, lambda options: shutil.which("gmsh") is not None)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("suites", nargs="*", metavar="SUITE", help=f"{', '.join(SUITES)}; by default all that can be measured here")
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--repetitions", type=int, default=3)
    results.add_option(parser)
    options = parser.parse_args()
    if unknown := set(options.suites) - set(SUITES):
        parser.error(f"no suite {unknown.pop()}; there are {', '.join(SUITES)}")
    suites = [measure for name, (measure, can) in SUITES.items() if (name in options.suites if options.suites else can(options))]
    results.show("bench/sizes.py", (measure(options) for measure in suites), options)


if __name__ == "__main__":
    main()
