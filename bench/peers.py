#!/usr/bin/env python3
"""Compares whole processes of driftmesh with those of Triangle, and prints tables in Markdown (docs/results/peers.md).

Triangle's program (Debian's non-free package triangle-bin) must be on the PATH; nothing else here needs it. The two
alternate on each input, so that a busy moment of the machine affects both, and neither writes files. Figures are
medians: wall time, processor time and peak memory of the process from its start to its end, and the ratio of wall times.
The suite triangles compares numbers of triangles and angles instead, threads compares driftmesh on one core and on all, and
sizes a size expression with a constant bound.
Where valgrind is installed, the suite count adds the instructions and mispredicted branches that it simulates on small meshes.

usage: peers.py [front-end] [kernel] [threads] [sizes] [count] [triangles] [options]
"""

import argparse
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

PROJECT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(PROJECT / "scripts" / "tables"))
import results  # noqa: E402
from table import Table  # noqa: E402

MODELS = {"pipe": "pipe", "cylinder_flow": "cylinder-flow", "chesapeake": "bay"}
# Inputs of the suite triangles besides the published models: the parameters of driftmesh generate.
COUNTED = {"bay, 400 m": ("bay", "--resolution", 400, "--seed", 41),
           "bay, ragged": ("bay", "--resolution", 300, "--roughness", 1, "--seed", 42),
           "comb": ("comb",), "comb, wide": ("comb", "--pitch", 0.15, "--width", 0.02),
           "fan": ("fan",), "fan, 10 of 30": ("fan", "--wedges", 10, "--angle", 30), "fan, corner": ("fan", "--corner"),
           "holes of 12": ("holes",), "holes of 24": ("holes", "--sides", 24, "--radius", 0.15, "--seed", 45),
           "pipe, finer": ("pipe", "--edge", 3, "--channels", 6),
           "2,000 points": ("random-points", "--points", 2000, "--segments", 300, "--seed", 49),
           "1,000 points": ("random-points", "--points", 1000, "--segments", 250, "--seed", 51),
           "polygon": ("random-polygon",),
           "polygon, jagged": ("random-polygon", "--vertices", 3000, "--jitter", 0.4, "--seed", 47),
           "hole in a rectangle": ("rectangle-hole",)}
PUBLISHED = ("A", "chesapeake", "cylinder_flow", "key", "pipe")
TRIANGLE = ["triangle", "-pNEPQ"]
ONE_PIECE = ["--subdomains", "1", "--threads", "1"]
MEBIBYTE = 1 << 20


class Inputs:
    """The inputs by name, made when they are first asked for."""

    def __init__(self, options, folder):
        self.options = options
        self.folder = pathlib.Path(folder)

    def path(self, name):
        given = pathlib.Path(self.options.data) / f"{name}.poly"
        if given.exists():
            return given
        path = self.folder / f"{name}.poly"
        if not path.exists():
            self.make(name, path)
        return path

    def make(self, name, path):
        if name == "annulus":
            return write_annulus(path, 500_000)
        kind, *parameters = COUNTED.get(name) or {"points": ("random-points", "--points", 1_000_000, "--segments", 100_000),
                             "more-points": ("random-points", "--points", 10_000_000, "--segments", 1_000_000),
                             "holes": ("holes", "--columns", 300, "--rows", 300),
                             "rectangle": ("rectangle-hole",), **{m: (k,) for m, k in MODELS.items()},
                             "key": ("rectangle-hole", "--sides", 50)}[name]
        subprocess.run([self.options.program, "generate", kind, *map(str, parameters), "-o", path], check=True,
                       stdout=subprocess.DEVNULL)


def write_annulus(path, sides):
    """Two concentric rings, as far apart as a thousandth of their radius."""
    with path.open("w") as file:
        file.write(f"{2 * sides} 2 0 0\n")
        for ring, radius in enumerate((1, 0.999)):
            for i in range(sides):
                angle = 2 * math.pi * i / sides
                file.write(f"{ring * sides + i + 1} {radius * math.cos(angle):.12g} {radius * math.sin(angle):.12g}\n")
        file.write(f"{2 * sides} 0\n")
        for ring in (0, sides):
            for i in range(sides):
                file.write(f"{ring + i + 1} {ring + i + 1} {ring + (i + 1) % sides + 1}\n")
        file.write("1\n1 0 0\n")


def run(command):
    """Wall seconds, processor seconds and peak bytes of one process."""
    start = time.perf_counter()
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    errors = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: exit code {process.returncode}\n{errors}")
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def medians(runs):
    return [statistics.median(values) for values in zip(*runs)]


def compare(options, ours, theirs):
    """Medians of both, after one run of each that is not counted."""
    run(ours), run(theirs)
    pairs = [(run(ours), run(theirs)) for _ in range(options.repetitions)]
    return medians([pair[0] for pair in pairs]), medians([pair[1] for pair in pairs])


