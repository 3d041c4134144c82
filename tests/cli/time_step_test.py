#!/usr/bin/env python3
"""Meshes that are to allow a time step: what the program says, against Courant numbers computed from the files alone.

usage: time_step_test.py DRIFTMESH [unittest options]
"""

import json
import math
import os
import pathlib
import random
import re
import subprocess

import program
from program import Cli, main


class Depths:
    """Random depths on a grid, and the file that has them."""

    def __init__(self, rng, west, south, size):
        self.columns, self.rows = rng.randrange(3, 30), rng.randrange(3, 30)
        self.west, self.south, self.step = west, south, size / (min(self.columns, self.rows) - 1)
        deepest = 2 ** rng.uniform(2, 5)
        self.values = [[round(rng.uniform(0, deepest), 3) for _ in range(self.columns)] for _ in range(self.rows)]

    def write(self, path):
        lines = [f"ncols {self.columns}", f"nrows {self.rows}", f"xllcenter {self.west!r}",
                 f"yllcenter {self.south!r}", f"cellsize {self.step!r}"]
        path.write_text("\n".join(lines + [" ".join(map(str, row)) for row in reversed(self.values)]) + "\n")

    def at(self, x, y):
        u = min(max((x - self.west) / self.step, 0), self.columns - 1)
        v = min(max((y - self.south) / self.step, 0), self.rows - 1)
        i, j = min(int(u), self.columns - 2), min(int(v), self.rows - 2)
        s, t = u - i, v - j
        below, above = self.values[j], self.values[j + 1]
        return ((1 - s) * (1 - t) * below[i] + s * (1 - t) * below[i + 1] + (1 - s) * t * above[i]
                + s * t * above[i + 1])

    def greatest_in(self, corners):
        """At points of the grid in the triangle, and along its edges, where it is quadratic between lines."""
        (ax, ay), (bx, by), (cx, cy) = corners
        places = []
        for (px, py), (qx, qy) in ((corners[0], corners[1]), (corners[1], corners[2]), (corners[2], corners[0])):
            cuts = {0, 1}
            for first, p, q, count in ((self.west, px, qx, self.columns), (self.south, py, qy, self.rows)):
                cuts.update((first + k * self.step - p) / (q - p) for k in range(count)
                            if min(p, q) < first + k * self.step < max(p, q))
            cuts = sorted(cuts)
            ways = [a + k / 12 * (b - a) for a, b in zip(cuts, cuts[1:]) for k in range(13)]
            places += [(px + t * (qx - px), py + t * (qy - py)) for t in ways]
        for j in range(self.rows):
            for i in range(self.columns):
                x, y = self.west + i * self.step, self.south + j * self.step
                sides = [(bx - ax) * (y - ay) - (by - ay) * (x - ax), (cx - bx) * (y - by) - (cy - by) * (x - bx),
                         (ax - cx) * (y - cy) - (ay - cy) * (x - cx)]
                if min(sides) >= 0:
                    places.append((x, y))
        return max(self.at(x, y) for x, y in places)


def read_mesh(stem):
    """Points and triangles of Triangle's files, which count from 0 or 1."""
    rows = lambda end: [line.split() for line in stem.with_suffix(end).read_text().splitlines()
                        if line.strip() and not line.startswith("#")]
    nodes, elements = rows(".node")[1:], rows(".ele")[1:]
    at = {row[0]: (float(row[1]), float(row[2])) for row in nodes}
    return [tuple(at[number] for number in row[1:4]) for row in elements]


def outline(rng, points, radius):
    """A star-shaped polygon as a .poly."""
    ring = []
    for k in range(points):
        angle = 2 * math.pi * (k + rng.uniform(-0.3, 0.3)) / points
        far = radius * rng.uniform(0.6, 1)
        ring.append((far * math.cos(angle), far * math.sin(angle)))
    nodes = "".join(f"{k} {x!r} {y!r}\n" for k, (x, y) in enumerate(ring))
    return f"{points} 2 0 0\n{nodes}{points} 1\n" + "".join(f"{k} {k} {(k + 1) % points} 1\n" for k in range(points)) + "0\n"


