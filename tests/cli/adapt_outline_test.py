#!/usr/bin/env python3
"""driftmesh adapt --outline: meshes from files whose domain has changed, and check --against, which judges what stayed.

usage: adapt_outline_test.py DRIFTMESH [unittest options]
"""

import json
import math
import os
import random
import struct

from adapt_test import REGIONS, Adapt, area, as_vtu
from program import SQUARE, main


def poly(rings, markers=None, holes=(), lines=()):
    """Rings of corners, each with a marker for every side; open lines with one."""
    points, segments = [], []
    for k, ring in enumerate(rings):
        first = len(points)
        points += ring
        segments += [(first + i, first + (i + 1) % len(ring), markers[k][i] if markers else k + 1)
                     for i in range(len(ring))]
    for line in lines:
        first = len(points)
        points += line
        segments += [(first + i, first + i + 1, 99) for i in range(len(line) - 1)]
    return (f"{len(points)} 2 0 0\n" + "".join(f"{i + 1} {x!r} {y!r}\n" for i, (x, y) in enumerate(points))
            + f"{len(segments)} 1\n" + "".join(f"{i + 1} {a + 1} {b + 1} {m}\n" for i, (a, b, m) in enumerate(segments))
            + f"{len(holes)}\n" + "".join(f"{i + 1} {x!r} {y!r}\n" for i, (x, y) in enumerate(holes)))


def sides(rings):
    return {tuple(sorted((ring[i], ring[i - 1]))) for ring in rings for i in range(len(ring))}


def distance(p, side):
    (ax, ay), (bx, by) = side
    dx, dy = bx - ax, by - ay
    t = min(1, max(0, ((p[0] - ax) * dx + (p[1] - ay) * dy) / (dx * dx + dy * dy)))
    return math.hypot(p[0] - ax - t * dx, p[1] - ay - t * dy)


def inside(p, ring):
    odd = False
    for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
        if (ay > p[1]) != (by > p[1]) and p[0] < ax + (p[1] - ay) / (by - ay) * (bx - ax):
            odd = not odd
    return odd


class Outline(Adapt):
    def change(self, old_poly, new_poly, size=0.3, **data):
        """Adapts a mesh of one domain to another one, with what every such run has to fulfill."""
        old = self.mesh("foreign.vtu", old_poly, size)
        self.write("new.poly", new_poly)
        out = self.adapt("first.vtu", "new.poly")
        return old, self.read("new.vtu"), out

    def adapt(self, mesh, outline, *options):
        out = self.succeed("adapt", mesh, "--outline", outline, "--map", "map.csv", "-o", "new.vtu", *options)
        self.succeed("check", "new.vtu", outline, "--angle", 20, "--against", mesh, "--map", "map.csv")
        return out

    def old_numbers(self, kind, count):
        """By the map: the old number of each."""
        numbers = list(range(count))
        for line in (self.folder / "map.csv").read_text().splitlines()[1:]:
            what, now, before = line.split(",")
            if what == kind:
                numbers[int(now)] = int(before)
        return numbers

    def assert_far_stays(self, old, new, far):
        """Each old triangle all of whose corners are far from what differs is there, with its bits, by the map."""
        (old_points, old_triangles), (points, triangles, _) = old, new
        point, triangle = self.old_numbers("point", len(points)), self.old_numbers("triangle", len(triangles))
        now = {before: t for t, before in enumerate(triangle) if before >= 0}
        for t, corners in enumerate(old_triangles):
            if not all(far(old_points[v]) for v in corners):
                continue
            self.assertIn(t, now, f"triangle {t} at {old_points[corners[0]]} is gone")
            self.assertEqual([point[v] for v in triangles[now[t]]], list(corners))
            self.assertEqual([points[v] for v in triangles[now[t]]], [old_points[v] for v in corners])
        return now


def margin_in(out):
    return float(out.split("up to ")[1].split()[0])


def longest_edge(mesh):
    points, triangles = mesh
    return max(math.dist(points[t[i]], points[t[i - 1]]) for t in triangles for i in range(3))


RING = [(0, 0), (4, 0), (4, 4), (0, 4)]
ISLAND = [(2.5, 2.5), (3, 2.5), (3, 3), (2.5, 3)]
PIER = [(0, 0), (1, 0), (1, 0.5), (1.2, 0.5), (1.2, 0), (4, 0), (4, 4), (0, 4)]