def commands(options, inputs, name, angle, area=None):
    bounds = f"q{angle}" if angle else ""
    theirs = [TRIANGLE[0], TRIANGLE[1] + bounds + (f"a{area:.12f}" if area else ""), inputs.path(name)]
    ours = [options.program, "mesh", inputs.path(name), "--angle", angle, "--quiet"]
    return ours + (["--area", repr(area)] if area else []), theirs


def beside(name, title, options, rows):
    """A table of whole processes of both programs."""
    table = Table(name, title, ["input", "driftmesh s", "Triangle s", "ratio", "CPU s", "CPU s", "MiB", "MiB"],
                  "Pairs of columns are driftmesh's and Triangle's; from the start of a process to its end, without files written; "
                  f"medians of {options.repetitions}.")
    for what, ours, theirs in rows:
        own, peer = compare(options, ours, theirs)
        table.add(what, f"{own[0]:.3f}", f"{peer[0]:.3f}", f"{own[0] / peer[0]:.2f}", f"{own[1]:.3f}", f"{peer[1]:.3f}",
                  f"{own[2] / MEBIBYTE:.0f}", f"{peer[2] / MEBIBYTE:.0f}")
    return table


def front_end(options, inputs):
    """Where reading, triangulation and the start of the program count."""
    rows = [(f"chesapeake, no area bound, {angle} degrees", "chesapeake", angle) for angle in (20, 30, 33)]
    rows += [("1 M points, 100 k segments, triangulation", "points", 0), ("rings of 1 M points, 20 degrees", "annulus", 20),
             ("90,000 holes, triangulation", "holes", 0), ("key, 20 degrees", "key", 20)]
    if options.large:
        rows.append(("10 M points, 1 M segments, triangulation", "more-points", 0))
    return beside("front-end", "Where reading, triangulation and the start of the program count", options,
                  [(title, *commands(options, inputs, name, angle)) for title, name, angle in rows])


def area_for(options, inputs, name, triangles):
    """The area bound with which driftmesh makes about this many triangles."""
    text = subprocess.run([options.program, "mesh", inputs.path(name), "--triangles", str(triangles)], check=True,
                          capture_output=True, text=True).stdout
    return float(re.search(r"at most ([-+.e0-9]+) requested", text).group(1))


def kernel(options, inputs):
    """Where refinement to an area bound counts: in one piece, on one core."""
    rows = []
    for name in (*MODELS, "rectangle"):
        ours, theirs = commands(options, inputs, name, 20, area_for(options, inputs, name, options.size))
        rows.append((f"{name}, {options.size / 1e6:.3g} M triangles", ours + ONE_PIECE, theirs))
    return beside("kernel", "One piece, one core, 20 degrees and a bound on area", options, rows)


def threads(options, inputs):
    """Whole processes of driftmesh on one core and on all, which alternate."""
    table = Table("threads", "One core against all",
                  ["input", "one piece, one core s", "subdomains, one core s", "all cores s", "against one core", "against one piece"],
                  f"Whole processes, 20 degrees, no files written; medians of {options.repetitions} alternating runs.")
    for name in (*MODELS, "rectangle"):
        ours, _ = commands(options, inputs, name, 20, area_for(options, inputs, name, options.size))
        cases = [ours + ONE_PIECE, ours + ["--threads", "1"], ours]
        runs = [[run(case)[0] for case in cases] for _ in range(options.repetitions + 1)][1:]
        piece, one, all_cores = medians(runs)
        table.add(f"{name}, {options.size / 1e6:.3g} M triangles", f"{piece:.3f}", f"{one:.3f}", f"{all_cores:.3f}",
                  f"{one / all_cores:.2f}", f"{piece / all_cores:.2f}")
    return table


def sizes(options, inputs):
    """A quadratic size expression against a constant area bound with as many triangles: in one piece, on one core."""
    size = f"{math.sqrt(600_000 / options.size)}*(1 + 0.000004*((x - 400)^2 + (y - 300)^2))"
    sized = [options.program, "mesh", inputs.path("pipe"), "--quiet", "--size", size, *ONE_PIECE]
    text = subprocess.run([arg for arg in sized if arg != "--quiet"], check=True, capture_output=True, text=True).stdout
    number = int(re.search(r"mesh +([\d,]+) triangles", text).group(1).replace(",", ""))
    constant = commands(options, inputs, "pipe", 20, area_for(options, inputs, "pipe", number))[0] + ONE_PIECE
    one, other = compare(options, constant, sized)
    return Table("sizes", "A size expression against a constant bound",
                 ["input", "constant bound, CPU s", "size expression, CPU s", "ratio"],
                 f"As many triangles, in one piece, on one core; medians of {options.repetitions} in alternation.",
                 [(f"pipe, {number / 1e6:.3g} M triangles", f"{one[1]:.3f}", f"{other[1]:.3f}", f"{other[1] / one[1]:.2f}")])


