#!/usr/bin/env python3
"""Meshes in pieces, written here byte by byte: how the program checks and converts them. And those that
the program writes from several ranks, read here with an XML parser and taken apart.

usage: pieces_test.py DRIFTMESH [unittest options]
"""

import collections
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

PROGRAM = None

INPUT = """6 2 0 0
0 0 0
1 1 0
2 2 0
3 2 1
4 1 1
5 0 1
6 1
0 0 1 5
1 1 2 5
2 2 3 6
3 3 4 7
4 4 5 7
5 5 0 8
0
"""

# Two unit squares side by side: points by number, then number triples of triangles and (number, number, marker).
POINTS = {0: (0, 0), 1: (1, 0), 2: (2, 0), 3: (0, 1), 4: (1, 1), 5: (2, 1), 6: (1, 0.5)}
LEFT = ([(0, 1, 6), (0, 6, 3), (3, 6, 4)], [(0, 1, 5), (4, 3, 7), (3, 0, 8)])
RIGHT = ([(1, 2, 6), (2, 5, 6), (6, 5, 4)], [(1, 2, 5), (2, 5, 6), (5, 4, 7)])


def vtu(piece, rank, points=None):
    """The bytes of a piece: lengths of 32 bits, other types than the program's own."""
    points = {**POINTS, **(points or {})}
    triangles, lines = piece
    numbers = sorted({v for t in triangles for v in t})
    local = {number: i for i, number in enumerate(numbers)}
    cells = [[local[v] for v in t] for t in triangles] + [[local[a], local[b]] for a, b, _ in lines]
    ends, end = [], 0
    for cell in cells:
        end += len(cell)
        ends.append(end)
    data, header = b"", ""
    sections = {"PointData": [("global_number", "UInt32", "I", numbers)],
                "CellData": [("subdomain", "Int16", "h", [rank + 3] * len(cells)),
                             ("rank", "UInt8", "B", [rank] * len(cells)),
                             ("marker", "Int32", "i", [0] * len(triangles) + [m for _, _, m in lines])],
                "Points": [("Points", "Float64", "d", [x for n in numbers for x in (*points[n], 0)])],
                "Cells": [("connectivity", "Int64", "q", [v for cell in cells for v in cell]),
                          ("offsets", "Int64", "q", ends),
                          ("types", "UInt8", "B", [5] * len(triangles) + [3] * len(lines))]}
    for section, arrays in sections.items():
        header += f"<{section}>\n"
        for name, kind, code, values in arrays:
            components = ' NumberOfComponents="3"' if section == "Points" else ""
            header += f'<DataArray type="{kind}" Name="{name}"{components} format="appended" offset="{len(data)}"/>\n'
            packed = struct.pack(f"<{len(values)}{code}", *values)
            data += struct.pack("<I", len(packed)) + packed
        header += f"</{section}>\n"
    return (f'<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>\n'
            f'<Piece NumberOfPoints="{len(numbers)}" NumberOfCells="{len(cells)}">\n{header}</Piece>\n'
            '</UnstructuredGrid><AppendedData encoding="raw">_').encode() + data + b"</AppendedData></VTKFile>\n"


PVTU = ('<VTKFile type="PUnstructuredGrid"><PUnstructuredGrid GhostLevel="0">\n'
        '<Piece Source="parts/l&amp;r.vtu"/><Piece Source="right.vtu"/></PUnstructuredGrid></VTKFile>\n')