class Changes(Outline):
    def test_the_same_outline_changes_nothing(self):
        text = poly([RING, ISLAND], holes=[(2.7, 2.7)])
        for new in text, poly([ISLAND, RING[1:] + RING[:1]], [[2] * 4, [1] * 4], [(2.7, 2.7)]):
            old, now, out = self.change(text, new)
            self.assertIn("the same as before", out)
            self.assertRegex(out, r"time +read mesh \d.*s read outline \d")
            self.assertEqual(now[:2], old)
            self.assertEqual((self.folder / "map.csv").read_text(), "kind,new,old\n")

    def test_a_pier_appears_and_goes(self):
        for before, after in (RING, PIER), (PIER, RING):
            old, new, out = self.change(poly([before]), poly([after]), 0.2)
            far = margin_in(out) + 2 * longest_edge(old)
            kept = self.assert_far_stays(old, new, lambda p: math.hypot(p[0] - 1.1, p[1] - 0.25) > 0.3 + far)
            self.assertGreater(len(kept), len(old[1]) / 2)
            total = sum(area(new[0], t) for t in new[1])
            self.assertAlmostEqual(total, 16 - (0.1 if after is PIER else 0), delta=1e-12)

    def test_an_island_appears_moves_and_goes(self):
        moved = [(x - 0.3, y) for x, y in ISLAND]
        domains = [poly([RING]), poly([RING, ISLAND], holes=[(2.7, 2.7)]), poly([RING, moved], holes=[(2.4, 2.7)])]
        for before, after in [(0, 1), (1, 0), (1, 2)]:
            old, new, out = self.change(domains[before], domains[after], 0.2)
            far = margin_in(out) + 2 * longest_edge(old)
            kept = self.assert_far_stays(old, new, lambda p: math.hypot(p[0] - 2.6, p[1] - 2.75) > 0.7 + far)
            self.assertGreater(len(kept), len(old[1]) / 3)

    def test_the_domain_grows_and_data_are_those_of_the_nearest_place(self):
        self.mesh("old.vtu", size=0.2, u=lambda x, y: 2 * x - 3 * y + 1, step=lambda x, y: 1.0 if x < 2 else 2.0)
        wide = [(0, 0), (4, 0), (4, 1), (6, 1), (6, 3), (4, 3), (4, 4), (0, 4)]
        self.write("new.poly", poly([wide]))
        out = self.adapt("old.vtu", "new.poly")
        points, triangles, values = self.read("new.vtu")
        beyond = [v for v, (x, _) in enumerate(points) if x > 4]
        self.assertIn(f"{len(beyond)} new points where the mesh was not", out)
        self.assertGreater(len(beyond), 20)
        for (x, y), (step, u) in zip(points, values):
            self.assertAlmostEqual(u, 2 * min(x, 4) - 3 * y + 1, delta=1e-12)
            if x > 2.5:
                self.assertEqual(step, 2)
        largest = max(area(points, t) for t in triangles)
        self.assertLess(largest, 0.03)

    def test_regions_and_markers(self):
        old = REGIONS.replace("2 2 3 2", "2 2 3 1")  # one marker on both sides of the border's end
        turned = old.replace("\n2 2 0\n", "\n2 2.4 0\n")
        self.assertNotIn(turned, (old, REGIONS))
        self.write("old.poly", old)
        self.write("new.poly", turned)
        self.succeed("mesh", "old.poly", "--area", 0.01, "-o", "first.vtu")
        self.adapt("first.vtu", "new.poly")
        self.write("none.poly", SQUARE)
        self.refuse("adapt", "first.vtu", "--outline", "none.poly", "-o", "no.vtu", says=["none.poly", "no regions"])

    def test_a_mesh_whose_regions_are_swapped_is_where_it_was(self):
        def messages(outline):
            result = self.run_program("adapt", "first.vtu", "--outline", outline, "-o", "new.vtu", "--map", "map.csv")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.succeed("check", "new.vtu", outline, "--angle", 20, "--against", "first.vtu", "--map", "map.csv")
            return result.stderr

        self.write("old.poly", REGIONS)
        self.write("swapped.poly", REGIONS.replace("1 1 1 10", "1 1 1 20").replace("2 3 1 20", "2 3 1 10"))
        self.write("tiny.poly", poly([[(x / 1000, y / 1000) for x, y in RING]]) + "1\n1 0.001 0.001 10\n")
        self.succeed("mesh", "old.poly", "--area", 0.05, "-o", "first.vtu")
        self.assertNotIn("warning", messages("swapped.poly"))
        self.assertIn("nothing of the mesh stays", messages("tiny.poly"))  # but for one corner

    def test_markers_that_stay_are_the_old_ones_and_new_lines_have_the_new(self):
        old = self.mesh("foreign.vtu", poly([RING]), 0.3)
        self.assertTrue(old)
        self.write("after.poly", poly([PIER], [[7] * 8]))
        out = self.succeed("adapt", "first.vtu", "--outline", "after.poly", "-o", "new.ele")
        self.assertIn("which are others in after.poly", out)
        nodes = [tuple(map(float, row[1:3])) for row in self.table("new.node")]
        rows = [row.split() for row in (self.folder / "new.poly").read_text().splitlines()]
        count = int(rows[1][0])
        markers = {}
        for _, a, b, marker in rows[2:2 + count]:
            x = (nodes[int(a) - 1][0] + nodes[int(b) - 1][0]) / 2, (nodes[int(a) - 1][1] + nodes[int(b) - 1][1]) / 2
            markers.setdefault(int(marker), []).append(x)
        self.assertEqual(set(markers), {1, 7})
        self.assertTrue(all(0.9 < x < 1.3 or y == 0 for x, y in markers[7]))

    def test_a_domain_elsewhere(self):
        self.mesh("old.vtu", size=0.5, u=lambda x, y: 3.0)
        self.write("new.poly", poly([[(10, 10), (12, 10), (12, 12)]]))
        result = self.run_program("adapt", "old.vtu", "--outline", "new.poly", "-o", "new.vtu")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("nothing of the mesh stays", result.stderr)
        self.succeed("check", "new.vtu", "new.poly", "--angle", 20)
        self.assertEqual({u for u, in self.read("new.vtu")[2]}, {3.0})

    def test_points_and_lines_inside(self):
        line, other = [(1, 1), (2, 1.5)], [(1, 1), (1.5, 2.5), (2.5, 2)]
        for before, after in [([], [line]), ([line], [other]), ([other], [])]:
            self.change(poly([RING], lines=before), poly([RING], lines=after))

    def test_lengths_that_are_asked_for(self):
        self.mesh("old.vtu", size=0.3, h=lambda x, y: 0.08)
        self.write("new.poly", poly([PIER]))
        counts = []
        for options in [], ["--lengths", "h"]:
            self.adapt("old.vtu", "new.poly", *options)
            counts.append(len(self.read("new.vtu")[1]))
        self.assertGreater(counts[1], 1.3 * counts[0])

    def test_a_file_with_few_digits_takes_a_tolerance(self):
        rng = random.Random(1)
        ring = [(2 * math.cos(a / 10 * math.pi) + 0.01 * rng.random(), 2 * math.sin(a / 10 * math.pi)) for a in range(20)]
        old = self.mesh("foreign.vtu", poly([ring]), 0.2)
        rounded = [(round(x, 3), round(y, 3)) for x, y in ring]
        rounded[3] = (1.5, 1.9)
        self.write("new.poly", poly([rounded]))
        out = self.succeed("adapt", "first.vtu", "--outline", "new.poly", "--outline-tolerance", 0.002, "-o", "new.vtu",
                           "--map", "map.csv")
        self.succeed("check", "new.vtu", "--angle", 20, "--against", "first.vtu", "--map", "map.csv")
        far = margin_in(out) + 2 * longest_edge(old)
        kept = self.assert_far_stays(old, self.read("new.vtu"), lambda p: math.dist(p, rounded[3]) > 0.8 + far)
        self.assertGreater(len(kept), len(old[1]) / 2)

    def test_subdomains(self):
        self.write("domain.poly", poly([RING]))
        self.write("new.poly", poly([PIER]))
        self.succeed("mesh", "domain.poly", "--area", 0.002, "--subdomains", 100, "-o", "old.vtu")
        self.adapt("old.vtu", "new.poly")


