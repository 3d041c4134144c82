#!/usr/bin/env python3
"""The encodings of .vtu files that VTK, meshio and others write, by a writer of its own, read and damaged.

usage: vtu_test.py DRIFTMESH [unittest options]
"""

import base64
import itertools
import re
import struct
import zlib

import program
from program import SQUARE, Cli, main

CODES = {"Float64": "d", "Int64": "q", "Int32": "i", "UInt8": "B"}
LENGTHS = {"UInt32": "I", "UInt64": "Q"}


class Grid:
    """The arrays of a .vtu that driftmesh has written: raw, appended, with lengths of 64 bits."""

    def __init__(self, content):
        head, data = content.split(b'<AppendedData encoding="raw">\n   _', 1)
        self.points, self.cells = re.search(rb'NumberOfPoints="(\d+)" NumberOfCells="(\d+)"', head).groups()
        self.sections = []  # (name, [(type, name, components, values)])
        for section, body in re.findall(rb"<(PointData|CellData|Points|Cells)[^>]*>(.*?)</\1>", head, re.DOTALL):
            arrays = []
            for tag in re.findall(rb"<DataArray ([^>]*)/>", body):
                about = {key.decode(): value.decode() for key, value in re.findall(rb'(\w+)="([^"]*)"', tag)}
                offset = int(about["offset"])
                size = struct.unpack_from("<Q", data, offset)[0]
                code = CODES[about["type"]]
                values = struct.unpack_from(f"<{size // struct.calcsize(code)}{code}", data, offset + 8)
                arrays.append((about["type"], about["Name"], int(about.get("NumberOfComponents", 1)), values))
            self.sections.append((section.decode(), arrays))


class Encoding:
    def __init__(self, place, coding, lengths, compressed, block=1000, compressor="vtkZLibDataCompressor"):
        self.place, self.coding, self.lengths, self.compressed, self.block = place, coding, lengths, compressed, block
        self.compressor = compressor if compressed else None

    def text(self, data):
        return base64.b64encode(data) if self.coding == "base64" else data

    def numbers(self, *values):
        return struct.pack(f"<{len(values)}{LENGTHS[self.lengths]}", *values)

    def encoded(self, data):
        if not self.compressed:
            return self.text(self.numbers(len(data)) + data)
        blocks = [data[i:i + self.block] for i in range(0, len(data), self.block)]
        packed = [zlib.compress(block) for block in blocks]
        last = len(data) % self.block
        head = self.numbers(len(blocks), self.block, last, *map(len, packed))
        return self.text(head) + self.text(b"".join(packed))

    def write(self, grid, with_others=True):
        appended, lines = b"", []

        def array(kind, name, components, values):
            nonlocal appended
            about = f'type="{kind}" Name="{name}" NumberOfComponents="{components}" RangeMin="0" RangeMax="1"'
            data = struct.pack(f"<{len(values)}{CODES[kind]}", *values)
            keys = b'<InformationKey name="L2_NORM_RANGE" location="vtkDataArray" length="1">' \
                   b'<Value index="0"> 0.5 </Value></InformationKey>' if with_others else b""
            if self.place == "appended":
                lines.append(f'<DataArray {about} format="appended" offset="{len(appended)}">'.encode() + keys)
                appended += self.encoded(data)
            elif self.place == "ascii":
                words = " ".join(map(repr, values)).encode()
                lines.append(f'<DataArray {about} format="ascii">\n'.encode() + words + b"\n" + keys)
            else:
                lines.append(f'<DataArray {about} format="binary">\n  '.encode() + self.encoded(data) + b"\n" + keys)
            lines.append(b"</DataArray>")

        compressor = f' compressor="{self.compressor}"' if self.compressor else ""
        lines.append(f'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
                     f'header_type="{self.lengths}"{compressor}>\n<UnstructuredGrid>'.encode())
        if with_others:
            lines.append(b"<FieldData>")
            array("Float64", "TimeValue", 1, [0.25])
            lines.append(b"</FieldData>")
        lines.append(b'<Piece NumberOfPoints="%s" NumberOfCells="%s">' % (grid.points, grid.cells))
        for section, arrays in grid.sections:
            lines.append(f"<{section}>".encode())
            if section == "PointData" and with_others:
                array("Float64", "temperature", 1, [0.5] * int(grid.points))
            for one in arrays:
                array(*one)
            lines.append(f"</{section}>".encode())
        lines.append(b"</Piece>\n</UnstructuredGrid>")
        if self.place == "appended":
            lines.append(f'<AppendedData encoding="{self.coding}">\n  _'.encode() + appended + b"\n</AppendedData>")
        return b"\n".join(lines) + b"\n</VTKFile>\n"


