#!/usr/bin/env python3
"""Domains that are made from rasters: outlines at a level, what marks their sides, and stacks of rasters.

usage: contour_test.py DRIFTMESH [unittest options]
"""

import json
import math

from program import Cli, main


def grid_text(columns, rows, spacing, first, value):
    """An ESRI ASCII grid of value(x, y) at points first + (i, j) spacing; None: no value."""
    lines = [f"ncols {columns}", f"nrows {rows}", f"xllcenter {first[0]!r}", f"yllcenter {first[1]!r}", f"cellsize {spacing!r}"]
    for j in reversed(range(rows)):
        values = (value(first[0] + i * spacing, first[1] + j * spacing) for i in range(columns))
        lines.append(" ".join("-9999" if v is None else repr(float(v)) for v in values))
    return "\n".join(lines) + "\n"


def basin(x, y):
    """Depth: a shore near x = 1, an island around (6, 5), and a pond in the corner, cut off from the sea."""
    if math.hypot(x - 6, y - 5) < 2:
        return math.hypot(x - 6, y - 5) - 1
    return 1 if x < 0.35 and y < 0.35 else x - 1 + 0.1 * math.sin(3 * y)


class Contours(Cli):
    def record(self, *arguments):
        self.succeed("mesh", *arguments, "--json", "run.json")
        return json.loads((self.folder / "run.json").read_text())

    def test_the_largest_part_with_its_island_and_open_sides(self):
        self.write("depth.asc", grid_text(101, 101, 0.1, (0, 0), basin).replace("xllcenter 0", "xllcenter 1000").replace("yllcenter 0", "yllcenter 2000"))
        common = ["--raster", "depth=depth.asc", "--contour", "depth=0"]
        run = self.record(*common, "--area", "0.1", "-o", "sea.vtu", "-o", "fort.14", "--open-boundary", "3")
        # What the shore leaves of 9 x 10, without the island.
        self.assertAlmostEqual(run["mesh"]["total_area"], 90 - math.pi, delta=0.4)
        counts = [line for line in (self.folder / "fort.14").read_text().splitlines() if line.endswith("boundaries")]
        self.assertEqual(counts[0], "1 = number of open boundaries")
        self.assertIn("2 = number of land boundaries", counts)
        self.succeed("check", "sea.vtu")
        # The pond in the corner, by a seed.
        pond = self.record(*common, "--contour-seeds", "1000.1,2000.1", "--area", "0.1", "-o", "pond.vtu")
        self.assertLess(pond["mesh"]["total_area"], 0.2)
        both = self.record(*common, "--contour-seeds", "1000.1,2000.1,1004,2001", "--area", "0.1", "-o", "both.vtu")
        self.assertAlmostEqual(both["mesh"]["total_area"], pond["mesh"]["total_area"] + run["mesh"]["total_area"], delta=1e-6)
        # Within limits, and the other way around.
        part = self.record(*common, "--contour-box", "1008,2000,1010,2004", "--area", "0.1", "-o", "part.vtu")
        self.assertAlmostEqual(part["mesh"]["total_area"], 8, delta=1e-6)
        land = self.record("--raster", "depth=depth.asc", "--contour", "depth<0", "--contour-seeds", "1006,2005", "--area", "0.1", "-o", "land.vtu")
        self.assertAlmostEqual(land["mesh"]["total_area"], math.pi, delta=0.1)

    def test_simplified_outlines_and_sizes_from_the_same_raster(self):
        self.write("depth.asc", grid_text(101, 101, 0.1, (1000, 2000), lambda x, y: basin(x - 1000, y - 2000)))
        common = ["--raster", "depth=depth.asc", "--contour", "depth=0", "--size", "0.2+0.2*distance(1, 2)", "--depth", "depth"]
        fine = self.record(*common, "-o", "fine.vtu")
        coarse = self.record(*common, "--simplify", "0.1", "-o", "coarse.vtu", "-n", "5")
        self.assertLess(coarse["input"]["points"], fine["input"]["points"] / 2)
        self.succeed("check", "coarse.vtu")
        # Every command that knows an input knows this one.
        domain = common[:4]
        self.succeed("check", "fine.vtu", *domain, "--size", common[5])
        self.succeed("check", "coarse.vtu", *domain, "--simplify", "0.1")
        self.assertEqual(self.run_program("check", "fine.vtu", *domain, "--contour-box", "1000,2000,1005,2005").returncode, 1)
        self.refuse("check", "fine.vtu", "depth.asc", *domain, code=2, says=["--contour", "another one is given"])
        self.succeed("plot", *domain, "-o", "domain.svg")
        self.succeed("plot", *domain, "--size", common[5], "-o", "sizes.svg")
        self.assertNotEqual(*(len((self.folder / name).read_text()) for name in ("domain.svg", "sizes.svg")))
        self.succeed("plot", *domain)
        self.assertIn("depth.png", self.files())
        self.refuse("plot", "-o", "nothing.png", code=2, says=["INPUT is missing"])
        self.succeed("decompose", *domain, "-n", "4", "-o", "sea.decomposition", "--plot", "parts.svg")
        self.refuse("decompose", "-n", "4", code=2, says=["INPUT is missing"])

    def test_degrees_become_meters(self):
        self.write("depth.asc", grid_text(101, 101, 0.1, (0, 40), lambda x, y: basin(x, y - 40)).replace("cellsize 0.1", "cellsize 0.01"))
        run = self.record("--raster", "depth=depth.asc", "--contour", "depth=0", "--size", "2000", "-o", "sea.vtu")
        self.assertEqual(run["input"]["projection"], "UTM zone 31N")
        self.assertAlmostEqual(run["mesh"]["total_area"] / (0.869 * 111.0e3 * 85.0e3), 1, delta=0.02)

    def test_what_is_wrong_is_said(self):
        self.write("depth.asc", grid_text(11, 11, 1, (1000, 2000), lambda x, y: x - 1005))
        mesh = ["mesh", "--raster", "depth=depth.asc", "--area", "1", "-o", "a.vtu"]
        self.refuse(*mesh, "--contour", "depth", code=2, says=["--contour is 'depth'", "depth=0"])
        self.refuse(*mesh, "--contour", "deep=0", code=2, says=["'deep'", "no raster"])
        self.refuse(*mesh, "--contour", "depth=0", "square.poly", code=2, says=["another one is given"])
        self.refuse(*mesh, "--contour-box", "1,2,3,4", "square.poly", code=2, says=["--contour-box", "--contour alone"])
        self.refuse(*mesh, "--contour", "depth=0", "--contour-box", "1,2,1,4", code=2, says=["is no box"])
        self.refuse(*mesh, "--contour", "depth=0", "--contour-seeds", "1,2,3", code=2, says=["one number"])
        self.refuse(*mesh, "--contour", "depth=7", says=["depth.asc", "nowhere above 7"])
        self.refuse(*mesh, "--contour", "depth=0", "--contour-seeds", "1001,2001", says=["(1001, 2001)", "--contour-seeds"])
        self.refuse(*mesh, "--contour", "depth=0", "--contour-box", "0,0,1,1", code=1,
                    says=["depth.asc", "less than two rows or columns within --contour-box", "1000 to 1010", "2000 to 2010"])
        self.refuse(*mesh, "--contour", "depth=0", "--contour-box", "1008.2,2000,1008.9,2010", says=["within --contour-box"])
        self.write("row.asc", grid_text(11, 1, 1, (1000, 2000), lambda x, y: x - 1005))
        self.refuse("mesh", "--raster", "depth=row.asc", "--area", "1", "-o", "a.vtu", "--contour", "depth=0", says=["row.asc", "less than two rows"])

    def test_stacks_fill_gaps_and_blend(self):
        self.write("square.poly", "4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n")
        self.write("ocean.asc", grid_text(11, 11, 1, (-3, -3), lambda x, y: 10))
        # Four tiles of a survey, of which one has a gap.
        for k, first in enumerate([(1, 1), (2, 1), (1, 2), (2, 2)]):
            gap = lambda x, y: None if math.hypot(x - 2.7, y - 2.7) < 0.15 else 2
            self.write(f"tile{k}.asc", grid_text(10, 10, 0.1, (first[0] + 0.05, first[1] + 0.05), gap))
        files = "depth=tile3.asc,tile0.asc,tile2.asc,tile1.asc,ocean.asc"
        common = ["square.poly", "--raster", files, "--depth", "depth", "--area", "0.005"]
        self.succeed("mesh", *common, "-o", "a.14", "--open-boundary", "0")
        depths = {(x, y): depth for x, y, depth in self.depths("a.14")}
        seen = set()
        for (x, y), depth in depths.items():
            off = max(abs(x - 2), abs(y - 2))
            away = math.hypot(x - 2.7, y - 2.7)
            if off < 0.94 and away > 0.32:
                seen.add("upper")
                self.assertAlmostEqual(depth, 2, places=5, msg=(x, y))
            if off > 1.06 or away < 0.06:
                seen.add("gap" if away < 0.06 else "lower")
                self.assertAlmostEqual(depth, 10, places=5, msg=(x, y))
            self.assertTrue(2 - 1e-6 <= depth <= 10 + 1e-6)
        self.assertEqual(seen, {"upper", "lower", "gap"})
        # Blended over half a unit, the middle of the ramp has both halves; ordered by spacings, whatever comes first.
        self.succeed("mesh", "square.poly", "--raster", "depth=ocean.asc,tile3.asc,tile0.asc,tile2.asc,tile1.asc", "--raster-order", "finest",
                     "--raster-blend", "0.5", "--depth", "depth", "--area", "0.005", "-o", "b.14", "--open-boundary", "0")
        ramp = [depth for x, y, depth in self.depths("b.14") if abs(y - 1.7) < 0.3 and abs(x - 1.25) < 0.03]
        self.assertTrue(ramp)
        for depth in ramp:
            self.assertAlmostEqual(depth, 6, delta=2)
        # Settings name files relative to their folder; sizes, subdomains and ranks see the same stack.
        (self.folder / "sub").mkdir()
        self.write("sub/run.yaml", "input: {file: ../square.poly, rasters: {depth: '../tile0.asc,../ocean.asc'}, raster-blend: 0.2}\n"
                   "sizing: {size: 0.02*depth}\n")
        digests = set()
        for more in (["--config", "sub/run.yaml"],
                     ["square.poly", "--raster", "depth=tile0.asc,ocean.asc", "--raster-blend", "0.2", "--size", "0.02*depth"]):
            self.succeed("mesh", *more, "--json", "run.json")
            digests.add(json.loads((self.folder / "run.json").read_text())["mesh"]["digest"])
        self.assertEqual(len(digests), 1)
        self.succeed("mesh", "square.poly", "--raster", files, "--size", "0.02*depth", "-n", "4", "-o", "c.vtu")
        self.succeed("check", "c.vtu", "square.poly", "--raster", files, "--size", "0.02*depth")

    def depths(self, name):
        lines = (self.folder / name).read_text().splitlines()
        return [tuple(map(float, line.split()[1:4])) for line in lines[2:2 + int(lines[1].split()[1])]]

    def test_faults_of_stacks(self):
        self.write("square.poly", "4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n")
        self.write("a.asc", grid_text(5, 5, 1, (0, 0), lambda x, y: 1))
        self.write("far.asc", grid_text(5, 5, 1, (100, 0), lambda x, y: 1))
        self.write("odd.asc", grid_text(5, 5, 1, (0.5, 0.3), lambda x, y: 1))
        mesh = ["mesh", "square.poly", "--size", "0.3*depth"]
        self.succeed(*mesh, "--raster", "depth=far.asc,a.asc", "-o", "a.vtu")
        self.refuse(*mesh, "--raster", "depth=far.asc,far.asc", says=["far.asc", "lies elsewhere"])
        self.refuse(*mesh, "--raster", "depth=a.asc,none.asc", says=["none.asc"])
        self.refuse(*mesh, "--raster", "depth=a.asc,far.asc", "--raster-blend", "-1", code=2, says=["--raster-blend"])
        self.refuse(*mesh, "--raster", "depth=far.asc,a.asc", "-o", "a.asc", says=["a.asc"])
        self.refuse("mesh", "--raster", "depth=a.asc,odd.asc", "--contour", "depth=0", "--area", "1", says=["odd.asc", "not on one grid"])


if __name__ == "__main__":
    main()
