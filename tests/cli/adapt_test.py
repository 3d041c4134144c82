#!/usr/bin/env python3
"""driftmesh adapt: meshes from files, made anew as lengths at their points ask, as a whole or in part.

usage: adapt_test.py DRIFTMESH [unittest options]
"""

import math
import os
import random
import re
import struct

from program import SQUARE, Cli, main

REGIONS = """6 0
1 0 0
2 2 0
3 4 0
4 4 4
5 2 4
6 0 4
7 1
1 1 2 1
2 2 3 2
3 3 4 3
4 4 5 4
5 5 6 5
6 6 1 6
7 2 5 9
0
2
1 1 1 10
2 3 1 20
"""
REGIONS = REGIONS.replace("6 0\n", "6 2 0 0\n", 1)


def as_vtu(points, triangles, data, at_triangles={}):
    """A mesh as other programs write it: text, with names of their own, and no segments."""
    def array(name, kind, values, components=1):
        return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">'
                f'{" ".join(map(str, values))}</DataArray>')
    return (f'<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">'
            f'<UnstructuredGrid><Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(triangles)}"><PointData>'
            + "".join(array(name, "Float64", map(repr, values)) for name, values in data.items())
            + '</PointData><CellData>'
            + "".join(array(name, "Float64", (repr(v) for row in rows for v in row), len(rows[0]))
                      for name, rows in at_triangles.items())
            + '</CellData><Points>'
            + array("Points", "Float64", (repr(x) for p in points for x in (*p, 0.0)), 3) + "</Points><Cells>"
            + array("connectivity", "Int64", (v for t in triangles for v in t))
            + array("offsets", "Int64", range(3, 3 * len(triangles) + 1, 3))
            + array("types", "UInt8", [5] * len(triangles)) + "</Cells></Piece></UnstructuredGrid></VTKFile>")


def integral(points, triangles, values):
    return math.fsum(area(points, t) * sum(values[v] for v in t) / 3 for t in triangles)