class Random(Outline):
    """Random domains, of which some corners and islands change."""

    def test_random_changes(self):
        # 8: a new edge whose ends have the numbers of those of one that is gone had its marker
        for seed in [int(os.environ["SEED"])] if "SEED" in os.environ else (0, 1, 2, 3, 4, 5, 8):
            with self.subTest(f"SEED={seed}"):
                self.try_changes(random.Random(seed))

    @staticmethod
    def star(rng, x, y, radius, n):
        return [(x + radius * rng.uniform(0.6, 1) * math.cos(2 * math.pi * k / n),
                 y + radius * rng.uniform(0.6, 1) * math.sin(2 * math.pi * k / n)) for k in range(n)]

    def islands(self, rng):
        """In squares of their own, which are all within the outer ring."""
        places = [(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1)]
        return {place: self.star(rng, *place, 0.3, rng.randrange(3, 8)) for place in rng.sample(places, rng.randrange(4))}

    def changed(self, rng, outer, islands):
        outer, islands = list(outer), dict(islands)
        for _ in range(rng.randrange(1, 4)):
            what = rng.randrange(5)
            if what == 0:
                k = rng.randrange(len(outer))
                factor = rng.uniform(0.9, 1.1)
                outer[k] = (outer[k][0] * factor, outer[k][1] * factor)
            elif what == 1 and islands:
                del islands[rng.choice(sorted(islands))]
            elif what == 2:
                islands.update(self.islands(rng))
            elif what == 3 and islands:
                place = rng.choice(sorted(islands))
                ring = islands[place] = list(islands[place])
                ring[rng.randrange(len(ring))] = place
                if len(set(ring)) < len(ring) or abs(sum(ring[i - 1][0] * ring[i][1] - ring[i][0] * ring[i - 1][1]
                                                 for i in range(len(ring)))) < 1e-3:
                    del islands[place]
            elif what == 4:
                k = rng.randrange(len(outer))
                (ax, ay), (bx, by) = outer[k - 1], outer[k]
                outer.insert(k, ((ax + bx) / 2 * 0.97, (ay + by) / 2 * 0.97))
        return outer, islands

    def text(self, outer, islands):
        holes = []
        for ring in islands.values():
            x, y = (sum(p[i] for p in ring) / len(ring) for i in (0, 1))
            seeds = ((x + dx, y + dy) for dx in (0, 0.02, -0.02, 0.05, -0.05, 0.1, -0.1, 0.15, -0.15)
                     for dy in (0, 0.02, -0.02, 0.05, -0.05, 0.1, -0.1, 0.15, -0.15))
            holes.append(next(seed for seed in seeds if inside(seed, ring)))
        return poly([outer, *islands.values()], [[1] * len(outer)] + [[2] * len(ring) for ring in islands.values()], holes)

    def try_changes(self, rng):
        n = rng.randrange(12, 30)
        outer = [(r * math.cos(2 * math.pi * k / n), r * math.sin(2 * math.pi * k / n))
                 for k in range(n) for r in [rng.uniform(2.2, 3)]]
        islands = self.islands(rng)
        new_outer, new_islands = self.changed(rng, outer, islands)
        old, new, out = self.change(self.text(outer, islands), self.text(new_outer, new_islands), rng.uniform(0.08, 0.3))
        differing = sides([outer, *islands.values()]) ^ sides([new_outer, *new_islands.values()])
        if not differing:
            self.assertEqual(new[:2], old)
            return
        margin = margin_in(out) + 2 * longest_edge(old)
        gone = [ring for place, ring in islands.items() if new_islands.get(place) != ring]
        gone += [ring for place, ring in new_islands.items() if islands.get(place) != ring]

        def far(p):
            return (all(distance(p, side) > margin for side in differing)
                    and inside(p, outer) == inside(p, new_outer) and not any(inside(p, ring) for ring in gone))
        self.assert_far_stays(old, new, far)


