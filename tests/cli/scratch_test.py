#!/usr/bin/env python3
"""Finished subdomains asleep on disk (--scratch): the mesh is the same, and nothing is left behind. What memory they take is
measured in limits_test.py.

usage: scratch_test.py DRIFTMESH [unittest options]
"""

import filecmp
import os
import pathlib
import re
import signal
import subprocess
import time

import program

CUT = ("--triangles", "600k", "-n", "60")


class Scratch(program.Cli):
    def setUp(self):
        super().setUp()
        self.write("square.poly", program.SQUARE)
        self.bed = self.folder / "bed"
        self.bed.mkdir()

    def start(self, *arguments, ranks=None, **options):
        ranks = ["mpiexec", "-n", str(ranks)] if ranks else []
        return subprocess.Popen([*ranks, program.PATH, "mesh", "square.poly", *arguments], cwd=self.folder,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                env=program.RANKS_ENVIRONMENT, **options)

    def run_to_end(self, *arguments, **options):
        process = self.start(*arguments, **options)
        output, errors = process.communicate(timeout=program.MESHER_SECONDS)
        return process.returncode, output, errors

    def digest(self, *arguments, **options):
        code, output, errors = self.run_to_end(*arguments, **options)
        self.assertEqual(code, 0, errors)
        self.assertEqual(list(self.bed.iterdir()), [])
        return re.search(r"digest +(\w+)", output).group(1)

    def test_the_mesh_is_that_of_memory(self):
        for presplit in ("on", "off"):
            asleep = self.digest(*CUT, "--presplit", presplit, "--sleep")
            for threads in ("1", "2", "3"):
                self.assertEqual(self.digest(*CUT, "--presplit", presplit, "--scratch", "bed", "--threads", threads), asleep)
        awake = self.digest(*CUT)
        self.assertEqual(self.digest(*CUT, "--scratch", "bed"), awake)
        self.assertEqual(self.digest(*CUT, "--scratch", "bed", ranks=2), awake)

    def test_files_are_the_same(self):
        self.digest(*CUT, "--sleep", "-o", "a.pvtu", "-o", "a.msh")
        self.digest(*CUT, "--scratch", "bed", "-o", "b.pvtu", "-o", "b.msh")
        for end in ("_0.vtu", ".msh"):
            self.assertTrue(filecmp.cmp(self.folder / f"a{end}", self.folder / f"b{end}", shallow=False), end)

    def test_many_pieces(self):
        """The same for any number of threads, and each is made while most subdomains sleep."""
        made = [self.digest("--triangles", "11M", "-n", "550", "--scratch", "bed", "--threads", threads, "-o",
                            f"t{threads}.pvtu") for threads in ("1", "2")]
        pieces = sorted(self.folder.glob("t1_*.vtu"))
        self.assertEqual(len(pieces), 3)
        for piece in pieces:
            twin = piece.with_name(piece.name.replace("t1", "t2"))
            self.assertTrue(filecmp.cmp(piece, twin, shallow=False), piece)
        checked = self.succeed("check", "t1.pvtu", "square.poly", "--angle", "20")
        self.assertIn(made[0], checked)
        self.assertIn("accepted", checked)
        self.assertEqual(made[0], made[1])

    def test_refusals_before_the_work_begins(self):
        for triangles, arguments, code, words in (
                ("600k", ("nowhere",), 1, ("nowhere", "No such file or directory")),
                ("600k", ("square.poly",), 1, ("square.poly", "Not a directory")),
                ("1T", ("bed", "-n", "4000", "--max-memory", "10T"), 1, ("bed", "free", "--scratch")),
                ("600k", ("bed", "-n", "1"), 2, ("--scratch", "one piece")),
                ("600k", ("bed", "--keep-incomplete"), 2, ("--scratch", "--keep-incomplete"))):
            ended, _, errors = self.run_to_end("--triangles", triangles, "--scratch", *arguments)
            self.assertEqual(ended, code, errors)
            for word in words:
                self.assertIn(word, errors)

    def test_a_disk_that_gets_full(self):
        """What the file system says, on a thread and on ranks, and nothing is left."""
        for ranks in ([], ["mpiexec", "-n", "2"]):
            as_on_a_full_disk = ["sh", "-c", 'trap "" XFSZ; ulimit -f 12000; exec "$0" "$@"']
            ended = subprocess.run([*ranks, *as_on_a_full_disk, program.PATH, "mesh", "square.poly", "--triangles", "4M",
                                    "-n", "200", "--scratch", "bed"], cwd=self.folder, capture_output=True, text=True,
                                   timeout=program.MESHER_SECONDS, check=False, env=program.RANKS_ENVIRONMENT)
            errors = ended.stderr
            self.assertEqual(ended.returncode, 1, errors)
            self.assertIn("bed: cannot write scratch data", errors)
            self.assertIn("File too large", errors)
            self.assertEqual(list(self.bed.iterdir()), [])

    def sleeps_in_bed(self, process):
        folder = pathlib.Path(f"/proc/{process.pid}/fd")
        try:
            return any(str(self.bed) in os.readlink(descriptor) for descriptor in folder.iterdir())
        except FileNotFoundError:  # closed meanwhile
            return False

    def test_nothing_is_left_by_a_killed_process(self):
        for number in (signal.SIGKILL, signal.SIGINT, signal.SIGABRT):
            process = self.start("--triangles", "100M", "--scratch", "bed")
            while not self.sleeps_in_bed(process):
                self.assertIsNone(process.poll())
                time.sleep(0.05)
            process.send_signal(number)
            process.communicate()
            self.assertEqual(process.returncode, -number)
            self.assertEqual(list(self.bed.iterdir()), [])


if __name__ == "__main__":
    program.main()
