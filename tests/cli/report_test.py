#!/usr/bin/env python3
"""Reports: what goes into a page, and what is refused.

usage: report_test.py DRIFTMESH [unittest options]
"""

import base64
import json
import re
import struct
import zlib

from program import SQUARE, Cli, main


def blocks(page, kind):
    """{name: bytes} of the data in a page, of kind run or mesh."""
    found = re.findall(rf'<script type="text/plain" data-{kind}="([^"]*)"[^>]*>([^<]*)</script>', page)
    return {name: zlib.decompress(base64.b64decode(text, validate=True)) for name, text in found}


def frame(at_points=None, at_triangles=None, width=1):
    """A .vtu of two triangles in a square, with data by name."""
    def arrays(data, kind="Float64"):
        return "".join(f'<DataArray type="{"Int64" if name == "global_number" else kind}" Name="{name}" NumberOfComponents="{3 if name == "Points" else 1}" format="ascii">'
                       f'{" ".join(map(str, values))}</DataArray>' for name, values in (data or {}).items())
    return f"""<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"><UnstructuredGrid>
<Piece NumberOfPoints="4" NumberOfCells="2"><PointData>{arrays(at_points)}</PointData><CellData>{arrays(at_triangles)}</CellData>
<Points>{arrays({"Points": [0, 0, 0, width, 0, 0, width, 1, 0, 0, 1, 0]})}</Points>
<Cells>{arrays({"connectivity": [0, 1, 2, 0, 2, 3], "offsets": [3, 6]}, "Int64")}{arrays({"types": [5, 5]}, "UInt8")}</Cells>
</Piece></UnstructuredGrid></VTKFile>
"""