def count(options, inputs):
    """Instructions and mispredicted branches for each triangle, simulated."""
    if shutil.which("valgrind") is None:
        sys.exit("peers.py: count needs valgrind")
    triangles = 100_000
    table = Table("count", f"Instructions and mispredicted branches for each of {triangles:,} triangles",
                  ["input", "instructions, driftmesh", "Triangle", "mispredictions, driftmesh", "Triangle"], "Simulated by valgrind.")
    for name in (*MODELS, "rectangle"):
        area = area_for(options, inputs, name, triangles)
        figures = [simulated(command, triangles) for command in commands(options, inputs, name, 20, area)]
        table.add(name, f"{figures[0][0]:.0f}", f"{figures[1][0]:.0f}", f"{figures[0][1]:.2f}", f"{figures[1][1]:.2f}")
    return table


def simulated(command, triangles):
    result = subprocess.run(["valgrind", "--tool=callgrind", "--branch-sim=yes", "--callgrind-out-file=/dev/null",
                             *map(str, command)], check=True, capture_output=True, text=True)
    totals = {}
    for what in ("Collected", "Mispredicts"):
        line = re.search(rf"{what}\s*:\s*([\d,]+)", result.stderr)
        totals[what] = int(line.group(1).replace(",", ""))
    return totals["Collected"] / triangles, totals["Mispredicts"] / triangles


def triangles(options, inputs):
    """Triangles that an angle bound alone takes, and angles below it: driftmesh / Triangle."""
    angles = (20, 25, 30, 33)
    table = Table("triangles", "Numbers of triangles by the angle bound alone",
                  ["input", *(column for angle in angles for column in (f"{angle} degrees", "ratio", "below"))],
                  "driftmesh's number before that of Triangle, their ratio, and the angles below the bound, at acute corners of the input.")
    ratios = {angle: [] for angle in angles}
    for name in (*PUBLISHED, *COUNTED):
        cells = [name]
        for angle in angles:
            (own, own_low), (peer, peer_low) = counted(options, inputs, name, angle)
            ratios[angle].append(own / peer)
            cells += [f"{own:,} / {peer:,}", f"{own / peer:.3f}", f"{own_low} / {peer_low}"]
        table.add(*cells)
    for name, of in (("median", statistics.median), ("greatest", max)):
        table.add(name, *(cell for angle in angles for cell in ("", f"{of(ratios[angle]):.3f}", "")))
    return table


def counted(options, inputs, name, angle):
    """Triangles and angles below the bound, of driftmesh and of Triangle."""
    folder = inputs.folder / "counted"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    ours, theirs = folder / "ours", folder / "theirs"
    run([options.program, "mesh", inputs.path(name), "--angle", angle, "--no-region-areas", "--quiet", "-o",
         ours.with_suffix(".node")])
    shutil.copy(inputs.path(name), theirs.with_suffix(".poly"))
    run(["triangle", f"-pPq{angle}Q", theirs.with_suffix(".poly")])
    return count_angles(ours, angle), count_angles(f"{theirs}.1", angle)


def count_angles(mesh, bound):
    """The number of triangles in a mesh of Triangle's format, and that of angles below a bound in degrees."""
    def rows(extension):
        lines = (line.split() for line in pathlib.Path(f"{mesh}{extension}").read_text().splitlines())
        _, *records = (line for line in lines if line and not line[0].startswith("#"))
        return records
    points = {row[0]: (float(row[1]), float(row[2])) for row in rows(".node")}
    corners = [[points[v] for v in row[1:4]] for row in rows(".ele")]
    low = sum(angle_at(t[k], t[k - 1], t[k - 2]) < bound - 1e-6 for t in corners for k in range(3))
    return len(corners), low


def angle_at(o, a, b):
    ax, ay, bx, by = a[0] - o[0], a[1] - o[1], b[0] - o[0], b[1] - o[1]
    return math.degrees(math.atan2(abs(ax * by - ay * bx), ax * bx + ay * by))


SUITES = {"front-end": front_end, "kernel": kernel, "threads": threads, "sizes": sizes, "count": count, "triangles": triangles}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("suites", nargs="*", metavar="SUITE", help=f"{', '.join(SUITES)}; by default the first two")
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh")
    parser.add_argument("--data", default=PROJECT.parent / "shared/data", help="folder of the published models")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--size", type=int, default=4_000_000, help="triangles of the suites kernel, threads and sizes")
    parser.add_argument("--large", action="store_true", help="10 million points, too")
    results.add_option(parser)
    options = parser.parse_args()
    for suite in options.suites:
        if suite not in SUITES:
            parser.error(f"there is no suite '{suite}'; choose from {', '.join(SUITES)}")
    if shutil.which(TRIANGLE[0]) is None:
        sys.exit("peers.py: Triangle's program is not on the PATH; Debian has it in non-free, as triangle-bin")
    with tempfile.TemporaryDirectory() as folder:
        inputs = Inputs(options, folder)
        results.show("bench/peers.py", (SUITES[suite](options, inputs) for suite in options.suites or ("front-end", "kernel")), options)


if __name__ == "__main__":
    main()