def area(points, triangle):
    (ax, ay), (bx, by), (cx, cy) = (points[v] for v in triangle)
    return ((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) / 2


class Adapt(Cli):
    def table(self, name):
        rows = [line.split() for line in (self.folder / name).read_text().splitlines() if not line.startswith("#")]
        return rows[1:1 + int(rows[0][0])]

    def read(self, name):
        """Points, triangles, and values at points, as text that has all bits."""
        self.succeed("convert", name, "table.ele")
        nodes = self.table("table.node")
        first = int(nodes[0][0])
        return ([tuple(map(float, row[1:3])) for row in nodes],
                [tuple(int(v) - first for v in row[1:4]) for row in self.table("table.ele")],
                [list(map(float, row[3:])) for row in nodes])

    def mesh(self, name, poly=SQUARE, size=0.5, **data):
        """A mesh of another program: functions of the place give its point data."""
        self.write("domain.poly", poly)
        self.succeed("mesh", "domain.poly", "--area", size * size / 2, "-o", "first.vtu")
        points, triangles, _ = self.read("first.vtu")
        self.write(name, as_vtu(points, triangles, {key: [f(*p) for p in points] for key, f in data.items()}))
        return points, triangles

    def assert_beyond_stays(self, old, new, inside):
        """No point or triangle beyond a margin changes, nor its number."""
        (old_points, old_triangles), (points, triangles, _) = old, new
        stay = [t for t, corners in enumerate(old_triangles) if not any(inside(*old_points[v]) for v in corners)]
        self.assertTrue(stay)
        moved = [t for t in stay if t >= len(triangles) or triangles[t] != old_triangles[t]
                 or any(points[v] != old_points[v] for v in old_triangles[t])]
        return stay, moved


class Whole(Adapt):
    def test_lengths_are_met_and_fields_come_along(self):
        points, triangles = self.mesh("old.vtu", h=lambda x, y: 0.1 + 0.1 * x, u=lambda x, y: 2 * x - 3 * y + 1,
                                      hill=lambda x, y: math.exp(-(x - 2) ** 2 - y * y))
        out = self.succeed("adapt", "old.vtu", "--lengths", "h", "--transfer", "hill=conserve", "-o", "new.vtu")
        self.assertIn("triangles", out)
        self.succeed("check", "new.vtu", "--angle", 20)
        new_points, new_triangles, values = self.read("new.vtu")
        for (x, y), (h, hill, u) in zip(new_points, values):
            self.assertAlmostEqual(h, 0.1 + 0.1 * x, delta=1e-12)
            self.assertAlmostEqual(u, 2 * x - 3 * y + 1, delta=1e-12)
        old_hill = integral(points, triangles, [math.exp(-(x - 2) ** 2 - y * y) for x, y in points])
        self.assertAlmostEqual(integral(new_points, new_triangles, [row[1] for row in values]), old_hill,
                               delta=1e-12 * old_hill)
        for t in new_triangles:
            x = min(new_points[v][0] for v in t)
            self.assertLess(area(new_points, t), 1.25 * 3 ** 0.5 / 4 * (0.1 + 0.1 * (x + 0.3)) ** 2)

    def test_what_is_coarsened_has_the_segments_of_the_outline(self):
        self.mesh("old.vtu", size=0.1, h=lambda x, y: 2.0)
        self.succeed("adapt", "old.vtu", "--lengths", "h", "-o", "new.vtu")
        self.succeed("check", "new.vtu", "--angle", 20)
        self.assertLess(len(self.read("new.vtu")[1]), 40)

    def test_regions_and_markers_stay(self):
        self.write("domain.poly", REGIONS)
        self.succeed("mesh", "domain.poly", "--area", 0.2, "-o", "old.msh")
        for name in "new.vtu", "new.msh", "new.h5":
            self.succeed("adapt", "old.msh", "--max-length", 0.2, "-o", name)
            self.succeed("check", name, "domain.poly", "--angle", 20, "--area", 0.0175)

    def test_lengths_are_limited(self):
        self.mesh("old.vtu", h=lambda x, y: 0.01 if x + y == 0 else 1)
        counts = []
        for options in [[], ["--gradation", "0.5"], ["--min-length", "0.3"], ["--max-length", "0.2"]]:
            self.succeed("adapt", "old.vtu", "--lengths", "h", *options, "-o", "new.vtu")
            self.succeed("check", "new.vtu", "--angle", 20)
            counts.append(len(self.read("new.vtu")[1]))
        default, steep, raised, lowered = counts
        self.assertLess(steep, default)
        self.assertLess(raised, default)
        self.assertGreater(lowered, default)


class Keep(Adapt):
    """What is as lengths want it stays."""

    def uniform(self, size, **data):
        self.write("domain.poly", SQUARE)
        self.succeed("mesh", "domain.poly", "--size", size, "-o", "first.vtu")
        points, triangles, _ = self.read("first.vtu")
        self.write("old.vtu", as_vtu(points, triangles, {key: [f(*p) for p in points] for key, f in data.items()}))
        return points, triangles

    def test_a_mesh_that_meets_its_lengths_stays(self):
        old = self.uniform(0.2, h=lambda x, y: 0.2)
        out = self.succeed("adapt", "old.vtu", "--lengths", "h", "-o", "new.vtu", "--map", "map.csv")
        self.assertIn(f"kept           {len(old[1])} triangles; 0 were too large, 0 too dense, 0 below", out)
        self.assertEqual(self.read("new.vtu")[:2], old)
        self.assertEqual((self.folder / "map.csv").read_text(), "kind,new,old\n")

    def test_only_where_lengths_change(self):
        for corner, wanted in [(0.05, 1), (0.6, 1.3)]:
            old = self.uniform(0.1, h=lambda x, y: corner if x + y < 1.5 else 0.1)
            out = self.succeed("adapt", "old.vtu", "--lengths", "h", "--gradation", 0, "-o", "new.vtu")
            kept = int(out.split("kept")[1].split()[0])
            self.succeed("check", "new.vtu", "--angle", 20, "--against", "old.vtu")
            _, moved = self.assert_beyond_stays(old, self.read("new.vtu"), lambda x, y: x + y < 3)
            if corner < 0.1:
                self.assertEqual(moved, [])
            self.assertGreater(kept, 0.6 * len(old[1]))
            self.assertLess(kept, 0.95 * len(old[1]))

    def test_triangles_that_fail_are_made_anew(self):
        points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (2.0, 0.2)]
        self.write("bad.vtu", as_vtu(points, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)], {}))
        out = self.succeed("adapt", "bad.vtu", "--max-length", 10, "-o", "new.vtu")
        self.succeed("check", "new.vtu", "--angle", 20)
        self.assertIn("kept           0 triangles; 0 were too large, 0 too dense", out)


