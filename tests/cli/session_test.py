#!/usr/bin/env python3
"""Adaptive meshes in files: --save of driftmesh mesh, on threads and ranks, and what check, convert and plot make of them.

usage: session_test.py DRIFTMESH [unittest options]
"""

import json
import re

import program

REQUEST = ("--generate", "pipe", "--area", "20", "-n", "12")


class Sessions(program.Cli):
    def save(self, name, *arguments, ranks=None):
        command = ("mesh", *REQUEST, "--save", name, "--json", "run.json", *arguments)
        result = self.run_program(*command) if ranks is None else self.on_ranks(ranks, *command)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn(name, result.stdout)
        self.assertNotIn("no mesh", result.stdout)
        record = json.loads((self.folder / "run.json").read_text())
        self.assertIn(name, [file["name"] for file in record["files"]])
        return record["mesh"]["digest"]

    def check(self, *arguments):
        text = self.succeed("check", *arguments)
        self.assertIn("accepted", text)
        return text

    def test_the_file_is_the_same_on_threads_and_ranks(self):
        digest = self.save("one.h5", "--threads", "1")
        text = self.check("one.h5")
        self.assertIn(digest, text)
        self.assertIn("generation 0, no fields", text)
        self.assertIn("angles of at least 20 degrees", text)
        first = (self.folder / "one.h5").read_bytes()
        for name, arguments, ranks in (("two.h5", ("--threads", "2", "--sleep"), None), ("three.kept", ("-o", "a.pvtu"), 3)):
            self.assertEqual(self.save(name, *arguments, ranks=ranks), digest)
            self.assertIn(digest, self.check(name))
            self.assertEqual(len((self.folder / name).read_bytes()), len(first))
        self.assertIn(digest, self.check("a.pvtu"))

    def test_a_saved_mesh_is_judged_by_the_bounds_of_its_session_or_others(self):
        self.save("flow.h5", "-o", "flow.vtu", "--plot", "flow.png")
        self.assertEqual(re.search(r"digest +(\w+)", self.check("flow.h5"))[1],
                         re.search(r"digest +(\w+)", self.check("flow.vtu"))[1])
        for wrong, says in (("--area", "10"), "large area"), (("--angle", "40"), "angle"):
            result = self.run_program("check", "flow.h5", *wrong)
            self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
            self.assertIn(says, result.stdout)
        self.succeed("generate", "rectangle-hole", "-o", "other.poly")
        self.assertEqual(self.run_program("check", "flow.h5", "other.poly").returncode, 1)

    def test_other_commands_read_it(self):
        self.save("flow.h5")
        self.succeed("convert", "flow.h5", "flow.vtu")
        self.check("flow.vtu", "--against", "flow.h5")
        self.succeed("plot", "flow.h5", "-o", "flow.svg")
        self.succeed("adapt", "flow.h5", "--max-length", "3", "-o", "next.vtu")
        self.refuse("convert", "flow.h5", "flow.h5", says=["flow.h5"])

    def test_a_domain_of_polygons_is_kept_with_its_holes(self):
        self.write("lake.geojson", json.dumps({"type": "Polygon", "coordinates": [
            [[0, 0], [900, 0], [900, 900], [0, 900], [0, 0]], [[300, 300], [300, 600], [600, 600], [600, 300], [300, 300]]],
            "crs": {"type": "name", "properties": {"name": "EPSG:32632"}}}))
        self.succeed("mesh", "lake.geojson", "--area", "2000", "--save", "lake.h5")
        self.assertIn("720000", self.check("lake.h5").replace(",", ""))

    def test_errors(self):
        self.refuse("mesh", *REQUEST, "--save", "a", "--method", "coupled", code=2, says=["--method", "--save"])
        self.refuse("mesh", "--generate", "pipe", "--save", "a", "-n", "1", code=2, says=["one piece"])
        self.refuse("mesh", *REQUEST, "--save", "-", code=2, says=["--save is standard output"])
        self.refuse("mesh", *REQUEST, "--save", "none/a", says=["none/a"])
        self.refuse("mesh", *REQUEST, "--save", "a.h5", "-o", "a.h5", says=["--save", "--output"])
        self.save("flow.h5")
        whole = (self.folder / "flow.h5").read_bytes()
        damaged = bytearray(whole)
        damaged[-len(damaged) // 3] ^= 1
        self.write("damaged.h5", bytes(damaged))
        self.write("cut.h5", whole[:len(whole) // 2])
        for name in ("damaged.h5", "cut.h5"):
            for command in (("check", name), ("convert", name, "a.vtu")):
                self.assertIn(name, self.refuse(*command, code=2 if command[0] == "check" else 1).stderr)
        extents, version = 2 * (1).to_bytes(8, "little"), (2).to_bytes(8, "little")
        later = bytearray(whole)
        later[whole.index(extents + version, whole.index(b"version")) + len(extents)] = 9
        self.write("later.h5", bytes(later))
        self.refuse("check", "later.h5", code=2, says=["later.h5", "an adaptive mesh of version 9", "reads version 2"])


if __name__ == "__main__":
    program.main()
