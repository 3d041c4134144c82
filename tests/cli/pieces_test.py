#!/usr/bin/env python3
"""Meshes in pieces, written here byte by byte: what the program says of them, and what it makes of them.

usage: pieces_test.py DRIFTMESH [unittest options]
"""

import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

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
        self.run_program("check", "two.pvtu", code=2, says=["piece 1 does not tell the numbers of its points"])

    def test_convert_and_plot(self):
        for name in ("whole.vtu", "whole.msh"):
            self.run_program("convert", "two.pvtu", name)
            self.run_program("check", name, "two.poly", says=["points         7", "subdomains     2, 1 interfaces"])
        self.run_program("plot", "two.pvtu", "-o", "ranks.svg", "--color", "rank")
        self.run_program("plot", "whole.msh", "-o", "subdomains.svg", "--color", "subdomain")
        self.run_program("convert", "two.pvtu", "whole.ele")
        self.run_program("plot", "whole.ele", "--color", "rank", code=1, says=["does not tell the rank"])

    def test_no_piece_is_written_over(self):
        before = self.right.read_bytes()
        self.run_program("convert", "two.pvtu", "right.vtu", code=1, says=["is the input itself"])
        self.assertEqual(self.right.read_bytes(), before)


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
