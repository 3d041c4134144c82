#!/usr/bin/env python3
"""--max-memory is a ceiling: the peak of every process stays within 1.05 times the limit, or the run is refused or
stopped with a message that names the limit, whatever takes the memory.

usage: limits_test.py DRIFTMESH [unittest options]
"""

import os
import random
import re
import struct
import subprocess
import unittest
import zlib

import program

MEGABYTE = 1 << 20
GRADED = ("--size", "1e-9+x")  # far more triangles than fit
LIMITS = (50, 90, 200)  # MiB


class Ceiling(program.Cli):
    def setUp(self):
        super().setUp()
        self.write("square.poly", program.SQUARE)

    def peak_of(self, *command):
        """Exit code, standard error and the peak of the largest process (that of mpiexec has its ranks' among it)."""
        errors = self.folder / "errors.txt"
        with errors.open("w") as stream:
            process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=stream,
                                       env=program.RANKS_ENVIRONMENT)
            _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, errors.read_text(errors="replace"), usage.ru_maxrss * 1024

    def hold(self, limit, *arguments, ranks=None):
        """Runs `mesh` within `limit` MiB. Returns whether it was completed."""
        start = ["mpiexec", "-n", str(ranks)] if ranks else []
        code, errors, peak = self.peak_of(*start, program.PATH, "mesh", "square.poly", "--max-memory", f"{limit}M",
                                          *arguments)
        what = f"{limit} MiB, {ranks} ranks, {arguments}: peak {peak / MEGABYTE:.1f} MiB\n{errors}"
        self.assertLessEqual(peak, 1.05 * limit * MEGABYTE, what)
        self.assertIn(code, (0, 3), what)
        if code == 3:
            self.assertIn("--max-memory", errors, what)
            self.assertNotIn("terminate called", errors, what)
        return code == 0

    def test_graded_sizes_in_one_piece(self):
        for limit in (50, 90):
            for output in ([], ["-o", "a.vtu"], ["-o", "a.ele", "--keep-incomplete"], ["-o", "a.msh"],
                           ["--plot", "a.png", "--keep-incomplete"]):
                self.assertFalse(self.hold(limit, *GRADED, *output))

    def test_what_fits_is_kept(self):
        """An incomplete mesh is written within the limit, too, and it is not a small part of what would fit."""
        self.hold(150, *GRADED, "--keep-incomplete", "-o", "kept.vtu")
        with (self.folder / "kept.vtu").open("rb") as file:
            head = file.read(4000)  # not all: children inherit the peak of this process
        triangles = int(re.search(rb'NumberOfCells="(\d+)"', head).group(1))
        self.assertGreater(triangles, 1_000_000)

    def test_subdomains_of_one_process(self):
        for limit in LIMITS:
            self.hold(limit, "-n", "50", "--area", "3e-5", "-o", "a.vtu")
            self.hold(limit, "-n", "3000", "--area", "3e-5", "-o", "a.ele")

    def test_many_tiny_subdomains_on_ranks(self):
        self.assertFalse(self.hold(60, "-n", "40000", ranks=2))
        self.assertTrue(self.hold(200, "-n", "10000", ranks=2))

    def test_finished_subdomains_are_small(self):
        """A subdomain that is done keeps its triangles, but nothing that only the work on them needed."""
        code, errors, peak = self.peak_of(program.PATH, "mesh", "square.poly", "-n", "20000", "--triangles", "400k")
        self.assertEqual(code, 0, errors)
        self.assertLessEqual(peak, 40 * MEGABYTE + 20000 * 4500)

    def test_meshes_written_by_ranks(self):
        for limit in (60, 120):
            for output in ("a.pvtu", "a.vtu", "a.ele"):
                self.hold(limit, "-n", "100", "--area", "4e-5", "-o", output, ranks=2)

    def test_a_rank_that_gets_the_work_of_the_others(self):
        for limit in (40, 60):
            self.hold(limit, "-n", "300", "--area", "3e-5", "--balance", "stealing", "--mapping", "block",
                      "--map-by-area", "--drag", "1,0.02", ranks=2)

    def test_a_fast_rank_takes_no_more_than_it_has_memory_for(self):
        """Two million triangles in all, of which it would take all but a tenth if it could."""
        for policy in ("stealing", "greedy", "diffusion"):
            self.assertTrue(self.hold(80, "-n", "64", "--triangles", "2M", "--balance", policy, "--drag", "1,0.2",
                                      ranks=2))

    def test_what_only_fits_asleep_sleeps(self):
        """Asleep, a triangle takes a quarter of the memory, so the forecast does not refuse what then succeeds."""
        self.assertTrue(self.hold(60, "-n", "200", "--area", "1.5e-5", "--sleep"))
        self.assertTrue(self.hold(60, "-n", "200", "--area", "1.5e-5"))
        self.assertTrue(self.hold(60, "--area", "1.5e-5"))
        self.assertFalse(self.hold(60, "-n", "1", "--area", "1.5e-5"))

    def test_subdomains_on_disk(self):
        """Four million triangles take 40 MB asleep in memory, besides the program."""
        self.assertTrue(self.hold(40, "--triangles", "4M", "--threads", "1", "--scratch", "."))

    def test_random_requests(self):
        wanted = os.environ.get("DRIFTMESH_SEED", "1")
        seed = random.randrange(2**32) if wanted == "random" else int(wanted)
        print(f"seed {seed}", flush=True)
        choose = random.Random(seed)
        for _ in range(6):
            limit = choose.choice(LIMITS)
            area = ["--area", f"{16 / (limit * MEGABYTE / choose.uniform(10, 60)):.2g}"]
            parts = choose.choice(([], ["-n", str(choose.choice((20, 200, 2000)))]))
            ranks = choose.choice((None, 2)) if parts else None
            sleep = choose.choice(([], ["--sleep"])) if parts else []
            output = choose.choice(([], ["-o", "a.vtu"], ["-o", "a.ele"], ["-o", "a.msh"], ["--plot", "a.png"]))
            with self.subTest(seed=seed):
                self.hold(limit, *choose.choice((area, [*area, "--size", "0.001+0.1*y"])), *parts, *sleep, *output,
                          ranks=ranks)