class Part(Adapt):
    def test_only_a_box_changes(self):
        old = self.mesh("foreign.vtu", size=0.1)
        out = self.succeed("adapt", "first.vtu", "--max-length", 0.03, "--only", "1,1,2,1.5", "-o", "new.vtu",
                           "--map", "map.csv")
        margin = float(out.split("up to ")[1].split()[0])
        self.succeed("check", "new.vtu", "domain.poly", "--angle", 20)
        new = self.read("new.vtu")
        far = margin * 1.001
        _, moved = self.assert_beyond_stays(
            old, new, lambda x, y: 0.8 - far <= x <= 2.2 + far and 0.8 - far <= y <= 1.7 + far)
        self.assertEqual(moved, [])
        self.assertGreater(len(new[1]), len(old[1]))
        rows = [line.split(",") for line in (self.folder / "map.csv").read_text().splitlines()[1:]]
        same = set(range(len(new[1]))) - {int(now) for kind, now, _ in rows if kind == "triangle"}
        self.assertTrue(all(new[1][t] == old[1][t] for t in same))
        self.assertEqual({before for *_, before in rows}, {"-1"})

    def test_a_mesh_without_segments_gets_those_of_its_boundary(self):
        self.mesh("old.vtu", size=0.3, h=lambda x, y: 0.1)
        self.succeed("adapt", "old.vtu", "--lengths", "h", "--only", "1,1,2,2", "-o", "new.vtu")
        self.succeed("check", "new.vtu", "--angle", 20)

    def test_lengths_are_those_that_are_there(self):
        points, triangles = self.mesh("old.vtu", size=0.2)
        self.succeed("adapt", "old.vtu", "--only", "1,1,3,3", "-o", "new.vtu")
        self.succeed("check", "new.vtu", "--angle", 20)
        self.assertLess(abs(len(self.read("new.vtu")[1]) / len(triangles) - 1), 0.25)

    def test_a_region_or_a_polygon(self):
        self.write("domain.poly", REGIONS)
        self.succeed("mesh", "domain.poly", "--area", 0.01, "--region-name", "20=sand", "-o", "old.vtu")
        old = self.read("old.vtu")[:2]
        self.write("area.poly", SQUARE.replace("1 0 0", "1 2 0").replace("4 0 4", "4 2 4"))
        for area in "sand", "20", "area.poly", "2,0,4,4":
            out = self.succeed("adapt", "old.vtu", "--max-length", 0.05, "--only", area, "-o", "new.vtu")
            self.succeed("check", "new.vtu", "domain.poly", "--angle", 20)
            margin = float(out.split("up to ")[1].split()[0]) * 1.001
            new = self.read("new.vtu")
            _, moved = self.assert_beyond_stays(old, new, lambda x, y: x >= 2 - margin)
            self.assertEqual(moved, [])
            self.assertGreater(len(new[1]), 2 * len(old[1]))

    def test_coarser_parts_leave_no_gaps_in_numbers(self):
        old = self.mesh("foreign.vtu", size=0.1)
        self.succeed("adapt", "first.vtu", "--min-length", 0.6, "--only", "1,1,3,3", "-o", "new.vtu")
        self.succeed("check", "new.vtu", "domain.poly", "--angle", 20)
        points, triangles, _ = self.read("new.vtu")
        self.assertLess(len(triangles), len(old[1]))
        self.assertEqual(len({v for t in triangles for v in t}), len(points))
        kept = set(old[0]) & set(points)
        same_number = sum(old[0][i] == points[i] for i in range(len(points)))
        self.assertGreaterEqual(same_number, len(kept) - (len(old[0]) - len(points)))

    def test_a_mesh_made_in_subdomains(self):
        self.write("domain.poly", SQUARE)
        self.succeed("mesh", "domain.poly", "--area", 0.002, "--subdomains", 100, "-o", "old.vtu")
        self.succeed("check", "old.vtu", "domain.poly", "--angle", 20)
        for length in 0.02, 0.3:
            self.succeed("adapt", "old.vtu", "--min-length", length, "--max-length", length, "--only", "1,1,1.2,1.2",
                         "-o", "new.vtu")
            self.succeed("check", "new.vtu", "domain.poly", "--angle", 20)

    def test_random_parts_of_random_meshes(self):
        for seed in [int(os.environ["SEED"])] if "SEED" in os.environ else range(6):
            with self.subTest(f"SEED={seed}"):
                self.try_random_part(random.Random(seed))

    def try_random_part(self, rng):
        corners = sorted((rng.uniform(0, 2 * math.pi) for _ in range(rng.randrange(4, 9))))
        ring = [(round(4 * rng.uniform(0.5, 1) * math.cos(a), 3), round(4 * rng.uniform(0.5, 1) * math.sin(a), 3))
                for a in [i * 2 * math.pi / len(corners) for i in range(len(corners))]]
        n = len(ring)
        poly = f"{n} 2 0 0\n" + "".join(f"{i + 1} {x} {y}\n" for i, (x, y) in enumerate(ring))
        poly += f"{n} 1\n" + "".join(f"{i + 1} {i + 1} {(i + 1) % n + 1} {i + 1}\n" for i in range(n)) + "0\n"
        fine = rng.uniform(0.03, 0.5)
        old = self.mesh("foreign.vtu", poly, size=rng.uniform(0.1, 0.3))
        x, y = rng.choice(old[0])
        width, height = rng.uniform(0.1, 1.5), rng.uniform(0.1, 1.5)
        x, y = x - width / 2, y - height / 2
        out = self.succeed("adapt", "first.vtu", "--min-length", fine, "--max-length", fine,
                           "--only", f"{x},{y},{x + width},{y + height}", "-o", "new.vtu")
        margin = float(out.split("up to ")[1].split()[0]) * 1.001
        self.succeed("check", "new.vtu", "domain.poly", "--angle", 20)
        new = self.read("new.vtu")
        longest = max(math.dist(old[0][t[i]], old[0][t[i - 1]]) for t in old[1] for i in range(3))
        far = margin + longest
        _, moved = self.assert_beyond_stays(
            old, new, lambda px, py: x - far <= px <= x + width + far and y - far <= py <= y + height + far)
        if len(new[1]) >= len(old[1]) and len(new[0]) >= len(old[0]):
            self.assertEqual(moved, [])
        here = {tuple(sorted(new[0][v] for v in t)) for t in new[1]}
        missing = [t for t in old[1] if tuple(sorted(old[0][v] for v in t)) not in here
                   and not any(x - far <= old[0][v][0] <= x + width + far and y - far <= old[0][v][1] <= y + height + far
                               for v in t)]
        self.assertEqual(missing, [])


