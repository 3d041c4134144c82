#!/usr/bin/env python3
"""Small domains that meshers got wrong, each with what is right, in one piece, in parts and on ranks.

The areas are known exactly, or follow from corners that are projected here. The program's own check is asked as well, but it does
not decide.

usage: cases_test.py DRIFTMESH [unittest options]
"""

import math
import pathlib
import re
import unittest

import program

CASES = pathlib.Path(__file__).parent / "cases"


class Case:
    """A domain with its area, and the most triangles that it may take in one piece."""

    def __init__(self, name, area, *options, triangles=2000, tolerance=1e-9):
        self.path = CASES / name
        self.area, self.options, self.triangles, self.tolerance = area, options, triangles, tolerance


def utm(longitude, latitude, meridian):
    """Meters in the zone around a meridian, by the series of Krueger (1912) to the fourth order: better than a micrometer."""
    n = 0.0033528106647474805 / (2 - 0.0033528106647474805)
    radius = 6378137.0 / (1 + n) * (1 + n**2 / 4 + n**4 / 64)
    series = (n / 2 - 2 / 3 * n**2 + 5 / 16 * n**3 + 41 / 180 * n**4, 13 / 48 * n**2 - 3 / 5 * n**3 + 557 / 1440 * n**4,
              61 / 240 * n**3 - 103 / 140 * n**4, 49561 / 161280 * n**4)
    sine, east = math.sin(math.radians(latitude)), math.radians(longitude - meridian)
    k = 2 * math.sqrt(n) / (1 + n)
    t = math.sinh(math.atanh(sine) - k * math.atanh(k * sine))
    xi, eta = math.atan2(t, math.cos(east)), math.atanh(math.sin(east) / math.hypot(1, t))
    x = eta + sum(a * math.cos(2 * j * xi) * math.sinh(2 * j * eta) for j, a in enumerate(series, 1))
    y = xi + sum(a * math.sin(2 * j * xi) * math.cosh(2 * j * eta) for j, a in enumerate(series, 1))
    return 500000 + 0.9996 * radius * x, 0.9996 * radius * y + (10e6 if latitude < 0 else 0)


def area_in_utm(meridian, *corners):
    """Of a polygon whose corners are longitudes and latitudes, with straight edges in the plane of UTM."""
    plane = [utm(*corner, meridian) for corner in corners]
    following = plane[1:] + plane[:1]
    return sum((a[0] - plane[0][0]) * (b[1] - plane[0][1]) - (b[0] - plane[0][0]) * (a[1] - plane[0][1])
               for a, b in zip(plane, following)) / 2


AREAS = [
    Case("A-duplicate-f.poly", 2),
    Case("A-duplicate-h.poly", 16 - 2 * 0.15),
    Case("B-near-origin.poly", 1.5),
    Case("D-sliver-1mm.geojson", 2 * 1000 * 1000 - 0.001 * 1000 / 2, triangles=1000),
    Case("F-hole-crosses.geojson", 90),
    Case("F-holes-overlap.geojson", 75),
    Case("F-polygon-over-hole.geojson", 46),
    Case("I-touching-ring.poly", 94, "--holes", "nested"),
    Case("J-doubled-clip-edge.geojson", 80),
    Case("J-pocket.geojson", 90),
    Case("K-two-holes.geojson", 489),
    Case("G-open-ring.poly", 100 * 100 - 20 * 20 - 10 * 10),
    Case("H-pinched.poly", 100 * 100 - 20 * 30 / 2),
    Case("L-nad83.geojson", area_in_utm(-69, (-70, 41), (-69.9, 41), (-69.9, 41.1), (-70, 41.1)), tolerance=1e-8),
    # Vertices that lie on edges in degrees stay on them in meters: those of lines move, those of polygons bend the edge.
    Case("E-open-line.geojson", area_in_utm(-69, (-71, 40), (-69, 40), (-69, 42), (-71, 42)), tolerance=1e-8, triangles=500),
    Case("E-polygons-in-a-T.geojson",
         area_in_utm(-69, (-71, 40), (-69, 40), (-69, 41), (-69, 42), (-70, 42), (-71, 42), (-71, 41)), tolerance=1e-8),
    Case("M-dateline-cut.geojson",
         area_in_utm(177, (177.2, -19), (180, -19), (181.5, -19), (181.5, -16), (180, -16), (177.2, -16)), tolerance=1e-8),
    Case("M-dateline-wrapped.geojson", area_in_utm(-177, (-177.1, 48.6), (-180.4, 49), (-180.7, 47.5), (-178.6, 47.1)),
         tolerance=1e-8),
]