class Pieces(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "parts").mkdir()
        self.left, self.right = self.folder / "parts/l&r.vtu", self.folder / "right.vtu"
        (self.folder / "two.poly").write_text(INPUT)
        (self.folder / "two.pvtu").write_text(PVTU)
        self.left.write_bytes(vtu(LEFT, 0))
        self.right.write_bytes(vtu(RIGHT, 1))

    def run_program(self, *arguments, code=0, says=()):
        result = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=60,
                                check=False)
        said = result.stdout + result.stderr
        self.assertEqual(result.returncode, code, f"{arguments}\n{said}")
        for words in says:
            self.assertIn(words, said)
        return said

    def test_pieces_that_fit_are_accepted(self):
        self.run_program("check", "two.pvtu", "two.poly", "--angle", "20",
                         says=["accepted: constrained Delaunay, conforming at 1 interfaces, covers the input",
                               "pieces         2", "points         7", "of 2 edges, 2 of these between ranks"])

    def test_threads_change_nothing(self):
        said = [self.run_program("check", "two.pvtu", "two.poly", "--threads", n) for n in ("1", "2", "0")]
        self.assertEqual(said[0], said[1])
        self.assertEqual(said[0], said[2])

    def test_the_folder_that_the_program_runs_in_does_not_matter(self):
        result = subprocess.run([PROGRAM, "check", self.folder / "two.pvtu"], cwd="/", capture_output=True, text=True,
                                timeout=60, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_coordinate_that_differs_in_its_last_bit(self):
        self.right.write_bytes(vtu(RIGHT, 1, {6: (1, math.nextafter(0.5, 1))}))
        self.run_program("check", "two.pvtu", code=1, says=["point 6 has other coordinates in piece 0 than in piece 1"])
        self.run_program("convert", "two.pvtu", "whole.vtu", code=1, says=["two.pvtu", "do not fit together"])
        self.assertFalse((self.folder / "whole.vtu").exists())

    def test_a_point_of_the_interface_that_one_side_lacks(self):
        self.right.write_bytes(vtu(([(1, 2, 5), (1, 5, 4)], RIGHT[1]), 1))
        self.run_program("check", "two.pvtu", "two.poly", code=1, says=["open edge"])

    def test_a_missing_piece(self):
        (self.folder / "two.pvtu").write_text(PVTU.replace('<Piece Source="right.vtu"/>', ""))
        self.run_program("check", "two.pvtu", code=1, says=["pieces are missing", "open edge"])
        (self.folder / "two.pvtu").write_text(PVTU)
        self.right.unlink()
        self.run_program("check", "two.pvtu", code=2, says=["right.vtu"])

    def test_a_truncated_piece(self):
        whole = self.right.read_bytes()
        for size in (0, 200, len(whole) // 2, len(whole) - 40):
            self.right.write_bytes(whole[:size])
            self.run_program("check", "two.pvtu", code=2, says=["right.vtu"])

    def test_a_piece_without_numbers(self):
        self.right.write_bytes(vtu(RIGHT, 1).replace(b"global_number", b"another_array"))
        self.run_program("check", "two.pvtu", code=2, says=["piece 1 does not say which numbers its points have"])

    def test_convert_and_plot(self):
        for name in ("whole.vtu", "whole.msh"):
            self.run_program("convert", "two.pvtu", name)
            self.run_program("check", name, "two.poly", says=["points         7", "subdomains     2, 1 interfaces"])
        self.run_program("plot", "two.pvtu", "-o", "ranks.svg", "--color", "rank")
        self.run_program("plot", "whole.msh", "-o", "subdomains.svg", "--color", "subdomain")
        self.run_program("convert", "two.pvtu", "whole.ele")
        self.run_program("plot", "whole.ele", "--color", "rank", code=1, says=["does not list the rank"])

    def test_no_piece_is_written_over(self):
        before = self.right.read_bytes()
        self.run_program("convert", "two.pvtu", "right.vtu", code=1, says=["right.vtu", "INPUT reads it"])
        self.assertEqual(self.right.read_bytes(), before)


CODES = {"Float64": "d", "Int64": "q", "Int32": "i", "UInt8": "B"}


class Piece:
    """A .vtu as the standard describes it: the header is XML, arrays follow the underscore at their offsets."""

    def __init__(self, path):
        whole = path.read_bytes()
        begin = whole.index(b"<AppendedData")
        data = whole.index(b"_", begin) + 1
        root = xml.etree.ElementTree.fromstring(whole[:begin] + b"</VTKFile>")
        assert root.attrib["header_type"] == "UInt64" and root.attrib["byte_order"] == "LittleEndian"
        self.tag = root.find("UnstructuredGrid/Piece")
        self.kinds = {}
        for section in self.tag:
            for array in section:
                assert array.attrib["format"] == "appended"
                code = CODES[array.attrib["type"]]
                offset = data + int(array.attrib["offset"])
                size = struct.unpack_from("<Q", whole, offset)[0]
                values = struct.unpack_from(f"<{size // struct.calcsize(code)}{code}", whole, offset + 8)
                setattr(self, f"{section.tag}_{array.attrib['Name']}", values)
                if section.tag in ("PointData", "CellData"):
                    self.kinds["P" + section.tag, array.attrib["Name"]] = array.attrib["type"]
        self.points = list(zip(self.Points_Points[0::3], self.Points_Points[1::3]))
        self.numbers = self.PointData_global_number
        self.triangles, self.lines, begin = [], [], 0
        for cell, (end, kind) in enumerate(zip(self.Cells_offsets, self.Cells_types)):
            corners = tuple(self.numbers[v] for v in self.Cells_connectivity[begin:end])
            (self.triangles if kind == 5 else self.lines).append((corners, cell))
            begin = end


class Ranks(unittest.TestCase):
    """The files that several ranks write, checked independently of the program."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        subprocess.run([PROGRAM, "generate", "holes", "--columns", "4", "--rows", "3", "-o", "holes.poly"],
                       cwd=self.folder, check=True, capture_output=True)

    def mesh(self, ranks, *outputs, options=()):
        environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                           OMPI_MCA_rmaps_base_oversubscribe="1", ASAN_OPTIONS="detect_leaks=0")
        done = subprocess.run(["mpiexec", "-n", str(ranks), PROGRAM, "mesh", "holes.poly", "--area", "0.01", "-n", "20", *options,
                               *(word for output in outputs for word in ("-o", output))],
                              cwd=self.folder, check=False, capture_output=True, text=True, timeout=120, env=environment)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def read(self, name, level="0"):
        grid = xml.etree.ElementTree.parse(self.folder / name).find("PUnstructuredGrid")
        self.assertEqual(grid.attrib["GhostLevel"], level)
        pieces = [Piece(self.folder / tag.attrib["Source"]) for tag in grid.findall("Piece")]
        declared = {(section.tag, array.attrib["Name"]): array.attrib["type"]
                    for section in grid if section.tag in ("PPointData", "PCellData") for array in section}
        for piece in pieces:
            self.assertEqual(piece.kinds, declared)
            self.assertEqual(len(piece.points), int(piece.tag.attrib["NumberOfPoints"]))
            self.assertEqual(len(piece.triangles) + len(piece.lines), int(piece.tag.attrib["NumberOfCells"]))
        return pieces

    def test_the_pieces_of_three_ranks_are_one_mesh(self):
        self.mesh(3, "holes.pvtu")
        pieces = self.read("holes.pvtu")
        self.assertEqual(len(pieces), 3)
        place, number = {}, {}
        for piece in pieces:
            for n, p in zip(piece.numbers, piece.points):
                self.assertEqual(place.setdefault(n, p), p)
                self.assertEqual(number.setdefault(p, n), n)
        self.assertEqual(sorted(place), list(range(len(place))))

        sides = collections.Counter()
        lines = set()
        area = 0
        for rank, piece in enumerate(pieces):
            self.assertEqual(set(piece.CellData_rank), {rank})
            for (a, b, c), _ in piece.triangles:
                (ax, ay), (bx, by), (cx, cy) = place[a], place[b], place[c]
                area += ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2
                sides.update([(a, b), (b, c), (c, a)])
            lines.update(frozenset(line) for line, _ in piece.lines)
        self.assertEqual(set(sides.values()), {1})
        # Exactly the edges with one triangle are the boundary.
        boundary = {frozenset(side) for side in sides if side[::-1] not in sides}
        self.assertEqual(boundary, lines)
        edges = len({frozenset(side) for side in sides})
        triangles = sum(len(piece.triangles) for piece in pieces)
        self.assertEqual(len(place) - edges + triangles, 1 - 12)  # Euler, for 12 holes
        hole = 12 / 2 * math.sin(2 * math.pi / 12) * 0.3 ** 2
        self.assertAlmostEqual(area, 12 * (1 - hole), places=9)
        # Ranks share points.
        self.assertGreater(sum(len(piece.points) for piece in pieces), len(place) + 20)

    def test_subdomains_tell_the_pieces_apart(self):
        self.mesh(2, "holes.pvtu")
        held = [set(piece.CellData_subdomain) for piece in self.read("holes.pvtu")]
        self.assertEqual(held[0] | held[1], set(range(20)))
        self.assertFalse(held[0] & held[1])

    def test_ghosts_are_the_triangles_of_others_at_own_points(self):
        """Of what is no ghost, pieces have each triangle, line and point once; they are read back without ghosts."""
        self.mesh(3, "plain.pvtu")
        self.mesh(3, "holes.pvtu", options=["--ghost-layer"])
        plain, pieces = self.read("plain.pvtu"), self.read("holes.pvtu", level="1")
        everywhere = {corners for piece in plain for corners, _ in piece.triangles}
        found = {"triangles": [], "lines": [], "points": []}
        for rank, (piece, without) in enumerate(zip(pieces, plain)):
            own = {corners for corners, _ in without.triangles}
            points = {v for corners in own for v in corners}
            self.assertEqual({corners for corners, cell in piece.triangles if piece.CellData_vtkGhostType[cell] == 0}, own)
            self.assertEqual({corners for corners, _ in piece.triangles}, {t for t in everywhere if points & set(t)})
            for corners, cell in piece.triangles:
                self.assertEqual(piece.CellData_rank[cell] == rank, piece.CellData_vtkGhostType[cell] == 0)
            for kind in ("triangles", "lines"):
                found[kind] += [frozenset(corners) for corners, cell in getattr(piece, kind) if piece.CellData_vtkGhostType[cell] == 0]
            found["points"] += [n for n, ghost in zip(piece.numbers, piece.PointData_vtkGhostType) if ghost == 0]
        expected = {"triangles": {frozenset(t) for t in everywhere}, "points": {n for piece in plain for n in piece.numbers},
                    "lines": {frozenset(line) for piece in plain for line, _ in piece.lines}}
        for kind, all_of_them in found.items():
            self.assertEqual(len(all_of_them), len(set(all_of_them)), kind)
            self.assertEqual(set(all_of_them), expected[kind])
        for name in ("plain", "holes"):
            subprocess.run([PROGRAM, "check", f"{name}.pvtu", "holes.poly", "--area", "0.01"], cwd=self.folder, check=True, capture_output=True)
            subprocess.run([PROGRAM, "convert", f"{name}.pvtu", f"{name}.msh"], cwd=self.folder, check=True, capture_output=True)
        self.assertEqual((self.folder / "plain.msh").read_bytes(), (self.folder / "holes.msh").read_bytes())

    def test_the_merged_file_does_not_depend_on_the_ranks(self):
        wholes = []
        for ranks in 1, 3:
            self.mesh(ranks, "holes.vtu")
            whole = (self.folder / "holes.vtu").read_bytes()
            begin = whole.index(b"<AppendedData")
            root = xml.etree.ElementTree.fromstring(whole[:begin] + b"</VTKFile>")
            offset = [int(a.attrib["offset"]) for a in root.iter("DataArray") if a.attrib["Name"] == "rank"][0]
            data = whole.index(b"_", begin) + 1 + offset
            size = 8 + struct.unpack_from("<Q", whole, data)[0]
            self.assertEqual(set(whole[data + 8:data + size:4]), set(range(ranks)))
            wholes.append(whole[:data] + whole[data + size:])
        self.assertEqual(wholes[0], wholes[1])


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