class AtTriangles(Adapt):
    """Data at triangles, of files of other programs and of our own."""

    def old(self, size=0.4):
        """A mesh with different values everywhere."""
        points, triangles = self.mesh("plain.vtu", size=size)
        rng = random.Random(len(triangles))
        values = [rng.uniform(1, 2) for _ in triangles]
        self.write("old.vtu", as_vtu(points, triangles, {"h": [0.2 + 0.1 * x for x, _ in points]},
                                     {"q": [(v,) for v in values], "dry&wet": [(float(v > 1.5),) for v in values],
                                      "flow": [(v, -v) for v in values]}))
        return points, triangles, values

    def values(self, name, array):
        """Those of triangles, which come first, from a file that driftmesh wrote."""
        raw = (self.folder / name).read_bytes()
        begin = b'<AppendedData encoding="raw">\n   _'
        offset = int(re.search(f'Name="{re.escape(array)}" format="appended" offset="([0-9]+)"'.encode(), raw)[1])
        place = raw.index(begin) + len(begin) + offset
        count = int.from_bytes(raw[place:place + 8], "little") // 8
        return struct.unpack(f"<{count}d", raw[place + 8:place + 8 + 8 * count])

    def assert_from_centers(self, old, new, values):
        points, triangles, of_old = old
        new_points, new_triangles, _ = new
        for t, value in zip(new_triangles, values):
            x, y = (sum(new_points[v][k] for v in t) / 3 for k in range(2))
            around = [of_old[i] for i, (a, b, c) in enumerate(triangles)
                      if all(area([points[u], points[v], (x, y)], (0, 1, 2)) > -1e-12 for u, v in ((a, b), (b, c), (c, a)))]
            self.assertIn(value, around)

    def test_each_comes_from_where_the_center_lies(self):
        old = self.old()
        self.succeed("adapt", "old.vtu", "--lengths", "h", "-o", "new.vtu")
        new = self.read("new.vtu")
        q = self.values("new.vtu", "q")
        self.assertGreater(len(new[1]), 1.5 * len(old[1]))
        self.assert_from_centers(old, new, q)
        self.assertEqual(self.values("new.vtu", "dry&amp;wet")[:len(new[1])], tuple(float(v > 1.5) for v in q[:len(new[1])]))
        self.assertEqual(self.values("new.vtu", "flow_0"), q)
        self.assertEqual(self.values("new.vtu", "flow_1"), tuple(-v for v in q))
        self.succeed("adapt", "new.vtu", "--min-length", 0.5, "-o", "coarse.vtu")
        self.assert_from_centers((new[0], new[1], q), self.read("coarse.vtu"), self.values("coarse.vtu", "q"))

    def test_integrals_stay_where_that_is_asked_for(self):
        points, triangles, values = self.old()
        whole = math.fsum(area(points, t) * v for t, v in zip(triangles, values))
        for name, lengths in ("fine.vtu", ("--lengths", "h")), ("coarse.vtu", ("--min-length", 0.7)):
            self.succeed("adapt", "old.vtu", *lengths, "--transfer", "q=conserve", "-o", name)
            new_points, new_triangles, _ = self.read(name)
            q = self.values(name, "q")
            self.assertAlmostEqual(math.fsum(area(new_points, t) * v for t, v in zip(new_triangles, q)), whole,
                                   delta=1e-12 * whole)
            self.assertTrue(all(min(values) <= v <= max(values) for v in q[:len(new_triangles)]))

    def test_what_stays_keeps_its_bits(self):
        points, triangles, values = self.old(0.15)
        self.write("moved.poly", SQUARE.replace("3 4 4", "3 4 3.5"))
        for how in (("--max-length", 0.05, "--only", "1,1,1.5,1.5", "--transfer", "q=conserve"), ("--outline", "moved.poly")):
            self.succeed("adapt", "old.vtu", *how, "-o", "new.vtu")
            new_points, new_triangles, _ = self.read("new.vtu")
            by_corners = {tuple(sorted(points[v] for v in t)): value for t, value in zip(triangles, values)}
            stayed = [(by_corners[key], value) for t, value in zip(new_triangles, self.values("new.vtu", "q"))
                      if (key := tuple(sorted(new_points[v] for v in t))) in by_corners]
            self.assertGreater(len(stayed), len(triangles) / 3)
            self.assertEqual(*map(list, zip(*stayed)))

    def test_formats_without_a_place_for_them(self):
        self.old()
        result = self.run_program("adapt", "old.vtu", "--lengths", "h", "-o", "new.su2")
        self.assertEqual(result.returncode, 0)
        self.assertIn("new.su2: has no place for data at triangles", result.stderr)

    def test_they_pass_through_formats(self):
        points, triangles, values = self.old()
        names = ["old.vtu", "a.msh", "b.h5", "c.vtu"]
        for old, new in zip(names, names[1:]):  # nothing has to change
            self.succeed("adapt", old, "--max-length", 9, "--threshold", 100, "-q", 0, "-o", new)
        self.assertEqual(len(self.read("c.vtu")[1]), len(triangles))
        self.assertEqual(list(self.values("c.vtu", "q"))[:len(triangles)], values)
        self.succeed("adapt", "a.msh", "--lengths", "h", "--transfer", "q=conserve", "-o", "new.h5")
        self.succeed("adapt", "new.h5", "--max-length", 9, "--threshold", 100, "-q", 0, "-o", "new.vtu")
        new_points, new_triangles, _ = self.read("new.vtu")
        whole = math.fsum(area(points, t) * v for t, v in zip(triangles, values))
        self.assertGreater(len(new_triangles), len(triangles))
        self.assertAlmostEqual(math.fsum(area(new_points, t) * v for t, v in zip(new_triangles, self.values("new.vtu", "q"))), whole,
                               delta=1e-12 * whole)

    def test_names_that_the_file_has_not(self):
        self.old()
        self.refuse("adapt", "old.vtu", "--lengths", "h", "--transfer", "w=conserve", "-o", "new.vtu",
                    says=["no data 'w', which --transfer names", "'h' at points", "'dry&wet', 'flow_0', 'flow_1', 'q' at triangles"])
        self.refuse("adapt", "old.vtu", "--lengths", "q", "-o", "new.vtu", says=["no point data 'q'", "'h' at points"])


