#!/usr/bin/env python3
"""Compares whole processes of driftmesh with those of Triangle, and prints tables in Markdown for docs/benchmarks.md.

Triangle's program (Debian's non-free package triangle-bin) must be on the PATH; nothing else here needs it. The two
alternate on each input, so that a busy moment of the machine affects both, and neither writes files. Figures are
medians: wall time, processor time and peak memory of the process from its start to its end, and the ratio of wall times.
Where valgrind is installed, the suite count adds the instructions and mispredicted branches that it simulates on small meshes.

usage: peers.py [front-end] [kernel] [count] [options]
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
MODELS = {"pipe": "pipe", "cylinder_flow": "cylinder-flow", "chesapeake": "bay"}
TRIANGLE = ["triangle", "-pNEPQ"]
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
        kind, *parameters = {"points": ("random-points", "--points", 1_000_000, "--segments", 100_000),
                             "more-points": ("random-points", "--points", 10_000_000, "--segments", 1_000_000),
                             "holes": ("holes", "--columns", 300, "--rows", 300),
                             "rectangle": ("rectangle-hole",), **{m: (k,) for m, k in MODELS.items()},
                             "key": ("rectangle-hole", "--sides", 50)}[name]
        subprocess.run([self.options.program, "generate", kind, *map(str, parameters), "-o", path], check=True)


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


def print_table(options, rows):
    print("| input | driftmesh s | Triangle s | ratio | CPU s | CPU s | MiB | MiB |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for title, ours, theirs in rows:
        own, peer = compare(options, ours, theirs)
        print(f"| {title} | {own[0]:.3f} | {peer[0]:.3f} | {own[0] / peer[0]:.2f} | {own[1]:.3f} | {peer[1]:.3f} "
              f"| {own[2] / MEBIBYTE:.0f} | {peer[2] / MEBIBYTE:.0f} |", flush=True)
    print()


def front_end(options, inputs):
    """Where reading, triangulation and the start of the program count."""
    rows = [(f"chesapeake, no area bound, {angle} degrees", "chesapeake", angle) for angle in (20, 30, 33)]
    rows += [("1 M points, 100 k segments, triangulation", "points", 0), ("rings of 1 M points, 20 degrees", "annulus", 20),
             ("90,000 holes, triangulation", "holes", 0), ("key, 20 degrees", "key", 20)]
    if options.large:
        rows.append(("10 M points, 1 M segments, triangulation", "more-points", 0))
    print_table(options, [(title, *commands(options, inputs, name, angle)) for title, name, angle in rows])


def area_for(options, inputs, name, triangles):
    """The area bound with which driftmesh makes about this many triangles."""
    text = subprocess.run([options.program, "mesh", inputs.path(name), "--triangles", str(triangles)], check=True,
                          capture_output=True, text=True).stdout
    return float(re.search(r"at most ([-+.e0-9]+) requested", text).group(1))


def kernel(options, inputs):
    """Where refinement to an area bound counts."""
    rows = []
    for name in (*MODELS, "rectangle"):
        area = area_for(options, inputs, name, options.size)
        rows.append((f"{name}, {options.size / 1e6:.3g} M triangles", *commands(options, inputs, name, 20, area)))
    print_table(options, rows)


def count(options, inputs):
    """Instructions and mispredicted branches for each triangle, simulated."""
    if shutil.which("valgrind") is None:
        sys.exit("peers.py: count needs valgrind")
    print("| input | instructions, driftmesh | Triangle | mispredictions, driftmesh | Triangle |")
    print("| --- | --- | --- | --- | --- |")
    triangles = 100_000
    for name in (*MODELS, "rectangle"):
        area = area_for(options, inputs, name, triangles)
        figures = [simulated(command, triangles) for command in commands(options, inputs, name, 20, area)]
        print(f"| {name} | {figures[0][0]:.0f} | {figures[1][0]:.0f} | {figures[0][1]:.2f} | {figures[1][1]:.2f} |",
              flush=True)
    print()


def simulated(command, triangles):
    result = subprocess.run(["valgrind", "--tool=callgrind", "--branch-sim=yes", "--callgrind-out-file=/dev/null",
                             *map(str, command)], check=True, capture_output=True, text=True)
    totals = {}
    for what in ("Collected", "Mispredicts"):
        line = re.search(rf"{what}\s*:\s*([\d,]+)", result.stderr)
        totals[what] = int(line.group(1).replace(",", ""))
    return totals["Collected"] / triangles, totals["Mispredicts"] / triangles


SUITES = {"front-end": front_end, "kernel": kernel, "count": count}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("suites", nargs="*", metavar="SUITE", help="front-end, kernel or count; all but count by default")
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh")
    parser.add_argument("--data", default=PROJECT.parent / "shared/data", help="folder of the published models")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--size", type=int, default=4_000_000, help="triangles of the suite kernel")
    parser.add_argument("--large", action="store_true", help="10 million points, too")
    options = parser.parse_args()
    for suite in options.suites:
        if suite not in SUITES:
            parser.error(f"there is no suite '{suite}'; choose from {', '.join(SUITES)}")
    if shutil.which(TRIANGLE[0]) is None:
        sys.exit("peers.py: Triangle's program is not on the PATH; Debian has it in non-free, as triangle-bin")
    with tempfile.TemporaryDirectory() as folder:
        inputs = Inputs(options, folder)
        for suite in options.suites or ("front-end", "kernel"):
            print(f"{suite}: {SUITES[suite].__doc__}\n")
            SUITES[suite](options, inputs)


if __name__ == "__main__":
    main()