class TimeSteps(Cli):
    def setUp(self):
        super().setUp()
        seed = int(os.environ.get("DRIFTMESH_SEED", "1"))
        print(f"{self.id()}: DRIFTMESH_SEED={seed}")
        self.rng = random.Random(f"{seed} {self.id()}")

    def draw(self, points, radius=1e4):
        (self.folder / "coast.poly").write_text(outline(self.rng, points, radius))
        self.depths = Depths(self.rng, -radius, -radius, 2 * radius)
        self.depths.write(self.folder / "depth.asc")

    def test_the_step_that_holds_is_that_of_the_files(self):
        for points in (7, 25, 60):
            self.draw(points)
            step, speed = self.rng.uniform(10, 40), self.rng.choice([0, 1.5])
            asked = ["--raster", "depth=depth.asc", "--depth", "depth", "--courant-step", step]
            asked += ["--courant-speed", speed] if speed else []
            altitude = self.rng.random() < 0.5
            asked += ["--courant-length", "altitude"] if altitude else []
            said = self.succeed("mesh", "coast.poly", *asked, "--area", 3e5, "-o", "mesh.node",
                                "--json", "run.json")
            record = json.loads((self.folder / "run.json").read_text())["time_step"]
            steps = []
            for corners in read_mesh(self.folder / "mesh"):
                edges = [math.dist(corners[k], corners[k - 1]) for k in range(3)]
                (ax, ay), (bx, by), (cx, cy) = corners
                twice = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
                length = twice / max(edges) if altitude else min(edges)
                steps.append(0.5 * length / (math.sqrt(9.81 * max(1, self.depths.greatest_in(corners))) + speed))
            self.assertAlmostEqual(record["holds"] / min(steps), 1, delta=2e-3)
            self.assertGreaterEqual(record["triangles_above"], sum(s < step * 0.998 for s in steps))
            self.assertLessEqual(record["triangles_above"], sum(s < step * 1.002 for s in steps))
            told = re.search(r"^time step    (\S+) s holds \(Courant 0.5\)", said, re.MULTILINE)
            self.assertAlmostEqual(float(told.group(1)) / min(steps), 1, delta=3e-3)
            checked = self.run_program("check", "mesh.node", "coast.poly", *asked, "--area", 3e5, "--angle", 20)
            self.assertEqual(checked.returncode, 0, checked.stdout)
            told = re.search(r"^time step      (\S+) s holds", checked.stdout, re.MULTILINE)
            self.assertAlmostEqual(float(told.group(1)) / min(steps), 1, delta=3e-3)
            strict = self.run_program("check", "mesh.node", "coast.poly", *asked, "--area", 3e5, "--strict")
            self.assertEqual(strict.returncode, 1 if record["triangles_above"] else 0)
            self.assertEqual("large Courant number" in strict.stdout, record["triangles_above"] > 0)

    def test_strict_refuses_a_mesh_whose_outline_is_too_fine(self):
        self.draw(300)
        asked = ["--raster", "depth=depth.asc", "--depth", "depth", "--courant-step", 60]
        said = self.succeed("mesh", "coast.poly", *asked, "-o", "coast.vtu")
        self.assertIn("\nedge length  as a time step of 60 s allows\n", said)
        self.assertRegex(said, r"at short segments of the input: \S+ s at \(\S+, \S+\)")
        self.assertRegex(said, r"a coarser outline: --simplify \d+")
        (self.folder / "coast.vtu").unlink()
        self.refuse("mesh", "coast.poly", *asked, "--strict", "-o", "coast.vtu",
                    says=["coast.poly", "time step of 60 s", "--simplify", "not strict"])
        self.assertFalse((self.folder / "coast.vtu").exists())

    def test_it_comes_before_sizes_and_areas(self):
        self.draw(7)
        asked = ["--raster", "depth=depth.asc", "--depth", "depth", "--courant-step", 20]
        counts = []
        for small in (["--area", 100], ["--size", "15"], ["--size-max", 15]):
            self.succeed("mesh", "coast.poly", *asked, *small, "-o", "coast.vtu", "--json", "run.json")
            counts.append(json.loads((self.folder / "run.json").read_text())["mesh"]["triangles"])
            self.succeed("check", "coast.vtu", "coast.poly", *asked, *small, "--angle", 20)
        self.assertLess(max(counts) / min(counts), 1.1)
        self.assertLess(max(counts), 3e8 / 100 / 20)

    def test_deleting_vertices_helps_altitudes(self):
        """The bay of the tutorial, with a channel and a trench: 18 triangles are above the bound, and would be 78."""
        west, south, step, columns, rows = -76.0, 36.89, 0.002, 190, 415
        lines = [f"ncols {columns}", f"nrows {rows}", f"xllcenter {west}", f"yllcenter {south}", f"cellsize {step}"]
        for j in reversed(range(rows)):
            y = south + j * step
            channel = -75.80 + 0.05 * math.sin(9 * (y - south))
            lines.append(" ".join(
                f"{3 + 17 * math.exp(-((x - channel) / 0.06) ** 2) + 30 * math.exp(-((y - 37.3 - 0.1 * (x + 75.8)) / 0.0008) ** 2):.2f}"
                for x in (west + step * i for i in range(columns))))
        (self.folder / "depth.asc").write_text("\n".join(lines) + "\n")
        bay = pathlib.Path(__file__).resolve().parents[2] / "examples/coast/bay.geojson"
        size = "min(44714*sqrt(9.81*depth)/400, 0.4*depth/max(slope(depth), 0.001), 400 + 0.1*distance(1, 2))"
        self.succeed("mesh", bay, "--simplify", 100, "--raster", "depth=depth.asc", "--depth", "depth", "--size", size,
                     "--courant-step", 8, "--courant-length", "altitude", "--json", "run.json")
        self.assertLess(json.loads((self.folder / "run.json").read_text())["time_step"]["triangles_above"], 45)

    def test_the_mesh_is_the_same_on_threads_and_ranks(self):
        self.draw(12)
        asked = ["mesh", "coast.poly", "--raster", "depth=depth.asc", "--depth", "depth", "--courant-step", "4",
                 "--area", "4000", "-n", "9"]
        digests = set()
        for threads in ("1", "3"):
            self.succeed(*asked, "--threads", threads, "--json", "run.json")
            digests.add(json.loads((self.folder / "run.json").read_text())["mesh"]["digest"])
        for ranks in ("1", "2"):
            run = subprocess.run(["mpirun", "-n", ranks, program.PATH, *asked, "--json", "run.json"], cwd=self.folder,
                                 capture_output=True, text=True, timeout=program.MESHER_SECONDS, check=False,
                                 env=program.RANKS_ENVIRONMENT)
            self.assertEqual(run.returncode, 0, run.stderr)
            record = json.loads((self.folder / "run.json").read_text())
            digests.add(record["mesh"]["digest"])
            self.assertIn("holds", record["time_step"])
        self.assertEqual(len(digests), 1)

    def test_what_makes_no_sense_is_refused(self):
        self.draw(7)
        raster = ["--raster", "depth=depth.asc"]
        self.refuse("mesh", "coast.poly", "--courant-step", 5, "-o", "a.vtu", code=2, says=["--courant-step", "--depth"])
        for bound in 0.5, 0.7:  # the default and another one
            self.refuse("mesh", "coast.poly", *raster, "--depth", "depth", "--courant", bound, "-o", "a.vtu", code=2,
                        says=["--courant", "--courant-step"])
        for call in ("check", "coast.vtu", "coast.poly"), ("decompose", "coast.poly", "-n", 2):
            self.refuse(*call, "--courant", 0.5, code=2, says=["--courant", "--courant-step"])
        self.refuse("mesh", "coast.poly", "--raster", "depth=depth.asc,", "--depth", "depth", "-o", "a.vtu", code=2,
                    says=["--raster", "comma", "'depth.asc,'"])
        self.refuse("mesh", "coast.poly", *raster, "--depth", "depth", "--courant-step", 5, "--courant", 0, "-o", "a.vtu",
                    code=2, says=["--courant"])


if __name__ == "__main__":
    main()