class Large(Adapt):
    def test_all_of_it_is_made_in_subdomains_on_threads(self):
        self.mesh("old.vtu", REGIONS, 0.3, s=lambda x, y: 1 + x + 2 * y, w=lambda x, y: x * y)
        old = "old.vtu", "--max-length", 0.0097, "--transfer", "s=conserve"
        for threads in 1, 3:
            self.succeed("adapt", *old, "--threads", threads, "--map", f"map{threads}.csv", "-o", f"new{threads}.vtu")
        for name in "new{}.vtu", "map{}.csv":
            self.assertEqual(*((self.folder / name.format(threads)).read_bytes() for threads in (1, 3)))
        report = self.succeed("check", "new1.vtu", "--angle", 20, "--against", "old.vtu", "--map", "map1.csv")
        self.assertRegex(report, r"subdomains +\d\d,")
        points, triangles, values = self.read("new1.vtu")
        self.assertGreater(len(triangles), 500_000)
        self.assertTrue(all(abs(s - (1 + x + 2 * y)) < 1e-12 for (x, y), (s, *_) in zip(points, values)))
        self.assertAlmostEqual(integral(points, triangles, [s for s, *_ in values]), 16 * 7, delta=16 * 7e-12)

    def test_regions_and_markers_are_those_of_the_mesh(self):
        self.write("domain.poly", REGIONS)
        self.succeed("mesh", "domain.poly", "--area", 0.05, "-o", "old.vtu")
        self.succeed("adapt", "old.vtu", "--max-length", 0.0097, "-o", "new.vtu")
        self.succeed("check", "new.vtu", "domain.poly", "--angle", 20)
        # Made anew once more, the mesh has no subdomains that are gone.
        self.succeed("adapt", "new.vtu", "--min-length", 0.1, "-o", "coarse.vtu")
        report = self.succeed("check", "coarse.vtu", "domain.poly", "--angle", 20)
        self.assertNotIn("subdomains", report)

    def test_the_most_triangles(self):
        self.mesh("old.vtu", SQUARE, 0.3)
        self.refuse("adapt", "old.vtu", "--max-length", 0.008, "--max-triangles", 600_000, "-o", "new.vtu", code=3,
                    says=["more than 600000 triangles"])