class Cases(program.Cli):
    def area_of(self, mesh):
        """From the files of Triangle, which are easy to read."""
        self.succeed("convert", mesh, "area.node")
        rows = [line.split() for line in (self.folder / "area.node").read_text().splitlines() if not line.startswith("#")]
        points = {row[0]: (float(row[1]), float(row[2])) for row in rows[1:] if row}
        rows = [line.split() for line in (self.folder / "area.ele").read_text().splitlines() if not line.startswith("#")]
        total, count = 0.0, 0
        for row in rows[1:]:
            if not row:
                continue
            a, b, c = (points[v] for v in row[1:4])
            total += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2
            count += 1
        return total, count

    def judge(self, case, how):
        area, triangles = self.area_of("mesh.vtu")
        self.assertLess(abs(area - case.area), case.tolerance * case.area + 1e-12, f"{case.path.name} {how}: {area}")
        self.assertLess(triangles, case.triangles, f"{case.path.name} {how}")
        self.succeed("check", "mesh.vtu", case.path, *case.options, "--quiet")

    def test_areas_in_one_piece_and_in_parts(self):
        for case in AREAS:
            for pieces in (1, 16, 60):
                with self.subTest(case=case.path.name, pieces=pieces):
                    area = () if pieces == 1 else ("--area", case.area / 200)
                    self.succeed("mesh", case.path, *case.options, *area, "-n", pieces, "-o", "mesh.vtu")
                    self.judge(case, f"in {pieces}")

    def test_areas_on_ranks(self):
        for case in AREAS:
            for ranks in (2, 5):
                with self.subTest(case=case.path.name, ranks=ranks):
                    run = self.on_ranks(ranks, "mesh", case.path, *case.options, "-n", 3 * ranks, "-o", "mesh.vtu")
                    self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
                    self.judge(case, f"on {ranks}")


    def in_parts(self, path, pieces):
        """The triangles of a mesh in parts, and the edges on separators."""
        self.succeed("mesh", path, "-n", pieces, "-o", "mesh.node", "--max-triangles", 100_000)
        self.succeed("check", "mesh.node", path, "--quiet")
        separator = re.compile(r"\s-1000000$", re.MULTILINE)  # their marker
        return (int((self.folder / "mesh.ele").read_text().split()[0]),
                len(separator.findall((self.folder / "mesh.poly").read_text())))

    def test_separators_leave_no_slits(self):
        for name, alone in [("C-slit-best3.node", 434), ("C-slit-best4.node", 179), ("C-turned-grid-mm.node", 4856),
                            ("C-turned-grid-nm.node", 9534)]:
            for pieces in (2, 16, 60):
                with self.subTest(case=name, pieces=pieces):
                    triangles, separators = self.in_parts(CASES / name, pieces)
                    self.assertLessEqual(triangles, 1.1 * alone + 4 * separators)

    def test_slits_are_announced_before_the_work(self):
        needles = self.run_program("mesh", CASES / "D-needles.poly", "--max-triangles", 100_000, "-o", "mesh.vtu")
        self.assertNotEqual(needles.returncode, 0)
        self.assertRegex(needles.stderr, r"near \(.*apart")
        self.succeed("mesh", CASES / "D-needles.poly", "--snap", 1e-5, "-o", "mesh.vtu")

    def test_a_gap_is_named_and_closed(self):
        self.refuse("mesh", CASES / "N-gap.geojson", "-o", "mesh.vtu", says=["apart"])
        self.succeed("mesh", CASES / "N-gap.geojson", "--snap", 0.02, "-o", "mesh.vtu")
        area = area_in_utm(-69, (-70, 41), (-69.9, 41), (-69.9, 41.1), (-70, 41.1))
        self.assertAlmostEqual(self.area_of("mesh.vtu")[0] / area, 1, places=6)


if __name__ == "__main__":
    program.main()