class Against(Outline):
    """check --against finds what a map or a mesh has wrong."""

    def setUp(self):
        super().setUp()
        self.old = self.mesh("old.vtu", size=0.3, u=lambda x, y: x * y)
        self.write("new.poly", poly([PIER]))
        self.adapt("old.vtu", "new.poly")
        self.new = self.read("new.vtu")

    def check(self, map_text=None, mesh="new.vtu"):
        options = []
        if map_text is not None:
            options = ["--map", self.write("other.csv", map_text)]
        return self.run_program("check", mesh, "--against", "old.vtu", *options)

    def test_numbers(self):
        points, triangles = (self.old_numbers(kind, len(self.new[k])) for k, kind in enumerate(("point", "triangle")))
        out = self.check().stdout
        stayed = sum(v >= 0 for v in points)
        self.assertIn(f"same points    {stayed} stayed, {sum(v == i for i, v in enumerate(points))} of them with", out)
        self.assertIn(f"; {len(points) - stayed} new, {len(self.old[0]) - stayed} gone", out)
        stayed = sum(t >= 0 for t in triangles)
        self.assertIn(f"same triangles {stayed} stayed, {sum(t == i for i, t in enumerate(triangles))} of them with", out)
        self.assertEqual(stayed, len({tuple(self.old[0][v] for v in t) for t in self.old[1]}
                                     & {tuple(self.new[0][v] for v in t) for t in self.new[1]}))

    def test_wrong_maps(self):
        text = (self.folder / "map.csv").read_text()
        lines = text.splitlines()
        new_point = next(i for i, line in enumerate(lines) if line.startswith("point") and line.endswith(",-1"))
        new_triangle = next(i for i, line in enumerate(lines) if line.startswith("triangle") and line.endswith(",-1"))
        for say, wrong in [("which another one has, too", lines[:new_point] + [lines[new_point][:-2] + "0"] + lines[new_point + 1:]),
                           ("is not where point", lines[:new_point] + lines[new_point + 1:]),
                           ("has not the corners", lines[:new_triangle] + lines[new_triangle + 1:]),
                           ("is new by the map", lines + ["point,0,-1"]),
                           ("which the new mesh has not", lines + ["point,100000,-1"]),
                           ("which the old mesh has not", lines + ["triangle,0,100000"]),
                           ("twice", lines + lines[-1:])]:
            result = self.check("\n".join(wrong))
            self.assertEqual(result.returncode, 1, say + result.stdout)
            self.assertIn(say, result.stdout)
            self.assertIn("rejected: contradicts what old.vtu has, or its map", result.stdout)
        for wrong in "point,1", "node,1,2", "point,x,2":
            result = self.check(text + wrong + "\n")
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"other.csv:{len(lines) + 1}", result.stderr)
        self.refuse("check", "new.vtu", "--map", "map.csv", code=2, says=["--map", "--against"])

    def test_other_data_and_places(self):
        points, triangles, values = self.new
        far = max(range(len(points)), key=lambda v: points[v][0] + points[v][1])
        data = [u for u, in values]
        data[far] += 1
        self.write("data.vtu", as_vtu(points, triangles, {"u": data}))
        result = self.check(mesh="data.vtu")
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"'u' at point {far} was ", result.stdout)
        moved = list(points)
        moved[far] = tuple(struct.unpack("d", struct.pack("q", struct.unpack("q", struct.pack("d", x))[0] - 1))[0]
                           for x in moved[far])
        self.write("moved.vtu", as_vtu(moved, triangles, {"u": [u for u, in values]}))
        result = self.run_program("check", "moved.vtu", "--against", "old.vtu", "--map", "map.csv")
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"point {far} is not where point", result.stdout)


class Degrees(Outline):
    def test_longitudes_and_latitudes(self):
        """A mesh made of degrees, in a format that has degrees again, fits the file that it came from."""
        def geojson(ring):
            return json.dumps({"type": "Feature", "properties": {}, "geometry": {
                "type": "Polygon", "coordinates": [[[8 + x / 100, 54 + y / 100] for x, y in ring + ring[:1]]]}})
        self.write("old.geojson", geojson(RING))
        self.write("new.geojson", geojson(PIER))
        self.succeed("mesh", "old.geojson", "--area", 2e4, "-o", "old.14")
        self.assertIn("the same as before", self.succeed("adapt", "old.14", "--outline", "old.geojson", "-o", "same.14"))
        out = self.succeed("adapt", "old.14", "--outline", "new.geojson", "-o", "new.14", "--map", "map.csv")
        self.assertIn("outline", out)
        self.succeed("check", "new.14", "new.geojson", "--angle", 20)
        self.assertGreater(sum(t >= 0 for t in self.old_numbers("triangle", len(self.read("new.14")[1]))), 300)


if __name__ == "__main__":
    main()