class Flaws(Adapt):
    """Meshes of which nothing can be made are refused, whatever is asked for and whatever file they come from."""

    ASKED = ["--max-length", 0.3], ["--max-length", 0.3, "--only", "0,0,1,1"], ["--outline", "domain.poly"]

    def assert_refused(self, points, triangles, says):
        self.write("old.vtu", as_vtu(points, triangles, {}))
        for asked in self.ASKED:
            result = self.refuse("adapt", "old.vtu", *asked, "-o", "new.vtu", says=["old.vtu: " + says])
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertNotIn("new.vtu", self.files())

    def test_a_point_twice_in_a_triangle(self):
        points, triangles = self.mesh("whole.vtu")
        says = f"triangle 3 (1 1 2; counted from 0): three different points below {len(points)} are expected"
        self.assert_refused(points, triangles[:3] + [(1, 1, 2)] + triangles[4:], says)
        for name in "bad.msh", "bad.h5", "bad.ele", "bad.su2", "bad.mesh", "bad.14":
            self.succeed("convert", "old.vtu", name)
            self.refuse("adapt", name, "--max-length", 0.3, "-o", "new.vtu", says=[f"{name}: {says}"])
        self.assert_refused(points, triangles + [(5, 5, 5)], f"triangle {len(triangles)} (5 5 5; counted from 0)")

    def test_triangles_that_do_not_fit_together(self):
        points, triangles = self.mesh("whole.vtu")
        near = next(i for i, t in enumerate(triangles) if max(map(max, (points[v] for v in t))) < 1)
        self.assert_refused(points, triangles + triangles[near:near + 1],
                            f"triangles {near} and {len(triangles)} (counted from 0) have the same corners")
        a, b, c = triangles[near]
        self.assert_refused(points + [tuple((points[a][k] + points[b][k] + points[c][k]) / 3 for k in range(2))],
                            triangles + [(a, b, len(points))],
                            f"triangles {near} and {len(triangles)} (counted from 0) lie on the same side of the edge from point {a} ")
        self.assert_refused(points, [t[::-1] if i % 3 == 1 else t for i, t in enumerate(triangles)],
                            f"corners of {(len(triangles) + 1) // 3} of {len(triangles)} triangles run in the other direction "
                            "than those of the others, first those of triangle 1 (counted from 0)")

    def test_points_and_triangles_in_wrong_places(self):
        corners = [(0.0, 0.0), (1.0, 0.0), (0.5, 0.0), (0.5, 1.0), (0.5, -1.0)]
        self.write("domain.poly", SQUARE)
        self.assert_refused(corners, [(0, 2, 1), (0, 2, 3), (2, 1, 3)], "triangle 0 (0 2 1; counted from 0) is flat")
        self.write("hang.vtu", as_vtu(corners, [(0, 4, 1), (0, 2, 3), (2, 1, 3)], {}))
        self.refuse("adapt", "hang.vtu", "--max-length", 0.3, "-o", "new.vtu",
                    says=["hang.vtu: point 2 (0.5, 0) lies on the edge from point 1 (1, 0) to point 0 (0, 0), which triangle 0"])
        points, triangles = self.mesh("whole.vtu")
        inner = next(v for v, p in enumerate(points) if 0 < p[0] < 4 and 0 < p[1] < 4)
        first = next(i for i, t in enumerate(triangles) if inner in t)
        again = [tuple(len(points) if i == first and v == inner else v for v in t) for i, t in enumerate(triangles)]
        self.write("twice.vtu", as_vtu(points + [points[inner]], again, {}))
        self.refuse("adapt", "twice.vtu", "--max-length", 0.3, "-o", "new.vtu",
                    says=[f"points {inner} and {len(points)} (counted from 0) are both at ("])
        other = [(x + 0.1, y + 0.1) for x, y in points]
        both = triangles + [tuple(v + len(points) for v in t) for t in triangles]
        self.write("over.vtu", as_vtu(points + other, both, {}))
        self.refuse("adapt", "over.vtu", "--max-length", 0.3, "-o", "new.vtu",
                    says=["over.vtu: the edge from point", "crosses that from point", "so that triangles overlap"])

    def test_no_triangles(self):
        self.write("domain.poly", SQUARE)
        self.write("none.vtu", as_vtu([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)], [], {}))
        self.refuse("adapt", "none.vtu", "--max-length", 0.3, "-o", "new.vtu", says=["none.vtu: ", "no triangles"])
        self.refuse("adapt", "none.vtu", "--outline", "domain.poly", "-o", "new.vtu", says=["none.vtu: ", "no triangles"])

    def test_points_without_triangles_do_not_matter(self):
        points, triangles = self.mesh("old.vtu")
        self.write("more.vtu", as_vtu(points + [points[5], (100.0, 100.0)], triangles, {}))
        for asked in self.ASKED[:2]:
            self.succeed("adapt", "more.vtu", *asked, "-o", "new.vtu")
            self.succeed("check", "new.vtu", "--angle", 20)

    def test_areas_that_are_not_there(self):
        self.write("domain.poly", REGIONS)
        self.succeed("mesh", "domain.poly", "--area", 0.2, "--region-name", "20=sand", "-o", "old.vtu")
        for area in "4", "silt", "nope.geojson":
            self.refuse("adapt", "old.vtu", "--max-length", 0.2, "--only", area, "-o", "new.vtu", code=2,
                        says=[f"'{area}'", "no region of old.vtu (it has the regions 10, 20 'sand')", "no file that exists"])
        self.mesh("plain.vtu")
        self.refuse("adapt", "plain.vtu", "--max-length", 0.2, "--only", "4", "-o", "new.vtu", code=2, says=["it has no regions"])