class Report(Cli):
    def setUp(self):
        super().setUp()
        self.write("square.poly", SQUARE)
        self.succeed("mesh", "square.poly", "--area", "0.3", "-o", "square.vtu", "--json", "square.json")

    def page(self, *arguments):
        self.succeed("report", *arguments)
        return (self.folder / "report.html").read_text()

    def test_records_and_traces_are_in_the_page(self):
        self.write("square.trace.json", '{"traceEvents": [{"ph": "X", "name": "refine", "tid": 1, "ts": 0, "dur": 2e6, '
                   '"args": {"triangles": 7, "to_be_made": 3}}]}')
        runs = blocks(self.page("square.json"), "run")
        self.assertEqual(list(runs), ["square"])
        run = json.loads(runs["square"])
        self.assertEqual(run["record"], json.loads((self.folder / "square.json").read_text()))
        self.assertEqual(run["timeline"]["busy"], [[1, 0.0, 2.0, 7]])

    def test_a_folder_stands_for_its_records_in_order(self):
        folder = self.folder / "runs"
        folder.mkdir()
        record = (self.folder / "square.json").read_text()
        for name in ("b.json", "a.json", "a.trace.json", "table.csv"):
            (folder / name).write_text("{}" if "trace" in name else record)
        self.assertEqual(list(blocks(self.page("runs", "square.json"), "run")), ["a", "b", "square"])

    def test_the_mesh_is_in_the_page_to_seven_digits(self):
        arrays = blocks(self.page("--mesh", "square.vtu"), "mesh")
        record = json.loads((self.folder / "square.json").read_text())["mesh"]
        points = struct.unpack(f"<{2 * record['vertices']}f", arrays["points"])
        corners = struct.unpack(f"<{3 * record['triangles']}I", arrays["triangles"])
        self.assertEqual((min(points), max(points)), (-2, 2))  # seen from the middle of the square
        area = 0
        for t in range(record["triangles"]):
            (ax, ay), (bx, by), (cx, cy) = ((points[2 * c], points[2 * c + 1]) for c in corners[3 * t:3 * t + 3])
            area += ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2
        self.assertAlmostEqual(area, 16, 4)

    def test_attributes_of_regions_are_in_the_page_as_they_are(self):
        regions = "1\n1 1 1 -2.5 0\n"
        self.assertTrue(SQUARE.endswith("0\n"), "no holes, and no regions yet")
        self.write("region.poly", SQUARE + regions)
        self.succeed("mesh", "region.poly", "-o", "region.vtu")
        arrays = blocks(self.page("--mesh", "region.vtu"), "mesh")
        self.assertEqual(set(struct.unpack(f"<{len(arrays['triangles']) // 12}f", arrays["region"])), {-2.5})

    def test_lengths_asked_for_are_in_the_page(self):
        self.succeed("mesh", "square.poly", "--size", "0.2+0.05*x", "--save-size-tree", "square.tree", "-o", "sized.vtu")
        arrays = blocks(self.page("--mesh", "sized.vtu", "--size-tree", "square.tree"), "mesh")
        points = struct.unpack(f"<{len(arrays['points']) // 4}f", arrays["points"])
        corners = struct.unpack(f"<{len(arrays['triangles']) // 4}I", arrays["triangles"])
        sizes = struct.unpack(f"<{len(arrays['sizes']) // 4}f", arrays["sizes"])
        self.assertEqual(len(sizes), len(corners) // 3)
        for t, size in enumerate(sizes):
            x = 2 + sum(points[2 * c] for c in corners[3 * t:3 * t + 3]) / 3  # the middle of the square is at (2, 2)
            self.assertLess(abs(size / (0.2 + 0.05 * x) - 1), 0.13, f"triangle {t} at x = {x}")
        self.assertNotIn("sizes", blocks(self.page("--mesh", "sized.vtu"), "mesh"))

    def test_lengths_of_something_else_are_refused(self):
        self.write("far.poly", SQUARE.replace("1 0 0\n2 4 0\n3 4 4\n4 0 4\n", "1 90 90\n2 94 90\n3 94 94\n4 90 94\n"))
        self.succeed("mesh", "far.poly", "--size", "0.01*x", "--save-size-tree", "far.tree", "-o", "far.vtu")
        before = self.files()
        self.refuse("report", "--mesh", "square.vtu", "--size-tree", "far.tree", says=["far.tree", "no lengths for some triangles"])
        self.refuse("report", "--mesh", "square.vtu", "--size-tree", "square.poly", says=["square.poly", "no compiled size field"])
        self.refuse("report", "square.json", "--size-tree", "far.tree", code=2, says=["--size-tree needs a --mesh"])
        self.assertEqual(self.files(), before)

    def test_the_page_needs_nothing_else(self):
        page = self.page("square.json", "--mesh", "square.vtu")
        self.assertNotRegex(page, r"""<(script|link|img)[^>]*(src|href)\s*=\s*["']?\w""")

    def test_names_cannot_end_their_place_in_the_page(self):
        (self.folder / "square.json").rename(self.folder / 'a"><b&.json')
        self.assertEqual(list(blocks(self.page('a"><b&.json'), "run")), ["a&quot;>&lt;b&amp;"])

    def test_what_is_no_run_is_refused_and_no_page_is_left(self):
        self.write("text.json", "not JSON")
        self.write("other.json", '{"format": "something else"}')
        (self.folder / "empty").mkdir()
        before = self.files()
        self.refuse("report", "text.json", says=["text.json", "is not JSON"])
        self.refuse("report", "other.json", says=["other.json", "is not the record of a run"])
        self.refuse("report", "empty", says=["empty", "has no records of runs"])
        self.refuse("report", "missing.json", says=["missing.json"])
        self.refuse("report", "square.json", "-o", "report.pdf", says=["report.pdf", ".html"])
        self.refuse("report", code=2, says=["name a run"])
        self.assertEqual(self.files(), before)


class Frames(Cli):
    """Meshes that follow each other."""

    def about(self, page):
        return dict(re.findall(r'data-(\w+)="([^"]*)"', re.search(r"<script[^>]* data-series=[^>]*>", page)[0]))

    def frames(self, page):
        """[(time, mesh, values)]"""
        found = re.findall(r'data-frame="values" data-of="(\d+)"(?: data-time="([^"]*)")?>([^<]*)<', page)
        unpacked = [zlib.decompress(base64.b64decode(text, validate=True)) for _, _, text in found]
        return [(time, int(mesh), struct.unpack(f"<{len(values) // 4}f", values)) for (mesh, time, _), values in zip(found, unpacked)]

    def page(self, *arguments, says):
        self.assertEqual(self.succeed("report", *arguments), f"report.html: {says}\n")
        return (self.folder / "report.html").read_text()

    def test_data_at_points_and_at_triangles_are_played(self):
        for k in (1, 2, 10):
            self.write(f"flow_{k}.vtu", frame({"depth": [k, 0, 0, 0]}, {"speed": [k, 1.5], "depth, m": [0, 0]}, width=k))
        files = ["flow_1.vtu", "flow_10.vtu", "flow_2.vtu"]  # as a shell lists them
        page = self.page(*files, "--field", "depth", says="3 frames")
        self.assertEqual(self.about(page), {"series": "flow_*.vtu", "field": "depth", "at": "points", "middle": "0.5 0.5",
                                            "box": "-0.5 -0.5 9.5 0.5", "range": "0 10"})
        self.assertEqual(self.frames(page), [("", 0, (1, 0, 0, 0)), ("", 1, (2, 0, 0, 0)), ("", 2, (10, 0, 0, 0))])
        page = self.page(*files, "--field", "speed", says="3 frames")
        self.assertEqual((self.about(page)["at"], self.about(page)["range"]), ("triangles", "1 10"))
        self.assertEqual([values for _, _, values in self.frames(page)], [(1, 1.5), (2, 1.5), (10, 1.5)])

    def test_names_that_differ_in_more_than_numbers_are_in_the_order_given(self):
        for name, value in (("later", 2), ("earlier", 1)):
            self.write(f"{name}.vtu", frame({"u": [value] * 4}))
        page = self.page("later.vtu", "earlier.vtu", says="2 frames")  # one field need not be named
        self.assertEqual(self.about(page)["series"], "later.vtu and 1 more")
        self.assertEqual(self.frames(page), [("", 0, (2,) * 4), ("", 0, (1,) * 4)])  # the mesh is the same

    def test_a_pvd_has_times(self):
        for k in range(2):
            self.write(f"u{k}.vtu", frame({"u": [k] * 4}))
        sets = "".join(f'<DataSet timestep="{time}" group="" part="0" file="u{k}.vtu"/>' for k, time in ((1, 0.25), (0, 0)))
        self.write("u.pvd", f'<VTKFile type="Collection" version="0.1"><Collection>{sets}</Collection></VTKFile>')
        page = self.page("u.pvd", "--field", "u", says="2 frames")
        self.assertEqual(self.about(page)["series"], "u.pvd")
        self.assertEqual(self.frames(page), [("0", 0, (0,) * 4), ("0.25", 0, (1,) * 4)])
        self.refuse("report", "u.pvd", "-o", "u1.vtu", says=["u1.vtu", ".html"])

    def test_pieces_are_one_frame(self):
        self.write("u_0.vtu", frame({"global_number": [0, 1, 2, 3]}, {"u": [5, 6]}))
        self.write("u.pvtu", '<VTKFile type="PUnstructuredGrid"><PUnstructuredGrid><Piece Source="u_0.vtu"/></PUnstructuredGrid></VTKFile>')
        page = self.page("u.pvtu", says="1 frame")
        self.assertEqual((self.about(page)["at"], self.frames(page)), ("triangles", [("", 0, (5, 6))]))

    def test_runs_and_a_mesh_can_be_beside_frames(self):
        self.write("square.poly", SQUARE)
        self.succeed("mesh", "square.poly", "-o", "square.vtu", "--json", "square.json")
        self.write("u0.vtu", frame({"u": [0] * 4}))
        page = self.page("square.json", "u0.vtu", "--mesh", "square.vtu", says="1 run, 2 triangles, 1 frame")
        self.assertEqual((list(blocks(page, "run")), len(self.frames(page))), (["square"], 1))

    def test_what_cannot_be_played_is_refused(self):
        self.write("a0.vtu", frame({"u": [0] * 4, "v": [0] * 4}))
        self.write("a1.vtu", frame({}, {"u": [0, 0]}))
        self.write("a2.vtu", frame({"v": [0] * 4}))
        self.write("bare.vtu", frame())
        self.write("piece.vtu", frame({"u": [0] * 4, "global_number": [0, 1, 2, 3]}))
        self.write("none.pvd", '<VTKFile type="Collection" version="0.1"><Collection></Collection></VTKFile>')
        before = self.files()
        self.refuse("report", "a0.vtu", "--field", "w", says=["a0.vtu", "has no field 'w'", "'u', 'v'"])
        self.refuse("report", "a0.vtu", says=["a0.vtu", "has the fields 'u', 'v'", "--field"])
        self.refuse("report", "a0.vtu", "a2.vtu", "--field", "u", says=["a2.vtu", "has no field 'u', which frames before it have"])
        self.refuse("report", "a0.vtu", "a1.vtu", "--field", "u", says=["a1.vtu", "has 'u' at triangles, and frames before it at points"])
        self.refuse("report", "bare.vtu", says=["bare.vtu", "has no data at points or triangles"])
        self.refuse("report", "piece.vtu", says=["piece.vtu", "is a piece of a mesh", ".pvtu"])
        self.refuse("report", "none.pvd", says=["none.pvd", "names no meshes"])
        self.refuse("report", "missing.vtu", says=["missing.vtu"])
        self.refuse("report", "--mesh", "a0.vtu", "--field", "u", code=2, says=["--field needs meshes to be played"])
        self.assertEqual(self.files(), before)


if __name__ == "__main__":
    main()