class Bombs(program.Cli):
    """A .vtu takes the memory of the mesh that it holds, not that of what its data unpack to."""

    UNPACKED = 72 * MEGABYTE
    MOST = 56 * MEGABYTE

    def packed(self, unit, total, block):
        """Repetitions of some bytes as VTK's compressed data, and how many bytes these are."""
        block -= block % len(unit)
        whole, rest = divmod(total - total % len(unit), block)
        packs = [self.deflated(unit, block)] * whole + ([self.deflated(unit, rest)] if rest else [])
        return struct.pack(f"<{3 + len(packs)}Q", len(packs), block, rest, *map(len, packs)) + b"".join(packs), whole * block + rest

    @staticmethod
    def deflated(unit, size):
        part = unit * (65536 // len(unit))
        deflater, made = zlib.compressobj(6), []
        for _ in range(size // len(part)):
            made.append(deflater.compress(part))
        return b"".join([*made, deflater.compress(unit * (size % len(part) // len(unit))), deflater.flush()])

    def bomb(self, points, cells, arrays):
        """`arrays`: section, name, type, components, unit, size, size of a block."""
        text, data = {"PointData": "", "CellData": "", "Points": "", "Cells": ""}, b""
        for section, name, kind, components, unit, size, block in arrays:
            text[section] += (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="appended" '
                              f'offset="{len(data)}"/>')
            data += self.packed(unit, size, block)[0]
        inside = "".join(f"<{section}>{lines}</{section}>" for section, lines in text.items())
        self.write("bomb.vtu", f'<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
                   f'header_type="UInt64" compressor="vtkZLibDataCompressor"><UnstructuredGrid><Piece NumberOfPoints="{points}" '
                   f'NumberOfCells="{cells}">{inside}</Piece></UnstructuredGrid><AppendedData encoding="raw">_'.encode()
                   + data + b"</AppendedData></VTKFile>")

    def test_what_is_unpacked_takes_no_memory(self):
        seed = random.randrange(1 << 32)
        print(f"seed {seed}", flush=True)
        draw = random.Random(seed)
        zero, total = bytes(8), self.UNPACKED
        place = ("Points", "Points", "Float64", 3)
        cells = [("Cells", "connectivity", "Int64", 1), ("Cells", "offsets", "Int64", 1), ("Cells", "types", "UInt8", 1)]
        block = lambda: draw.choice([1 << 15, 1 << 20, total])
        one_cell = [(*cells[0], zero, 24, 24), (*cells[1], struct.pack("<q", 3), 8, 8), (*cells[2], b"\5", 1, 1)]
        three = (*place, zero, 72, 72)
        small = draw.choice(["UInt8", "Int8"])
        bombs = {
            "points": (total // 24, 1, [(*place, struct.pack("<3d", draw.random(), 1, 0), total, block()), *one_cell]),
            "small points": (total // 12, 1, [("Points", "Points", "Float32", 3, bytes(12), total, block()), *one_cell]),
            "types": (3, total, [three, (*cells[0], zero, 24, 24), (*cells[1], zero, 24, 24), (*cells[2], b"\5", total, block())]),
            "offsets": (3, total // 2, [three, ("Cells", "connectivity", small, 1, b"\0", total, block()),
                                        ("Cells", "offsets", small, 1, b"\3", total // 2, block()),
                                        (*cells[2], b"\5", total // 2, block())]),
            "corners": (3, 1, [three, ("Cells", "connectivity", small, 1, b"\1", total, block()), *one_cell[1:]]),
            "attributes": (3, 1, [three, ("PointData", "attribute", "Float64", total // 24, zero, total - total % 24, block()), *one_cell]),
            "markers": (3, 1, [three, ("PointData", "marker", "Int32", total // 12, bytes(4), total - total % 12, block()), *one_cell]),
            "regions": (3, 1, [three, ("CellData", "region", "Float64", total // 8, zero, total, block()), *one_cell]),
            "another": (3, 1, [three, ("CellData", "other", "Float64", 1, zero, total, block()), *one_cell]),
        }
        for what, (points, count, arrays) in bombs.items():
            with self.subTest(what=what):
                self.bomb(points, count, arrays)
                process = subprocess.Popen([program.PATH, "convert", "bomb.vtu", "x.msh"], cwd=self.folder, stderr=subprocess.PIPE)
                errors = process.stderr.read().decode(errors="replace")
                process.stderr.close()
                _, status, usage = os.wait4(process.pid, 0)
                process.returncode = os.waitstatus_to_exitcode(status)
                self.assertEqual(process.returncode, 0 if what == "another" else 1, errors)
                self.assertLess(usage.ru_maxrss * 1024, self.MOST, what)
                self.assertLessEqual(errors.count("\n"), 1)

    def test_streams_that_never_end(self):
        """Given up as soon as they cannot be what is expected, and long before the memory is full."""
        for source in ("cat /dev/zero", "yes", "yes '<'"):
            for command in ("mesh -", "mesh -.geojson", "check -", "convert - x.vtu", "convert -.msh x.vtu", "plot - -o x.png"):
                if source == "yes '<'" and command in ("check -", "convert - x.vtu", "plot - -o x.png"):
                    continue  # like a file, so that it is read up to the limit
                process = subprocess.Popen(["bash", "-c", f"{source} | exec '{program.PATH}' {command}"], cwd=self.folder,
                                           stderr=subprocess.PIPE)
                errors = process.stderr.read().decode(errors="replace")
                process.stderr.close()
                _, status, usage = os.wait4(process.pid, 0)
                process.returncode = os.waitstatus_to_exitcode(status)
                self.assertIn(process.returncode, (1, 2), (source, command, errors))
                self.assertIn("does not begin like", errors)
                self.assertLess(usage.ru_maxrss * 1024, self.MOST)


if __name__ == "__main__":
    program.main()