class Errors(Adapt):
    def test_help_lists_what_it_writes(self):
        self.mesh("old.vtu")
        listed = re.search(r"The new mesh; its extension selects the format: ([^:]*?)(?=\n +-|\n\n|$)",
                           re.sub(r"\s*\n {10,}", " ", self.succeed("adapt", "--help")))[1]
        extensions = re.findall(r"\.[a-z0-9.]*[a-z0-9]", listed)
        self.assertIn(".vtu", extensions)
        self.assertGreater(len(extensions), 8)
        for extension in extensions:
            self.succeed("adapt", "old.vtu", "--max-length", 0.3, "-o", "new" + extension)

    def test_each_is_one_clear_line(self):
        self.mesh("old.vtu", h=lambda x, y: 1.0, bad=lambda x, y: -1.0 if x > 3 else 1.0,
                  nan=lambda x, y: math.nan if x > 3 else 1.0)
        self.refuse("adapt", "old.vtu", "--lengths", "g", "-o", "new.vtu", says=["old.vtu", "'g'", "--lengths", "'h'"])
        self.refuse("adapt", "old.vtu", "--lengths", "bad", "-o", "new.vtu", says=["old.vtu", "-1", "at point"])
        self.refuse("adapt", "old.vtu", "--lengths", "nan", "-o", "new.vtu", says=["old.vtu", "nan", "at point"])
        self.refuse("adapt", "old.vtu", "--lengths", "h", "--only", "7,7,8,8", "-o", "new.vtu",
                    says=["no triangle", "7,7,8,8", "from 0,0 to 4,4"])
        self.refuse("adapt", "old.vtu", "--lengths", "h", "--only", "nowhere", "-o", "new.vtu", code=2,
                    says=["nowhere", "no region"])
        self.refuse("adapt", "old.vtu", "--lengths", "h", "--transfer", "w", "-o", "new.vtu", says=["'w'", "--transfer"])
        self.refuse("adapt", "old.vtu", "--lengths", "h", "--transfer", "h=sometimes", "-o", "new.vtu", code=2,
                    says=["sometimes", "conserve"])
        self.refuse("adapt", "old.vtu", "--lengths", "h", "--transfer", "nan=conserve", "-o", "new.vtu",
                    says=["old.vtu", "'nan' is nan at point", "cannot be conserved"])
        self.succeed("adapt", "old.vtu", "--lengths", "h", "--transfer", "nan", "-o", "kept.vtu")
        self.refuse("adapt", "old.vtu", "-o", "new.vtu", code=2, says=["--lengths", "--max-length", "--only"])
        self.refuse("adapt", "old.vtu", "--min-length", 1, "--max-length", 0.5, "-o", "new.vtu", code=2,
                    says=["--min-length is 1", "--max-length 0.5"])
        self.refuse("adapt", "old.vtu", "--lengths", "h", "--transfer", "h", "--transfer", "h=conserve", "-o", "new.vtu", code=2,
                    says=["--transfer names 'h' twice"])
        self.write("domain.poly", SQUARE)
        for option, value in ("--only", "0,0,1,1"), ("--outline", "domain.poly"):
            self.refuse("adapt", "old.vtu", "--lengths", "h", option, value, "--threshold", 1.2, "-o", "new.vtu", code=2,
                        says=["--threshold", option])
        self.refuse("adapt", "old.vtu", "--outline", "domain.poly", "--transfer", "h=conserve", "-o", "new.vtu",
                    says=["old.vtu: the integral of 'h' cannot stay", "interpolate"])
        self.refuse("adapt", "domain.poly", "--max-length", 1, "-o", "new.vtu",
                    says=["domain.poly: is a domain and no mesh", "no domain.ele", "driftmesh mesh"])
        self.refuse("adapt", "old.vtu", "--max-length", 0.01, "--max-triangles", 1000, "-o", "new.vtu", code=3,
                    says=["1000"])
        self.refuse("adapt", "old.vtu", "--lengths", "h", "-o", "old.vtu", says=["old.vtu"])
        self.assertNotIn("new.vtu", self.files())


if __name__ == "__main__":
    main()