PLACES = [("appended", "raw"), ("appended", "base64"), ("binary", "base64")]
ENCODINGS = [Encoding(place, coding, lengths, compressed, block)
             for (place, coding), lengths, (compressed, block) in
             itertools.product(PLACES, LENGTHS, [(False, 0), (True, 1000), (True, 1024), (True, 32768)])]
ENCODINGS.append(Encoding("ascii", None, "UInt32", False))


# With attributes, markers and a region.
RICH_SQUARE = (SQUARE.replace("4 2 0 0", "4 2 1 1").replace("1 0 0", "1 0 0 .5 3", 1).replace("2 4 0", "2 4 0 1 0", 1)
               .replace("3 4 4", "3 4 4 1 0", 1).replace("4 0 4", "4 0 4 1 -7", 1) + "1\n1 1 1 2.5 0\n")


class Vtu(Cli):
    def setUp(self):
        super().setUp()
        self.write("square.poly", RICH_SQUARE)
        self.succeed("mesh", "square.poly", "--area", "0.05", "-n", "3", "-o", "mesh.vtu")
        self.original = (self.folder / "mesh.vtu").read_bytes()
        self.grid = Grid(self.original)

    def test_every_encoding_reads_as_the_same_mesh(self):
        self.assertEqual([len(arrays) for _, arrays in self.grid.sections], [2, 3, 1, 3])
        for encoding, others in itertools.product(ENCODINGS, (True, False)):
            with self.subTest(**encoding.__dict__, others=others):
                self.write("other.vtu", encoding.write(self.grid, others))
                self.succeed("convert", "other.vtu", "back.vtu")
                self.assertEqual((self.folder / "back.vtu").read_bytes(), self.original)

    def test_other_compressors_are_refused_with_what_to_do(self):
        for name in ("vtkLZ4DataCompressor", "vtkLZMADataCompressor"):
            self.write("other.vtu", Encoding("appended", "raw", "UInt32", True, compressor=name).write(self.grid))
            self.refuse("convert", "other.vtu", "back.vtu", says=["other.vtu:2", name, "zlib"])

    def refuse_all(self, files):
        """Every one of the {name: content} is refused."""
        for what, content in files.items():
            with self.subTest(what):
                self.write("other.vtu", content)
                self.refuse("convert", "other.vtu", "back.vtu", says=["other.vtu"])

    def test_every_length_is_checked(self):
        for encoding in (Encoding("appended", "raw", "UInt64", True), Encoding("appended", "base64", "UInt32", True),
                         Encoding("binary", "base64", "UInt32", True), Encoding("appended", "raw", "UInt32", False),
                         Encoding("binary", "base64", "UInt64", False)):
            numbers = encoding.numbers
            count = {"calls": 0}
            for which, add in itertools.product(range(8), (-1, 1, 7, 1 << 30)):
                def wrong(*values, which=which, add=add):
                    changed = list(values)
                    if count["calls"] == 3 and which < len(changed):  # of a marker, not of other arrays
                        changed[which] = max(changed[which] + add, 0)
                        count["changed"] = changed != list(values)
                    count["calls"] += 1
                    return numbers(*changed)
                count.update(calls=0, changed=False)
                encoding.numbers = wrong
                content = encoding.write(self.grid)
                if count["changed"]:
                    self.refuse_all({f"{encoding.place} {encoding.coding} number {which} + {add}": content})
            encoding.numbers = numbers

    def test_every_count_of_the_header_is_checked(self):
        for encoding in ENCODINGS[::5] + ENCODINGS[-1:]:
            whole = encoding.write(self.grid)
            files = {}
            for name, text in (("points", rb'NumberOfPoints="%d"'), ("cells", rb'NumberOfCells="%d"')):
                now = int(getattr(self.grid, name))
                for other in (0, now - 1, now + 1, now * 2, 10 ** 15, 1 << 62):
                    files[f"{name} {other}"] = whole.replace(text % now, text % other)
            at = whole.index(b'Name="marker" NumberOfComponents="1"')
            files["components"] = whole[:at] + whole[at:].replace(b'NumberOfComponents="1"', b'NumberOfComponents="2"', 1)
            files["type"] = whole[:at - 10] + whole[at - 10:].replace(b"Int32", b"Int64", 1) \
                if encoding.place != "ascii" else whole.replace(b"</DataArray>", b" 7 </DataArray>", 1) \
                .replace(b'Name="TimeValue"', b'Name="marker"').replace(b"FieldData", b"PointData")
            files["end"] = whole.replace(b"</VTKFile>\n", b"")
            files["more"] = whole + b"more"
            self.refuse_all(files)

    def test_damaged_data(self):
        for encoding in ENCODINGS[:-1:5]:
            whole = encoding.write(self.grid)
            files = {f"cut after {part}/8": whole[:len(whole) * part // 8] for part in range(8)}
            if encoding.place == "appended":
                end = whole.index(b"\n</AppendedData>")
                files["a byte less"] = whole[:end - 1] + whole[end:]
                files["data behind"] = whole[:end] + b"AAAAAAAA" + whole[end:]
            else:
                first = whole.index(b'Name="marker"')
                begin = whole.index(b"\n  ", first) + 3
                files["data behind"] = whole[:begin] + whole[begin:].replace(b"\n", b"AAAA\n", 1)
                files["no base64"] = whole[:begin] + b"*" + whole[begin + 1:]
            self.refuse_all(files)

    def test_offsets_that_overlap(self):
        whole = Encoding("appended", "raw", "UInt64", True).write(self.grid)
        offsets = [int(offset) for offset in re.findall(rb'offset="(\d+)"', whole)]
        self.refuse_all({f"offset {old} as {new}": whole.replace(b'offset="%d"' % old, b'offset="%d"' % new)
                         for old, new in ((offsets[2], offsets[1]), (offsets[3], offsets[3] - 1),
                                          (offsets[-1], offsets[-1] + 1), (offsets[-1], 1 << 40))})


class Pieces(Cli):
    def setUp(self):
        super().setUp()
        self.write("square.poly", RICH_SQUARE)
        self.succeed("mesh", "square.poly", "--area", "0.05", "-n", "3", "-o", "m.pvtu")

    def test_what_a_pvtu_declares_is_in_its_pieces(self):
        whole = (self.folder / "m_0.vtu").read_bytes()
        names = [b"marker", b"attribute", b"global_number", b"region", b"subdomain", b"rank"]
        for name in names:
            for found in re.finditer(b'Name="' + name + b'"', whole):
                other = b'Name="' + b"x" * len(name) + b'"'
                self.write("m_0.vtu", whole[:found.start()] + other + whole[found.end():])
                self.refuse("convert", "m.pvtu", "x.vtu", says=["m_0.vtu", name.decode(), ".pvtu declares"])
        self.write("m_0.vtu", whole)
        text = (self.folder / "m.pvtu").read_text()
        self.write("m.pvtu", text.replace('Name="attribute"', 'Name="attribute" NumberOfComponents="2"'))
        self.refuse("convert", "m.pvtu", "x.vtu", says=["m_0.vtu", "attribute", "declares 2"])
        for more in ("more", "<Piece/>"):
            self.write("m.pvtu", text + more)
            self.refuse("check", "m.pvtu", code=2, says=["m.pvtu"])


if __name__ == "__main__":
    main()
